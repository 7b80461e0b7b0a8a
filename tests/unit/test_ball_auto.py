"""`mbs plan` of machines without maps, on balls and tapered rollers, and which of them are judged."""

from __future__ import annotations

import dataclasses

import numpy as np

from ehdmaps.physics.lubricant import Lubricant
from mbs import assemble, parse_scene, read_scene
from mbs.model.equilibrium import equilibrium
from mbs.planning.physics import verdicts
from mbs.planning.plan import plan
from mbs.planning.question import at_one_speed
from tests.cases import commands
from tests.unit.test_tapered_scenes import O_PAIR, WEIGHT, text


def test_plan_tells_what_is_seen_and_writes_no_job(capsys, tmp_path):
    status, out, _ = commands.run(capsys, "plan", "electric_drive")
    assert status == 0 and "largest load of a ball at rest" in out
    assert "in the film table of points, which answers: no map" in out and "nothing to write" in out
    fastest = read_scene("electric_drive").sweep.end
    element = assemble(read_scene("electric_drive"), "hertz").balls[0]
    assert f"{element.entrainment_rate * fastest:.4g} m/s" in out
    status, _, err = commands.run(capsys, "plan", "electric_drive", "-o", str(tmp_path / "job.toml"))
    assert status == 2 and "there is no map to make" in " ".join(err.split())
    assert not list(tmp_path.iterdir())


def test_rollers_are_planned_and_balls_beside_them_told():
    given = read_scene("nu2210_shaft")
    head, _, right = given.text.rpartition("geometry = { estimate")
    mixed = head + 'bearing = "6210"\n\n[[inputs' + right.partition("[[inputs")[2]
    found = plan(at_one_speed(parse_scene(mixed, "mixed", "mixed.toml")))
    (rollers,), (balls,) = found.needed, found.seen
    assert (rollers.bearings, balls.bearings) == (("left",), ("right",))
    balance = equilibrium(found.model.system, found.model.operation)
    radial = np.linalg.norm(balance.forces[found.model.ring_places[1]][1:3])
    # Stribeck's factor without clearance, 4.37; unbalance, and the angle at which a ball is just below the load, add
    assert 4.2 < balls.static_load * balls.geometry.balls / radial < 5.0
    assert [job.bearing.name for job in found.jobs()] == ["NU2210"]


def test_lines_of_tapered_rollers_are_judged_and_points_are_not():
    scene = dataclasses.replace(
        parse_scene(text(**O_PAIR, more=WEIGHT), "rotor", "rotor.toml"), lubricant=Lubricant.named("FVA3")
    )
    (seen,) = plan(scene).seen
    assert not seen.of_points and seen.display.unit == "N/mm"
    assert {verdict.physics for verdict in verdicts(scene)} >= {"inlet heat", "limiting shear stress"}
    assert verdicts(read_scene("electric_drive")) == ()
