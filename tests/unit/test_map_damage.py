"""Damaged map files: whatever is wrong with one, it is told in words, and nothing of absurd size is loaded."""

from __future__ import annotations

import json
import os
import resource
import shutil
from pathlib import Path

import h5py
import netCDF4
import numpy as np
import pytest

from ehdmaps.errors import EhdmapsError, InputError, MapError
from ehdmaps.jobs import job
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.make.generate import generate
from ehdmaps.jobs.reader import read_job
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.records import DERIVED, read_json
from ehdmaps.physics.closed_form import FormulaSolver
from tests.cases.jobs import map_job, spaced

JOB = map_job(spaced("1 N/mm", "100 N/mm", 9), '["0.5 m/s", "1 m/s", "2 m/s"]', '["40 degC", "60 degC"]')


class WithBackbone(FormulaSolver):
    """Closed formulas that ask for a backbone: a whole map without a solve."""

    wants_backbone = True
    natural_frequencies = (0.5, 2.0)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A map with a backbone, as `generate` writes it."""
    folder = tmp_path_factory.mktemp("damage")
    (folder / "job.toml").write_text(JOB)
    generate(read_job(str(folder / "job.toml"), None), folder / "map.nc", workers=1, solver=WithBackbone())
    return folder / "map.nc"


@pytest.fixture(scope="module")
def old(made):
    """The same map as schema 1 had it, without a checksum and without a seal of its points."""
    path = made.with_name("old.nc")
    now = open_map(made)
    older = now.dataset.drop_vars([entry.name for entry in schema.table() if entry.since > 1], errors="ignore")
    older = older.assign_attrs(schema_version=1)
    del older.attrs[schema.CHECKSUM]
    older.to_netcdf(path)
    group = now.backbone.copy()
    del group.attrs[schema.SEAL]
    group.to_netcdf(path, mode="a", group="backbone")
    open_map(path).law("series")
    return path


@pytest.fixture(scope="module")
def unsealed(made):
    """The same map without its checksum, so that what is damaged is met by the check of its own."""
    path = made.with_name("unsealed.nc")
    shutil.copy(made, path)
    set_attribute(schema.CHECKSUM, None)(path)
    open_map(path).law("series")
    return path


def set_attribute(name, value, group="/"):
    """Set or delete an attribute."""

    def damage(path):
        with netCDF4.Dataset(path, "a") as file:
            holder = file[group] if group != "/" else file
            if value is None:
                holder.delncattr(name)
            elif isinstance(value, str):
                holder.setncattr_string(name, value)
            else:
                holder.setncattr(name, value)

    return damage


def set_value(name, index, value):
    """Overwrite values."""

    def damage(path):
        with netCDF4.Dataset(path, "a") as file:
            file.set_auto_maskandscale(False)
            file[name][index] = value

    return damage


def replaced(name, dims=None, dtype="f8", units=True, shape=None):
    """Replace a variable by one of other dims or another type, chunked and never written."""

    def damage(path):
        group_name, _, short = name.rpartition("/")
        with netCDF4.Dataset(path, "a") as file:
            group = file[group_name] if group_name else file
            old = group.variables[short]
            attributes = {key: old.getncattr(key) for key in ("units", "long_name")}
            names = old.dimensions if dims is None else dims
            group.renameVariable(short, "old_" + short)
            for number, length in enumerate(shape or ()):
                file.createDimension(f"huge{number}", length)
            names = [f"huge{number}" for number in range(len(shape))] if shape else names
            new = group.createVariable(short, dtype, names, chunksizes=[1] * len(names) if shape else None)
            if units:
                new.setncatts(attributes)

    return damage


def of_hdf5(change):
    """Change the HDF5 file itself."""

    def damage(path):
        with h5py.File(path, "a") as file:
            change(file)

    return damage


def external_link(name):
    def change(file):
        del file[name]
        file[name] = h5py.ExternalLink("elsewhere.h5", "/stiffness")

    return of_hdf5(change)


def deleted(name):
    return of_hdf5(lambda file: file.__delitem__(name))


def cut(share):
    def damage(path):
        os.truncate(path, int(share * path.stat().st_size))

    return damage


def overwritten(name, count):
    """Overwrite bytes of the values of a variable, wherever the file has them."""

    def damage(path):
        with h5py.File(path) as file:
            values = file[name].id
            place = values.get_offset() if values.get_offset() is not None else values.get_chunk_info(0).byte_offset
        with path.open("r+b") as file:
            file.seek(place)
            file.write(b"\xff" * count)

    return damage


def record(attribute, change):
    """Change a record in JSON."""

    def damage(path):
        with netCDF4.Dataset(path, "a") as file:
            value = json.loads(file.getncattr(attribute))
            file.setncattr_string(attribute, json.dumps(change(value)))

    return damage


DEEP = "[" * 10_000 + "]" * 10_000
JSON = ("contacts", "geometry", "lubricant")
ANY = "."
DAMAGES = {
    "axis deleted": (deleted("load"), ANY),
    "contact deleted": (deleted("contact"), ANY),
    "variable deleted": (deleted("film_compliance"), "variable film_compliance is missing|cannot be read"),
    "derived variable deleted": (deleted("stiffness"), ""),
    "external link": (external_link("stiffness"), ANY),
    "soft link to itself": (of_hdf5(lambda f: f.__setitem__("self", h5py.SoftLink("/self"))), ANY),
    "cut to nothing": (cut(0.0), "cannot be read"),
    "cut in the middle": (cut(0.5), "cannot be read"),
    "bytes overwritten": (overwritten("backbone/film_offset", 64), ANY),
    "negative load": (set_value("load", 0, -1e4), "coordinate load holds -10000 N m-1; allowed: 1e-06 to"),
    "load of zero": (set_value("load", 0, 0.0), "coordinate load holds 0 N m-1"),
    "load NaN": (set_value("load", 1, np.nan), "coordinate load is empty or holds values that are not finite"),
    "load not rising": (set_value("load", 1, 1e9), "coordinate load does not rise"),
    "load of 1e300": (set_value("load", -1, 1e300), "coordinate load holds 1e\\+300"),
    "negative speed": (set_value("entrainment_speed", 0, -1.0), "coordinate entrainment_speed holds -1 m s-1"),
    "temperature of 0 K": (set_value("temperature", 0, 0.0), "coordinate temperature holds 0 K"),
    "unknown status": (set_value("status", (0, 0, 0, 0), 77), "status holds \\[77\\]"),
    "stiffness negative": (
        set_value("stiffness", (0, 0, 0, 0), -1.0),
        "variable stiffness contradicts the films: 1 of",
    ),
    "stiffness infinite": (set_value("stiffness", (0, 0, 0, 0), np.inf), "variable stiffness contradicts the films: 1"),
    "film NaN": (set_value("film_offset", (0, 0, 0, 0), np.nan), "variable approach contradicts the films: 1 of 108"),
    "film compliance": (set_value("film_compliance", (1, 3, 1, 1), 1e-12), "variable damping contradicts the films: 1"),
    "other structural law": (
        set_attribute("structural_law", "half_space"),
        "is 'half_space'; .* contacts has iso16281",
    ),
    "contacts of another law": (
        record("contacts", lambda r: [entry | {"structural_law": "half_space"} for entry in r]),
        "structural_law is 'iso16281'; the attribute contacts has half_space; they must be alike",
    ),
    "wide contact of half_space": (
        lambda path: [
            set_attribute("structural_law", "half_space")(path),
            record("contacts", lambda r: [c | {"structural_law": "half_space", "reference_depth": 1e-6} for c in r])(
                path
            ),
        ],
        "half_space law: got a contact half-width of",
    ),
    "other dims": (
        replaced("damping", dims=("load", "contact", "entrainment_speed", "temperature")),
        r"variable damping has dims \('load', 'contact'",
    ),
    "a number": (replaced("damping", dims=()), "variable damping has dims|cannot be read"),
    "status of floats": (replaced("status", dtype="f4"), "variable status has values of another type"),
    "stiffness of texts": (replaced("stiffness", dtype=str), "variable stiffness has values of another type"),
    "reason of numbers": (replaced("reason", dims=schema.DIMS), "variable reason has values of another type"),
    "no units": (replaced("damping", units=False), "variable damping has units None"),
    "a variable of terabytes": (replaced("damping", shape=(10**6, 10**6)), "1000000 x 1000000 values; allowed: at"),
    "an axis of terabytes": (replaced("load", shape=(10**12,)), "coordinate load has 1000000000000 values"),
    "texts of terabytes": (replaced("reason", dtype="S1", shape=(2, 9, 3, 2, 10**11)), "characters; generate"),
    "packed": (
        lambda path: [set_attribute("scale_factor", 2.0, "damping")(path)],
        "variable damping is packed",
    ),
    "group: no axis": (deleted("backbone/zeta"), ANY),
    "group: no variable": (deleted("backbone/film_offset"), "group backbone: variable film_offset is missing|cannot"),
    "group: zeta NaN": (set_value("backbone/zeta", 3, np.nan), "group backbone: coordinate zeta is empty or holds"),
    "group: speed negative": (set_value("backbone/reference_speed", 0, -1.0), "group backbone: coordinate reference"),
    "group: other type": (replaced("backbone/status", dtype="f8"), "group backbone: variable status has values of an"),
    "group: terabytes": (replaced("backbone/loss_compliance", shape=(10**7, 10**6)), "group backbone: variable loss_c"),
    "group: no contact": (set_attribute("reference_contact", None, "backbone"), "attribute reference_contact is miss"),
    "group: contact no JSON": (set_attribute("reference_contact", "{", "backbone"), "does not read"),
    "group: film NaN": (
        set_value("backbone/film_offset", (30, 0, 0), np.nan),
        "backbone of the map: has 1 solved points without a number or .* reference speed .* m/s and 40 degC; generate",
    ),
    "group: film negative": (set_value("backbone/film_offset", (30, 0, 0), -1.0), "1 solved points without a number"),
    "group: not needed": (
        set_value("backbone/status", (30, 0, 0), schema.NOT_NEEDED),
        "1 unsolved points beside one another within a line",
    ),
    "group: two failed": (
        set_value("backbone/status", (slice(30, 32), 0, 0), 5),
        "unsolved points beside one another within a line, at reference speed",
    ),
    "group: two stagnated": (
        set_value("backbone/status", (slice(30, 32), 0, 0), 2),
        r"the solver ended there \(stagnated\), and the same job ends there again; in the job, leave these speeds",
    ),
    "response: no axis": (deleted("backbone/natural_frequency"), ANY),
    "response: one variable": (
        deleted("backbone/film_compliance_imaginary"),
        "variable film_compliance_imaginary is missing; it belongs to natural_frequency, film_compliance_real|cannot",
    ),
    "response: not rising": (
        set_value("backbone/natural_frequency", 0, 3.0),
        "group backbone: coordinate natural_frequency does not rise",
    ),
    "response: negative": (set_value("backbone/natural_frequency", 0, -1.0), "natural_frequency holds -1 1; allowed"),
    "response: other dims": (
        replaced("backbone/film_compliance_real", dims=("zeta", "reference_speed", "temperature")),
        r"variable film_compliance_real has dims \('zeta', 'reference_speed', 'temperature'\); expected",
    ),
    "response: other type": (
        replaced("backbone/film_compliance_error", dtype=str),
        "variable film_compliance_error has values of another type",
    ),
    "response: no units": (
        replaced("backbone/film_compliance_real", units=False),
        "variable film_compliance_real has units None",
    ),
    "response: NaN": (
        set_value("backbone/film_compliance_real", (30, 0, 0, 1), np.nan),
        "has 1 solved points without a number",
    ),
    "response: infinite": (
        set_value("backbone/film_compliance_imaginary", (30, 0, 0, 0), np.inf),
        "has 1 solved points without a number",
    ),
    **{
        f"{name}: {what}": (set_attribute(name, text), f"attribute {name}: does not read .*generate the map again")
        for place, name in enumerate(JSON)
        for what, text in {
            "no JSON": "not JSON",
            "nested": DEEP,
            "a number": "17",
            "NaN": '{"name": NaN}',
            "huge": '{"name": 1e999, "radius": 1' + 400 * "0" + "}",
            "control": '{"name": "\\u001b[2J"}',
        }.items()
        if place == 0 or what in ("no JSON", "huge")
    },
    **{f"{name}: of numbers": (set_attribute(name, 3.5), f"attribute {name} is .*3.5") for name in JSON},
    "radius of text": (record("contacts", lambda r: [r[0] | {"radius": "5 mm"}, r[1]]), "contacts: does not read"),
    "radius of 1e300": (record("contacts", lambda r: [r[0] | {"radius": 1e300}, r[1]]), ANY),
    "no contacts": (record("contacts", lambda r: []), "attribute contacts: names"),
    "unknown key": (record("geometry", lambda r: r | {"colour": "red"}), "geometry: does not read"),
    "viscosity of text": (record("lubricant", lambda r: r | {"vogel_factor": "thick"}), ANY),
    "versions": (set_attribute("package_versions", "[1]"), ""),
    "settings": (set_attribute("solver_settings", DEEP), ""),
    "control characters": (set_attribute("title", "\x1b[2J\x07"), "attribute title is .*control characters"),
    "scaling of text": (set_attribute("structural_scaling", "one"), "attribute structural_scaling is 'one'; expected"),
    "verified of text": (set_attribute("lubricant_verified", "yes"), "attribute lubricant_verified is 'yes'"),
    "within_bar of text": (set_attribute("law_damping_within_bar", "all"), "attribute law_damping_within_bar is 'all'"),
    "created of numbers": (set_attribute("created", np.array([1.0, 2.0])), "attribute created is array"),
    "version of text": (set_attribute("schema_version", "one"), "attribute schema_version is 'one', no whole number"),
    "version of numbers": (set_attribute("schema_version", np.array([1, 1])), "attribute schema_version is array"),
    "solver missing": (set_attribute("solver", None), "attribute solver is missing"),
    "build without version": (set_attribute("openfoam_build", "x"), ""),
    "mathematics in a title": (set_attribute("job_name", "$\\frac{$"), ""),
}


DRAWN = ("mathematics in a title", "group: film NaN")
"""Maps that open and are drawn, the second one without a law; pictures of others are like the first."""


EVERY_TENTH = tuple(DAMAGES)[::10]


def used(path):
    """Open a map and take from it what a multibody model needs."""
    emap = open_map(path)
    assert emap.bearing.name == "NU308"
    return emap.law("series")


@pytest.mark.slow
@pytest.mark.parametrize("name", DAMAGES)
def test_a_damaged_map_is_told_in_words(unsealed, tmp_path, capsys, name):
    damage, message = DAMAGES[name]
    path = tmp_path / "damaged.nc"
    shutil.copy(unsealed, path)
    damage(path)
    # An empty message: the damage is of no importance to a law.
    if message:
        with pytest.raises(MapError, match=message):
            used(path)
    else:
        used(path)
    figure, table = str(tmp_path / "a.png"), str(path)
    pictures = [["plot", table, "-o", figure]] if name in DRAWN else []
    shown = [["show", table]] if not message or "control" in name or name in EVERY_TENTH else []
    for command in (*shown, *pictures):  # others read a map as `show` does, and all refuse it by the reader of `used`
        status = main(command)
        told = capsys.readouterr()
        assert status in (0, 2)
        assert "Traceback" not in told.err
        assert "\x1b" not in told.out + told.err
        assert (status == 2) == bool(told.err)


SCHEMA_2_ONLY = (
    "response: no axis",
    "variable deleted",
    "film compliance",
    "other structural law",
    "contacts of another law",
)
UNNAMED_IN_SCHEMA_1 = tuple(name for name in DAMAGES if name.startswith("response: "))
"""Rows that the table of schema 1 does not have."""

UNREAD_IN_SCHEMA_1 = ("stiffness negative", "stiffness infinite", "film NaN")
"""Of the grid, which a law with a backbone does not read; schema 1 had nothing to hold them to."""


# each third: the rows read the same tests, on what the old schema is turned into
@pytest.mark.parametrize("name", [name for name in DAMAGES if name not in SCHEMA_2_ONLY][::3])
def test_a_damaged_map_of_schema_1_is_told_in_words(old, tmp_path, name):
    damage, message = DAMAGES[name]
    path = tmp_path / "damaged.nc"
    shutil.copy(old, path)
    damage(path)
    if name == "derived variable deleted":
        message = "variable stiffness is missing|cannot be read"
    if message and name not in UNREAD_IN_SCHEMA_1 + UNNAMED_IN_SCHEMA_1:
        with pytest.raises(MapError, match=message):
            used(path)
    else:
        used(path)


def test_foreign_variables_are_not_loaded(made, tmp_path):
    """Of terabytes, chunked and never written; as axes of their own too, which xarray would load to open the file."""
    path = tmp_path / "foreign.nc"
    shutil.copy(made, path)
    with netCDF4.Dataset(path, "a") as file:
        for number, length in enumerate((10**7, 10**6)):
            file.createDimension(f"d{number}", length)
        file.createVariable("mine", "f8", ("d0", "d1"), chunksizes=(1, 10**6))
        file.createDimension("foreign", 10**12)
        file.createVariable("foreign", "f8", ("foreign",), chunksizes=(10**6,))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    emap = open_map(path)
    assert set(emap.dataset.variables) == set(open_map(made).dataset.variables)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 200_000  # kB; what is foreign has 80 TB


def test_places_that_are_no_files(tmp_path):
    os.mkfifo(tmp_path / "pipe.nc")
    for path in (tmp_path, tmp_path / "pipe.nc", tmp_path / "none.nc", "a\0b"):
        with pytest.raises(MapError, match="cannot be read"):
            open_map(path)


def test_the_largest_map_is_the_largest_job():
    assert schema.MOST_POINTS == job.MOST_POINTS


def change(path, edit):
    """Change a map with xarray and save it, its group too, as a user would."""
    import xarray as xr

    with xr.open_dataset(path) as opened, xr.open_dataset(path, group="backbone") as group:
        dataset, backbone = edit(opened.load(), group.load())
    dataset.to_netcdf(path)
    if backbone is not None:
        backbone.to_netcdf(path, mode="a", group="backbone")


def scaled(name):
    def edit(dataset, backbone):
        held = backbone if name.startswith("backbone/") else dataset
        values = held[name.removeprefix("backbone/")].values
        values[values > 0] *= 3.0
        return dataset, backbone

    return edit


@pytest.mark.parametrize(
    "edit",
    [
        scaled("max_pressure"),
        scaled("backbone/film_offset"),
        lambda dataset, backbone: (
            dataset.assign_attrs(lubricant=dataset.lubricant.replace("887.6", "900.1")),
            backbone,
        ),
        lambda dataset, backbone: (dataset, None),
        lambda dataset, backbone: (dataset.isel(load=slice(1, None)), backbone),
    ],
    ids=["grid", "backbone", "oil", "backbone lost", "load lost"],
)
def test_a_map_changed_since_it_was_made_is_refused_until_its_owner_says_so(made, tmp_path, capsys, edit):
    path = tmp_path / "changed.nc"
    shutil.copy(made, path)
    change(path, edit)
    with pytest.raises(MapError, match=r"changed\.nc: was changed since it was made: .*generate it again; or, if"):
        open_map(path)
    assert main(["show", str(path)]) == 2
    assert "content_sha256" in capsys.readouterr().err
    set_attribute(schema.CHECKSUM, None)(path)
    open_map(path).law("series")


@pytest.fixture(scope="module")
def own(made):
    """A map of one's own: films of the grid alone, from which the rest is derived."""
    path = made.with_name("own.nc")
    now = open_map(made)
    dataset = now.dataset.drop_vars([name for name in DERIVED if name in now.dataset])
    del dataset.attrs[schema.CHECKSUM]
    dataset.to_netcdf(path)
    open_map(path).law("series")
    return path


