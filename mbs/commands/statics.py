"""`mbs statics`: the equilibrium, the loads of the rollers, stiffness and damping of the bearings."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.units import DAMPER, FILM, PRESSURE, SPRING, written
from mbs.analyses.reach import fade_lines, outside_at
from mbs.analyses.soundness import Judged
from mbs.analyses.statics import statics
from mbs.bearings.contact_report import BearingContacts
from mbs.bearings.force_at_point import RollerLoads
from mbs.commands.auto import analysed
from mbs.commands.cases import load_model
from mbs.commands.common import Looked, with_bands, write
from mbs.model.equilibrium import Equilibrium
from mbs.model.on_rings import ring_matrices
from mbs.model.relaxation import NOTABLE
from mbs.output.band_text import about_lines, bearing_quantities, lost_lines, quantity_lines
from mbs.output.model_text import heading
from mbs.output.state_text import DAMPINGS, STIFFNESSES, flooded_note, largest_torque, life_lines, loss_words
from mbs.planning.question import at_one_speed
from mbs.scene.assembly import Model, ring_motions
from mbs.unknowns.held_open import held_open_of

if TYPE_CHECKING:
    from mbs.unknowns.looks import Band

_SHOWN = (1, 2, 4, 5)
_ROUND_OFF = 1e-9
_IN_A_ROW = 6
_NAMES = ("y", "z", "theta_y", "theta_z")


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Find the equilibrium at the operating speed and describe it."""
    done = analysed(arguments, _asked, statics, lambda model: Looked(at_one_speed(model.scene), 0.0))
    found = done.result
    model = found.model
    balance, contacts = found.balance, found.contacts
    bands = found.bands if with_bands(arguments, []) and model.scene.has_bearings else {}
    figure = found.plot(bool(bands)) if arguments.plot else None
    judged = Judged([("", found.findings)])
    lines = [
        *judged.first,
        *done.lines,
        *heading(model, model.scene.speed),
        f"equilibrium in {balance.steps} Newton steps, residual {balance.residual:.1e} of the largest force",
        *_coordinates(model, balance),
    ]
    for index, (bearing, motion) in enumerate(ring_motions(model, balance.displacement)):
        force = balance.forces[index]
        size = float(np.hypot(force[1], force[2]))
        rollers = bearing.loads(motion, balance.operation)
        stiffness, damping = ring_matrices(balance.element_stiffness[index], balance.element_damping[index])
        lines += [
            f"{bearing.name}: {size:.6g} N on the inner ring "
            f"(y {_clean(force[1], size):.6g}, z {_clean(force[2], size):.6g}), moved against the outer ring "
            f"{_um(motion[1])} in y, {_um(motion[2])} in z",
            f"  entrainment speed {bearing.entrainment_speed(balance.operation):.4g} m/s; "
            f"{np.count_nonzero(rollers.load > 0.0)} of {rollers.load.size} rollers loaded, the most with "
            f"{float(rollers.load.max()):.5g} N",
            *_loads(rollers),
            f"  {_contact_words(contacts[index])}",
            f"  {loss_words(found.losses[index])}",
            *life_lines(bearing, bearing.bearing.geometry, rollers, balance.operation),
            *_matrix(f"K [{STIFFNESSES}]", SPRING.factor * stiffness),
            *_matrix(f"C [{DAMPINGS}]", DAMPER.factor * damping),
        ]
    if model.located:
        from mbs.output.one_bearing.located import located_lines

        lines += located_lines(model, balance)
    others = list(zip(model.on_rings, contacts, found.losses, strict=True))[len(model.bearings) :]
    lines += [f"{entry.name}: {_contact_words(state)}; {loss_words(loss, 'elements')}" for entry, state, loss in others]
    if model.gears:
        from mbs.output.results import gear_lines

        lines += gear_lines(model, balance)
    if bands:
        names = [str(name) for name in found.dataset["bearing"].values]
        lines += [
            *quantity_lines(list(bearing_quantities(names, bands))),
            *about_lines(model.scene, held_open_of(model), _told(bands)),
        ]
        lines += [line for line in lost_lines(next(iter(bands.values())), []) if "not in the bands" in line]
    lines += flooded_note(largest_torque(found.losses), model.supplies.values())
    lines += _slow(model, balance) if model.supplies or others else []
    lines += fade_lines(model, np.array([model.scene.speed]))
    outside = outside_at(model, balance)
    lines += [*judged.last, *(f"warning: {line}" for line in found.free), *outside]
    lines += write(arguments, (found.bounded() if bands else found.dataset) if arguments.output else None, figure)
    return "\n".join(lines), 1 if outside or judged.status else 0


