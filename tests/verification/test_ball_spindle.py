"""The shipped motor spindle, and with ROSS the electric drive: on the same tables, and preload by vectors in space."""

from __future__ import annotations

import dataclasses
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from ehdmaps.errors import AnalysisError
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from mbs import assemble, read_scene
from mbs.linearised.critical import order_responses
from mbs.linearised.modes import modes
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.scene.matrices import MatrixSpec
from mbs.scene.specs import ShaftSpec
from mbs.settings import Settings
from mbs.transient.run import run
from tests.cases.balls import balls_in_space

RPM = math.pi / 30.0
REFERENCES = Path(__file__).parents[1] / "references"


@pytest.fixture(scope="module")
def scene():
    return read_scene("spindle")


@pytest.fixture(scope="module")
def machine(scene):
    return assemble(dataclasses.replace(scene, gravity=(0.0, 0.0, 0.0)), "hertz")


class TestRoss:
    """ROSS 2.3.0 with the tables of all bearings: `tests.benchmarks.ross_balls`."""

    @pytest.fixture(scope="class", params=["spindle", "electric_drive"])
    @staticmethod
    def compared(request):
        """A shipped scene on the tables of its bearings, and what ROSS finds."""
        scene = read_scene(request.param)
        given = tomllib.loads((REFERENCES / f"ross_{request.param}.toml").read_text(encoding="utf-8"))
        speeds, elements = np.array(given["speeds"]), []
        for ball in scene.located:
            whole = np.zeros((2, speeds.size, 6, 6))
            for part, key in zip(whole, ("stiffness", "damping"), strict=True):
                part[:, 1:3, 1:3] = given["tables"][ball.name][key]
            # what only ROSS does not have: something that holds the shaft along its axis
            whole[0, :, 0, 0] = 1e8
            elements.append(MatrixSpec(ball.name, ball.inner, whole[0], whole[1], ball.outer, speeds))
        bodies = [
            dataclasses.replace(body, cutoff=50e3, largest_element=0.01, damping_ratio=0.0)
            if isinstance(body, ShaftSpec)
            else body
            for body in scene.bodies
        ]
        return assemble(dataclasses.replace(scene, elements=elements, bodies=bodies), "hertz"), given

    def test_eigenvalues(self, compared):
        """The first eight, to 2.8 and 3 kHz. Without modes above 50 kHz: with all it would be 3e-5 and 5e-5."""
        (model, given), bound = compared, {"spindle": 4e-5, "electric_drive": 7e-5}
        for speed, pairs in zip(given["speeds"], given["ross"]["eigenvalues"], strict=True):
            wanted = np.array(pairs) @ np.array([1, 1j])
            found = modes(equilibrium(model.system, Operation(speed))).eigenvalues
            nearest = found[np.argmin(np.abs(found[:, None] - wanted), axis=0)]
            assert len(set(nearest.tolist())) == wanted.size == 8
            assert np.max(np.abs(nearest / wanted - 1.0)) < bound[model.scene.name]

    def test_unbalance(self, compared):
        model, given = compared
        (unbalance,) = model.scene.unbalances
        (response,) = order_responses(lambda speed: model.system, np.array(given["speeds"]))
        moved = response.motion @ model.system.relative(unbalance.on)[1:3].T
        wanted = np.array(given["ross"]["moved"]) @ np.array([1, 1j]) * unbalance.moment
        np.testing.assert_allclose(np.abs(moved), np.abs(wanted), rtol=1e-4)


def harris(name: str, axial: float, speed: float) -> tuple[float, float]:
    """Axial force of a bearing [N] and its stiffness [N/m] under an axial displacement, by velocities in space."""
    geometry = ball_estimate(name).with_clearance(0.0)

    def force(u: float) -> float:
        return -geometry.balls * balls_in_space(geometry, np.array([u, 0.0, 0.0, 0.0, 0.0, 0.0]), speed, only=1)[0][0]

    step = 2e-8
    return force(axial), (force(axial + step) - force(axial - step)) / (2.0 * step)


def statics(machine, rpm):
    """Axial force, stiffness and displacement of each bearing by its name."""
    rest, found = equilibrium(machine.system, Operation(rpm * RPM)), {}
    for index, entry in enumerate(machine.system.elements):
        place = entry.transform @ rest.displacement
        answer = entry.element.evaluate(place, np.zeros(6), rest.operation)
        found[entry.element.name] = abs(rest.forces[index][0]), answer.stiffness[0, 0], place[0]
    return found


class TestPreload:
    """Without weight: pairs are preloaded by displacement at the nose and by force at the other end."""

    @pytest.mark.parametrize("rpm", [0.0, 5000.0, 10000.0])
    def test_preload_and_stiffness(self, machine, rpm):
        """Forces by the oracle's displacements; of the nose's, the 40 mm of the shaft between its bearings take F L/EA.
        The equilibrium is left with 1e-10 of the forces, and the balance of the balls 1e-8 of the axial one."""
        found = statics(machine, rpm)
        force, stiffness, way = found["front"]
        inside, _, other = found["front_inside"]
        shortened = force * 40e-3 / (210e9 * math.pi / 4.0 * (70e-3**2 - 30e-3**2))
        assert way - other == pytest.approx(-shortened, rel=1e-3)
        wanted, slope = harris("7014C", 12e-6 + way, rpm * RPM)
        assert force == pytest.approx(wanted, rel=1e-6)
        assert harris("7014C", -other, rpm * RPM)[0] == pytest.approx(inside, rel=1e-6)
        assert stiffness == pytest.approx(slope, rel=1e-5)
        rear, stiffness, _ = found["rear"]
        u = brentq(lambda u: harris("7012C", u, rpm * RPM)[0] - rear, -1e-5, 1e-4, xtol=1e-13)
        assert stiffness == pytest.approx(harris("7012C", u, rpm * RPM)[1], rel=1e-5)

    def test_trends(self, machine):
        """Speed raises what a displacement makes, and not what springs make; both pairs soften radially."""
        slow, fast = statics(machine, 500.0), statics(machine, 10000.0)
        assert fast["front"][0] > 2.0 * slow["front"][0]
        assert fast["rear"][0] == pytest.approx(slow["rear"][0], rel=0.05)
        assert fast["rear"][1] < 0.5 * slow["rear"][1]


@pytest.mark.slow
def test_loss_of_preload_in_a_run_is_said(scene):
    """Springs that pull where they should press: the rings of the sleeve come apart, and the run says so."""
    loads = [dataclasses.replace(load, force=-load.force) for load in scene.loads]
    machine = assemble(dataclasses.replace(scene, loads=loads), "hertz:1.25e-5 s")
    rest = equilibrium(assemble(scene, "hertz").system, Operation(1000.0 * RPM))
    with pytest.raises(AnalysisError, match=r"bearing 'rear.*preload is lost; take more preload"):
        run(
            machine.system,
            SpeedProfile.constant(1000.0 * RPM),
            0.02,
            Settings(step=2e-5, sample=1e-3),
            displacement=rest.displacement,
        )
