"""Imports run one way: errors <- physics <- (ehl | openfoam | maps | solids) <- exports <- jobs; maps, physics <- mbs.

Scenes call jobs. Nothing imports the examples.
"""

from __future__ import annotations

import ast
import os
import re
import shlex
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

from tests.cases.programs import needed

ROOT = Path(__file__).parents[2]

ALLOWED = {
    "ehdmaps.arrays": set(),
    "ehdmaps.copies": {"ehdmaps.arrays", "ehdmaps.compiled"},
    "ehdmaps.extras": {"ehdmaps.errors"},
    "ehdmaps.units": {"ehdmaps.errors"},
    "ehdmaps.choices": {"ehdmaps.errors", "ehdmaps.units", "ehdmaps.physics", "ehdmaps.maps"},
    "ehdmaps.command_table": {"ehdmaps.choices", "ehdmaps.program"},
    "ehdmaps.figures": set(),
    "ehdmaps.errors": set(),
    "ehdmaps.inputs": {"ehdmaps.errors"},
    "ehdmaps.netcdf_structure": set(),
    "ehdmaps.outputs": {"ehdmaps.errors", "ehdmaps.figures", "ehdmaps.netcdf_structure"},
    "ehdmaps.provenance": set(),
    "ehdmaps.version": {"ehdmaps.provenance"},
    "ehdmaps.compiled": {"ehdmaps.compiling", "ehdmaps.outputs", "ehdmaps.program", "ehdmaps.provenance"},
    "ehdmaps.kernel": {"ehdmaps.errors", "ehdmaps.outputs"},
    "ehdmaps.interrupts": set(),
    "ehdmaps.program": {"ehdmaps.errors", "ehdmaps.interrupts", "ehdmaps.version"},
    "ehdmaps.compiling": set(),
    "ehdmaps.workers": {"ehdmaps.compiling", "ehdmaps.errors", "ehdmaps.interrupts", "ehdmaps.program"},
    "ehdmaps.physics": {"ehdmaps.arrays", "ehdmaps.errors"},
    "ehdmaps.ehl": {
        "ehdmaps.arrays",
        "ehdmaps.compiled",
        "ehdmaps.compiling",
        "ehdmaps.copies",
        "ehdmaps.errors",
        "ehdmaps.physics",
    },
    "ehdmaps.point": {
        "ehdmaps.arrays",
        "ehdmaps.compiled",
        "ehdmaps.copies",
        "ehdmaps.compiling",
        "ehdmaps.ehl",
        "ehdmaps.errors",
        "ehdmaps.physics",
    },
    "ehdmaps.maps": {
        "ehdmaps.arrays",
        "ehdmaps.compiled",
        "ehdmaps.errors",
        "ehdmaps.inputs",
        "ehdmaps.kernel",
        "ehdmaps.netcdf_structure",
        "ehdmaps.outputs",
        "ehdmaps.provenance",
        "ehdmaps.units",
        "ehdmaps.physics",
        "ehdmaps.table",
    },
    "ehdmaps.electrics": {"ehdmaps.arrays", "ehdmaps.errors", "ehdmaps.maps", "ehdmaps.physics", "ehdmaps.table"},
    "ehdmaps.table": {
        "ehdmaps.arrays",
        "ehdmaps.compiled",
        "ehdmaps.errors",
        "ehdmaps.kernel",
        "ehdmaps.netcdf_structure",
        "ehdmaps.outputs",
        "ehdmaps.physics",
    },
    "ehdmaps.openfoam": {
        "ehdmaps.arrays",
        "ehdmaps.compiling",
        "ehdmaps.errors",
        "ehdmaps.extras",
        "ehdmaps.outputs",
        "ehdmaps.units",
        "ehdmaps.physics",
    },
    "ehdmaps.solids": {
        "ehdmaps.arrays",
        "ehdmaps.errors",
        "ehdmaps.extras",
        "ehdmaps.inputs",
        "ehdmaps.physics",
    },
    "ehdmaps.report": {"ehdmaps.arrays", "ehdmaps.errors", "ehdmaps.figures", "ehdmaps.outputs", "ehdmaps.units"},
    "ehdmaps.trade": {"ehdmaps.arrays", "ehdmaps.errors", "ehdmaps.figures", "ehdmaps.outputs", "ehdmaps.units"},
    "ehdmaps.exports": {
        "ehdmaps.arrays",
        "ehdmaps.errors",
        "ehdmaps.outputs",
        "ehdmaps.kernel",
        "ehdmaps.program",
        "ehdmaps.units",
        "ehdmaps.version",
        "ehdmaps.physics",
        "ehdmaps.maps",
    },
    "ehdmaps.jobs": {
        "ehdmaps",
        "ehdmaps.exports",
        "ehdmaps.arrays",
        "ehdmaps.choices",
        "ehdmaps.command_table",
        "ehdmaps.compiling",
        "ehdmaps.electrics",
        "ehdmaps.provenance",
        "ehdmaps.workers",
        "ehdmaps.errors",
        "ehdmaps.extras",
        "ehdmaps.figures",
        "ehdmaps.inputs",
        "ehdmaps.interrupts",
        "ehdmaps.netcdf_structure",
        "ehdmaps.outputs",
        "ehdmaps.program",
        "ehdmaps.units",
        "ehdmaps.version",
        "ehdmaps.physics",
        "ehdmaps.ehl",
        "ehdmaps.openfoam",
        "ehdmaps.point",
        "ehdmaps.maps",
        "ehdmaps.report",
        "ehdmaps.solids",
        "ehdmaps.table",
        "ehdmaps.trade",
    },
    "mbs": {
        "ehdmaps.exports",
        "ehdmaps.kernel",
        "ehdmaps.arrays",
        "ehdmaps.compiled",
        "ehdmaps.provenance",
        "ehdmaps.interrupts",
        "ehdmaps.workers",
        "ehdmaps.copies",
        "ehdmaps.electrics",
        "ehdmaps.errors",
        "ehdmaps.extras",
        "ehdmaps.figures",
        "ehdmaps.inputs",
        "ehdmaps.netcdf_structure",
        "ehdmaps.outputs",
        "ehdmaps.program",
        "ehdmaps.units",
        "ehdmaps.version",
        "ehdmaps.physics",
        "ehdmaps.point",
        "ehdmaps.table",
        "ehdmaps.maps",
        "ehdmaps.report",
        "ehdmaps.solids",
        "ehdmaps.trade",
    },
    "mbs.scene.scene": {
        "ehdmaps.exports",
        "ehdmaps.kernel",
        "ehdmaps.arrays",
        "ehdmaps.compiling",
        "ehdmaps.choices",
        "ehdmaps.command_table",
        "ehdmaps.provenance",
        "ehdmaps.interrupts",
        "ehdmaps.workers",
        "ehdmaps.copies",
        "ehdmaps.electrics",
        "ehdmaps.errors",
        "ehdmaps.extras",
        "ehdmaps.figures",
        "ehdmaps.inputs",
        "ehdmaps.netcdf_structure",
        "ehdmaps.outputs",
        "ehdmaps.program",
        "ehdmaps.units",
        "ehdmaps.version",
        "ehdmaps.physics",
        "ehdmaps.maps",
        "ehdmaps.report",
        "ehdmaps.solids",
        "ehdmaps.trade",
        "ehdmaps.jobs",
        "mbs",
    },
    "examples": {
        "ehdmaps",
        "ehdmaps.arrays",
        "ehdmaps.errors",
        "ehdmaps.extras",
        "ehdmaps.outputs",
        "ehdmaps.program",
        "ehdmaps.units",
        "ehdmaps.version",
        "ehdmaps.physics",
        "ehdmaps.ehl",
        "ehdmaps.point",
        "ehdmaps.table",
        "ehdmaps.solids",
        "mbs",
        "mbs.scene.scene",
    },
}
ALLOWED["mbs.laboratory"] = {*ALLOWED} - {"ehdmaps", "examples"}
"""What each layer may import besides itself and other distributions. `ehdmaps` itself is the shop window of all. The
laboratory measures them all, and none imports it."""

