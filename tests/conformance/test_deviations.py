"""Deviations from the form in all kinds of bearings: compiled runs, and what linear analyses make of them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbs import assemble, parse_scene
from mbs.analyses.sensors import excited_orders
from mbs.linearised.critical import orders
from mbs.linearised.excitation import lines_of
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.passes import passes_of
from mbs.settings import Settings
from mbs.transient.run import Options, run
from tests.conformance.machines import KINDS

ROLLING = [kind for kind in KINDS if kind.name != "table"]
STEPS, STEP = 40, 2e-5
KEYS = """
waviness = [{ on = "inner", waves = 9, amplitude = "0.3 um" }, { on = "outer", waves = [2, 8], amplitude = "0.2 um" }, \
{ on = "elements", element = 2, waves = 2, amplitude = "0.2 um" }]
size_difference = ["0.4 um", "0 um", "-0.3 um"]
spall = [{ on = "outer", angle = "-90 deg", length = "2 mm", depth = "3 um" }]
"""

WAVES_AND_SIZES = """
waviness = [{ on = "inner", waves = 9, amplitude = "0.3 um" }, { on = "outer", waves = 4, amplitude = "0.3 um" }]
size_difference = ["0.4 um", "0 um", "-0.3 um"]
"""


def model_of(kind, law):
    """A machine whose bearings all deviate, under a load."""
    text = kind.text((300.0, -2000.0, 150.0)).replace("[[bearings]]\n", f"[[bearings]]{KEYS}")
    return assemble(parse_scene(text, "machine", "machine.toml"), law)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ROLLING, ids=lambda kind: kind.name)
def test_compiled_steps_are_those_of_python(kind):
    """Forces to what Newton's method leaves, 1e-10, grown over the steps; energies are told."""
    model = model_of(kind, "hertz:1.25e-5 s")
    start = equilibrium(model.system, model.operation).displacement
    course, settings = SpeedProfile.ramp(150.0, 160.0, STEPS * STEP), Settings(step=STEP, sample=STEP)
    ours, theirs = (
        run(model.system, course, STEPS * STEP, settings, displacement=start, options=Options(compiled=compiled))
        for compiled in (True, False)
    )
    assert ours.compiled == ours.steps and theirs.compiled == 0
    for one, other in zip(ours.forces, theirs.forces, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-6 * np.abs(other).max())
    for one, other in zip(ours.energy.elements, theirs.energy.elements, strict=True):
        assert one.told and other.told
        # balls that change between two and four contacts do so a round-off apart
        assert [one.driven, one.dissipated] == pytest.approx([other.driven, other.dissipated], rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("law", ["hertz:1.25e-5 s", "table"])
@pytest.mark.parametrize("kind", ROLLING, ids=lambda kind: kind.name)
def test_the_energy_that_deviations_bring_in_is_accounted_for(kind, law):
    """What an element takes and gives is what it stores, but for the steps: trapezoids, of second order in them.

    Films may leave 3e-5 of what went through besides: runs blend laws between tables, and read them by parabolas.
    """
    text = kind.text((200.0, -3000.0, 150.0)).replace("[[bearings]]\n", "[[bearings]]\n" + WAVES_AND_SIZES)
    model, left = assemble(parse_scene(text, "machine", "machine.toml"), law), []
    start = equilibrium(model.system, model.operation).displacement
    for step in (1e-5, 5e-6):
        course = SpeedProfile.constant(150.0)
        done = run(model.system, course, 2e-3, Settings(step=step, sample=2e-5), displacement=start)
        elements = done.energy.elements
        assert all(one.told and one.dissipated > 0.0 for one in elements)
        through = sum(abs(one.work) + abs(one.driven) + one.dissipated + abs(one.change) for one in elements)
        left.append(sum(abs(one.residual) for one in elements) / through)
    # rollers that are bodies swing in a few steps; the work of centrifugal loads begins with the first step
    assert left[1] < 0.01 and left[1] < max(0.6 * left[0], 3e-5)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ROLLING, ids=lambda kind: kind.name)
def test_small_approaches_are_felt_as_they_are(kind):
    """Force by an approach in each contact, as linear analyses have it, against differences of the force at rest."""
    model = model_of(kind, "table")
    balance = equilibrium(model.system, model.operation)
    entry = balance.system.elements[0]
    element = getattr(entry.element, "plain", entry.element)
    moved = balance.system.relative(element.inner, element.outer) @ balance.displacement
    count, step = element.deviation_data.elements, 1e-9
    condensed = element.small_motions(moved, model.operation)
    found = condensed.by_approach(np.zeros(1, dtype=np.complex128), count)[0].real
    wanted = np.zeros((count, 2, 6))
    for contact in np.ndindex(count, 2):
        for way in (step, -step):
            added = np.zeros((count, 2, 2))
            added[(*contact, 0)] = way
            element.deviate(added)
            wanted[contact] += element.evaluate(moved, np.zeros(6), model.operation).force / (2.0 * way)
    element.deviate(None)
    # the tractions that hold gyroscopic moments are not symmetric; differences to some 1e-4
    np.testing.assert_allclose(found, wanted, atol=2e-3 * np.abs(wanted).max(axis=(0, 1)).max())


@pytest.mark.parametrize("kind", ROLLING, ids=lambda kind: kind.name)
def test_statics_are_those_of_perfect_bearings(kind):
    """To the last bit."""
    text = kind.text((300.0, -2000.0, 150.0))
    perfect = assemble(parse_scene(text, "machine", "machine.toml"), "hertz:1.25e-5 s")
    ours, theirs = (equilibrium(one.system, one.operation) for one in (model_of(kind, "hertz:1.25e-5 s"), perfect))
    np.testing.assert_array_equal(ours.displacement, theirs.displacement)
    for one, other in zip(ours.forces, theirs.forces, strict=True):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(ours.stiffness, theirs.stiffness)


@pytest.mark.parametrize("kind", ROLLING, ids=lambda kind: kind.name)
def test_orders_of_the_bearings_are_drawn_and_searched(kind):
    """Those of rolling without slip by the geometry: cage, passes of both rings, both contacts of an element."""
    model = model_of(kind, "hertz:1.25e-5 s")
    entry = model.system.elements[0].element
    element = getattr(entry, "plain", entry)
    geometry = (getattr(element, "bearing", None) or element.force).geometry
    row = geometry.balls if hasattr(geometry, "balls") else geometry.rollers
    cage, outer, inner, own = passes_of(geometry, row, element.inner_spin, element.outer_spin)
    drawn = dict(excited_orders(model, math.inf))
    for order, name in ((cage, "FTF"), (outer, "1 BPFO"), (inner, "1 BPFI"), (2.0 * own, "2 BSF")):
        assert min(abs(one - order) for one in orders(model.system)) < 1e-8
        # of two bearings that are alike either gives the name
        assert any(abs(one - order) < 1e-8 and f" {name}" in words for one, words in drawn.items())


@pytest.mark.parametrize("kind", ROLLING, ids=lambda kind: kind.name)
def test_every_source_has_its_lines(kind):
    balance = equilibrium(model_of(kind, "hertz:1.25e-5 s").system, model_of(kind, "hertz").operation)
    lines = lines_of(balance)
    assert {line.source for line in lines} == {"inner ring", "outer ring", "elements", "sizes", "passing"}
    assert all(line.order > 0.0 and np.all(np.isfinite(force)) for line, force in lines.items())
