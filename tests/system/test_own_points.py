"""Points of a map that its user changed: every reader has what the file says, and none what it said before."""

from __future__ import annotations

import functools
import re
import zipfile
from collections.abc import Callable
from contextlib import redirect_stdout
from dataclasses import replace
from io import StringIO
from pathlib import Path
from unittest import mock

import numpy as np
import pytest

import ehdmaps
import mbs
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.generate import generate
from ehdmaps.maps import schema
from ehdmaps.maps.records import DERIVED
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from mbs.cli import main as mbs_main

pytestmark = pytest.mark.slow

AT = ["--speed", "1 m/s", "--temperature", "60 degC"]
FACTORS = {"film_offset": 1.2, "film_compliance": 1.2, "loss_compliance": 1.5}

JOB = Job.build(
    bearing=BearingGeometry.named("NU308"),
    lubricant=Lubricant.named("FVA3"),
    loads=np.geomspace(2e3, 4e5, 5),
    entrainment_speeds=(0.5, 1.2, 3.0),
    temperatures=(320.0, 345.0),
    name="nu308",
)


ORIGINS = ["table", "solved"]
"""Laws that know more than points: by the film table, or by refinement lines."""


@pytest.fixture(scope="module")
def made_maps(tmp_path_factory) -> Callable[[str], dict[str, Path]]:
    """What makes the maps of an origin, once for all tests, in whatever order pytest has them."""
    return functools.cache(lambda origin: make_maps(origin, tmp_path_factory.mktemp(origin)))


@pytest.fixture(params=ORIGINS)
def maps(request, made_maps) -> dict[str, Path]:
    """A map as it is made, with changed films, and with these films in a map that never had any others."""
    return made_maps(request.param)


def make_maps(origin: str, folder: Path) -> dict[str, Path]:
    """Make these maps."""
    paths = {name: folder / name / "nu308.nc" for name in ("made", "changed", "plain")}
    for path in paths.values():
        path.parent.mkdir()
    job = replace(JOB, law_check=0, solver_options={"films": origin})
    made = generate(job, paths["made"], workers=1)
    assert (made.backbone is not None) == (origin == "solved")
    own = made.dataset.drop_vars(list(DERIVED))
    own = own.assign({name: own[name] * factor for name, factor in FACTORS.items()})
    del own.attrs[schema.CHECKSUM]
    own.to_netcdf(paths["changed"])
    if made.backbone is not None:
        made.backbone.to_netcdf(paths["changed"], mode="a", group=schema.BACKBONE)
    own.attrs.pop(schema.FILM_TABLE, None)
    own.to_netcdf(paths["plain"])
    return paths


def _law(path: Path) -> np.ndarray:
    law = ehdmaps.open_map(path).law("series")
    point = law.at(1.0, 333.15)
    memory = point.memory
    state = memory.settled(4e-6)
    return np.array([*law(4e-6, 1e-4, 1.0, 333.15), memory.advance(state, 4.1e-6, 1e-5)[0], *point.rolling_force(1e5)])


def _numbers(text: str) -> np.ndarray:
    """Numbers of at least ten digits in a text: those of a law, and none of its provenance."""
    found = re.findall(r"-?\d\.\d{9,}(?:e[-+]?\d+)?|-?0\.\d{9,}(?:e[-+]?\d+)?", text)
    assert len(found) > 100
    return np.array(found, dtype=float)


def _exported(target: str, name: str, *options: str) -> Callable[[Path], np.ndarray]:
    """Numbers of an export of a map."""

    def read(path: Path) -> np.ndarray:
        out = path.parent / name
        assert main(["export", str(path), "--to", target, "-o", str(out), *options]) == 0
        if target == "fmu":
            with zipfile.ZipFile(out) as unit:
                return _numbers(unit.read("sources/ehd.c").decode())
        return _numbers((out / "ehd.c" if target == "c" else out).read_text())

    return read


def _bearing(path: Path) -> np.ndarray:
    found = mbs.statics(mbs.assemble(mbs.read_scene("nu308_rigid"), "map", str(path)))
    return np.concatenate([found.dataset[f"bearing_{name}"].values.ravel() for name in ("stiffness", "damping")])


