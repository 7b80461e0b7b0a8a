"""A manifest of results: what both programs compute, write and say of themselves, as checksums to compare bit for bit.

Run it before a change that must change no number, and again after it:

    python -m tests.benchmarks.manifest --out before.json
    python -m tests.benchmarks.manifest --against before.json

It makes small maps by each solver, runs the commands of `RUNS` on them in a folder of its own, and keeps for each file
the checksum of every variable with its attributes, or the lines of a text. Beside FILE.json stands FILE.npz with the
numbers themselves, by which `--against` says how far a variable is off; without it the manifest says only that it is.
Of both programs it keeps the help and every argument of every command. What changes from run to run is left out:
times of day and of the clock, versions, hashes of sources, paths, identifiers. OpenFOAM is not run, as a point of it
takes half a minute: of it the file of a case is compared.

A process that compiles a film solver may compute with other last digits than one that reads the compiled code from the
disk. So the work is done in a process of its own, and once more where the first one compiled anything.
Warm it takes some two minutes. Exit status 1 with ``--against``: something differs.
"""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import io
import json
import os
import re
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import scipy.io

from tests.cases.jobs import LINE, map_job, spaced

VOLATILE_ATTRIBUTES = frozenset(
    {"created", "history", "package_versions", "solver_version", "content_sha256", "code_hash"}
)
"""Attributes that state when and by which sources a file was made."""

VOLATILE_VARIABLES = frozenset({"solve_seconds"})
"""Variables that the clock decides."""

VOLATILE_WORDS = (
    (re.compile(r"\b\d{4}-\d\d-\d\d[T ]\d\d:\d\d(:\d\d)?(\.\d+)?(Z|[+-]\d\d:?\d\d)?"), "DATE"),
    (re.compile(r"\b\d\d-\w{3}-\d\d(\d\d)?\s+\d\d:\d\d:\d\d"), "DATE"),
    (re.compile(r"[0-9a-fA-F]{8}(-[0-9a-fA-F]{4}){3}-[0-9a-fA-F]{12}"), "GUID"),
    (re.compile(r"\b0\.1\.0(\+[\w.]+)?"), "VERSION"),
    (re.compile(r"\b[0-9a-f]{32,64}\b"), "HASH"),
    (re.compile(r"(code_hash: |code +hash )[0-9a-f]{16}\b"), "HASH"),
    (re.compile(r"\b(src\.|g)[0-9a-f]{10}(\.dirty)?(\.[0-9a-f]{10})?\b"), "VERSION"),
    (re.compile(r"[\d.]+ us of processor time a step(, [\d.]+ s)?"), "TIME"),
    (re.compile(r"time: +[\d.]+ s now .wall time.; [\d.]+ s|time +about .* a point"), "TIME"),
    (re.compile(r"processor time( to solve)? +ms .*"), "TIME"),
    (re.compile(r'"solve_seconds": .*'), "TIME"),
)
"""What texts have of the kind, and what stands in its place."""

PROGRESS = re.compile(r"^\d+ of \d+ (steps|points)|\d+ (points?|steps)/s|compiling, once|\d+%\||^\s*$")
"""Lines of stderr that the clock decides."""

LOADS, TEMPERATURE = spaced("0.1 N/mm", "1000 N/mm", 13), '["40 degC"]'
FEW_LOADS, SPEEDS = '["5 N/mm", "50 N/mm", "300 N/mm"]', '["0.5 m/s", "2 m/s"]'
QUICK = 'backbone = "none"\nlaw_check = 0\n'

JOBS = {
    "read": map_job(LOADS, spaced("0.05 m/s", "10 m/s", 6), '["30 degC", "50 degC"]', "reynolds") + "law_check = 40\n",
    "solved": map_job(FEW_LOADS, SPEEDS, TEMPERATURE, "reynolds") + "law_check = 6\n",
    "thermal": map_job(FEW_LOADS, SPEEDS, TEMPERATURE, "reynolds") + QUICK + 'physics = "thermal"\n',
    "inlet": map_job(FEW_LOADS, SPEEDS, TEMPERATURE, "reynolds") + QUICK + 'physics = "inlet-heat"\n',
    "limiting": map_job(FEW_LOADS, SPEEDS, TEMPERATURE, "reynolds") + QUICK + 'shear = "limiting"\n',
    "formula": map_job(LOADS, spaced("0.05 m/s", "10 m/s", 6), '["30 degC", "40 degC"]', bearing="N1014"),
    "dry": map_job(LOADS, SPEEDS, TEMPERATURE, "hertz"),
    "line": LINE,
}
"""Jobs of maps by their names."""

