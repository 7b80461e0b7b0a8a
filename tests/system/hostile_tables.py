"""Tables of hostile and unlucky inputs: what is given, with which exit status it ends, and what is said about it."""

from __future__ import annotations

import copy
import json
import math
import tomllib
from collections.abc import Callable, Iterable, Iterator
from importlib import resources
from pathlib import Path
from typing import Any, NamedTuple

import netCDF4

JOB = """
schema = 1
[bearing]
name = "NU308"
diametral_clearance = "20 um"
[lubricant]
viscosity_law = "roelands"
viscosity_40 = "95 mm^2/s"
viscosity_100 = "10.6 mm^2/s"
pressure_viscosity = "22.4 1/GPa"
density = "880 kg/m^3"
[grid]
load = { from = "1 N/mm", to = "100 N/mm", points = 3, spacing = "log" }
entrainment_speed = ["1 m/s", "2 m/s"]
temperature = ["40 degC", "60 degC"]
[solver]
name = "hertz"
structural_law = "iso16281"
fill = "none"
backbone = "none"
law_check = 0
"""

BODY = """
matrices = { format = "calculix", stiffness = "b.sti", mass = "b.mas", dofs = "b.dof" }
mesh = "m.inp"
units = "SI"
cutoff = "20 kHz"
[interfaces]
left = { at = ["0 mm", "25 mm", "20 mm"], plane = { axis = "x", tolerance = "0.1 mm" }, kind = "rigid" }
right = { at = ["200 mm", "25 mm", "20 mm"], plane = { axis = "x", diameter = "1 m" } }
[points]
top = ["100 mm", "50 mm", "40 mm"]
node = 20
"""

SCENE = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8")


class Case(NamedTuple):
    """A command, what stands in the folder besides the good files, and how it has to end.

    `said`: each of them is in what is written to stderr, where the status is 2; with | between words, one of them.
    """

    name: str
    arguments: tuple[str, ...]
    files: dict[str, bytes]
    status: int = 2
    said: tuple[str, ...] = ()


class Raw(str):
    """Text that stands in a TOML file as it is."""


