"""Stepped shafts with discs as flexible bodies.

A shaft is free; springs and bearings of a system hold it. It moves with the freedoms of its frames, with the static
shape that belongs to them, and with the modes that it has when its frames are held, up to a cut-off frequency.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from mbs.flexible.damping import modal_damping
from mbs.flexible.shaft_layout import shaft_problems
from mbs.flexible.shaft_model import ShaftModel, reduced, shaft_model
from mbs.flexible.shaft_parts import Disc, Section
from mbs.model.body import FREEDOMS, Body, Frame


def flexible_shaft(
    name: str,
    sections: Sequence[Section],
    discs: Sequence[Disc],
    freedoms: Sequence[str],
    position: Sequence[float],
    frames: Mapping[str, float],
    spin: float = 0.0,
    largest_element: float | None = None,
    cutoff: float | None = None,
    damping_ratio: float = 0.0,
) -> Body:
    """A shaft of Timoshenko beams with rigid discs.

    Where sections overlap along x, stiffness and mass add up: one is taken as pressed into the bore of the other all
    along, with plane sections in common. A part that adds mass only is a disc.

    Parameters
    ----------
    name : str
        Name of the body.
    sections : sequence of Section
        Sections, at least one, without a gap along x.
    discs : sequence of Disc
        Rigid parts; within the sections.
    freedoms : sequence of str
        Some of x, y, z, theta_x, theta_y, theta_z; those left out are held all along the shaft. Bending needs two:
        y and theta_z, z and theta_y.
    position : sequence of float, shape (3,)
        Position of x = 0 of sections, discs and frames [m].
    frames : mapping of str to float
        Places on the axis by name, along x from the position [m]; at least one.
    spin : float
        Speed about x as a multiple of the system's.
    largest_element : float, optional
        Length of an element [m]. Left out: what makes an error of 1e-4 in the frequency of bending waves at the
        cut-off; without a cut-off half the diameter.
    cutoff : float, optional
        Modes of the shaft with its frames held are kept up to this frequency [Hz]. Left out: no reduction, and the
        coordinates are those of all nodes.
    damping_ratio : float
        Damping ratio of the modes of the free shaft at rest.

    Returns
    -------
    Body
        Coordinates "left.y" and so on for each frame, then "mode 1" and so on in the order of their frequencies,
        mass-normalised. Frames at the same place share their coordinates, under the name of the first.

    Raises
    ------
    InputError
        With all that does not fit together.

    Notes
    -----
    Valid for waves that are longer than a few diameters: sections stay plane. A cut-off above that all along the
    shaft is an error. Modes of a system are good up to about half the cut-off.
    """
    problems = shaft_problems(sections, discs, freedoms, position, frames, spin, largest_element, cutoff, damping_ratio)
    if problems:
        raise InputError([f"shaft {name!r}, {problem}" for problem in problems])
    try:
        model = shaft_model(sections, discs, freedoms, list(frames.values()), largest_element, cutoff)
        nodes = {key: model.node(place) for key, place in frames.items()}
        if cutoff is None:
            kept = list(range(len(model.nodes)))
            mass, gyroscopic, stiffness = model.mass, model.gyroscopic, model.stiffness
            basis = np.eye(len(mass))
        else:
            kept = list(dict.fromkeys(nodes.values()))
            mass, gyroscopic, stiffness, basis = reduced(model, kept, cutoff)
        damping = modal_damping(mass, stiffness, damping_ratio)
    except InputError as error:
        raise InputError([f"shaft {name!r}, {problem}" for problem in error.problems]) from error
    labels = {node: key for key, node in reversed(nodes.items())}
    own = [(labels.get(node, f"node {node + 1}"), freedom) for node in kept for freedom in freedoms]
    modes = range(1, len(mass) - len(own) + 1)
    here = np.asarray(position, dtype=np.float64)
    places = {}
    for key, node in nodes.items():
        transform = np.zeros((6, len(mass)))
        for column, owner in enumerate(own):
            if owner[0] == labels[node]:
                transform[FREEDOMS.index(owner[1]), column] = 1.0
        places[key] = Frame(here + np.array([frames[key], 0.0, 0.0]), transform)
    return Body(
        name=name,
        coordinates=(*(f"{label}.{freedom}" for label, freedom in own), *(f"mode {number}" for number in modes)),
        units=(*("rad" if freedom.startswith("theta") else "m" for _, freedom in own), *("1" for _ in modes)),
        mass=mass,
        gyroscopic=gyroscopic,
        damping=damping,
        stiffness=stiffness,
        frames=places,
        spin=spin,
        line=_line(model, here, basis),
    )


def _line(model: ShaftModel, here: FloatArray, basis: FloatArray) -> tuple[Frame, ...]:
    """All nodes of a shaft, with how they move by its coordinates."""
    rows = [FREEDOMS.index(freedom) for freedom in model.freedoms]
    found = []
    for node, place in enumerate(model.nodes.tolist()):
        transform = np.zeros((6, basis.shape[1]))
        transform[rows] = basis[model.rows([node], model.freedoms)]
        found.append(Frame(here + np.array([place, 0.0, 0.0]), transform))
    return tuple(found)