SCENES: dict[str, tuple[str, tuple[tuple[str, str], ...]]] = {
    "rigid": (
        "nu308_rigid",
        ((r'duration = "0.2 s"', 'duration = "0.02 s"'), (r'from = "0 rpm"', 'from = "1000 rpm"')),
    ),
    "bodies": (
        "nu308_rigid",
        (
            (r'duration = "0.2 s"', 'duration = "0.005 s"'),
            (r'from = "0 rpm"', 'from = "1000 rpm"'),
            (r"slices = 41", 'slices = 9\nrollers = "bodies"'),
            (r'diametral_clearance = "0 um"', 'diametral_clearance = "10 um"'),
        ),
    ),
    "gearbox": (
        "gearbox",
        (
            (r'duration = "5 s"', 'duration = "0.1 s"'),
            (r"slices = 21", "slices = 9"),
            (r'sample = "40 us"', 'sample = "20 us"'),
            (r'from = "500 rpm"', 'from = "1400 rpm"'),
            (r'to = "2500 rpm"', 'to = "1600 rpm"'),
        ),
    ),
    "rig": ("n1014_testrig", ((r"points = 2000", "points = 100"), (r"slices = 41", "slices = 15"))),
    "rotor": ("overhung_rotor", ((r'duration = "2.5 s"', 'duration = "0.05 s"'),)),
    "shaft": ("nu2210_shaft", ()),
}
"""Scenes by their names: the shipped one, and what is replaced in its text."""

NU308 = ("--map", "read.nc")
BEARING = ("bearing", "NU308", "--clearance", "20 um")
POINT = ("solve", "nu308", "--load", "88 N/mm", "--speed", "1.7 m/s", "--temperature", "40 degC", "--json")
EXPORT = ("export", "read.nc", "--to")
SPRING = ("--load", "5 kN", "--speed", "1500 rpm")
OVER = ("--speed", "500 rpm", "2000 rpm", "3")

