"""Versions of the map file: what was made before opens as before, what is newer is refused, a row makes a variable."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import netCDF4
import numpy as np
import pytest

import ehdmaps
from ehdmaps.errors import MapError
from ehdmaps.jobs.cli import main
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.reading import check_content, content_sha256
from tests.cases.laws import dataset_of

DATA = Path(__file__).parents[1] / "data"
OLD, OLD_2, OLD_3, OLD_4 = (DATA / f"schema{version}.nc" for version in (1, 2, 3, 4))
"""NU308 by the solver reynolds, with a standstill and a backbone, as `ehdmaps generate` wrote it in schema 1 to 4."""

RECORDED = {path: json.loads(path.with_suffix(".json").read_text()) for path in (OLD, OLD_2, OLD_3, OLD_4)}
"""Values of their laws, recorded when laws went on below the lowest mapped speed by the film table. That changed the
point below it, as intended, and those within the map by 1e-5 at most. Before, laying tables along the solved valley had
moved them from the code that made the maps by 3e-6 of w, 7e-4 of k, 2e-3 of c at most. They are points (approach,
rate, speed, temperature) and (w, dw/ddelta, dw/drate) of the laws of the backbone, and of those of the grid alone; of
schema 2 also loads and tangents of a course in time with films that have a memory."""

NEXT = schema.SCHEMA_VERSION + 1

SAME_CODE = 1e-12
"""Relative: what compilers and powers of other machines may round otherwise. The record is no evidence of accuracy."""


@pytest.mark.parametrize("path", [OLD, OLD_2], ids=["schema 1", "schema 2"])
@pytest.mark.parametrize("laws", ["laws", "grid_laws"])
@pytest.mark.parametrize("kind", ["series", "inner", "outer"])
def test_laws_of_an_old_map_are_as_they_were(path, laws, kind):
    emap, recorded = open_map(path), RECORDED[path]
    law = (emap if laws == "laws" else EHDMap(emap.dataset)).law(kind)
    found = [law(*point) for point in recorded["points"]]
    np.testing.assert_allclose(found, recorded[laws][kind], rtol=SAME_CODE)


def test_a_map_of_schema_3_gives_the_laws_that_it_gave_in_time_too():
    """It has no model errors, and its films answer over frequency."""
    emap, recorded = open_map(OLD_3), RECORDED[OLD_3]
    assert emap.dataset.attrs["schema_version"] == 3 and "stiffness_model_error" not in emap.dataset
    law = emap.law("series")
    np.testing.assert_allclose(
        [law(*point) for point in recorded["points"]], recorded["laws"]["series"], rtol=SAME_CODE
    )
    memory = law.at(1.0, 313.15).memory
    state, found = memory.settled(recorded["course"][0]), []
    for approach in recorded["course"]:
        w, tangent, state = memory.advance(state, approach, recorded["step"])
        found.append((w, tangent))
    # The state is found to 1e-13 of the table's scale.
    np.testing.assert_allclose(found, recorded["memory"]["series"], rtol=1e-10)
    other = open_map(OLD_3, structural_law="half_space")
    assert other.dataset.attrs["schema_version"] == schema.SCHEMA_VERSION


def test_a_map_of_schema_4_gives_the_laws_that_it_gave():
    """It has neither temperatures nor traction, and its oil and solids the heat that is assumed today."""
    emap, recorded = open_map(OLD_4), RECORDED[OLD_4]
    assert emap.dataset.attrs["schema_version"] == 4 and "film_temperature" not in emap.dataset
    assert emap.lubricant == ehdmaps.Lubricant.named("FVA3")
    law = emap.law("series")
    np.testing.assert_allclose(
        [law(*point) for point in recorded["points"]], recorded["laws"]["series"], rtol=SAME_CODE
    )


@pytest.mark.parametrize("kind", ["series", "inner", "outer"])
def test_films_with_memory_of_an_old_map_are_as_they_were(kind):
    """It knows no response over frequency: its films lock by the closed formula."""
    recorded = RECORDED[OLD_2]
    memory = open_map(OLD_2).law(kind).at(1.0, 313.15).memory
    state, found = memory.settled(recorded["course"][0]), []
    for approach in recorded["course"]:
        w, tangent, state = memory.advance(state, approach, recorded["step"])
        found.append((w, tangent))
    # The state is found to 1e-13 of the table's scale.
    np.testing.assert_allclose(found, recorded["memory"][kind], rtol=1e-10)


def test_an_old_map_holds_what_it_held_and_its_films():
    emap = open_map(OLD)
    with netCDF4.Dataset(OLD) as file:
        assert file.schema_version == 1 and "film_compliance" not in file.variables
        file.set_auto_maskandscale(False)
        for name in ("approach", "stiffness", "damping", "stiffness_error", "damping_error", "film_offset"):
            assert np.array_equal(emap.dataset[name].values, file[name][...], equal_nan=True)
    assert emap.dataset.attrs["schema_version"] == 1
    loads = emap.dataset["load"].values[:, None, None]
    for i, contact in enumerate(emap.contacts):
        k, c, s, loss = (
            emap.dataset[name].values[i] for name in ("stiffness", "damping", "film_compliance", "loss_compliance")
        )
        # The film's part is what is left of 1/k: round-off of that.
        np.testing.assert_allclose(s + contact.structural_compliance(loads), 1.0 / k, rtol=1e-14)
        np.testing.assert_allclose(loss, c / k**2, rtol=1e-14)
    check_content(emap.dataset, emap.backbone, "old")
    again = EHDMap(emap.dataset, emap.backbone)
    assert again.dataset.equals(emap.dataset)


def test_an_old_map_serves_another_structural_law(tmp_path):
    emap = open_map(OLD, structural_law="half_space")
    assert emap.dataset.attrs["schema_version"] == schema.SCHEMA_VERSION
    assert emap.law("series")(5e-6, 0.0, 1.0, 313.15)[0] != open_map(OLD).law("series")(5e-6, 0.0, 1.0, 313.15)[0]
    # Schema 1 kept no error of the loss, so none can be stated for another damping.
    assert np.isnan(emap.dataset["damping_error"]).all() and np.isfinite(emap.dataset["stiffness_error"]).all()
    path = tmp_path / "new.nc"
    emap.dataset.to_netcdf(path)
    emap.backbone.to_netcdf(path, mode="a", group="backbone")
    point = (5e-6, 1e-4, 1.0, 313.15)
    assert open_map(path).law("series")(*point) == emap.law("series")(*point)


def test_an_old_and_a_new_map_are_compared(tmp_path, capsys):
    """The same films in both versions: only the last digits differ."""
    old = open_map(OLD)
    new = tmp_path / "new.nc"
    converted = old.with_structure("half_space").with_structure("iso16281")
    assert converted.dataset.attrs["schema_version"] == schema.SCHEMA_VERSION
    converted.dataset.to_netcdf(new)
    converted.backbone.to_netcdf(new, mode="a", group="backbone")
    for pair in ((OLD, new), (new, OLD)):
        found = ehdmaps.compare(*pair)
        assert (found.common, found.solved, found.differing) == (48, 48, ())
        assert max(entry.largest for entry in found.differences) < 1e-12
        assert main(["compare", *map(str, pair)]) == 0
    assert "48 points in common" in capsys.readouterr().out


@pytest.mark.slow
def test_show_and_plot_take_an_old_map(tmp_path, capsys):
    assert main(["show", str(OLD)]) == 0
    shown = capsys.readouterr().out
    assert "schema 1" in shown and "as made (sha256" in shown
    for line in ("  stiffness  ", "  damping  ", "  approach  "):
        assert line in shown
    for command, name in (("plot", "old.png"), ("export", "old.csv")):
        assert main([command, str(OLD), "-o", str(tmp_path / name)]) == 0


@pytest.mark.parametrize("version", [0, -1, schema.SCHEMA_VERSION + 1, 99])
def test_versions_that_nobody_knows_are_refused(tmp_path, version):
    path = tmp_path / "map.nc"
    shutil.copy(OLD, path)
    with netCDF4.Dataset(path, "a") as file:
        file.schema_version = version
    newer = "it was made by a newer one: update ehdmaps, or " if version > 1 else ""
    message = rf"map\.nc: schema_version is {version}; this ehdmaps reads 1 to {schema.SCHEMA_VERSION}; {newer}generate"
    with pytest.raises(MapError, match=message):
        open_map(path)


def test_a_map_of_schema_2_holds_what_it_held():
    emap = open_map(OLD_2)
    assert emap.dataset.attrs["schema_version"] == 2
    check_content(emap.dataset, emap.backbone, "old")
    for held, group in ((emap.dataset, None), (emap.backbone, "backbone")):
        with netCDF4.Dataset(OLD_2) as file:
            file.set_auto_maskandscale(False)
            variables = (file if group is None else file[group]).variables
            names = [entry.name for entry in schema.table(group or schema.GRID, 2) if entry.dtype == "float64"]
            for name in (name for name in names if name in variables):
                assert np.array_equal(held[name].values, variables[name][...], equal_nan=True)
    other = open_map(OLD_2, structural_law="half_space")
    assert other.dataset.attrs["schema_version"] == schema.SCHEMA_VERSION
    assert schema.NATURAL not in other.backbone.variables


def test_an_old_map_that_calls_itself_new_is_refused(tmp_path):
    path = tmp_path / "map.nc"
    shutil.copy(OLD, path)
    with netCDF4.Dataset(path, "a") as file:
        file.schema_version = 2
    with pytest.raises(MapError, match="variable film_compliance is missing"):
        open_map(path)


def test_what_the_table_of_the_version_does_not_name_is_left_alone(tmp_path):
    """A variable of the next version, or of the user, is neither read nor checked, whatever it holds."""
    path = tmp_path / "map.nc"
    shutil.copy(OLD, path)
    with netCDF4.Dataset(path, "a") as file:
        file.createVariable("film_compliance", "f8", ("temperature",))[...] = -1.0  # of schema 2, in a map of schema 1
        file.createVariable("heat_flow", "i4", ("load",))[...] = 7
        file.createGroup("mine").createDimension("n", 3)
    emap = open_map(path)
    assert emap.dataset["film_compliance"].equals(open_map(OLD).dataset["film_compliance"])
    assert "heat_flow" not in emap.dataset


@pytest.mark.parametrize("path", [OLD, OLD_2, OLD_3, OLD_4], ids=["1", "2", "3", "4"])
def test_a_checksum_that_was_made_over_times_too_still_holds(path):
    emap = open_map(path)
    dataset, backbone = emap.dataset, emap.backbone
    assert dataset.attrs[schema.CHECKSUM] != content_sha256(dataset, backbone)
    check_content(dataset, backbone, "old")
    for name in ("film_offset", "solve_seconds"):
        with pytest.raises(MapError, match="old: was changed since it was made"):
            check_content(dataset.assign({name: 2.0 * dataset[name]}), backbone, "old")


def test_a_checksum_does_not_know_what_the_clock_said():
    dataset = dataset_of()
    assert "solve_seconds" in dataset
    slower = dataset.assign(solve_seconds=2.0 * dataset["solve_seconds"] + 1.0)
    assert content_sha256(slower, None) == content_sha256(dataset, None)
    other = dataset.assign(iterations=dataset["iterations"] + 1)
    assert content_sha256(other, None) != content_sha256(dataset, None)


def test_one_row_of_the_table_makes_a_variable_or_an_axis(tmp_path, monkeypatch):
    """As the text of the table says: written, read, checked and sealed; older maps open as before."""
    rows = (
        schema.Variable("heat_flow", "W m-1", "heat that the contact gives off", required=False, since=NEXT),
        schema.Variable(
            "frequency",
            "Hz",
            "frequency of small motion",
            required=False,
            dims=("frequency",),
            since=NEXT,
            limits=(0.0, 1e9),
        ),
        schema.Variable(
            "film_response",
            "m2 N-1",
            "film compliance at a frequency",
            required=False,
            dims=(*schema.DIMS, "frequency"),
            since=NEXT,
        ),
    )
    monkeypatch.setattr(schema, "TABLE", schema.TABLE + rows)
    monkeypatch.setattr(schema, "SCHEMA_VERSION", NEXT)
    plain = dataset_of().assign_attrs(schema_version=NEXT)
    shape = plain["film_offset"].shape
    values = {name: plain[name].values for name in plain.data_vars}
    values |= {"heat_flow": np.full(shape, 0.1), "film_response": np.full((*shape, 2), 1e-12)}
    coordinates = {name: plain[name].values for name in plain.coords} | {"frequency": [10.0, 1e4]}
    built = schema.dataset(coordinates, values, plain.attrs)
    built.attrs[schema.CHECKSUM] = content_sha256(built, None)
    built.to_netcdf(tmp_path / "new.nc")
    opened = open_map(tmp_path / "new.nc")
    assert opened.dataset["film_response"].attrs["units"] == "m2 N-1"
    assert opened.dataset["frequency"].values.tolist() == [10.0, 1e4]
    point = (5e-6, 1e-4, 1.0, 330.0)
    assert opened.law("series")(*point) == EHDMap(dataset_of()).law("series")(*point)
    with pytest.raises(MapError, match="new: was changed since it was made"):
        check_content(opened.dataset.assign(heat_flow=2.0 * opened.dataset["heat_flow"]), None, "new")
    for change, message in (
        (
            lambda d: d.assign_coords(frequency=d["frequency"][::-1]),
            "frequency does not rise",
        ),
        (lambda d: d.assign(heat_flow=d["heat_flow"].isel(load=0)), "variable heat_flow has dims"),
    ):
        with pytest.raises(MapError, match=message):
            EHDMap(change(built))
    EHDMap(plain)
    open_map(OLD)


def test_every_row_names_its_version():
    # version 6 brought an attribute and no row: the film table that laws are read from
    assert {entry.since for entry in schema.TABLE} | {6} == set(range(1, schema.SCHEMA_VERSION + 1))
    names = [(entry.group, entry.name) for entry in schema.TABLE]
    assert len(names) == len(set(names))
    for entry in schema.TABLE:
        assert entry.axis == (entry.limits is not None or entry.name == "contact")
        for dim in entry.dims:
            assert schema.variable(dim, entry.group).axis
    with pytest.raises(KeyError, match="nothing"):
        schema.variable("nothing")


def test_fixture_is_small():
    assert max(path.stat().st_size for path in (OLD, OLD_2, OLD_3)) < 300_000