SCENES = (
    *("__main__", "analyses", "budget", "cli", "commands", "exports", "imports", "library"),
    *("identification", "one_bearing", "output", "planning", "report", "scene", "unknowns", "vibration"),
)
"""Modules of mbs that plan a scene or are its command line: they may call ehdmaps.jobs; no other module of mbs may
call them."""


def _layer(module: str) -> str | None:
    parts = module.split(".")
    if parts[:2] == ["mbs", "laboratory"]:
        return "mbs.laboratory"
    if parts[0] == "mbs":
        return "mbs.scene.scene" if len(parts) > 1 and parts[1] in SCENES else "mbs"
    if parts[0] == "examples":
        return "examples"
    if parts[0] != "ehdmaps":
        return None
    return ".".join(parts[:2])


@cache
def _imports(path: Path) -> tuple[ast.Import | ast.ImportFrom, ...]:
    """All imports of a file, which many tests ask for."""
    tree = ast.parse(path.read_text())
    return tuple(node for node in ast.walk(tree) if isinstance(node, ast.Import | ast.ImportFrom))


def _imported(path: Path) -> set[str]:
    modules = set()
    for node in _imports(path):
        if isinstance(node, ast.Import):
            modules.update(alias.name for alias in node.names)
        else:
            assert node.level == 0, f"{path}: relative import"
            modules.add(node.module or "")
    return modules