RUNS: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    *(
        (f"map-{name}", "ehdmaps", ("generate", f"{name}.toml", "-o", f"{name}.nc", "--workers", "1"))
        for name in JOBS
        if name != "solved"
    ),
    ("map-solved", "ehdmaps", ("generate", "solved.toml", "-o", "solved.nc", "--workers", "1", "--fresh-films")),
    ("check", "ehdmaps", ("check", "read.toml")),
    ("show", "ehdmaps", ("show", "read.nc")),
    ("compare", "ehdmaps", ("compare", "solved.nc", "limiting.nc", "--json")),
    ("solve", "ehdmaps", (*POINT, "--frequency", "1 kHz")),
    ("solve-traction", "ehdmaps", (*POINT[:-1], "--slide-to-roll", "0.001", "1", "4")),
    ("solve-sliding", "ehdmaps", (*POINT, "--slide-to-roll", "0.1", "--shear", "eyring")),
    ("solve-starved", "ehdmaps", (*POINT, "--supply", "2 um")),
    ("export-c", "ehdmaps", (*EXPORT, "c", "-o", "export-c-sources")),
    ("export-fmu", "ehdmaps", (*EXPORT, "fmu", "-o", "read.fmu", "--sources-only", "--films", "memory")),
    ("export-mat", "ehdmaps", (*EXPORT, "mat", "-o", "read.mat")),
    ("export-csv", "ehdmaps", (*EXPORT, "csv", "-o", "read.csv")),
    (
        "export-modelica",
        "ehdmaps",
        (*EXPORT, "modelica", "-o", "read.mo", "--speed", "1.7 m/s", "--temperature", "40 degC"),
    ),
    (
        "export-ross",
        "ehdmaps",
        (*EXPORT, "ross", "-o", "ross.toml", "--load", "5 kN", "--speed", "500 rpm", "1500 rpm", "3"),
    ),
    (
        "export-calculix",
        "ehdmaps",
        (*EXPORT, "calculix", "-o", "read.inp", *SPRING, "--frequency", "10 Hz", "5 kHz", "4"),
    ),
    ("export-nastran", "ehdmaps", (*EXPORT, "nastran", "-o", "read.bdf", *SPRING)),
    ("export-ansys", "ehdmaps", (*EXPORT, "ansys", "-o", "ansys.txt", *SPRING)),
    ("bearing", "mbs", (*BEARING, "--load", "5 kN", "--speed", "1500 rpm", *NU308, "-o", "bearing.nc")),
    ("bearing-hertz", "mbs", (*BEARING, *SPRING, "--law", "hertz:1.25e-5 s", "--direction", "7 deg", "-o", "hertz.nc")),
    (
        "bearing-table",
        "mbs",
        (*BEARING, "--load", "1 kN", "9 kN", "3", "--speed", "700 rpm", "3000 rpm", "3", "-o", "bearing.csv"),
    ),
    (
        "bearing-supply",
        "mbs",
        (*BEARING, *SPRING, *NU308, "--supply", "oil air", "--roughness", "0.3 um", "-o", "supply.nc"),
    ),
    ("bearing-coupled", "mbs", (*BEARING, *SPRING, *NU308, "--coupled", "--slices", "15", "-o", "coupled.nc")),
    ("statics", "mbs", ("statics", "rigid.toml", *NU308, "-o", "statics.nc")),
    ("statics-gearbox", "mbs", ("statics", "gearbox.toml", *NU308, "-o", "gearbox_statics.nc")),
    ("statics-shaft", "mbs", ("statics", "shaft.toml", "-o", "shaft_statics.nc")),
    ("statics-bodies", "mbs", ("statics", "bodies.toml", *NU308, "-o", "bodies_statics.nc")),
    ("modes", "mbs", ("modes", "gearbox.toml", *NU308, "-o", "modes.nc")),
    ("modes-bodies", "mbs", ("modes", "bodies.toml", *NU308, "-o", "bodies_modes.nc")),
    ("lsa", "mbs", ("lsa", "rig.toml", "--map", "formula.nc", "-o", "lsa.nc", "--state-space", "space.mat")),
    (
        "sweep",
        "mbs",
        (
            "sweep",
            "gearbox.toml",
            *NU308,
            "--films",
            "slow",
            "--films",
            "memory",
            *OVER,
            "-o",
            "sweep.nc",
            "--workers",
            "1",
        ),
    ),
    ("critical", "mbs", ("critical", "rotor.toml", "--law", "hertz:1.25e-5 s", "-o", "critical.nc")),
    ("plan", "mbs", ("plan", "rigid.toml", "-o", "plan.toml")),
    (
        "runup",
        "mbs",
        ("runup", "rigid.toml", *NU308, "--films", "slow", "--films", "memory", "-o", "runup.nc", "--workers", "1"),
    ),
    (
        "runup-bodies",
        "mbs",
        ("runup", "bodies.toml", *NU308, "--films", "slow", "-o", "bodies_slow.nc", "--workers", "1"),
    ),
    ("runup-bodies-memory", "mbs", ("runup", "bodies.toml", *NU308, "-o", "bodies_memory.nc", "--workers", "1")),
    (
        "runup-drive",
        "mbs",
        (
            "runup",
            "rotor.toml",
            "--law",
            "hertz:1.25e-5 s",
            "--spectrum-at",
            "120 rpm",
            "-o",
            "drive.nc",
            "--workers",
            "1",
        ),
    ),
    (
        "campbell",
        "mbs",
        (
            "campbell",
            "gearbox.toml",
            *NU308,
            "--law",
            "hertz",
            "--window",
            "20 ms",
            "-o",
            "campbell.nc",
            "--workers",
            "1",
        ),
    ),
    ("campbell-signals", "mbs", ("runup", "runup.nc", "--spectrum-at", "1500 rpm", "--window", "5 ms")),
    (
        "hammer",
        "mbs",
        (
            "hammer",
            "rig.toml",
            "--map",
            "formula.nc",
            "-o",
            "hits.uff",
            "--hits",
            "2",
            "--duration",
            "0.2 s",
            "--workers",
            "1",
        ),
    ),
    ("modal-fit", "mbs", ("modal-fit", "hits.uff", "--band", "100 Hz", "2 kHz", "-o", "fit.nc")),
)
"""Results by their names: program and arguments. Each leaves its output, and the file of ``-o``."""


