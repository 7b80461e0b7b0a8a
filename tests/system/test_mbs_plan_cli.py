"""From a scene to the map that it needs, and back: plan, generate, analyse."""

from __future__ import annotations

import pytest

import ehdmaps
from ehdmaps.jobs import cli as ehdmaps_cli
from ehdmaps.jobs import solvers
from ehdmaps.jobs.make.tasks import LineTask
from ehdmaps.jobs.reader import read_job
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.solution import FilmSolution, Status, contact_solution
from mbs import cli


@pytest.mark.usefixtures("fine_laws")
@pytest.mark.slow
def test_a_planned_map_serves_its_scene_and_is_as_good_as_it_should_be(tmp_path, monkeypatch, capsys):
    """At 40 degC the damping of the gearbox is negative in the valley, beside which a law must not ring."""
    monkeypatch.chdir(tmp_path)
    assert cli.main(["plan", "gearbox", "-o", "job.toml"]) == 0
    assert "job.toml: written; `ehdmaps generate job.toml` makes the map" in capsys.readouterr().out
    assert ehdmaps_cli.main(["generate", "job.toml", "-o", "map.nc", "--workers", "1"]) == 0
    assert "unmet" not in capsys.readouterr().out
    emap = ehdmaps.open_map("map.nc")
    assert emap.dataset.attrs["law_check_usable"] == 100
    assert emap.dataset.attrs["law_damping_within_bar"] >= 0.99
    assert emap.dataset.attrs["law_valley_damping_within_bar"] >= 0.95

    assert all(Status(word).usable for word in set(emap.dataset["status"].values.ravel().tolist()))
    # Held at the edge of a map, a law would count the call, and the status would be 1.
    assert cli.main(["statics", "gearbox", "--map", "map.nc"]) == 0
    assert "outside the map" not in capsys.readouterr().out

    # The law between the nodes of the map, at its one temperature, against a fresh solve beside those of its check.
    job = read_job("job.toml")
    inner, load, speed, temperature = job.contacts[0], 2.2e4, 0.825, job.temperatures[0]
    arrays = LineTask(
        inner, job.lubricant, (load,), speed, temperature, solvers.build(job.solver, job.solver_options)
    ).run()
    film = FilmSolution(
        **{name: array[0].item() for name, array in arrays.items() if name != "status"},
        status=Status(int(arrays["status"][0])),
    )
    fresh = contact_solution(film, inner, OperatingPoint(load, speed, temperature))
    found, stiffness, damping = emap.law("inner")(fresh.approach, 0.0, speed, temperature)
    # 0.0005: what the law of the map misses between its lines, as `ehdmaps show` reports it; damping ten times
    assert found == pytest.approx(load, rel=5e-4)
    assert stiffness == pytest.approx(fresh.stiffness, rel=5e-4)
    assert damping == pytest.approx(fresh.damping, rel=5e-3)
