"""Runs in time of all kinds at once: compiled code makes the steps of Python, with lift-off, dry and with films."""

from __future__ import annotations

import numpy as np
import pytest

from mbs import assemble, parse_scene
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.settings import Settings
from mbs.transient.run import Options, run
from tests.conformance.machines import MIXED

ALL = MIXED[-1]
STEPS, STEP = 30, 2e-5

TEXT = ALL.text().replace('bearing = "6208"', 'bearing = "6208"\ndiametral_clearance = "0 um"')
"""The ball bearing without clearance: with some of it contacts beat, and differences grow beyond the bounds below."""


LAWS = {"dry": ("hertz:1.25e-5 s", 1e-6), "films": ("table", 1e-4)}
"""Laws, and how far forces may be apart: what Newton's method leaves, 1e-10, grown over the steps; of films with memory
parabolas in place of the cubics of their tables, 1e-5."""


@pytest.fixture(scope="module", params=LAWS)
def runs(request):
    """The machine of all kinds, pushed by 8 um so that contacts part, in compiled code and in Python."""
    law, within = LAWS[request.param]
    model = assemble(parse_scene(TEXT, "machine", "machine.toml"), law)
    start = equilibrium(model.system, model.operation).displacement.copy()
    start[[model.system.coordinates.index(f"rotor.{way}") for way in "xy"]] += 8e-6
    course, settings = SpeedProfile.ramp(150.0, 160.0, STEPS * STEP), Settings(step=STEP, sample=STEP)
    return within, [
        run(model.system, course, STEPS * STEP, settings, displacement=start, options=Options(compiled=compiled))
        for compiled in (True, False)
    ]


@pytest.mark.slow
@pytest.mark.parametrize("index", range(len(ALL.bearings)))
def test_compiled_is_python(runs, index):
    """Forces at every step, and energies where elements tell them."""
    within, (ours, theirs) = runs
    assert ours.compiled == ours.steps == theirs.steps >= STEPS and theirs.compiled == 0
    size = np.abs(theirs.forces[index]).max()
    assert size > 10.0
    np.testing.assert_allclose(ours.forces[index], theirs.forces[index], atol=within * size)
    one, other = ours.energy.elements[index], theirs.energy.elements[index]
    assert one.told == other.told
    if one.told:
        assert [one.driven, one.dissipated, one.change] == pytest.approx(
            [other.driven, other.dissipated, other.change], rel=1e-4, abs=within * ours.energy.through
        )