def make(folder: Path) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Return the manifest, and the numbers of all variables, of what the programs do in a folder."""
    for name, text in JOBS.items():
        (folder / f"{name}.toml").write_text(text)
    for name, (shipped, changes) in SCENES.items():
        _write_scene(folder / f"{name}.toml", shipped, changes)
    files: dict[str, Any] = {}
    values: dict[str, np.ndarray] = {}
    known = set(folder.rglob("*"))
    spent = {}
    for name, program, arguments in RUNS:
        begin = time.process_time()
        files[f"{name}: output"] = _run(program, arguments)
        spent[name] = time.process_time() - begin
        new = sorted(path for path in set(folder.rglob("*")) - known if path.is_file())
        known.update(folder.rglob("*"))
        for path in new:
            if ".store" not in str(path):
                _describe(path, f"{name}: {path.relative_to(folder)}", files, values)
    files["openfoam: case"] = {"lines": _openfoam_case()}
    slowest = ", ".join(f"{name} {spent[name]:.1f} s" for name in sorted(spent, key=spent.__getitem__)[:-6:-1])
    print(f"{len(RUNS)} runs, {sum(spent.values()):.0f} s of processor time; most: {slowest}", file=sys.stderr)
    print("openfoam is not run, half a minute a point: the file of its case is compared", file=sys.stderr)
    return {"files": files, "commands": dict(_commands())}, values


def _write_scene(path: Path, shipped: str, changes: tuple[tuple[str, str], ...]) -> None:
    """Write a shipped scene with other words in its text, each of which must stand there."""
    import mbs

    systems = Path(mbs.__file__).parent / "systems"
    text = (systems / f"{shipped}.toml").read_text()
    for old, new in changes:
        if old not in text:
            raise SystemExit(f"{shipped}: no {old!r} in the scene; look after SCENES of {__file__}")
        text = text.replace(old, new)
    path.write_text(re.sub(r'reduced = "(\w+\.nc)"', lambda found: f'reduced = "{systems / found[1]}"', text))


def _run(program: str, arguments: tuple[str, ...]) -> dict[str, Any]:
    """Run a program in this process, and return its exit status and what it says."""
    from ehdmaps.jobs import cli as ehdmaps
    from mbs import cli as mbs

    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = {"ehdmaps": ehdmaps, "mbs": mbs}[program].main(arguments)
    said = [line for line in err.getvalue().splitlines() if not PROGRESS.search(line)]
    return {"lines": [f"status {status}", *_steady(out.getvalue()), "stderr:", *_steady("\n".join(said))]}


def _steady(text: str) -> list[str]:
    """Return the lines of a text without what changes from run to run."""
    for pattern, word in ((re.compile(re.escape(os.getcwd()) + "/?"), ""), *VOLATILE_WORDS):
        text = pattern.sub(word, text)
    return [line.replace(str(Path(__file__).parents[2]), "ROOT") for line in text.splitlines()]


def _describe(path: Path, name: str, files: dict[str, Any], values: dict[str, np.ndarray]) -> None:
    """Add a file to a manifest, by what it is."""
    if path.suffix == ".nc":
        with netCDF4.Dataset(path) as dataset:
            dataset.set_auto_mask(False)
            files[name] = _dataset(dataset, name, values)
    elif path.suffix == ".mat":
        files[name] = {"variables": {}}
        for key, value in _leaves(scipy.io.loadmat(path, simplify_cells=True)):
            if key.rpartition(".")[2] not in VOLATILE_ATTRIBUTES:
                _variable(files[name], name, key, np.asarray(value), values)
    elif path.suffix == ".fmu":
        with zipfile.ZipFile(path) as archive:
            for member in sorted(archive.namelist()):
                files[f"{name}/{member}"] = {"lines": _steady(archive.read(member).decode("utf-8", "replace"))}
    else:
        files[name] = {"lines": _steady(path.read_text(encoding="utf-8", errors="replace"))}


def _dataset(dataset: Any, name: str, values: dict[str, np.ndarray], prefix: str = "") -> dict[str, Any]:
    """Return checksums of all variables, and all attributes, of a netCDF file and its groups."""
    found: dict[str, Any] = {"variables": {}, "attributes": {}}
    for where, owner in (("", dataset), *dataset.variables.items()):
        for key in owner.ncattrs():
            if key not in VOLATILE_ATTRIBUTES:
                found["attributes"][f"{prefix}{where}:{key}"] = _steady(_text(owner.getncattr(key)))
    for key, variable in dataset.variables.items():
        if key not in VOLATILE_VARIABLES:
            _variable(found, name, f"{prefix}{key}", np.asarray(variable[...]), values, variable.dimensions)
    for key, group in dataset.groups.items():
        inner = _dataset(group, name, values, f"{prefix}{key}/")
        found["variables"].update(inner["variables"])
        found["attributes"].update(inner["attributes"])
    return found


def _variable(
    found: dict[str, Any],
    name: str,
    key: str,
    value: np.ndarray,
    values: dict[str, np.ndarray],
    dimensions: tuple[str, ...] = (),
) -> None:
    """Add the checksum of a variable, and its numbers or its text."""
    numbers = value.dtype.kind in "biufc"
    content = np.ascontiguousarray(value).tobytes() if numbers else "\n".join(_steady(_text(value))).encode()
    label = f"{value.dtype if numbers else 'text'} {dimensions}{value.shape}"
    found["variables"][key] = f"{hashlib.sha256(content).hexdigest()} {label}"
    if numbers:
        values[f"{name}|{key}"] = value


def _text(value: object) -> str:
    """Return an attribute, or an array of texts, as text that tells every digit."""
    return json.dumps(np.asarray(value).tolist(), default=str)


def _leaves(tree: Any, prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the arrays of a file of MATLAB with their names; not the date in its head."""
    if isinstance(tree, dict):
        for key, value in tree.items():
            if not key.startswith("__"):
                yield from _leaves(value, f"{prefix}.{key}" if prefix else key)
    elif isinstance(tree, np.ndarray) and tree.dtype == object:
        for index, value in enumerate(tree.ravel()):
            yield from _leaves(value, f"{prefix}[{index}]")
    else:
        yield prefix, tree