def inline(value: Any) -> str:
    """A value in TOML, in one line."""
    if isinstance(value, Raw):
        return str(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(key)} = {inline(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(inline, value)) + "]"
    if isinstance(value, float) and not math.isfinite(value):
        return repr(value)
    return json.dumps(value, ensure_ascii=False) if isinstance(value, (str, bool)) else repr(value)


def dump(values: dict[str, Any]) -> bytes:
    """A TOML file, a line for each key at top level."""
    return "".join(f"{json.dumps(key)} = {inline(value)}\n" for key, value in values.items()).encode()


JUNK: dict[str, Any] = {
    "switch": True,
    "number": -3.5,
    "not a number": math.nan,
    "infinite": math.inf,
    "empty text": "",
    "other unit": "3 bananas",
    "too large": "1e999 m",
    "tower of powers": "1 m^9^9^9",
    "long text": "9" * 5000,
    "empty list": [],
    "nested list": [[[]]],
    "table": {"a": 1},
    "date": Raw("1979-05-27T07:32:00Z"),
    "huge number": Raw("9" * 400),
    "negative": "-1e30 m",
    "path": "../../../etc/passwd",
}


def leaves(value: Any, place: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Places of all values that are no tables and no lists of tables."""
    if isinstance(value, dict):
        for key, entry in value.items():
            yield from leaves(entry, (*place, key))
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        for index, entry in enumerate(value):
            yield from leaves(entry, (*place, index))
    else:
        yield place


def changed(values: dict[str, Any], place: tuple[Any, ...], new: Any) -> dict[str, Any]:
    """The same with another value at a place."""
    result = copy.deepcopy(values)
    inside: Any = result
    for key in place[:-1]:
        inside = inside[key]
    inside[place[-1]] = new
    return result


def junk(text: str, file: str, arguments: tuple[str, ...], each: int, legal: set[str], skip: str = "") -> list[Case]:
    """Every value of a file in turn replaced by some of JUNK; `legal` names those that are allowed after all."""
    values = tomllib.loads(text)
    cases, turn = [], 0
    for place in leaves(values):
        if skip and skip in place:
            continue
        for _ in range(each):
            name = list(JUNK)[turn % len(JUNK)]
            turn += 1
            label = f"{file}, {'.'.join(map(str, place))}: {name}"
            status = 0 if label in legal else 2
            words = next(key for key in reversed(place) if isinstance(key, str))
            # Names that nobody has are shown themselves.
            shown = f"|{JUNK[name][:20]}" if isinstance(JUNK[name], str) and JUNK[name] else ""
            new = dump(changed(values, place, JUNK[name]))
            cases.append(Case(label, arguments, {file: new}, status, (words + shown,)))
    return cases


def left_out(text: str, file: str, arguments: tuple[str, ...], optional: set[str]) -> list[Case]:
    """Every key of a file left out in turn; `optional` names those that need not be there."""
    values = tomllib.loads(text)
    cases = []
    for place in leaves(values):
        result = copy.deepcopy(values)
        inside: Any = result
        for key in place[:-1]:
            inside = inside[key]
        del inside[place[-1]]
        label = f"{file} without {'.'.join(map(str, place))}"
        cases.append(
            Case(
                label,
                arguments,
                {file: dump(result)},
                0 if label in optional else 2,
                ("missing|allowed: one of them|allowed: either",),
            )
        )
    return cases


CHECK = ("check", "job.toml")

TEXTS: dict[str, tuple[bytes, int, str]] = {
    "empty": (b"", 2, "missing"),
    "blanks": (b"\n\n   \n", 2, "missing"),
    "a mark": (b"\xef\xbb\xbf", 2, "missing"),
    "two marks": (b"\xef\xbb\xbf\xef\xbb\xbf", 2, "is not TOML"),
    "UTF-16": ("schema = 1".encode("utf-16"), 2, "is not UTF-8 text (byte 0)"),
    "Latin-1": (b'title = "\xe9"', 2, "is not UTF-8 text (byte 9)"),
    "surrogates": (b'title = "\xed\xa0\x80"', 2, "is not UTF-8 text"),
    "zeros": (bytes(1000), 2, "is not TOML"),
    "all bytes": (bytes(range(256)), 2, "is not UTF-8 text"),
    "an ELF program": (b"\x7fELF\x02\x01\x01" + bytes(64), 2, "is not TOML"),
    "JSON": (b'{"schema": 1}', 2, "is not TOML"),
    "deep lists": (b"a = " + b"[" * 100_000, 2, "is not TOML"),
    "deep tables": (b"a" + b".a" * 20_000 + b" = 1", 2, "line 1 has a dotted key of more than 64 parts"),
    "deep headers": (b"\n[ a" + b" . 'a'" * 150_000 + b" ]", 2, "line 2 has a dotted key of more than 64 parts"),
    "deep inline tables": (b"a = {b = {" + b"a." * 300_000 + b"a = 1}}", 2, "line 1 has a dotted key"),
    "many digits": (b"schema = " + b"9" * 5000, 2, "is not TOML"),
    "a key twice": (b"schema = 1\nschema = 1\n", 2, "is not TOML"),
    "cut off": (b'schema = 1\n[bearing]\nname = "NU3', 2, "is not TOML"),
    "too long": (b"#" * 1_000_001, 2, "longer than 1000000 bytes"),
    "a long line": (b'a = "' + b"x" * 900_000 + b'"', 2, "unknown key"),
    "many keys": (b"".join(b"k%d = 1\n" % n for n in range(5000)), 2, "unknown key"),
    "a carriage return": (b"schema\r = 1", 2, "is not TOML"),
    "another schema": (b"schema = 2", 2, "schema: got 2; allowed: 1|schema: unknown key"),
    "schema as text": (b'schema = "1"', 2, "schema: got '1'|schema: unknown key"),
    "schema as a switch": (b"schema = true", 2, "schema: got True|schema: unknown key"),
    "tables as values": (
        b"schema = 1\nbearing = 1\noperation = 1\nmatrices = 1\ngrid = []",
        2,
        "got 1; allowed: a table",
    ),
}


READ_BY_ALL = ("empty", "UTF-16", "cut off", "too long", "many keys", "another schema", "tables as values")
"""Texts for every kind of file: one reader of TOML has them all, and is given the others as a job."""


def texts(file: str, arguments: tuple[str, ...], names: Iterable[str] = tuple(TEXTS)) -> list[Case]:
    """Files that are no TOML, or nothing that a program can use."""
    rows = ((name, *TEXTS[name]) for name in names)
    return [Case(f"{file}: {name}", arguments, {file: text}, status, (words,)) for name, text, status, words in rows]


def replaced(file: str, text: str, arguments: tuple[str, ...], table: dict[tuple[str, str], str]) -> list[Case]:
    """A text with a part of it replaced, and what is said."""
    for old, _ in table:
        assert old in text, old
    return [
        Case(f"{file}: {old} -> {new}"[:120], arguments, {file: text.replace(old, new).encode()}, 2, (words,))
        for (old, new), words in table.items()
    ]


GRIDS = {
    ("points = 3", "points = 0"): "points",
    ("points = 3", "points = 1"): "points",
    ("points = 3", "points = 2000000000"): "points",
    ("points = 3", "points = 3.0"): "points",
    ('from = "1 N/mm"', 'from = "100 N/mm"'): "from",
    ('from = "1 N/mm"', 'from = "200 N/mm"'): "from",
    ('from = "1 N/mm"', 'from = "0 N/mm"'): "load",
    ('from = "1 N/mm"', 'from = "-1 N/mm"'): "load",
    ('from = "1 N/mm"', 'from = "1 N"'): "load",
    ('from = "1 N/mm"', 'from = "1"'): "without a unit",
    ('from = "1 N/mm"', 'from = "1e-300 N/mm"'): "load",
    ('to = "100 N/mm"', 'to = "1e30 N/mm"'): "load",
    ('spacing = "log"', 'spacing = "logarithmic"'): "spacing: got 'logarithmic'",
    ('["1 m/s", "2 m/s"]', '["2 m/s", "1 m/s"]'): "entrainment_speed",
    ('["1 m/s", "2 m/s"]', '["1 m/s", "1 m/s"]'): "entrainment_speed",
    ('["1 m/s", "2 m/s"]', '["1 m/s", 2]'): "entrainment_speed",
    ('["1 m/s", "2 m/s"]', '["1 m/s", "299792458 m/s"]'): "entrainment_speed",
    ('["1 m/s", "2 m/s"]', '["-1 m/s", "2 m/s"]'): "entrainment_speed",
    ('["40 degC", "60 degC"]', '["-300 degC", "60 degC"]'): "temperature",
    ('["40 degC", "60 degC"]', '["40 K", "60 K"]'): "temperature",
    ('["40 degC", "60 degC"]', '["40 degC", "4000 degC"]'): "temperature",
    ('"95 mm^2/s"', '"1 mm^2/s"'): "viscosity",
    ('"10.6 mm^2/s"', '"106 mm^2/s"'): "viscosity",
    ('"22.4 1/GPa"', '"22.4 GPa"'): "pressure_viscosity",
    ('"880 kg/m^3"', '"0.88 kg/m^3"'): "density",
    ('"NU308"', '"NU3009"'): "bearing designation: got 'NU3009' (did you mean 'NU309'?); allowed: N1014, NU308",
    ('"NU308"', '"nu308\\u0000"'): "bearing designation: got",
    ('"hertz"', '"herz"'): "did you mean 'hertz'?",
    ('"iso16281"', '"iso 16281"'): "structural_law",
    ("[solver]", "[solvers]"): "did you mean 'solver'?",
    ("law_check = 0", "law_check = 99999999"): "law_check",
    ("law_check = 0", "columns = 400"): "columns: unknown key",
    ('name = "NU308"', 'name = "NU308"\nrollers = 12'): "rollers",
}

SCENES = {
    ('speed = "500 rpm"', 'speed = "500"'): "speed: got '500' without a unit",
    ('speed = "500 rpm"', 'speed = "-500 rpm"'): "speed",
    ('temperature = "40 degC"', 'temperature = "40 K"'): "temperature",
    ('on = "shaft:left"', 'on = "shaft:lefft"'): "lefft",
    ('on = "ring_left"', 'on = "nobody"'): "nobody",
    ('name = "ring_right"', 'name = "ring_left"'): "ring_left",
    ('name = "bearing_right"', 'name = "bearing_left"'): "bearing_left",
    ('inner = "shaft:left"', 'inner = "ring_left"'): "ring_left",
    ('freedoms = ["y", "z"]', 'freedoms = ["y", "y"]'): "freedoms",
    ('freedoms = ["y", "z"]', 'freedoms = ["w"]'): "freedoms",
    ("spin = 1 ", "spin = 1e9 "): "spin",
    ('diameter = "40 mm" }', 'diameter = "40 mm", bore = "40 mm" }'): "bore",
    ('diameter = "40 mm" }', 'diameter = "4000 km" }'): "diameter",
    ('y = "1e5 N/m"', 'y = "nan N/m"'): "stiffness",
    ('y = "1e5 N/m"', 'y = "-1e99 N/m"'): "stiffness",
    ("slices = 41", "slices = 0"): "slices",
    ("slices = 41", "slices = 1000000"): "slices",
    ('profile = "iso"', 'profile = "round"'): "profile",
    ("direction = [0, 1, 1]", "direction = [0, 0, 0]"): "direction",
    ("direction = [0, 1, 1]", "direction = [0, 1]"): "direction",
    ("direction = [0, 1, 1]", "direction = [1, 0, 0]"): "direction",
    ("direction = [0, 1, 1]", "direction = [nan, 1, 1]"): "direction",
    ('quantity = "acceleration"', 'quantity = "jerk"'): "quantity",
    ("points = 2000", "points = 2000000000"): "points",
    ('duration = "0.2 s"', 'duration = "-1 s"'): "duration",
    ('step = "20 us"', 'step = "0 us"'): "step",
    ('sample = "0.1 ms"', 'sample = "1 ps"'): "sample",
    ("spectral_radius = 0.8", "spectral_radius = 1.8"): "spectral_radius",
    ('force = ["0 N", "100 N", "100 N"]', 'force = ["0 N", "100 N"]'): "force",
    ('force = ["0 N", "100 N", "100 N"]', 'force = "100 N"'): "force",
    ('force = ["0 N", "100 N", "100 N"]', 'force = ["0 N", "1e30 N", "0 N"]'): "force",
    ('assumed = ["position"]', 'assumed = ["weight"]'): "assumed",
    ('geometry = { name = "NU308", diametral_clearance = "0 um" }', "geometry = 308"): "geometry",
    ("[[gears]]" if "[[gears]]" in SCENE else "[runup]", "[run_up]"): "did you mean 'runup'?",
}

BODIES = {
    ('"b.sti"', '"gone.sti"'): "gone.sti: cannot be read (No such file",
    ('"b.sti"', '""'): "stiffness",
    ('"b.sti"', '"."'): "it is a folder",
    ('"b.sti"', '"pipe"'): "it is a pipe",
    ('"b.mas"', '"pipe"'): "it is a pipe",
    ('"b.dof"', '"pipe"'): "it is a pipe",
    ('"m.inp"', '"pipe"'): "it is a pipe",
    ('"m.inp"', '"link_to_pipe.msh"'): "it is a pipe",
    ('"m.inp"', '"b.sti"'): "of a mesh whose numbers of nodes are not read",
    ('"m.inp"', '"a\\u0000b"'): "mesh: got",
    ('"m.inp"', f'"{"x" * 300}"'): "cannot be read",
    ('"m.inp"', '"loop.inp"'): "cannot be read",
    ('"b.mas"', '"b.sti"'): "interface|the mass",
    ('"b.dof"', '"b.sti"'): "b.sti",
    ('"SI"', '"inch"'): "units",
    ('"20 kHz"', '"20 Hz"'): "",
    ('"20 kHz"', '"1e30 Hz"'): "cutoff",
    ('["200 mm", "25 mm", "20 mm"]', '["200 m", "25 m", "20 m"]'): "at",
    ('["200 mm", "25 mm", "20 mm"]', '["20 m", "25 mm", "20 mm"]'): "no node of the mesh is on its surface",
    (
        'plane = { axis = "x", diameter = "1 m" }',
        "nodes = [10]",
    ): "from its 1 nodes, whose centroid is at 0 mm, 0 mm, 0 mm",
    ('plane = { axis = "x", diameter = "1 m" }', "nodes = [10, 20]"): "at: got 200 mm",
    ('plane = { axis = "x", diameter = "1 m" }', "nodes = [99999]"): "node 99999 without a position",
    ('plane = { axis = "x", diameter = "1 m" }', "nodes = [110, 120, 110]"): "a node is there twice",
    ("node = 20", "node = 7"): "node 7",
    ("node = 20", 'node = ["9 m", "9 m", "9 m"]'): "from the nearest node",
    ("[interfaces]", "[interface]"): "did you mean 'interfaces'?",
}
del BODIES[('"20 kHz"', '"20 Hz"')], BODIES[('"b.mas"', '"b.sti"')]

EHDMAPS_OPTIONS: dict[str, tuple[str, int, str]] = {
    "check": ("check", 2, "JOB: missing; allowed: a job or map, or --bearing"),
    "no command": ("", 2, "required: COMMAND"),
    "unknown command": ("make", 2, "invalid choice: 'make'"),
    "unknown option": ("check job.toml --colour", 2, "unrecognized arguments: --colour"),
    "no file": ("check gone.toml", 2, "gone.toml: cannot be read (No such file"),
    "a folder": ("check .", 2, "cannot be read (it is a folder)"),
    "a pipe": ("check pipe", 2, "cannot be read (it is a pipe)"),
    "generate a pipe": ("generate pipe", 2, "cannot be read (it is a pipe)"),
    "a close name": ("check nu380", 2, "got 'nu380' (did you mean 'NU320'?)"),
    "a long name": (f"check {'x' * 5000}", 2, "cannot be read"),
    "a solver": ("check job.toml --solver herz", 2, "--solver: got 'herz'"),
    "workers 0": ("generate job.toml --workers 0", 2, "--workers: got '0'"),
    "workers -1": ("generate job.toml --workers -1", 2, "--workers"),
    "workers half": ("generate job.toml --workers 1.5", 2, "--workers: got '1.5'"),
    "workers many": ("generate job.toml --workers 99999", 2, "--workers: got '99999'"),
    "workers in other digits": ("generate job.toml --workers ²", 2, "--workers: got"),
    "output folder": ("generate job.toml -o .", 2, "-o"),
    "output nowhere": ("generate job.toml -o none/a.nc", 2, "-o"),
    "keep cases": ("generate job.toml --keep-cases", 2, "--keep-cases"),
    "show no map": ("show job.toml", 2, "job.toml"),
    "show nothing": ("show gone.nc", 2, "gone.nc"),
    "show a folder": ("show .", 2, "."),
    "plot no map": ("plot job.toml", 2, "job.toml"),
    "plot another ending": ("plot map.nc -o map.xyz", 2, "xyz"),
    "plot nowhere": ("plot map.nc -o none/a.png", 2, "-o"),
    "compare one": ("compare map.nc", 2, "required: B.nc"),
    "compare with a job": ("compare map.nc job.toml", 2, "job.toml"),
    "compare with nothing": ("compare map.nc gone.nc", 2, "gone.nc"),
    "no point": ("solve job.toml", 2, "required: --load, --speed, --temperature"),
    "a load without unit": (
        "solve job.toml --load 40 --speed 1m/s --temperature 40degC",
        2,
        "--load: got '40' without a unit",
    ),
    "a force without length": ("solve job.toml --load 40N --speed 1m/s --temperature 40degC", 2, "--length"),
    "a negative load": ("solve job.toml --load=-4N/mm --speed 1m/s --temperature 40degC", 2, "--load"),
    "a load of NaN": (
        "solve job.toml --load nanN/mm --speed 1m/s --temperature 40degC",
        2,
        "--load: got 'nanN/mm'",
    ),
    "a load beyond all": ("solve job.toml --load 1e999N/mm --speed 1m/s --temperature 40degC", 2, "--load"),
    "a length besides": ("solve job.toml --load 4N/mm --length 1mm --speed 1m/s --temperature 40degC", 0, ""),
    "a length of zero": ("solve job.toml --load 4N --length 0mm --speed 1m/s --temperature 40degC", 2, "--length"),
    "a speed of light": ("solve job.toml --load 4N/mm --speed 3e8m/s --temperature 40degC", 2, "--speed"),
    "a cold oil": ("solve job.toml --load 4N/mm --speed 1m/s --temperature=-300degC", 2, "--temperature"),
    "a frequency": ("solve job.toml --load 4N/mm --speed 1m/s --temperature 40degC --frequency=-1Hz", 2, "--frequency"),
    "a frequency of text": (
        "solve job.toml --load 4N/mm --speed 1m/s --temperature 40degC --frequency x",
        2,
        "--frequency",
    ),
    **{
        f"frequencies, {name}": (
            f"solve job.toml --load 4N/mm --speed 1m/s --temperature 40degC --frequency {line}",
            status,
            said,
        )
        for name, line, status, said in (
            ("as they are", "10Hz 20kHz 2", 0, ""),
            ("not a number", "nanHz 20kHz 9", 2, "--frequency: got 'nanHz'"),
            ("zero", "0Hz 20kHz 9", 2, "--frequency: got '0Hz'; allowed: 0.001 Hz to 1e+07 Hz"),
            ("negative", "-5Hz 20kHz 9", 2, "expected at least one argument|--frequency: got '-5Hz'"),
            ("infinite", "10Hz infHz 9", 2, "--frequency: got 'infHz'"),
            ("beyond all", "10Hz 1e999Hz 9", 2, "--frequency: got '1e999Hz'"),
            ("above all", "10Hz 1GHz 9", 2, "--frequency: got '1GHz'; allowed: 0.001 Hz to 1e+07 Hz"),
            ("without a unit", "10 20kHz 9", 2, "--frequency: got '10' without a unit"),
            ("another unit", "10rpm 20kHz 9", 2, "--frequency: got the unit 'rpm'"),
            ("equal ends", "1kHz 1000Hz 9", 2, "allowed: TO above FROM"),
            ("upside down", "20kHz 10Hz 9", 2, "allowed: TO above FROM"),
            ("one point", "10Hz 20kHz 1", 2, "POINTS: got '1'; allowed: a whole number from 2 to 2000"),
            ("no points", "10Hz 20kHz 0", 2, "POINTS: got '0'"),
            ("a million points", "10Hz 20kHz 1000000", 2, "POINTS: got '1000000'"),
            ("points of text", "10Hz 20kHz many", 2, "POINTS: got 'many'"),
            ("half a point", "10Hz 20kHz 2.5", 2, "POINTS: got '2.5'"),
            ("points of nan", "10Hz 20kHz nan", 2, "POINTS: got 'nan'"),
            ("two of them", "10Hz 20kHz", 2, "--frequency: got 2 values; allowed: one, or FROM TO POINTS"),
            ("and fields", "10Hz 20kHz 9 --fields a.vtu", 2, "--fields: stands beside --frequency"),
            ("a plot of a kind", "10Hz 20kHz 9 --plot a.gif", 2, "--plot: got"),
            ("a plot nowhere", "10Hz 20kHz 9 --plot none/a.png", 2, "--plot: got"),
            ("the job as plot", "10Hz 20kHz 9 --plot job.toml", 2, "--plot"),
        )
    },
    **{
        f"slide to roll, {name}": (
            f"solve job.toml --load 4N/mm --speed 1m/s --temperature 40degC {line}",
            2,
            said,
        )
        for name, line, said in (
            ("by another solver", "--slide-to-roll 0.001 1 3", "--slide-to-roll: the solver 'hertz' keeps no film"),
            (
                "not a number",
                "--slide-to-roll x 1 3",
                "--slide-to-roll: got 'x'; allowed: a bare number from 1e-06 to 2",
            ),
            ("with nan", "--slide-to-roll nan 1 3", "--slide-to-roll: got 'nan'"),
            ("zero", "--slide-to-roll 0 1 3", "--slide-to-roll: got '0'"),
            ("above all", "--slide-to-roll 0.1 3 3", "--slide-to-roll: got '3'"),
            ("upside down", "--slide-to-roll 1 0.1 3", "--slide-to-roll: got 1 to 0.1; allowed: TO above FROM"),
            ("one point", "--slide-to-roll 0.1 1 1", "POINTS: got '1'; allowed: a whole number from 2 to 1000"),
            (
                "with a frequency",
                "--slide-to-roll 0.1 1 3 --frequency 1kHz",
                "--slide-to-roll: stands beside --frequency",
            ),
            ("a stress alone", "--shear-stress 6MPa", "--shear-stress: the solver 'hertz' knows none"),
            ("a ratio alone", "--limiting-ratio 0.05", "--limiting-ratio: the solver 'hertz' knows none; allowed: "),
            ("two ratios", "--slide-to-roll 0.1 1", "--slide-to-roll: got 2 values; allowed: one ratio, or FROM TO"),
            ("one ratio", "--slide-to-roll 0.1", "--slide-to-roll: the solver 'hertz' knows none; allowed: with"),
            ("heat", "--physics thermal", "--physics: the solver 'hertz' knows none; allowed: with --solver reynolds"),
            ("another heat", "--solver reynolds --physics warm", "--physics: got 'warm'; allowed: 'isothermal', 'inl"),
            # without ehlFoam that is said first
            (
                "a law",
                "--solver openfoam --shear plastic",
                "--shear: got 'plastic'; allowed: 'newtonian', 'eyring'|got 'openfoam', which needs more than is here",
            ),
            (
                "a stress",
                "--solver openfoam --shear-stress much",
                "--shear-stress: got 'much'|got 'openfoam', which needs more than is here",
            ),
            ("a stress of text", "--slide-to-roll 0.1 1 3 --shear-stress much", "--shear-stress: got 'much'"),
            ("no stress", "--slide-to-roll 0.1 1 3 --shear-stress 0Pa", "allowed: 0.1 MPa to 1000 MPa"),
            ("a wrong ratio", "--slide-to-roll 0.1 1 3 --limiting-ratio 2", "--limiting-ratio: got '2'"),
        )
    },
    "a tiny frequency": (
        "solve job.toml --load 4N/mm --speed 1m/s --temperature 40degC --frequency 1e-9Hz",
        2,
        "--frequency: got '1e-9Hz'; allowed: 0 Hz",
    ),
    "fields without cells": (
        "solve job.toml --load 4N/mm --speed 1m/s --temperature 40degC --fields a.vtu",
        2,
        "--fields",
    ),
    "a plot without cells": ("solve job.toml --load 4N/mm --speed 1m/s --temperature 40degC --plot a.png", 2, "--plot"),
    "no points": ("tradeoff job.toml --points 0", 2, "--points: got '0'"),
    "a seed below zero": ("tradeoff job.toml --seed -1", 2, "--seed"),
    "a measurement over a map": ("tradeoff job.toml -o map.nc", 2, "is not a trade of ehdmaps"),
    "a map as it is": ("show map.nc", 0, ""),
    "a job as it is": ("check job.toml", 0, ""),
    "the job of a map": ("check map.nc", 0, ""),
}

MBS_OPTIONS: dict[str, tuple[str, int, str]] = {
    "no command": ("", 2, "required: COMMAND"),
    "unknown command": ("dance", 2, "invalid choice: 'dance'"),
    "no scene": ("statics", 2, "required: SCENE"),
    "a close name": ("statics nu380_rigid", 2, "did you mean 'nu308_rigid'?"),
    "a folder": ("statics .", 2, "cannot be read (it is a folder)"),
    "a pipe": ("statics pipe", 2, "cannot be read (it is a pipe)"),
    "a map as scene": ("statics map.nc", 2, "map.nc"),
    "a job as scene": ("statics job.toml", 2, "job.toml"),
    "a law": ("statics nu308_rigid --law herz", 2, "--law"),
    "a constant law": ("statics nu308_rigid --law constant:none", 2, "constant:none"),
    "law map alone": ("statics nu308_rigid --law map", 2, "--map"),
    "two laws": ("statics nu308_rigid --law hertz --law formula", 2, "--law: got 2 of them"),
    "the same law twice": ("sweep nu308_rigid --law hertz --law hertz", 2, "--law: got 'hertz' twice"),
    "no map": ("statics nu308_rigid --map gone.nc", 2, "--map: gone.nc"),
    "a job as map": ("statics nu308_rigid --map job.toml", 2, "--map: job.toml"),
    "a clearance": ("statics nu308_rigid --clearance 20", 2, "--clearance: got '20' without a unit"),
    "a clearance of text": ("statics nu308_rigid --clearance wide", 2, "--clearance: got 'wide'"),
    "a clearance of a metre": ("statics nu308_rigid --clearance 1m", 2, "--clearance: got '1m'"),
    "two clearances": ("modes nu308_rigid --clearance 1um --clearance 2um", 2, "--clearance: got 2 of them"),
    "output nowhere": ("statics nu308_rigid -o none/a.nc", 2, "-o: got"),
    "output a folder": ("statics nu308_rigid -o .", 2, "-o: got"),
    "no output": ("statics nu308_rigid -o=", 2, "-o"),
    "a plot of a kind": ("lsa nu308_rigid --plot a.gif", 2, "--plot: got"),
    "the same file twice": ("lsa nu308_rigid -o a.png --plot a.png", 2, "a.png"),
    "the scene as output": ("statics scene.toml -o scene.toml", 2, "scene.toml"),
    "the map as output": ("statics nu308_rigid --map map.nc -o map.nc", 2, "map.nc"),
    "speeds": ("sweep nu308_rigid --speed 500rpm 100rpm 5", 2, "--speed"),
    "speeds of no number": ("sweep nu308_rigid --speed 100rpm 500rpm many", 2, "--speed"),
    "speeds without unit": ("sweep nu308_rigid --speed 100 500 5", 2, "--speed"),
    "too many speeds": ("sweep nu308_rigid --speed 100rpm 500rpm 99999999", 2, "--speed"),
    "two speeds": ("sweep nu308_rigid --speed 100rpm 500rpm", 2, "expected 3 arguments"),
    "cage angles": ("sweep nu308_rigid --cage-angles 0", 2, "--cage-angles"),
    "cage angles of text": ("sweep nu308_rigid --cage-angles x", 2, "--cage-angles"),
    "a load factor": ("sweep nu308_rigid --load-factor 0", 2, "--load-factor: got '0'"),
    "a load factor of text": ("sweep nu308_rigid --load-factor nan", 2, "--load-factor: got 'nan'"),
    "too many cases": (
        "sweep nu308_rigid" + "".join(f" --clearance {n}um --load-factor 1.{n}" for n in range(1, 7)),
        2,
        "got 36 combinations; allowed: up to 24 side by side",
    ),
    "a key to vary": ("variants nu308_rigid --law hertz --law formula --vary none 1", 2, "--vary"),
    "one law to compare": ("variants nu308_rigid --law hertz --vary slices 5", 2, "two"),
    "a damper": ("statics nu308_rigid --law hertz:-1us", 2, "--law"),
    "a sensor": ("campbell nu308_rigid --sensor none", 2, "sensor"),
    "a highest frequency": ("campbell nu308_rigid --highest 1", 2, "--highest"),
    "a window": ("campbell nu308_rigid --window 1year", 2, "--window"),
    "no window": ("campbell nu308_rigid --window 0s", 2, "--window"),
    "no hits": ("hammer nu308_rigid --hits 0 -o a.uff", 2, "hits"),
    "hits of text": ("hammer nu308_rigid --hits x -o a.uff", 2, "hits"),
    "many hits": ("hammer nu308_rigid --hits 99999999 -o a.uff", 2, "hits"),
    "noise": ("hammer nu308_rigid --noise -1 -o a.uff", 2, "noise"),
    "noise of nan": ("hammer nu308_rigid --noise nan -o a.uff", 2, "noise"),
    "a seed": ("hammer nu308_rigid --seed -1 -o a.uff", 2, "seed"),
    "a duration": ("hammer nu308_rigid --duration 1 -o a.uff", 2, "duration"),
    "a long duration": ("hammer nu308_rigid --duration 1year -o a.uff", 2, "duration"),
    "no records": ("modal-fit gone.uff", 2, "gone.uff: cannot be read"),
    "records in a pipe": ("modal-fit pipe", 2, "cannot be read (it is a pipe)"),
    "records in a scene": ("modal-fit scene.toml", 2, "scene.toml"),
    "a band upside down": ("modal-fit good.uff --band 900Hz 100Hz", 2, "band"),
    "a band of text": ("modal-fit good.uff --band low high", 2, "band"),
    "a band beyond": ("modal-fit good.uff --band 1MHz 2MHz", 2, "band"),
    "half a band": ("modal-fit good.uff --band 100Hz", 2, "expected 2 arguments"),
    "no modes": ("modal-fit good.uff --modes 0", 2, "modes"),
    "an order": ("modal-fit good.uff --order 0", 2, "order"),
    "a window decay": ("modal-fit good.uff --window-decay -1s", 2, "--window-decay"),
    "a margin": ("plan nu308_rigid --margin 0.5", 2, "--margin: got '0.5'"),
    "a margin of text": ("plan nu308_rigid --margin wide", 2, "--margin: got 'wide'"),
    "a plan of another ending": ("plan nu308_rigid -o job.txt", 2, "-o: got job.txt"),
    "a plan over the scene": ("plan scene.toml -o scene.toml", 2, "scene.toml"),
    "no body": ("reduce gone.toml", 2, "gone.toml: cannot be read"),
    "a body in a pipe": ("reduce pipe", 2, "cannot be read (it is a pipe)"),
    "a scene as body": ("reduce scene.toml -o a.nc", 2, "matrices: missing"),
    "another ending": ("reduce body.toml -o a.txt", 2, "-o: got"),
    "a reduced body nowhere": ("reduce body.toml -o none/a.nc", 2, "-o: got"),
    "a scene as it is": ("statics nu308_rigid", 0, ""),
    "a plan as it is": ("plan nu308_rigid", 0, ""),
}


def options(table: dict[str, tuple[str, int, str]]) -> list[Case]:
    """Commands on files that are good."""
    return [Case(name, tuple(line.split()), {}, status, (words,)) for name, (line, status, words) in table.items()]


def _records(path: Path) -> None:
    """A title of records."""
    path.write_bytes(path.read_bytes().replace(b"a long title", b"a\x1b[31m title"))


def _attributes(path: Path) -> None:
    """All plain texts of a map but its job."""
    with netCDF4.Dataset(path, "a") as file:
        for name in file.ncattrs():
            text = file.getncattr(name)
            if isinstance(text, str) and not name.startswith(("job", "schema")) and not text.startswith(("{", "[")):
                file.setncattr(name, f"{text}\x1b[31m\x9b2J\r")


CONTROL: dict[str, tuple[str, str, bytes | Callable[[Path], None]]] = {
    "a key of a job": ("ehdmaps", "check job.toml", b'schema = 1\n"a\\u001b[31mb" = 1\n'),
    "a name in a job": ("ehdmaps", "check job.toml", JOB.replace('"NU308"', '"NU\\u001b]0;x\\u0007"').encode()),
    "a C1 code in a job": ("ehdmaps", "check job.toml", JOB.replace('"NU308"', '"NU\\u009b31m"').encode()),
    "a line break in a key": ("ehdmaps", "check job.toml", b'schema = 1\n"a\\nehdmaps check: all is well" = 1\n'),
    "right to left in a key": ("ehdmaps", "check job.toml", '"a\u202eb" = 1\n'.encode()),
    "an oil in a job": ("ehdmaps", "check job.toml", JOB.replace('"roelands"', '"\\u001b[2J"').encode()),
    "the title of a scene": (
        "mbs",
        "statics scene.toml",
        SCENE.replace('title = "NU308: rigid', 'title = "\\u001b[31mNU308: \\u0007rigid').encode(),
    ),
    "a body of a scene": ("mbs", "statics scene.toml", SCENE.replace("ring_left", "ring\\u001b[2Jleft").encode()),
    "a bearing of a scene": ("mbs", "statics scene.toml", SCENE.replace('"bearing_left"', '"b\\u009b2J\\r"').encode()),
    "a key of a scene": ("mbs", "statics scene.toml", b'"a\\u001b[31mb" = 1\n'),
    "the title of records": ("mbs", "modal-fit good.uff", _records),
    "the attributes of a map": ("ehdmaps", "show map.nc", _attributes),
    "a key of a body": ("mbs", "reduce body.toml", b'"a\\u001b[31mb" = 1\n'),
    "a path in a body": ("mbs", "reduce body.toml", BODY.replace('"m.inp"', '"m\\u001b[31m.inp"').encode()),
    "an interface of a body": ("mbs", "reduce body.toml", BODY.replace("left =", '"le\\u001b[31mft" =').encode()),
}
"""Control characters in names: program, command, and the file that it reads, or what changes the good one. None of them
may reach the terminal."""