@pytest.mark.parametrize(
    "name, factor, words",
    [
        ("film_offset", 3.0, "12 lines over the load whose film_offset contradicts film_compliance, or stiffness: of"),
        ("film_compliance", 0.3, "the film offset falls by a factor of .*, and by its compliance, which is minus its"),
        ("loss_compliance", 1e25, "points whose damping is more than 1 s times the stiffness, inner at 1 N/mm, 0.5 m"),
    ],
)
def test_films_that_contradict_each_other_are_told(own, tmp_path, name, factor, words):
    path = tmp_path / "contradicting.nc"
    shutil.copy(own, path)
    with netCDF4.Dataset(path, "a") as file:
        file[name][:] = factor * file[name][:]
    with pytest.raises(MapError, match=words):
        open_map(path).law("series")


def test_a_backbone_with_absurd_damping_is_told(unsealed, tmp_path):
    path = tmp_path / "stiff.nc"
    shutil.copy(unsealed, path)
    set_value("backbone/loss_compliance", (30, 0, 0), 1e10)(path)
    with pytest.raises(MapError, match="1 points whose loss compliance is more than 1 s times their compliance, at"):
        open_map(path).law("series")


def test_a_changed_film_takes_along_what_is_derived_from_it(made, tmp_path):
    """Also where the owner says that the change is meant: stiffness cannot stay what it was."""
    path = tmp_path / "changed.nc"
    shutil.copy(made, path)
    change(path, scaled("film_compliance"))
    with pytest.raises(MapError, match="was changed since it was made"):
        open_map(path)
    set_attribute(schema.CHECKSUM, None)(path)
    with pytest.raises(MapError, match=r"variable stiffness contradicts the films: .*delete approach, stiffness"):
        open_map(path)
    change(path, lambda dataset, backbone: (dataset.drop_vars(list(DERIVED)), backbone))
    softer, before = open_map(path).dataset, open_map(made).dataset
    assert (softer["stiffness"].values < before["stiffness"].values).all()


