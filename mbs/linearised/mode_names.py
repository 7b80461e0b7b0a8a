"""Names of modes by where their strain energy is and by how that part moves: "first bending of rotor", "axial of B".

A shaft bends, twists or stretches, each in coordinates of its own; its modes of one kind are counted in rising
frequency, those of bending in pairs, as it bends in two planes. Bearings, or springs, that have energy alike are named
together, bearings by the direction in which they are strained. Whirl goes with the spin (forward), against it, or stays
in a plane.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import ComplexArray, IntArray
from mbs.linearised.modes import Modes
from mbs.model.body import Body
from mbs.model.elements import OnRings
from mbs.model.equilibrium import Equilibrium

ALIKE = 0.5
"""Part of the largest share of strain energy from which on another bearing or spring is named beside the first."""

IN_A_PLANE = 0.1
"""Size of the direction of whirl below which a motion counts as one in a plane."""

_ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth")
_WAYS = (("axial", (0,)), ("radial", (1, 2)), ("twisting", (3,)), ("tilting", (4, 5)))
_STRETCHED = (("bending", [4, 5]), ("torsion", [3]), ("stretching", [0]))
"""How a shaft deforms, and the freedoms of its places by which it does."""


def mode_names(balance: Equilibrium, found: Modes, chosen: IntArray, whirl: bool = True) -> dict[int, str]:
    """Names of some modes by their indices; empty for modes that strain nothing.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium at which the modes are.
    found : Modes
        All modes.
    chosen : array of int
        Indices of the modes that are named, in rising frequency.
    whirl : bool
        Whether names end with the direction of whirl.
    """
    counts: dict[str, int] = {}
    names = {mode: _name(balance, found, mode, counts) for mode in chosen.tolist()}
    return {mode: name + turning if whirl else name for mode, (name, turning) in names.items()}


def ordinal(number: int) -> str:
    """A number from 1 on as a word: first, second; 11th.

    Parameters
    ----------
    number : int
        The number.
    """
    return _ORDINALS[number - 1] if number <= len(_ORDINALS) else f"{number}th"


def _name(balance: Equilibrium, found: Modes, mode: int, counts: dict[str, int]) -> tuple[str, str]:
    """Name of one mode and its whirl; `counts` is how many of a body came before it, by kind."""
    shares, shape = found.shares[:, mode], found.shapes[:, mode]
    if not shares.max(initial=0.0) > 0.0:
        return "", ""
    system, first = balance.system, found.parts[int(np.argmax(shares))]
    bodies = {body.name: body for body in system.bodies}
    if first in bodies:
        return _of_body(bodies[first], shape[system.own(first)], counts)
    elements = {connected.element.name: place for place, connected in enumerate(system.elements)}
    rings = {name for name, place in elements.items() if isinstance(system.elements[place].element, OnRings)}
    if first in elements and first not in rings:
        return f"mesh of {first}", ""
    kind = rings if first in rings else set(found.parts) - set(bodies) - set(elements)
    ranked = sorted(zip(-shares, found.parts, strict=True))
    alike = [part for share, part in ranked if part in kind and -share >= ALIKE * shares.max()]
    if first not in rings:
        return f"on {', '.join(alike)}", ""
    energies, moved = np.zeros(6), []
    for place in map(elements.__getitem__, alike):
        ports = system.elements[place].transform @ shape
        force = balance.element_stiffness[place] @ ports
        # of rollers that are bodies, both rings and the rollers have a part; the inner ring tells the direction
        energies += np.real(np.conj(ports[:6]) * force[:6])
        moved.append((ports[:6] - ports[6:12] if ports.size > 6 else ports)[1:3])
    way, _ = max(_WAYS, key=lambda one: float(energies[list(one[1])].sum()))
    spin = next((body.spin for body in system.bodies if body.spin), 1.0)
    return f"{way} of {', '.join(alike)}", _whirl(np.array(moved), spin) if way == "radial" else ""


def _of_body(body: Body, shape: ComplexArray, counts: dict[str, int]) -> tuple[str, str]:
    """Deformation of a body with its number among those of its kind, and its whirl."""

    def counted(kind: str) -> int:
        counts[kind] = counts.get(kind, 0) + 1
        return counts[kind]

    if not body.line:
        return f"{ordinal(counted(body.name))} of {body.name}", ""
    energy, planes = {}, {}
    along = np.array([node.transform for node in body.line])
    for name, freedoms in _STRETCHED:
        # coordinates that move these freedoms of some place; the groups of a straight shaft are apart
        moving = np.any(along[:, freedoms] != 0.0, axis=0)
        part = np.where(np.any(moving, axis=0), shape, 0.0)
        energy[name] = float(np.real(np.conj(part) @ (body.stiffness @ part)))
        planes[name] = max(int(np.count_nonzero(np.any(moving, axis=1))), 1)
    kind = max(energy, key=energy.__getitem__)
    number = (counted(f"{kind} of {body.name}") - 1) // planes[kind] + 1
    whirl = _whirl((along @ shape)[:, 1:3], body.spin) if kind == "bending" else ""
    return f"{ordinal(number)} {kind} of {body.name}", whirl


def _whirl(across: ComplexArray, spin: float) -> str:
    """Direction of whirl of some places that move along y and z, shape (places, 2), in words."""
    size = float(np.sum(np.abs(across) ** 2))
    if not size > 0.0:
        return ""
    sense = -2.0 * float(np.sum(np.imag(np.conj(across[:, 0]) * across[:, 1]))) / size
    if abs(sense) >= IN_A_PLANE and spin:
        return ", forward" if sense * spin > 0.0 else ", backward"
    return f", along {'yz'[int(np.argmax(np.sum(np.abs(across) ** 2, axis=0)))]}"
