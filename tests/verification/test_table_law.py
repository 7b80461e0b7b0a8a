"""Contact laws and maps from the film table beside those from solved lines."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import ehdmaps
from ehdmaps.errors import InputError
from ehdmaps.jobs.make.report import films_lines
from ehdmaps.jobs.make.table_law import law, table_map
from ehdmaps.jobs.solvers import build
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.surface import SMOOTH, Surface
from mbs import assemble, read_scene, statics
from mbs.cli import main
from tests.cases.jobs import FINE
from tests.conftest import made_map

OIL = Lubricant.named("FVA3")
LINE = LineContact("line", 6e-3, STEEL, "half_space", reference_depth=6e-3)
narrow_law = partial(law, LINE, OIL, loads=(2e3, 4e5), entrainment_speeds=(0.5, 3.0), temperatures=(320.0, 345.0))


def test_a_kind_that_there_is_not_is_refused() -> None:
    with pytest.raises(InputError, match="kind: got 'series'; allowed: line"):
        narrow_law(kind="series")
    with pytest.raises(InputError, match="kind: got 'line'; allowed: series, inner, outer"):
        ehdmaps.law(ehdmaps.BearingGeometry.named("NU308"), OIL, "line")


@pytest.mark.slow
def test_a_map_in_memory_is_its_dataset() -> None:
    """Laws of a map in memory do without its dataset; all that they take is in it, to the last bit."""
    given = {"supply": OilSupply(5e-6), "surface": Surface(2e-7)}
    emap = table_map(ehdmaps.BearingGeometry.named("NU308"), OIL, (2e3, 4e5), (0.5, 3.0), (320.0, 345.0), **given)
    whole = EHDMap(emap.dataset)
    for name in ("contacts", "lubricant", "bearing", "supply", "surface", "solver", "from_table", "known_between"):
        assert getattr(emap, name) == getattr(whole, name), name
    for name in schema.DIMS[1:]:
        np.testing.assert_array_equal(emap.axis(name), whole.axis(name))
    held = [entry.name for entry in schema.table() if not entry.axis and entry.name in whole.dataset]
    assert {"stiffness", "central_film", "rolling_force", "max_pressure_error"} <= set(held)
    for name in held:
        np.testing.assert_array_equal(emap.points(name), whole.points(name), name)
    assert emap.points("film_temperature") is None is whole.points("film_temperature")
    one, other = (each.law("inner", supply=FLOODED, surface=SMOOTH) for each in (emap, whole))
    for part, same in zip(one.plain_table.own, other.plain_table.own, strict=True):
        np.testing.assert_array_equal(part, same)
    bounds = [each.at(1.0, 330.0).bounds(np.array([1e4])) for each in (one, other)]
    assert bounds[0] == bounds[1]


@pytest.mark.slow
def test_a_machine_runs_on_the_table_as_on_a_map(solved_map: str) -> None:
    """Stiffness within 0.1 % and damping within 2 %: the errors of table and map."""
    scene = read_scene("nu308_rigid")
    read, solved = statics(assemble(scene, "table", inlet_heat=False)), statics(assemble(scene, "map", solved_map))
    assert read.model.label == "film table"
    assert solved.model.label == "Reynolds map"
    for name, bound in (("stiffness", 1e-3), ("damping", 0.02)):
        one, other = (found.dataset[f"bearing_{name}"].values[:, :2, :2] for found in (read, solved))
        assert np.max(np.abs(one - other)) < bound * np.max(np.abs(other))


@pytest.mark.slow
@pytest.mark.parametrize("speed", ["1500 rpm", "0 rpm"])
def test_a_bearing_has_films_without_a_map(speed: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bearing", "NU308", "--law", "table", "--load", "5 kN", "--speed", speed]) == 0
    head = capsys.readouterr().out.splitlines()[0]
    assert head == "NU308: law film table, FVA3, inlet heat; films of the map, FVA3, flooded"


def test_what_the_law_of_the_table_needs(small_map: str, capsys: pytest.CaptureFixture[str]) -> None:
    bare = replace(read_scene("nu308_rigid"), lubricant=None)
    with pytest.raises(InputError, match=r"--law: got 'table', but nu308_rigid has no \[lubricant\]; add the table"):
        assemble(bare, "table")
    with pytest.raises(InputError, match="--law: got 'table', but nu308_rigid has no bearings; leave it out"):
        assemble(replace(bare, lubricant=OIL, elements=()), "table")
    asked = ["bearing", "NU308", "--law", "table", "--map", small_map, "--load", "5 kN", "--speed", "800 rpm"]
    assert main(asked) == 2
    assert "--law: got 'table' with a map; allowed: hertz or map with --map" in capsys.readouterr().err


READ = FINE.replace("law_check = 0", 'law_check = 40\nfilms = "table"')


@pytest.mark.slow
def test_a_map_with_films_from_the_table_is_that_of_solved_films(solved_map: str, tmp_path: Path) -> None:
    """Within the errors that both state; its laws are checked by fresh solves."""
    read, solved = open_map(made_map(tmp_path, READ, statuses=(0, 1))).dataset, open_map(solved_map).dataset
    assert "film_table" in read.attrs and "film_table" not in solved.attrs
    usable = (read["status"] <= 1) & (solved["status"] <= 1)
    assert float(usable.mean()) > 0.95
    for name in ("central_film", "film_offset"):
        apart = np.abs(read[name] / solved[name] - 1.0)
        stated = np.abs(read[f"{name}_error"]) + np.abs(solved[f"{name}_error"])
        assert float((apart <= stated).where(usable).mean()) > 0.95
        assert float(apart.where(usable).median()) < 1e-3  # the grid of the map that was solved
    settings = json.loads(read.attrs["solver_settings"])
    assert settings["density"] == 10.0 and "film_table" in settings
    line, _ = films_lines(read)  # the other is the check of the release
    assert line.startswith(f"films: {read['status'].size} points read from the film table")
    assert not list(films_lines(solved))


def test_films_with_heat_take_no_table() -> None:
    words = r"\[solver\] films: got 'table'; film table: knows nothing of heat in the film \(physics = thermal\)"
    with pytest.raises(InputError, match=words):
        build("reynolds", {"films": "table", "physics": "thermal"})
