"""A map of `reynolds` that a few points of OpenFOAM correct, with heat and a limiting stress: the recommended way."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.jobs import solvers
from ehdmaps.jobs.make.generate import generate
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.contact import OperatingPoint

pytestmark = pytest.mark.openfoam

TEXT = """schema = 1
[contact]
radius = "5.515 mm"
reference_depth = "5 mm"
[lubricant]
name = "FVA3"
[grid]
load = ["5 N/mm", "20 N/mm"]
entrainment_speed = ["4 m/s", "7 m/s"]
temperature = ["50 degC"]
[solver]
name = "reynolds"
structural_law = "half_space"
backbone = "none"
physics = "thermal"
shear = "limiting"
corrected_by = "openfoam"
correction_points = 5
[correction]
columns = 100
rows = 4
"""
"""So few columns that OpenFOAM may differ by parts in a thousand; the error of its rows is taken off."""


def test_with_heat_and_a_limiting_stress_films_become_those_of_cfd(tmp_path: Path) -> None:
    job = parse_job(TEXT, "warm", "warm")
    assert job.corrected_by is not None
    made = generate(job, tmp_path / "warm.nc", workers=1).dataset
    record = json.loads(made.attrs["correction"])
    assert record["settings"]["physics"] == "thermal" and record["settings"]["shear"] == "limiting"
    assert record["usable"] == record["asked"] == 5
    cfd = solvers.build(job.corrected_by.solver, job.corrected_by.options)
    plain = solvers.build("reynolds", job.solver_options)
    errors = []
    for contact in job.contacts[:1]:
        point = OperatingPoint(2e4, 7.0, 323.15)  # of the map; the correction asks for random ones
        dear, cheap = (
            s.solve_line(contact, job.lubricant, (point.load,), point.entrainment_speed, point.temperature)[0]
            for s in (cfd, plain)
        )
        at = dict(zip(("load", "entrainment_speed", "temperature"), (2e4, 7.0, 323.15), strict=True))
        mapped = made.sel(contact=contact.name).sel(at, method="nearest")
        errors.append([abs(h / dear.film_offset - 1.0) for h in (float(mapped["film_offset"]), cheap.film_offset)])
    corrected, uncorrected = np.max(errors, axis=0)
    # a correction that five points do not show to be one is left out: then both programs agree as they are, within
    # what so few columns cost a film
    if "film_offset" in record["not_applied"]:
        assert corrected == uncorrected < 2e-3
    else:
        assert corrected < 0.5 * uncorrected  # of five points, over a factor of four of the load
