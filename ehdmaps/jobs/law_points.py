"""What a contact law gives at loads, and what fresh solves give there."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.jobs.store import Arrays
from ehdmaps.jobs.tasks import LineTask
from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.solution import ContactSolution, FilmSolution, Status, contact_solution

COMPLIANCE_BARS, DAMPING_BARS = (0.01, 1e-4), (0.05, 1e-3)
"""An error is within its bar where it is below a share of the film compliance or of 1/k; of c or of k b/u."""

READ_COMPLIANCE_BARS = (0.01, 1e-3)
"""The bar of film compliance for laws whose films are read from the film table: a thousandth of a stiffness. Whoever
needs more has the films solved."""

SMALL_DAMPING = DAMPING_BARS[1] / DAMPING_BARS[0]
"""Damping, as a share of k b/u, below which an error is related to this share: damping runs through zero in its valley,
and a share of nothing is no measure."""


def fresh_solution(task: LineTask, arrays: Arrays) -> ContactSolution:
    """The first point of a line with its structure.

    Parameters
    ----------
    task : LineTask
        The line.
    arrays : Arrays
        Films of the line.
    """
    film = FilmSolution(
        **{name: array[0].item() for name, array in arrays.items() if name != "status" and array.ndim == 1},
        status=Status(int(arrays["status"][0])),
    )
    point = OperatingPoint(task.loads[0], task.entrainment_speed, task.temperature)
    return contact_solution(film, task.contact, point)


def at_loads(
    law: ContactLaw, approach: FloatArray, load: FloatArray, speed: FloatArray, temperature: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Approach [m] at which a law of one contact has these loads, with stiffness [N/m2] and damping [N s/m2] there.

    Parameters
    ----------
    law : ContactLaw
        Law of one contact.
    approach : array (n,)
        Begin of the search [m].
    load, speed, temperature : array (n,)
        [N/m], [m/s] and [K].
    """
    dry = np.array([law.contacts[0].structural_compliance(float(w)) for w in load])
    approach = approach.copy()
    for _ in range(8):
        found, stiffness, damping = law(approach, 0.0, speed, temperature)
        approach -= (found - load) / np.maximum(stiffness, 1e-12 / dry)
    _, stiffness, damping = law(approach, 0.0, speed, temperature)
    return approach, stiffness, damping