def _told(run: Callable[[list[str]], int], *words: str) -> Callable[[Path], np.ndarray]:
    """Numbers that a command prints; `made` stands for the map as it was made."""

    def read(path: Path) -> np.ndarray:
        held = {"map": str(path), "made": str(path.parent.parent / "made" / "nu308.nc")}
        with redirect_stdout(StringIO()) as out:
            assert run([held.get(word, word) for word in words]) == 0
        text = out.getvalue().replace(str(path.parent.parent), "")
        return np.array(re.findall(r"(?<![\w.])-?\d+\.\d+(?:e[-+]?\d+)?", text), dtype=float)

    return read


READERS: dict[str, Callable[[Path], np.ndarray]] = {
    "law": _law,
    "bearing": _bearing,
    "csv": _exported("csv", "law.csv", *AT),
    "c": _exported("c", "c"),
    "fmu": _exported("fmu", "law.fmu"),
    "mbs bearing": _told(mbs_main, "bearing", "NU308", "--map", "map", "--load", "5 kN", "--speed", "700 rpm",
                         "--temperature", "60 degC"),
    "compare": _told(main, "compare", "map", "made"),
}  # fmt: skip


@pytest.mark.parametrize(
    ("maps", "reader"),
    [*(("table", reader) for reader in READERS), ("solved", "law")],
    indirect=["maps"],
)
def test_every_reader_of_a_map_has_what_the_file_says(maps, reader):
    with mock.patch("ehdmaps.exports.fmu.unit.platforms", return_value=()):
        changed, plain = (READERS[reader](maps[name]) for name in ("changed", "plain"))
    np.testing.assert_array_equal(changed, plain)
    if reader in ("csv", "c", "fmu"):  # files of the law, which was another one
        return
    made = READERS[reader](maps["made"])
    assert changed.shape != made.shape or np.max(np.abs(changed - made) / (np.abs(made) + 1e-300)) > 1e-3


def test_it_is_told(maps, capsys):
    assert main(["show", str(maps["changed"])]) == 0
    out = capsys.readouterr().out
    assert "films: points of your own, " in out and "; laws read these points, and were not checked" in out
    assert "refinement lines of" not in out and "film table, as the films" not in out
    assert main(["show", str(maps["made"])]) == 0
    assert "of your own" not in capsys.readouterr().out


def test_what_is_no_change_of_a_film_leaves_the_laws(maps):
    """Saved again, other attributes, a film that no law reads, or single precision of a table: the same laws."""
    made = ehdmaps.open_map(maps["made"])
    kept = {"backbone": made.backbone}
    for dataset in (
        made.dataset.assign_attrs(title="mine"),
        made.dataset.assign(central_film=1.01 * made.dataset["central_film"]),
        made.dataset.drop_vars(["rolling_force", "mass_flow"]),
    ):
        other = ehdmaps.maps.emap.EHDMap(dataset, **kept)
        assert not other.own_points and other.known_between
    edited = made.dataset.copy(deep=True).drop_vars(list(DERIVED))
    edited["film_offset"][0, 3, 1, 1] *= 1.001
    assert ehdmaps.maps.emap.EHDMap(edited, **kept).own_points
    oil = made.dataset.assign_attrs(lubricant=made.dataset.attrs["lubricant"].replace("887.6", "900.1"))
    assert ehdmaps.maps.emap.EHDMap(oil, **kept).own_points


def test_points_of_another_film_table_are_the_maps_own():
    """A map of a table that is no more: its laws are those of its points, as it says, and not of the table of today."""
    dataset = ehdmaps.generate(replace(JOB, law_check=0))
    older = dataset.drop_vars(list(DERIVED)).assign(film_offset=dataset["film_offset"] * (1.0 + 1e-5))
    assert not ehdmaps.maps.emap.EHDMap(dataset).own_points
    emap = ehdmaps.maps.emap.EHDMap(older)
    assert "are not those of the film table" in emap.own_points and not emap.from_table