ROOMS = ("ehdmaps", "mbs", "examples")
FILES = sorted(path for room in ROOMS for path in ROOT.glob(f"{room}/**/*.py"))


def test_imports_point_one_way() -> None:
    for path in FILES:
        module = ".".join(path.relative_to(ROOT).with_suffix("").parts)
        own = _layer(module)
        if module in ("ehdmaps.__init__", "ehdmaps.__main__", "mbs.__init__"):
            continue
        assert own is not None, path
        foreign = {layer for name in _imported(path) if (layer := _layer(name)) not in (None, own)}
        assert foreign <= ALLOWED[own], f"{path}: imports {sorted(foreign - ALLOWED[own])}"


def _modules_of(path: Path, known: set[str]) -> set[str]:
    """Modules of this repository that a module imports, those under TYPE_CHECKING and within functions included."""
    modules = set()
    for node in _imports(path):
        if isinstance(node, ast.Import):
            modules.update(alias.name for alias in node.names)
        else:
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                modules.add(inner if inner in known else str(node.module))
    return modules & known


def circles(arrows: dict[str, set[str]]) -> list[list[str]]:
    """Modules that reach each other: those left when modules that import nothing, or that nobody imports, are gone."""
    left = {module: set(targets) for module, targets in arrows.items()}
    while True:
        imported = set().union(*left.values()) if left else set()
        free = {module for module, targets in left.items() if not targets or module not in imported}
        if not free:
            return [sorted(left)] if left else []
        left = {module: targets - free for module, targets in left.items() if module not in free}


LATE = {("ehdmaps.jobs.job", "ehdmaps.jobs.reader")}
"""`Job.build` writes a job file and has the reader check it: imported when it is called, and the only such pair."""


def test_no_circles_of_modules() -> None:
    """The packages' `__init__` are shop windows of all, loaded name by name, and are left out."""
    files = {".".join(path.relative_to(ROOT).with_suffix("").parts): path for path in FILES}
    files = {name: path for name, path in files.items() if not name.endswith("__init__")}
    arrows = {name: _modules_of(path, set(files)) for name, path in files.items()}
    assert sum(map(len, arrows.values())) > 500  # they are seen at all
    for module, late in LATE:
        assert late in arrows[module]
        arrows[module].discard(late)
    assert circles(arrows) == []


def test_a_circle_is_found() -> None:
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"a"}}) == [["b", "c"]]
    assert circles({"a": {"a"}}) == [["a"]]
    assert circles({"a": {"b"}, "b": set()}) == []


def test_analyses_know_no_command_line() -> None:
    for path in (ROOT / "mbs" / "analyses").glob("*.py"):
        known = ("argparse", "mbs.commands", "mbs.cli", "matplotlib")
        assert not [name for name in _imported(path) if name.startswith(known)], path


