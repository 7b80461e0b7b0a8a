"""Five machines with little damping, imported from files of ROSS, beside its figures: `tests.benchmarks.ross_machines`.

Two are examples of ROSS: `rotor_example` on springs without damping, and `compressor_example` with layers without
stiffness, a disc without inertia and twelve seals. Three are made for this: cones and a seal that drives a whirl, feet
without damping, an overhung fan on a cone.
"""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from mbs import SweepRange, SweepSettings, assemble, critical, parse_scene
from mbs.imports.ross_file import read_ross
from mbs.imports.ross_scene import ross_scene
from mbs.linearised.critical import order_responses
from mbs.linearised.modes import modes
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium

TESTS = Path(__file__).parents[1]
ROSS = tomllib.loads((TESTS / "references" / "ross_machines.toml").read_text(encoding="utf-8"))
SIMPLE = ("rotor", "seal", "mounts", "fan")
TAPER = {"rotor": 1e-9, "mounts": 5e-7, "seal": 1e-4, "fan": 4e-4}
"""What frequencies differ by: of cylinders by round-off and modes that are left out above 20 kHz, of cones by what the
shapes of ROSS miss of their static solution, which falls with the length of its elements."""


def complex_of(pairs):
    return np.array(pairs) @ np.array([1, 1j])


def with_unbalance(name):
    text = ross_scene(read_ross(TESTS / "data" / "ross" / f"{name}.toml"), f"{name}.toml", name)
    return f"""{text}
[[unbalances]]
name = "unbalance"
on = "rotor"
at = "{ROSS[name]["place"]!r} m"
moment = "{ROSS["unbalance"]} kg m"
"""


@pytest.fixture(scope="module", params=SIMPLE)
def machine(request):
    name = request.param
    return name, assemble(parse_scene(with_unbalance(name), name, name)), ROSS[name]


def nearest(values, wanted):
    """The value that is nearest to each of some."""
    return values[np.argmin(np.abs(values[:, None] - wanted[None, :]), axis=0)]


def eigenvalues(model, speed):
    return modes(equilibrium(model.system, Operation(speed))).eigenvalues


def test_eigenvalues(machine):
    name, model, case = machine
    for speed, row in zip(case["speeds"], case["eigenvalues"], strict=True):
        wanted = complex_of(row)
        wanted = wanted[np.abs(wanted) < 2.0 * math.pi * 1e3]
        found = nearest(eigenvalues(model, speed), wanted)
        assert len(set(found.tolist())) == len(wanted)
        np.testing.assert_allclose(found.imag, wanted.imag, rtol=TAPER[name])
        # Round-off of frequencies is more than no damping.
        atol = max(TAPER[name], 1e-11) * np.max(np.abs(wanted))
        np.testing.assert_allclose(found.real, wanted.real, rtol=20.0 * TAPER[name], atol=0.1 * atol)


def test_critical_speeds(machine):
    name, model, case = machine
    found = critical(model, SweepSettings(SweepRange(case["from"], case["to"], 15))).found
    wanted = complex_of(case["critical"])
    # Critical speeds are found to 1e-7 of their frequency.
    np.testing.assert_allclose([entry.speed for entry in found], wanted.imag, rtol=TAPER[name] + 2e-7)
    ratios = -wanted.real / np.abs(wanted)
    np.testing.assert_allclose([entry.damping_ratio for entry in found], ratios, rtol=20.0 * TAPER[name], atol=1e-9)


@pytest.mark.parametrize("name", ["seal", "mounts", "fan"])
def test_peaks_of_an_unbalance_and_their_widths(name):
    case = ROSS[name]
    model = assemble(parse_scene(with_unbalance(name), name, name))
    found = critical(model, SweepSettings(SweepRange(case["from"], case["to"], 15))).found
    first = next(entry for entry in found if entry.damping_ratio > 1e-5)
    # Seven speeds about the peak, up to two damping ratios away: of each program, about its own critical speed.
    speeds = np.array(case["about"]) * first.speed / case["about"][3]
    (response,) = order_responses(lambda speed: model.system, speeds)
    moved = np.abs(response.motion @ model.system.relative("rotor:unbalance")[1:3].T)
    wanted = np.abs(np.array(case["moved"]) @ np.array([1, 1j]))
    assert np.argmax(wanted[:, 0]) in (2, 3, 4)
    # A distance from the peak of two damping ratios, changed by the part by which these differ; amplitudes of mm.
    np.testing.assert_allclose(moved, wanted, rtol=40.0 * TAPER[name] + 1e-3)


def test_a_seal_drives_a_whirl_from_the_speed_of_ross_on():
    case = ROSS["seal"]
    model = assemble(parse_scene(with_unbalance("seal"), "seal", "seal"))
    # The limit follows damping, and that the shape of the mode at the seal: ten times the error of its frequency.
    assert np.max(eigenvalues(model, case["limit"] * (1.0 - 2e-3)).real) < 0.0
    assert np.max(eigenvalues(model, case["limit"] * (1.0 + 2e-3)).real) > 0.0


class TestCompressor:
    """ROSS's example of a compressor as it stands: 91 elements, 36 of them layers, 12 seals."""

    @pytest.fixture(scope="class")
    @staticmethod
    def model():
        return assemble(parse_scene(with_unbalance("compressor"), "compressor", "compressor"))

    def test_all_of_it_is_there(self, model):
        (shaft,) = model.scene.bodies
        assert len(shaft.sections) == 91
        assert sum(section.youngs_modulus == 6894.75 for section in shaft.sections) == 36
        assert [disc.inertia.polar == 0.0 for disc in shaft.discs] == [True] + 6 * [False]
        assert len(model.scene.elements) == 14

    @pytest.mark.parametrize("point", [0, 1, 2])
    def test_eigenvalues(self, model, point):
        case = ROSS["compressor"]
        found = eigenvalues(model, case["speeds"][point])
        low = complex_of(case["eigenvalues"][point])
        low = low[np.abs(low) < 2.0 * math.pi * 400.0]
        assert len(low) >= 4
        here = nearest(found, low)
        # The smoothing of ROSS's tables, and layers that shear by themselves there.
        np.testing.assert_allclose(np.abs(here), np.abs(low), rtol=1.1e-4)
        np.testing.assert_allclose(here.real / np.abs(here), low.real / np.abs(low), atol=1.2e-4)

    @pytest.mark.parametrize("point", [0, 1, 2])
    def test_what_differs_is_how_layers_shear(self, model, point):
        case = ROSS["compressor"]
        found = eigenvalues(model, case["speeds"][point])
        as_is, shared = (complex_of(case[key][point]) for key in ("eigenvalues", "shared"))
        apart, together = (np.abs(nearest(found, wanted) / wanted - 1.0) for wanted in (as_is, shared))
        # With the shear of the shaft in its layers ROSS has what is left of its smoothing, also at 1 kHz.
        assert np.max(together) < 3e-4
        assert np.max(apart) > 2.0 * np.max(together) or np.max(apart) < 3e-4

    def test_critical_speeds(self, model):
        case = ROSS["compressor"]
        found = critical(model, SweepSettings(SweepRange(case["from"], case["to"], 6))).found
        wanted = complex_of(case["critical"])
        np.testing.assert_allclose([entry.speed for entry in found], wanted.imag, rtol=1e-4)
        ratios = -wanted.real / np.abs(wanted)
        np.testing.assert_allclose([entry.damping_ratio for entry in found], ratios, atol=1.2e-4)
