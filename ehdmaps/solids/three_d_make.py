"""All cases over the length of a roller by finite elements, made anew: minutes of one core, and some gigabytes."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.profiles import iso_profile
from ehdmaps.physics.solids import STEEL
from ehdmaps.solids.three_d_calculix import load_by_calculix
from ehdmaps.solids.three_d_reference import (
    HEAVY,
    LEVELS,
    TILT_ARM,
    LengthCase,
    LengthReference,
    MeshedContact,
    light_load,
    quarter_model,
)

DEEPEST = 1e-3
"""The profile of ISO has no bound at the ends; a depth no contact reaches [m]."""


def profile_depths(name: str, bearing: BearingGeometry, places: FloatArray) -> FloatArray:
    """Depths of a named profile [m], bounded.

    Parameters
    ----------
    name : str
        iso or straight.
    bearing : BearingGeometry
        The bearing.
    places : array (n,)
        Places along the roller, ends included [m].
    """
    if name == "straight":
        return np.zeros_like(places)
    with np.errstate(divide="ignore"):
        return np.minimum(iso_profile(places, bearing.roller_diameter, bearing.roller_length), DEEPEST)


def make_reference(
    bearing: BearingGeometry, levels: Sequence[float] = LEVELS, calculix: bool = True
) -> LengthReference:
    """Solve all cases of a bearing on all meshes.

    Parameters
    ----------
    bearing : BearingGeometry
        The bearing.
    levels : sequence of float
        Sizes of the elements, the coarsest first.
    calculix : bool
        Whether CalculiX solves the straight roller on the coarsest mesh too.

    Raises
    ------
    InputError
        If CalculiX is missing.
    AnalysisError
        If a contact is not found.
    """
    model, load = quarter_model(bearing), light_load(bearing)
    wanted = [
        (name, load * factor, load * factor * arm * bearing.roller_length)
        for name in ("iso", "straight")
        for factor, arm in ((1.0, 0.0), (HEAVY, 0.0), (1.0, TILT_ARM))
    ]
    cases: dict[float, list[LengthCase]] = {}
    unknowns: dict[float, int] = {}
    check: dict[str, float] = {}
    for level in levels:
        contact = MeshedContact(model, level)
        unknowns[level] = contact.unknowns
        cases[level] = [
            contact.solve(name, profile_depths(name, bearing, contact.places), *loads) for name, *loads in wanted
        ]
        if calculix and not check:
            straight = next(case for case in cases[level] if case.profile == "straight" and case.moment == 0.0)
            layers = contact.roller.positions.shape[0]
            with tempfile.TemporaryDirectory() as folder:
                by_calculix = load_by_calculix(
                    contact.roller, contact.race, np.zeros(layers), STEEL, straight.approach, Path(folder)
                )
            check = {"approach": straight.approach, "load": straight.load, "load_by_calculix": by_calculix}
    return LengthReference(bearing.name, model, cases, unknowns, check)