BELOW = (
    (("scene", "output"), ("mbs.analyses", "mbs.planning", "mbs.report", "mbs.commands", "mbs.cli")),
    (("analyses",), ("mbs.planning", "mbs.report", "mbs.commands", "mbs.cli")),
    (("planning", "report", "one_bearing", "exports", "exports/one_bearing"), ("mbs.commands", "mbs.cli")),
)
"""Rooms of mbs, and what of mbs stands above them: no arrow points up there."""


@pytest.mark.parametrize(("rooms", "above"), BELOW, ids=" ".join)
def test_rooms_know_nothing_above_them(rooms, above) -> None:
    for path in (path for room in rooms for path in (ROOT / "mbs" / room).glob("*.py")):
        assert [name for name in _imported(path) if name.startswith(above)] == [], path


JOBS = (("make",), ("show", "solve", "budget", "commands")), (("show", "solve", "budget"), ("commands",))
"""Rooms of ehdmaps.jobs, and those that they may not know."""


@pytest.mark.parametrize(("rooms", "above"), JOBS, ids=" ".join)
def test_rooms_of_jobs(rooms, above) -> None:
    above = tuple(f"ehdmaps.jobs.{room}." for room in above)
    paths = [path for room in rooms for path in (ROOT / "ehdmaps" / "jobs" / room).glob("*.py")]
    assert len(paths) > 10
    for path in paths:
        assert [name for name in _imported(path) if name.startswith(above)] == [], path


def test_kernels_know_no_map() -> None:
    paths = sorted((ROOT / "ehdmaps" / "maps" / "kernels").glob("*.py"))
    assert len(paths) > 5
    for path in paths:
        own = {name for name in _imported(path) if name.startswith("ehdmaps.maps")}
        assert [name for name in own if not name.startswith("ehdmaps.maps.kernels")] == [], path


@pytest.mark.parametrize("room", ["kernel", "maps", "maps/kernels", "physics"])
def test_rooms_list_their_modules(room) -> None:
    folder = ROOT / "ehdmaps" / room
    names = [path.stem for path in folder.glob("*.py") if path.stem != "__init__"]
    names += [path.parent.name for path in folder.glob("*/__init__.py")]
    listed = re.findall(r"(?m)^(\w+)  +\S", ast.get_docstring(ast.parse((folder / "__init__.py").read_text())) or "")
    assert sorted(listed) == sorted(names)


@pytest.mark.parametrize("package", ["ehdmaps", "mbs"])
def test_folders_have_at_most_twenty_files(package) -> None:
    folders = {path.parent for path in FILES if path.is_relative_to(ROOT / package)}
    assert len(folders) > 10
    assert [folder for folder in folders if len(list(folder.glob("*.py"))) > 20] == []


@pytest.mark.parametrize("path", sorted((ROOT / "mbs" / "modal").glob("*.py")), ids=lambda p: p.stem)
def test_modal_analysis_knows_no_machine(path: Path) -> None:
    names = {name for name in _imported(path) if name.partition(".")[0] in ("mbs", "ehdmaps")}
    known = {f"ehdmaps.{part}" for part in ("arrays", "errors", "extras", "inputs", "outputs", "units")}
    assert [name for name in names if not name.startswith("mbs.modal.") and name not in known] == []


def test_pyfoam_has_one_door() -> None:
    users = [path for path in FILES if any(name.partition(".")[0] == "PyFoam" for name in _imported(path))]
    assert users == [ROOT / "ehdmaps" / "openfoam" / "pyfoam.py"]


def test_types_of_arrays_have_one_home() -> None:
    own = re.compile(r"^\w+ = .*NDArray\[np\.", re.MULTILINE)
    assert [path for path in FILES if own.search(path.read_text())] == [ROOT / "ehdmaps" / "arrays.py"]