def test_a_map_saved_again_without_a_change_is_the_same_map(made, tmp_path):
    path = tmp_path / "again.nc"
    shutil.copy(made, path)
    mine = {"note": "two\nlines\t", "weights": np.array([1.0, 2.0])}
    change(path, lambda dataset, backbone: (dataset.assign_attrs(mine), backbone))
    assert open_map(path).dataset.attrs["weights"].tolist() == [1.0, 2.0]


def test_maps_made_before_open_as_ever(made, tmp_path, capsys):
    """Without checksum and the later error estimates, with texts as netCDF strings."""
    path = tmp_path / "older.nc"
    now = open_map(made)
    later = ["central_film_error", "minimum_film_error", "max_pressure_error"]
    older = now.dataset.drop_vars(later)
    del older.attrs[schema.CHECKSUM]
    for name in ("contact", "reason"):
        older[name].encoding = {"dtype": str}
    older.to_netcdf(path)
    now.backbone.to_netcdf(path, mode="a", group="backbone")
    with netCDF4.Dataset(path) as file:
        assert file["reason"].dtype is str
    again = open_map(path)
    for name in older.variables:
        assert again.dataset[name].dtype == older[name].dtype
        assert again.dataset[name].equals(older[name])
    values = (2e-6, 0.0, 1.0, 320.0)
    assert again.law("series")(*values) == now.law("series")(*values)
    assert main(["show", str(path)]) == 0
    assert "may have been changed since: the map has no checksum" in capsys.readouterr().out
    assert main(["compare", str(path), str(made)]) == 0


def test_json_is_read_in_one_place():
    assert read_json('{"a": [1, null]}', "solver_settings") == {"a": [1, None]}
    with pytest.raises(MapError, match=r"attribute x: does not read .*got Infinity"):
        read_json("[Infinity]", "x")
    with pytest.raises(MapError, match=r"attribute x: does not read .*RecursionError"):
        read_json(DEEP, "x")


def test_errors_of_a_map_in_memory_are_the_same(made):
    emap = open_map(made)
    with pytest.raises(MapError, match="map: group backbone: coordinate zeta does not rise"):
        EHDMap(emap.dataset, emap.backbone.isel(zeta=slice(None, None, -1)))
    assert issubclass(MapError, EhdmapsError) and issubclass(InputError, EhdmapsError)
    assert Path(made).is_file()
