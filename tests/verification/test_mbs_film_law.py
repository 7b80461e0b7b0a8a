"""What films with memory are estimated to leave out, beside films by the solver itself, at any complex frequency.

The oil is one with which no number of the law or of the estimate was chosen. Loads of the slices are those of the map's
equilibrium for both.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps import BearingGeometry
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.generate import generate_in_memory
from ehdmaps.maps.emap import EHDMap
from ehdmaps.physics.lubricant import Lubricant
from mbs.analyses.film_errors import film_errors
from mbs.analyses.modes import modes as analysed
from mbs.commands.modes import _table
from mbs.linearised.averaged import steady_system
from mbs.linearised.dynamic import element_dynamic_stiffness
from mbs.linearised.mode_part import ModePart
from mbs.linearised.modes import modes
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.output.model_text import band_lines, film_law_line, film_lines
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene
from tests.cases.exact_films import ExactMachine

SPEED = 800.0 * math.pi / 30.0
WARM = 313.15
OIL = Lubricant.roelands(viscosity=0.28, pressure_viscosity=22e-9, density=890.0)
"""As thick as an ISO VG 320."""


@pytest.fixture(scope="module")
def emap():
    nu308 = BearingGeometry.named("NU308").without_clearance
    u = nu308.entrainment_speed(1.0, 0.0) * SPEED
    job = Job.build(
        lubricant=OIL, bearing=nu308, loads=[50.0, 3e5], entrainment_speeds=[0.7 * u, 1.4 * u], temperatures=[WARM]
    )
    made = generate_in_memory(job, 1)
    return EHDMap(made.dataset, made.backbone)


@pytest.fixture(scope="module")
def films():
    """Films of the solver, which both machines share."""
    return {}


def machine(emap, films, scene, clearance):
    """A machine with memory, its equilibrium, and the same with exact films."""
    model = assemble(read_scene(scene), "map", emap, clearance, "memory")
    balance = equilibrium(steady_system(model.system), Operation(SPEED))
    return model, balance, ExactMachine(balance, OIL, films)


@pytest.mark.slow
@pytest.mark.parametrize(("scene", "clearance"), [("nu308_rigid", 20e-6), ("gearbox", 30e-6)])
def test_stiffness_along_the_load_is_wrong_by_what_is_stated(emap, films, scene, clearance):
    model, balance, exact = machine(emap, films, scene, clearance)
    slow, memory = (film_errors(model, balance.displacement, balance.operation, kind) for kind in ("slow", "memory"))
    frequencies = np.array([500.0, 1000.0, 2000.0, 4000.0])
    force = balance.forces[0][1:3]
    along = np.array([0.0, *(force / np.linalg.norm(force)), 0.0, 0.0, 0.0])
    for frequency in frequencies:
        s = 2j * math.pi * frequency
        true = exact.bearings[0].stiffness(s)
        found = along @ element_dynamic_stiffness(balance, 0, np.array([s]))[0] @ along
        rest = along @ (balance.element_stiffness[0] + s * balance.element_damping[0]) @ along
        for entry, has in ((memory[0], found), (slow[0], rest)):
            wrong = abs(has - true) / abs(true)
            # Not less, but for the map's own splines, and no more than what is added for the reading.
            assert 0.98 * wrong - 1e-4 < entry.at(frequency) < 1.1 * wrong + 0.015, (frequency, entry.films)


@pytest.mark.slow
def test_modes_are_wrong_by_what_is_stated(emap, films):
    _, balance, exact = machine(emap, films, "gearbox", 30e-6)
    found = modes(balance)
    share = found.shares[[found.parts.index(bearing.name) for bearing in exact.bearings]].sum(axis=0)
    compared, largest = 0, 0.0
    for k in np.flatnonzero((found.eigenvalues.imag > 0.0) & (share > 0.2) & (found.frequency < 4e3)):
        value, _ = exact.mode(complex(found.eigenvalues[k]), found.shapes[:, k])
        ratio = -value.real / abs(value) - found.damping_ratio[k]
        frequency = abs(value) / (2.0 * math.pi) - found.frequency[k]
        # Second order, and the reading between the frequencies of the map.
        assert found.film_law.damping_ratio[k] == pytest.approx(ratio, rel=0.05, abs=1e-4)
        assert found.film_law.frequency[k] == pytest.approx(frequency, rel=0.05, abs=0.1)
        compared, largest = compared + 1, max(largest, abs(ratio) / found.damping_ratio[k])
    assert compared > 8 and largest > 0.03


def test_it_stands_beside_each_mode(emap):
    memory, slow = (assemble(read_scene("nu308_rigid"), "map", emap, 0.0, kind) for kind in ("memory", "slow"))
    found = analysed(memory, Operation(SPEED))
    law, data = found.modes.film_law, found.dataset
    np.testing.assert_array_equal(data["damping_ratio_film_law"], law.damping_ratio)
    np.testing.assert_array_equal(data["frequency_film_law"], law.frequency)
    (k,) = np.flatnonzero((found.modes.frequency > 3e3) & np.isfinite(law.frequency))[:1]
    head, *lines = _table(found.modes, np.arange(found.modes.frequency.size))
    assert head.count("+-  film law") == 2
    assert f"{law.frequency[k]:+10.2g}" in lines[k] and f"{law.damping_ratio[k]:+10.2g}" in lines[k]
    unknown = dataclasses.replace(found.modes, film_law=ModePart(*np.full((2, law.frequency.size), np.nan)))
    assert _table(unknown, np.array([k]))[1].count(f"{'-':>10s}") == 2
    assert "how films relax" in band_lines(memory)[0]
    assert film_law_line(memory, True)[0].startswith("  film law: what one relaxation time of a slice leaves out of ")
    without = analysed(slow, Operation(SPEED))
    assert without.modes.film_law is None and np.all(np.isnan(without.dataset["frequency_film_law"]))
    assert film_law_line(slow, False) == [
        "  film law: not known; films of slow motion leave out how films relax (--films memory has it)"
    ]
    (line,) = film_lines(film_errors(memory, found.balance.displacement, found.balance.operation)[:1], [2000.0])
    assert line.endswith(" %, by the response that the map holds")


def test_laws_without_a_response_say_that_it_is_not_known():
    formula, hertz = (assemble(read_scene("nu308_rigid"), law) for law in ("formula", "hertz"))
    assert analysed(formula).modes.film_law is None
    assert film_law_line(formula, False) == ["  film law: not known; the law holds no response of the film solver"]
    assert film_law_line(hertz, False) == []