def test_every_file_is_looked_at() -> None:
    """What git tracks, exactly: a glob that loses a folder, or a file that was never committed, is found."""
    if not (ROOT / ".git").exists():
        pytest.skip("needs a clone")
    command = [needed("git"), "ls-files", "--cached", "--others", "--exclude-standard", "--deduplicate", *ROOMS]
    listed = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout.split()
    tracked = {name for name in listed if name.endswith(".py") and (ROOT / name).exists()}
    assert {path.relative_to(ROOT).as_posix() for path in FILES} == tracked


@pytest.mark.parametrize(
    "statement",
    ["import ehdmaps", "import ehdmaps.physics.closed_form", "import ehdmaps.openfoam", "import mbs"],
)
def test_import_is_light(statement: str) -> None:
    heavy = ("numba", "matplotlib", "PyFoam", "meshio", "xarray", "scipy", "pint")
    code = f"{statement}; import sys; print([m for m in {heavy!r} if m in sys.modules])"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    assert result.stdout.strip() == "[]"


BEARING = "mbs bearing NU308 --law hertz --load '5 kN' --speed '1500 rpm' --bands numerics"
WITH_BANDS = "mbs bearing NU308 --load '5 kN' --speed '1500 rpm'"
STATICS = "mbs statics nu308_rigid --law hertz --bands numerics"
FILMS_OF_TABLE = "from ehdmaps.jobs.make import assemble, table_law"

SOLVING = ("ehdmaps.ehl", "ehdmaps.openfoam", "ehdmaps.table")
LATER = ("matplotlib", "xarray", "pandas", "netCDF4", "scipy.interpolate", "scipy.optimize", "scipy.sparse")
MACHINES = ("mbs.transient", "mbs.linearised", "mbs.flexible", "mbs.spectral", "mbs.timedata", "mbs.modal")

BUDGETS = (
    ("from mbs import Bearing", 20, (*SOLVING, *LATER, *MACHINES, "ehdmaps.jobs", "ehdmaps.maps", "numba", "pint")),
    ("from mbs.bearings import bearing_force", 50, (*SOLVING, *LATER, *MACHINES, "ehdmaps.jobs", "ehdmaps.maps.law")),
    (BEARING, 116, (*SOLVING, *LATER, *MACHINES, "ehdmaps.jobs", "ehdmaps.maps.law", "ehdmaps.maps.emap")),
    (WITH_BANDS, 195, ("ehdmaps.openfoam", "numba", "matplotlib", "xarray", "pandas")),
    (STATICS, 130, (*SOLVING, *LATER, *MACHINES, "ehdmaps.jobs.job", "ehdmaps.maps.law", "ehdmaps.maps.emap")),
    (FILMS_OF_TABLE, 101, (SOLVING[1], "numba", "matplotlib", "xarray", "pandas", "mbs")),
    ("from mbs.analyses import campbell, runup", 235, ("numba",)),
    (
        "import ehdmaps; ehdmaps.open_map(MAP).law('inner')",
        95,
        (*SOLVING[:2], "numba", "matplotlib", "ehdmaps.jobs", "mbs"),
    ),
)
"""What a question loads of our own modules at most, and what it does not need.

Heads of results list what is held open, by the rules of scenes: these are loaded with every bearing.
"""


@pytest.mark.parametrize(("asked", "most", "unneeded"), BUDGETS, ids=[asked for asked, _, _ in BUDGETS])
def test_a_question_loads_what_it_needs(asked, most, unneeded, small_map) -> None:
    code = f"MAP = {str(small_map)!r}\n{asked}"
    if asked.startswith("mbs "):
        code = f"from mbs.cli import main\nassert main({shlex.split(asked)[1:]!r}) == 0"
    code += "\nimport sys\nprint('LOADED', *sys.modules)"
    # Kernels as Python: nothing is compiled for a test of imports.
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONWARNINGS": "ignore"}
    command = [sys.executable, "-c", code]
    result = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT, env=environment)
    loaded = result.stdout.rpartition("LOADED ")[2].split()
    own = [name for name in loaded if name.partition(".")[0] in ("ehdmaps", "mbs")]
    assert [name for name in loaded if any(name == part or name.startswith(f"{part}.") for part in unneeded)] == []
    assert 0 < len(own) <= most, f"{len(own)} modules: {' '.join(own)}"
