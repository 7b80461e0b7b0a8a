"""Pages of keys and commands: they are what the code says now, every key has words, and stated defaults hold."""

from __future__ import annotations

import ast
import copy
import dataclasses
import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.jobs import solvers
from ehdmaps.jobs.make.batch import parse_batch
from ehdmaps.jobs.reader import parse_job
from ehdmaps.jobs.solids import job_sections
from ehdmaps.jobs.table import Table
from ehdmaps.physics.solids import STEEL
from ehdmaps.units import LENGTH
from mbs.scene.reader import parse_scene
from tests.cases.programs import needs_film_solver
from tests.manual import keys
from tests.manual.keys import WordsError, job_page
from tests.manual.pages import PAGES
from tests.manual.probes import job_readings, scene_readings
from tests.manual.recording import recording, shortest

ROOT = Path(__file__).parents[2]
READERS = [
    *(ROOT / "ehdmaps" / "jobs" / f"{name}.py" for name in ("reader", "problem", "solids", "supply", "make/batch")),
    *sorted((ROOT / "mbs" / "scene").rglob("*.py")),
]
READING = {"get", "table", "optional", "quantity", "number", "integer", "choice", "place", "text", "vector", "words"}
"""Methods of tables, whose first argument is a key, and functions of `mbs.scene.fields`, whose second one is."""

NO_KEYS = {"films", "line", "map"}
"""A key that [batch] had once and refuses, and keys of dictionaries that are no tables of a file."""


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_a_page_is_what_the_code_says(path):
    """After a change of keys, words or options: python -m tests.manual --write."""
    if path.name == "job_keys.md":
        needs_film_solver()
    assert path.read_text(encoding="utf-8") == PAGES[path]()


@pytest.fixture(scope="module")
def asked():
    """Keys that the readers asked for when all probes were read."""
    return {key for readings in (job_readings(), scene_readings()) for table in readings.values() for key in table}


@pytest.mark.parametrize("path", READERS, ids=lambda path: path.stem)
def test_probes_reach_every_key_that_a_reader_names(path, asked):
    """A key that is read in a branch that no probe reaches would be on no page: tests/manual/probes.py."""
    named = {
        argument.value
        for call in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute) and call.func.attr in READING
        for argument in call.args[isinstance(call.func.value, ast.Name) and call.func.value.id == "fields" :][:1]
        if isinstance(argument, ast.Constant) and isinstance(argument.value, str) and argument.value.isidentifier()
    }
    assert named - asked <= NO_KEYS


def test_readings_are_limits_forms_and_what_is_required():
    with recording() as found:
        table = Table({"width": "3 mm"}, "[thing] 3", [])
        table.quantity("width", "m", 0.0, 1.0, LENGTH, required=True)
        table.choice("kind", ("a", "b"))
        table.get("name", "a short text")
        Table({}, "[[rows]][2]", []).integer("count", 1, 100000)
    assert found["[thing] 3"]["width"].allowed == ["0 to 1000 mm"]
    assert found["[thing] 3"]["kind"].allowed == ['`"a"`, `"b"`']
    assert [found["[thing] 3"][key].required for key in ("width", "kind", "name")] == [True, False, True]
    assert found["[thing] 3"]["name"].form == "a short text"
    assert found["[[rows]]"]["count"].allowed == ["1 to 1e5, whole"]
    assert shortest(1e-6) == "1e-6"


def test_a_key_without_words_and_words_without_a_key_are_named(monkeypatch):
    needs_film_solver()
    words = tomllib.loads((keys.DOCS / "job_keys.toml").read_text(encoding="utf-8"))
    words["[grid]"]["humidity"] = words["[grid]"].pop("temperature")
    monkeypatch.setattr(keys, "_words", lambda name: words)
    with pytest.raises(WordsError, match=r"\[grid\] temperature: read, without words") as raised:
        job_page()
    assert "[grid] humidity: has words, and no reader asks for it" in str(raised.value)