def _openfoam_case() -> list[str]:
    """Return the parameter file of a case of OpenFOAM."""
    from ehdmaps.openfoam.parameters import Mesh, Parameters, Start
    from ehdmaps.physics.lubricant import Lubricant

    case = Parameters(
        reduced_radius=5.5e-3,
        reduced_modulus=2.3e11,
        load=1e4,
        lower_speed=0.5,
        upper_speed=1.5,
        oil=Lubricant.named("FVA3").at(313.15),
        cavitation_range=500.0,
        mesh=Mesh(film=0.2, spike_position=0.8, spike_width=0.05),
        columns=400,
        rows=6,
        start=Start(np.array([-1e-4, 0.0, 1e-4]), np.array([0.0, 5e8, 0.0]), 1e-7),
    )
    return _steady(case.text())


def _commands() -> Iterator[tuple[str, Any]]:
    """Yield help and arguments of every command of both programs."""
    from ehdmaps.jobs import cli as ehdmaps
    from mbs import cli as mbs

    for program in (ehdmaps, mbs):
        yield from _parser(program.parser())


def _parser(parser: argparse.ArgumentParser) -> Iterator[tuple[str, Any]]:
    """Yield help and arguments of a parser and of its commands."""
    rows = []
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for inner in action.choices.values():
                yield from _parser(inner)
        row = {
            key: getattr(action, key) for key in ("option_strings", "dest", "nargs", "default", "metavar", "required")
        }
        choices = list(action.choices) if action.choices is not None else None
        kind = getattr(action.type, "__name__", str(action.type))
        rows.append(json.dumps({**row, "choices": choices, "type": kind, "help": action.help}, default=str))
    # Of a width that does not depend on the terminal.
    yield parser.prog, {"lines": [*_steady(parser.format_help()), *rows]}


def differences(before: dict[str, Any], after: dict[str, Any], old: Any, new: Any) -> Iterator[str]:
    """Yield a line for each thing in which two manifests differ; old and new hold the numbers of both."""
    for part in ("files", "commands"):
        for name in sorted(before[part].keys() | after[part].keys()):
            first, second = before[part].get(name), after[part].get(name)
            if first is None or second is None:
                yield f"{name}: {'new' if first is None else 'missing'}"
                continue
            for key in ("variables", "attributes"):
                for inner in sorted(first.get(key, {}).keys() | second.get(key, {}).keys()):
                    one, other = first.get(key, {}).get(inner), second.get(key, {}).get(inner)
                    if one != other:
                        yield f"{name}: {inner}: {_difference(one, other, f'{name}|{inner}', old, new)}"
            if first.get("lines") != second.get("lines"):
                yield from _lines(name, first.get("lines", []), second.get("lines", []))


