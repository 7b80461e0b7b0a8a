"""What nothing holds at an equilibrium, and loads that act along it."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError
from mbs.model.body import rigid_body
from mbs.model.elements import Load, Operation, Spring
from mbs.model.equilibrium import equilibrium, free_lines, free_motions
from mbs.model.system import System
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene, shipped_systems
from tests.cases.elements import MASS, OneSided, force, stiff


def two_bodies(loads=(), **ground):
    """Two bodies on a spring between them; the second on the ground by what is given."""
    bodies = [rigid_body(name, [MASS], ["y", "z"]) for name in "ab"]
    springs = [Spring("between", "a", "b", stiff(y=1e9, z=1e9))]
    springs += [Spring("foundation", "b", "ground", stiff(**ground))] if ground else []
    return System(bodies, springs, [Load(f"load {index}", *load) for index, load in enumerate(loads)])


def lines(system):
    return free_lines(free_motions(equilibrium(system, Operation())))


def test_what_is_held_is_not_free():
    assert lines(two_bodies([("a", force(y=1.0))], y=1e3, z=1e5)) == []  # also where the spring is soft


def test_a_coordinate_without_stiffness_is_named():
    body = rigid_body("ring", [MASS], ["x", "y", "theta_z"])
    system = System([body], [Spring("mount", "ring", "ground", stiff(y=1e5))], [Load("w", "ring", force(y=10.0))])
    assert lines(system) == [
        "ring moves freely along x: its position is arbitrary",
        "ring tilts freely about z: its position is arbitrary",
    ]


def test_bodies_that_move_together_are_named_together():
    found = free_motions(equilibrium(two_bodies([("a", force(y=5.0), "b")], z=1e5), Operation()))
    assert [motion.coordinates for motion in found] == [("a.y", "b.y")]
    np.testing.assert_allclose(found[0].shape, [1.0, 0.0, 1.0, 0.0], atol=1e-6)  # of the eigenvalue solver
    assert free_lines(found) == ["a.y, b.y move freely together: their positions are arbitrary"]


def test_a_gap_is_free():
    system = System([rigid_body("a", [MASS], ["y", "z"])], [Spring("s", "a", "ground", stiff(z=1e6))],
                    [Load("w", "a", force(z=3.0))], [OneSided("stop", "a", gap=1e-3)])  # fmt: skip
    assert lines(system) == ["a moves freely along y: its position is arbitrary"]


def test_a_small_load_along_it_is_no_equilibrium():
    # Beside 1 MN the residual of a nanonewton is nothing, and was taken for an equilibrium.
    system = System([rigid_body("a", [MASS], ["y", "z"])], [Spring("s", "a", "ground", stiff(z=1e9))],
                    [Load("w", "a", force(z=1e4, y=1e-7))])  # fmt: skip
    balance = equilibrium(system, Operation())
    with pytest.raises(AnalysisError, match="no equilibrium: a moves freely along y, and a load of 1e-07 N acts that"):
        free_motions(balance)
    together = two_bodies([("a", force(y=1e-7, z=1e4))], z=1e5)
    with pytest.raises(AnalysisError, match=r"a\.y, b\.y move freely together, and a load of 1e-07 N acts that way"):
        free_motions(equilibrium(together, Operation()))


def test_a_large_load_along_it_is_no_equilibrium():
    with pytest.raises(AnalysisError, match="no equilibrium after"):
        equilibrium(two_bodies([("a", force(y=5.0))], z=1e5), Operation())


@pytest.mark.parametrize("name", shipped_systems())
def test_shipped_systems_are_held(name):
    model = assemble(read_scene(name), "hertz")
    assert lines(model.system) == []


def test_unloaded_rollers_are_counted():
    model = assemble(read_scene("n1014_rigid"), "hertz", clearance=20e-6)
    balance = equilibrium(model.system, model.operation)
    bearing = model.bearings[0]
    motion = model.system.relative(bearing.inner, bearing.outer) @ balance.displacement
    unloaded = np.count_nonzero(bearing.loads(motion, model.operation).load == 0.0)
    assert 0 < unloaded < 24
    (line,) = free_lines(free_motions(balance))
    assert line.startswith("bearing_rollers: ")
    assert line.endswith(" unloaded rollers move freely; their places are arbitrary")
    # One that was left just touching a raceway is held by that, though it carries nothing.
    assert 0 < int(line.split()[1]) <= unloaded