AXES = """
[grid]
load = { from = "1 N/mm", to = "100 N/mm", points = 3, spacing = "log" }
entrainment_speed = ["1 m/s"]
temperature = ["40 degC"]
"""
JOBS = (
    f"""
schema = 1
[bearing]
estimate = {{ bore = "30 mm", outside_diameter = "62 mm", width = "16 mm" }}
basic_static_rating = "39 kN"
[material]
[lubricant]
viscosity_law = "roelands"
viscosity = "50 mPa s"
pressure_viscosity = "20 1/GPa"
density = "870 kg/m^3"
[supply]
oil_layer = "3 um"
[surface]
roughness = "0.3 um"
[solids]
bore = "30 mm"
outside_diameter = "62 mm"
{AXES}
[solver]
name = "reynolds"
structural_law = "iso16281"
line_steps = {{}}
""",
)
SCENE = """
schema = 1
[operation]
speed = "900 rpm"
temperature = "50 degC"
[[bodies]]
name = "disc"
freedoms = ["y"]
spin = 1
cylinders = [{ from = "0 mm", to = "10 mm", diameter = "30 mm" }]
[[shafts]]
name = "shaft"
freedoms = ["y", "theta_z"]
sections = [{ from = "0 mm", to = "100 mm", diameter = "30 mm" }]
discs = [{ from = "0 mm", to = "10 mm", diameter = "60 mm" }]
frames = { end = "0 mm" }
cutoff = "5 kHz"
[[flexible]]
name = "reduced"
reduced = "body.nc"
attached = [{ at = "seat", from = "0 mm", to = "10 mm", diameter = "60 mm" }]
[[flexible]]
name = "housing"
matrices = { format = "abaqus", stiffness = "k.mtx", mass = "m.mtx" }
mesh = "mesh.inp"
cutoff = "5 kHz"
[flexible.interfaces.PLACE]
at = ["0 mm", "0 mm", "0 mm"]
cylinder = { axis = "x", diameter = "60 mm", from = "0 mm", to = "10 mm" }
[flexible.interfaces.OTHER]
at = ["0 mm", "0 mm", "0 mm"]
plane = { axis = "x" }
[[springs]]
name = "spring"
on = "disc"
stiffness = { y = "1e6 N/m" }
[[loads]]
name = "load"
on = "disc"
force = ["0 N", "3 N", "0 N"]
[[loads]]
name = "moment"
on = "disc"
moment = ["0 N m", "3 N m", "0 N m"]
[[unbalances]]
name = "unbalance"
on = "disc"
moment = "3 g mm"
[[excitations]]
name = "ripple"
on = "disc"
order = 2
force = ["0 N", "3 N", "0 N"]
[[excitations]]
name = "torque"
on = "disc"
order = 2
moment = ["0 N m", "3 N m", "0 N m"]
[[bearings]]
name = "left"
inner = "disc"
outer = "ground"
geometry = { name = "N1014" }
[[bearings]]
name = "right"
inner = "disc"
outer = "ground"
geometry = { name = "NU308" }
thermal = { shaft = "1 W/K", housing = "1 W/K" }
[bearings.fit]
inner = { interference = "10 um", seat = "40 mm" }
outer = { interference = "10 um", seat = "90 mm", diameter = "120 mm" }
[[bearings]]
name = "arc"
inner = "disc"
outer = "ground"
geometry = { name = "NU308" }
profile = { crown_drop = "10 um" }
spall = [{ on = "inner", length = "1 mm", depth = "5 um" }]
waviness = [{ on = "inner", waves = 2, amplitude = "1 um" }, { on = "inner", waves = [2, 3], amplitude = "1 um" }]
[[gears]]
name = "mesh"
on = "disc"
against = "shaft:end"
teeth = [21, 23]
module = "4 mm"
pressure_angle = "20 deg"
face_width = "25 mm"
stiffness = "14 N/(um mm)"
backlash = "0.1 mm"
[laws.own]
stiffness = "1e8 N/m"
[[inputs]]
name = "hit"
on = "disc"
direction = "y"
[[inputs]]
name = "teeth"
on = "mesh:mesh"
[[sensors]]
name = "S1"
on = "disc"
direction = "y"
quantity = "acceleration"
[linear]
frequencies = { from = "1 Hz", to = "9 Hz", points = 3 }
[runup]
from = "0 rpm"
to = "900 rpm"
duration = "1 s"
step = "0.1 ms"
[campbell]
"""
DRIVEN = SCENE.replace('to = "900 rpm"\n', "") + '[drive]\ninertia = "1 kg m^2"\nmotor = "3 N m"\n'
PLACES = {
    "[bearing]": ("bearing",),
    "[[bearings]] thermal": ("bearings", 1, "thermal"),
    "[[bearings]] fit inner": ("bearings", 1, "fit", "inner"),
    "[[bearings]] fit outer": ("bearings", 1, "fit", "outer"),
    "[[flexible]] interfaces PLACE": ("flexible", 1, "interfaces", "PLACE"),
    "[[flexible]] interfaces PLACE cylinder": ("flexible", 1, "interfaces", "PLACE", "cylinder"),
    "[[flexible]] interfaces PLACE plane": ("flexible", 1, "interfaces", "OTHER", "plane"),
    "[laws.NAME]": ("laws", "own"),
    "profile": ("bearings", 2, "profile"),
    "[[bearings]] waviness": ("bearings", 2, "waviness", 1),
    "[[bearings]] spall": ("bearings", 2, "spall", 0),
}
"""Where tables are in the texts above; all others by their own names, the first one of a list."""