def _difference(one: Any, other: Any, key: str, old: Any, new: Any) -> str:
    """Say how two values of one name differ."""
    if one is None or other is None:
        return "new" if one is None else "missing"
    if isinstance(one, list):
        return f"{' '.join(one)[:200]} -> {' '.join(other)[:200]}"
    labels = [text.split(" ", 1)[1] for text in (one, other)]
    if labels[0] != labels[1]:
        return f"{labels[0]} -> {labels[1]}"
    if key not in old or key not in new:
        return "differs"
    first, second = np.asarray(old[key]), np.asarray(new[key])
    both = np.isfinite(first) & np.isfinite(second)
    apart = np.abs(np.subtract(second, first, where=both, out=np.zeros(first.shape, np.result_type(first, 1.0))))
    size = np.maximum(np.abs(first), np.abs(second))
    relative = np.divide(apart, size, where=both & (size > 0), out=np.zeros(first.shape))
    scale = np.max(size, where=both, initial=0.0)
    holes = int(np.sum(np.isfinite(first) != np.isfinite(second)))
    return (
        f"largest relative difference {np.max(relative, initial=0.0):.2g}, of the largest value "
        f"{np.max(apart, initial=0.0) / (scale or 1.0):.2g}, in {int(np.sum(apart > 0))} of {first.size} values"
        + (f", {holes} finite in one alone" if holes else "")
    )


def _lines(name: str, before: list[str], after: list[str]) -> Iterator[str]:
    """Yield the lines in which two texts differ, ten at most."""
    import difflib

    changed = [line for line in difflib.unified_diff(before, after, lineterm="", n=0) if line[:3] not in ("---", "+++")]
    for line in changed[:10]:
        yield f"{name}: {line[:240]}"
    if len(changed) > 10:
        yield f"{name}: and {len(changed) - 10} more lines"


def _compiled() -> int:
    """Return the number of files of machine code of this state of the sources."""
    from ehdmaps.compiled import FOLDER_VARIABLE
    from ehdmaps.outputs import cache_folder
    from ehdmaps.provenance import compiled_hash

    return len(list(cache_folder("compiled", FOLDER_VARIABLE, os.environ).glob(f"{compiled_hash()}-*/**/*.nbc")))


def _made(path: Path) -> None:
    """Make a manifest in a process of its own, once more where it compiled anything."""
    root = Path(__file__).parents[2]
    threads = {name: "1" for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS")}
    environment = {**os.environ, **threads, "COLUMNS": "80", "PYTHONPATH": str(root), "MPLBACKEND": "Agg"}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    for _ in range(3):
        before = _compiled()
        with tempfile.TemporaryDirectory() as folder:
            environment["EHDMAPS_REDUCED"] = folder
            command = [sys.executable, "-m", "tests.benchmarks.manifest", "--make", str(path.resolve())]
            work = Path(folder) / "work"
            work.mkdir()
            subprocess.run(command, check=True, env=environment, cwd=work)
        if _compiled() == before:
            return
        print("film solvers were compiled: once more with compiled ones", file=sys.stderr)


def _values(path: Path) -> dict[str, np.ndarray]:
    """Return the numbers that stand beside a manifest; none where that file is not there."""
    beside = path.with_suffix(".npz")
    if not beside.is_file():
        return {}
    with np.load(beside) as file:
        return dict(file)


def main() -> int:
    """Make a manifest, or compare this state of the sources with one."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.manifest", description=__doc__.split("\n", 1)[0])
    group = parser.add_mutually_exclusive_group(required=True)
    group.add_argument("--out", metavar="FILE.json", type=Path, help="write a manifest, and the numbers beside it")
    group.add_argument("--against", metavar="FILE.json", type=Path, help="print what differs from a manifest")
    group.add_argument("--make", metavar="FILE.json", type=Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.make:
        found, values = make(Path.cwd())
        arguments.make.write_text(json.dumps(found, indent=1))
        np.savez_compressed(arguments.make.with_suffix(".npz"), **values)
        return 0
    if arguments.out:
        _made(arguments.out)
        return 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "after.json"
        _made(path)
        before, after = json.loads(arguments.against.read_text()), json.loads(path.read_text())
        found = list(differences(before, after, _values(arguments.against), _values(path)))
    print("\n".join(found) or f"{len(after['files'])} files and {len(after['commands'])} commands as before")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
