"""Physics, law of shear and sliding on the command line and in jobs; what films with them have, in tables and maps."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace

import numpy as np
import pytest

import ehdmaps
from ehdmaps.errors import InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.make.generate import generate_in_memory
from ehdmaps.jobs.make.tasks import FOUND_BY_SOME
from ehdmaps.jobs.reader import parse_job, read_job
from ehdmaps.jobs.show.describe import describe
from ehdmaps.maps.emap import EHDMap
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import FilmSolution

JOB = """schema = 1
[bearing]
name = "NU308"
[lubricant]
name = "FVA3"
[grid]
load = { from = "1 N/mm", to = "100 N/mm", points = 4, spacing = "log" }
entrainment_speed = ["1 m/s", "2 m/s"]
temperature = ["40 degC"]
[solver]
name = "reynolds"
structural_law = "iso16281"
"""
POINT = ["--load", "200 N", "--length", "1 mm", "--speed", "10 m/s", "--temperature", "100 degC"]


@dataclass(frozen=True)
class Sliding(FormulaSolver):
    """Closed formulas whose films have traction and temperatures, as those of a solver with heat."""

    def solve_line(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[FilmSolution, ...]:
        films = super().solve_line(contact, lubricant, loads, entrainment_speed, temperature)
        return tuple(
            replace(film, traction=0.02 * load, wall_stress=1e7, film_temperature=temperature + 5.0)
            for film, load in zip(films, loads, strict=True)
        )


def test_a_solve_with_heat_in_the_inlet(capsys):
    assert main(["solve", "nu308", *POINT, "--physics", "inlet-heat"]) == 0
    text = capsys.readouterr().out
    assert "solver reynolds, inlet-heat, structural law" in text
    assert "inner: " in text and "inlet heat by a formula: film x 0.932" in text
    found = {}
    for physics in ("isothermal", "inlet-heat"):
        assert main(["solve", "nu308", *POINT, "--physics", physics, "--json"]) == 0
        found[physics] = json.loads(capsys.readouterr().out)[0]
    cold, warm = (found[physics]["film_offset"] for physics in found)
    assert 0.93 < warm / cold < 0.94
    assert all(found["inlet-heat"][name] is None for name in ("film_temperature", "surface_temperature"))


def test_keys_of_the_command_line_are_those_of_the_solver():
    problems: list[str] = []
    assert solvers.stated("reynolds", {"physics": "inlet-heat"}, problems) == {"physics": "inlet-heat"}
    texts = {"shear": "limiting", "shear_stress": "3 MPa", "slide_to_roll": "-0.1"}
    assert solvers.stated("openfoam", {"shear": "limiting", "slide_to_roll": "-0.1"}, problems) == {
        "shear": "limiting",
        "slide_to_roll": -0.1,
    }
    assert problems == []
    assert solvers.stated("formula", texts, problems) == {}
    assert [problem.split(":")[0] for problem in problems] == ["--shear", "--shear-stress", "--slide-to-roll"]
    assert all("the solver 'formula' knows none; allowed: with --solver" in problem for problem in problems)


def test_words_of_a_solver_leave_its_defaults_out():
    assert solvers.solver_words({"density": 6.5, "physics": "isothermal", "shear": "newtonian"}) == ""
    words = solvers.solver_words({"physics": "thermal", "shear": "limiting", "slide_to_roll": 0.1})
    assert words == ", thermal, limiting, slide to roll 0.1"


def test_a_job_with_heat_needs_the_conductivity_of_its_oil():
    warm = JOB + 'physics = "inlet-heat"\n'
    assert parse_job(warm, "warm", "warm.toml").solver_options == {"physics": "inlet-heat"}
    other = warm.replace('"FVA3"', '"Spirax MA 80W"')
    with pytest.raises(InputError, match=r"\[lubricant\]: lubricant 'Spirax MA 80W', thermal_conductivity: got none"):
        parse_job(other, "warm", "warm.toml")
    stated = other.replace('80W"', '80W"\nthermal_conductivity = "0.13 W/(m K)"')
    assert parse_job(stated, "warm", "warm.toml").lubricant.thermal_conductivity == 0.13
    cold = parse_job(JOB.replace('"FVA3"', '"Spirax MA 80W"'), "cold", "cold.toml")
    assert cold.lubricant.thermal_conductivity is None


def test_a_map_holds_what_its_films_have_and_nothing_else():
    job = parse_job(JOB.replace('"reynolds"', '"formula"'), "small", "small.toml")
    dataset = generate_in_memory(job, workers=1, solver=Sliding()).dataset
    np.testing.assert_allclose(dataset["traction"].values[0, :, 0, 0], 0.02 * np.array(job.loads), rtol=1e-15)
    assert dataset["film_temperature"].attrs["units"] == "K"
    assert "surface_temperature" not in dataset  # no film had one
    text = describe(EHDMap(dataset), "small.nc")
    assert "traction " in text and "film_temperature " in text and "surface_temperature" not in text
    plain = generate_in_memory(job, workers=1).dataset  # of closed forms, which know nothing of all this
    assert not set(FOUND_BY_SOME) & set(plain.data_vars)


def test_a_table_of_a_point_has_what_its_films_have(monkeypatch, capsys):
    monkeypatch.setattr(solvers, "build", lambda name, options: Sliding())
    assert main(["solve", "nu308", *POINT, "--solver", "formula"]) == 0
    text = capsys.readouterr().out
    rows = {line[2:24].strip(): line.split()[-1] for line in text.splitlines()}
    assert rows["hottest of the film"] == "105" and rows["largest wall stress"] == "0.01"
    assert "hottest of the surfaces" not in text


def test_shipped_jobs_keep_their_keys():
    assert read_job("nu308").solver_options == {}
    assert ehdmaps.Job.build(
        bearing=read_job("nu308").bearing, lubricant=read_job("nu308").lubricant, loads=[1e4, 2e4],
        entrainment_speeds=[1.0], temperatures=[313.15], solver_options={"physics": "inlet-heat"},
    ).solver_options == {"physics": "inlet-heat"}  # fmt: skip


def test_a_solver_in_place_of_the_jobs_keeps_what_the_film_is():
    job = read_job("nu308_openfoam", "reynolds")
    assert job.solver_options == {"physics": "thermal", "shear": "limiting", "slide_to_roll": 0.0}
    assert read_job("nu308_openfoam", "formula").solver_options == {}
    with pytest.raises(InputError, match="--solver: got 'openfoam', which knows no physics = 'inlet-heat'"):
        parse_job(JOB + 'physics = "inlet-heat"\n', "job", "job", "openfoam")