def _told(bands: Mapping[str, Band]) -> dict[str, Band]:
    """Bands of K and C along the axes, and of films, by what they are of."""
    axes = np.arange(6)
    shown = {"K": "bearing_stiffness", "C": "bearing_damping", "film": "minimum_film"}
    return {
        words: bands[name] if words == "film" else bands[name].of((slice(None), axes, axes))
        for words, name in shown.items()
        if name in bands
    }


def _slow(model: Model, balance: Equilibrium) -> list[str]:
    """Lines on the frequencies up to which K and C hold, for laws with films."""
    from mbs.analyses.film_errors import film_errors

    return [
        f"{entry.bearing}: K and C are those of slow motion; the estimated error of the dynamic stiffness along the "
        f"load passes {100.0 * NOTABLE:g} % at {entry.frequency:.4g} Hz"
        for entry in film_errors(model, balance.displacement, balance.operation, "slow")
        if math.isfinite(entry.frequency)
    ]


def _asked(arguments: argparse.Namespace) -> Model:
    """The model, whose rollers are drawn if asked for."""
    problems = Problems()
    with_bands(arguments, problems)
    problems.check()
    model = load_model(arguments)
    if arguments.plot and not model.on_rings:
        raise InputError(f"--plot: {model.scene.name} has no bearing of rollers or balls to draw; leave it out")
    return model


def _loads(rollers: RollerLoads) -> list[str]:
    """Lines of the loads of all loaded rollers, each with its angle."""
    loaded = np.flatnonzero(rollers.load > 0.0)
    order = loaded[np.argsort(-rollers.load[loaded], kind="stable")]
    shown = [f"{written(rollers.load[k])} N at {_clean(math.degrees(rollers.angle[k])):.4g} deg" for k in order]
    rows = [", ".join(shown[first : first + _IN_A_ROW]) for first in range(0, len(shown), _IN_A_ROW)]
    return [f"  {'rollers, from y towards z: ' if not row else '  '}{words}" for row, words in enumerate(rows)]


def _contact_words(contacts: BearingContacts) -> str:
    """Largest pressure and smallest films of a bearing, inner and outer."""
    inner, outer = contacts.hertz_pressure
    words = f"Hertz pressure up to {PRESSURE.value(inner):.4g} inner, {PRESSURE.value(outer):.4g} GPa outer"
    if not np.all(np.isfinite(contacts.minimum_film)):
        return words
    central, smallest = (
        " inner, ".join(f"{FILM.value(film):.4g}" for film in films)
        for films in (contacts.central_film, contacts.minimum_film)
    )
    return f"{words}; film down to {smallest} um outer (central {central} um outer)"


def _coordinates(model: Model, balance: Equilibrium) -> list[str]:
    """Lines of the coordinates."""
    shown = {"m": (1e6, "um"), "rad": (1e6, "urad"), "1": (1.0, "")}
    lines = []
    for name, unit, value in zip(model.system.coordinates, model.system.units, balance.displacement, strict=True):
        factor, word = shown[unit]
        if ".roller_" not in name:
            lines.append(f"  {name:24s} {_clean(value * factor):14.6g} {word}")
    return lines


def _matrix(title: str, matrix: FloatArray) -> list[str]:
    """Lines of a matrix on the inner ring, without the axial rows."""
    scale = np.sqrt(np.abs(np.diag(matrix)))
    rows = [
        f"    {_NAMES[i]:8s}"
        + "".join(f"{_clean(matrix[row, column], scale[row] * scale[column]):13.5g}" for column in _SHOWN)
        for i, row in enumerate(_SHOWN)
    ]
    return [f"  {title}", f"{'':12s}" + "".join(f"{name:>13s}" for name in _NAMES), *rows]


def _um(value: float) -> str:
    """A length."""
    return f"{_clean(value * 1e6):.5g} um"


def _clean(value: float, scale: float = 1.0) -> float:
    """Zero in place of what is left by round-off."""
    return 0.0 if abs(value) < _ROUND_OFF * scale else float(value)