OTHERS = {
    ("[[bearings]]", "expansion"): ("bearings", 1),
    ("[[bearings]] waviness", "phase"): ("bearings", 2, "waviness", 0),
    ("[[flexible]]", "units"): ("flexible", 1),
    ("[[inputs]]", "quantity"): ("inputs", 1),
    ("[[loads]]", "force"): ("loads", 1),
    ("[[excitations]]", "force"): ("excitations", 1),
}
"""Places of keys that need others beside them."""


def place_of(table, key):
    """Keys and indices that lead to a table."""
    if (table, key) in OTHERS:
        return OTHERS[table, key]
    if table in PLACES:
        return PLACES[table]
    first, *rest = table.split()
    name = first.strip("[]")
    path = (name, 0) if first.startswith("[[") else (name,)
    for part in rest:
        path += (part, 0) if part in ("cylinders", "sections", "discs", "attached") else (part,)
    return path


def defaults(name):
    """Keys of a page whose default is a value: table, key, value."""
    words = tomllib.loads((ROOT / "docs" / name).read_text(encoding="utf-8"))
    return [
        pytest.param(table, key, entry["default"], id=f"{table} {key}")
        for table, entries in words.items()
        for key, entry in entries.items()
        if isinstance(entry, dict) and "default" in entry
    ]


def toml(value):
    """A value as TOML, tables in braces."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(part)}" for key, part in value.items()) + " }"
    return f"[{', '.join(map(toml, value))}]" if isinstance(value, list) else json.dumps(value)


def with_and_without(text, path, key, value):
    """Texts with the default stated, and without the key."""
    texts = []
    for stated in (False, True):
        values = copy.deepcopy(tomllib.loads(text))
        table = values
        for part in path:
            table = table[part]
        table.pop(key, None)
        if stated:
            table[key] = value
        texts.append("\n".join(f"{name} = {toml(part)}" for name, part in values.items()))
    return texts


@pytest.mark.parametrize(("table", "key", "value"), defaults("job_keys.toml"))
def test_a_default_of_a_job_changes_nothing_where_it_is_stated(table, key, value):
    if (solver := table.removeprefix("[solver] ")) in solvers.SOLVERS:
        if solver == "openfoam":
            needs_film_solver()
        build, other = (solvers.SOLVERS[solver].build(**stated) for stated in ({}, {key: value}))
        assert repr(build) == repr(other)
        return
    without, stated = with_and_without(JOBS[0], place_of(table, key), key, value)
    assert without != stated
    left_out, given = (dataclasses.replace(parse_job(text, "job", "job"), text="") for text in (without, stated))
    if table == "[solids]":  # what is stated is remembered; the sections that are meshed are to be equal
        left_out, given = (job_sections(job.solids, job.bearing, STEEL) for job in (left_out, given))
    assert repr(left_out) == repr(given)


def test_the_defaults_of_correction_points_and_checked_maps():
    with_points = JOBS[0] + 'corrected_by = "formula"\n'
    job = parse_job(with_points, "job", "job")
    assert job == dataclasses.replace(parse_job(f"{with_points}correction_points = 16\n", "job", "job"), text=job.text)
    batch = '[batch]\nbearings = ["NU308"]\noils = ["FVA3"]\n'
    rest = f'schema = 1\n{AXES}\n[solver]\nname = "hertz"\nstructural_law = "iso16281"\n'
    checked = [parse_batch(f"schema = 1\n{batch}{line}{rest[11:]}", "b", "b").checked for line in ("", "checked = 0\n")]
    assert checked[0] == checked[1]


@pytest.mark.parametrize(("table", "key", "value"), defaults("scene_keys.toml"))
def test_a_default_of_a_scene_changes_nothing_where_it_is_stated(table, key, value, tmp_path):
    for name in ("body.nc", "k.mtx", "m.mtx", "mesh.inp"):
        (tmp_path / name).write_bytes(b"")
    text = DRIVEN if table == "[drive]" else SCENE
    without, stated = with_and_without(text, place_of(table, key), key, value)
    assert without != stated
    scenes = [dataclasses.replace(parse_scene(text, "own", "own", tmp_path), text="") for text in (without, stated)]
    with np.printoptions(threshold=10**6, floatmode="unique"):
        left_out, given = map(repr, scenes)
    assert left_out == given
