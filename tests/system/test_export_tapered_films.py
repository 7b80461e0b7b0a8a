"""Units of tapered rollers, and of NUP on its ribs, whose films have a memory, by FMPy: against the element in time."""

from __future__ import annotations

import math
from unittest import mock

import numpy as np
import pytest
from fmpy.validation import validate_fmu

from ehdmaps.exports.fmu.binaries import platforms
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FilmConditions, OilSupply
from ehdmaps.physics.rollers.ribbed_geometry import ribbed_estimate
from ehdmaps.physics.rollers.tapered_catalogue import tapered_estimate
from ehdmaps.physics.surface import Surface
from mbs.bearings.locating.locating_block import FELT
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.cli import main
from mbs.model.elements import Operation
from mbs.scene.locating.line_films import FilmsOfLines, OilOfLines
from tests.cases.fmu import Unit, stepped
from tests.cases.tapered_runs import driven

SPEED, WARM, STEP = 3000.0 * math.pi / 30.0, 333.15, 5e-6


@pytest.mark.slow
@pytest.mark.parametrize(("name", "fmi"), [("32208", "2"), ("NUP210", "3")])
def test_unit_in_time_is_the_element(tmp_path, name, fmi):
    """Up to 60 um within 0.2 ms, so that rollers lift off: both end in the balance of the rollers to 1e-9, and read the
    same law and springs, with heat, on an oil layer and between rough surfaces."""
    geometry = tapered_estimate(name) if name[0].isdigit() else ribbed_estimate(name)
    force = TaperedForce(geometry)
    real = FilmConditions(inlet_heat=True, supply=OilSupply(2e-6), surface=Surface(0.1e-6))
    oil = OilOfLines("table", Lubricant.named("FVA3"), WARM, 1.05 * geometry.entrainment_speed(SPEED), real)
    element = LocatingElement("b", "i", "o", force, films=FilmsOfLines(geometry, oil), memory="memory")
    path = tmp_path / ("b.fmu" if fmi == "2" else "b.fmi3.fmu")
    words = ("--load", "1 kN", "--axial", "2 kN", "--temperature", "60 degC", "--speed", "3000 rpm", "--oil", "FVA3",
             "--supply", "2 um", "--roughness", "0.1 um")  # fmt: skip
    with mock.patch("ehdmaps.exports.fmu.unit.platforms", return_value=platforms()[:1]):
        assert main(["bearing", name, *words, "--law", "table", "--films", "memory", "-o", str(path)]) == 0
    assert validate_fmu(str(path)) == []
    turn, place = np.linspace(0.0, 4.0 * math.pi, 41), np.array([30e-6, -3e-6, 8e-6, 0.0, 2e-5, -4e-5])
    if name == "NUP210":
        place[0] += force.ribs[0].play
    course = place + np.outer(np.sin(turn), [-60e-6, 20e-6, 10e-6, 0.0, 1e-4, -5e-5])
    wanted, loads, _ = driven(element, SPEED, course, STEP)
    found = stepped(Unit(path, tmp_path / "unit"), course[:, FELT], SPEED, STEP)
    assert loads.min() < 1e-2 * loads.max()
    slow = np.array([element.evaluate(place, np.zeros(6), Operation(SPEED)).force[FELT] for place in course[::8]])
    largest = np.abs(wanted).max(axis=0)
    assert np.all(np.abs(wanted[::8] - slow).max(axis=0) > 3e-3 * largest)
    np.testing.assert_array_less(np.abs(found - wanted).max(axis=0), 1e-7 * largest)
