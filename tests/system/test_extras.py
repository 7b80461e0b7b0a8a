"""The base installation does the main path; what needs an extra says so, in words and with exit status 2."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path
from typing import NamedTuple

import pytest

from ehdmaps.errors import DependencyError
from ehdmaps.extras import lacking, needs

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]

RUN = """
import contextlib, importlib, io, json, sys

class Without:
    def __init__(self, finder, names):
        self.finder, self.names = finder, names

    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in self.names:
            return None  # as of a package that is not there: some ask before they import
        return self.finder.find_spec(name, path, target)

    def __getattr__(self, name):
        return getattr(self.finder, name)

absent = set(sys.argv[1].split(","))
sys.meta_path[:] = [Without(finder, absent) for finder in sys.meta_path]
for program, *arguments in json.loads(sys.argv[2]):
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = importlib.import_module(program).main(arguments)
    print(json.dumps([status, out.getvalue(), err.getvalue()]))
"""
"""Runs programs one after the other in a process where some packages cannot be imported."""

JOB = """
schema = 1
[bearing]
name = "NU308"
[lubricant]
name = "FVA3"
[grid]
load = { from = "0.1 N/mm", to = "1000 N/mm", points = 7, spacing = "log" }
entrainment_speed = { from = "0.4 m/s", to = "1.8 m/s", points = 2, spacing = "log" }
temperature = ["40 degC"]
[solver]
name = "reynolds"
backbone = "none"
density = 4.5
structural_law = "iso16281"
"""


def plain(name: str) -> str:
    """Name of a distribution as all spellings of it have it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def base_distributions() -> set[str]:
    """What `pip install .` brings: the requirements of the project, and theirs, without any extra."""
    found: set[str] = set()
    waiting = list(PROJECT["dependencies"])
    while waiting:
        requirement = waiting.pop()
        name = plain(re.match(r"[\w.-]+", requirement)[0])
        if name in found or "extra ==" in requirement:
            continue
        try:
            waiting += metadata.requires(name) or []
        except metadata.PackageNotFoundError:
            continue  # of another system or version of Python
        found.add(name)
    return found


def foreign_modules() -> set[str]:
    """Modules that are installed here and are not in the base installation."""
    base = base_distributions()
    return {
        module
        for module, owners in metadata.packages_distributions().items()
        if not {plain(owner) for owner in owners} & (base | {"ehdmaps"})
    }


class Ended(NamedTuple):
    """How a program ended."""

    status: int
    out: str
    err: str


def run(folder: Path, *commands: tuple[str, ...]) -> list[Ended]:
    """Run programs in a folder, with the base installation alone; one process for all, which need not load it anew."""
    command = [sys.executable, "-c", RUN, ",".join(sorted(foreign_modules())), json.dumps(commands)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=300)
    assert (done.returncode, done.stderr) == (0, "")
    ended = [Ended(*json.loads(line)) for line in done.stdout.splitlines()]
    assert len(ended) == len(commands)
    return ended


def test_what_is_blocked():
    blocked = foreign_modules()
    assert {"PyFoam", "meshio", "h5py", "pymetis", "gmsh", "pyuff", "sdypy", "pytest", "rich"} <= blocked
    assert not {"numpy", "scipy", "numba", "xarray", "netCDF4", "pint", "tqdm", "matplotlib", "ehdmaps"} & blocked


@pytest.mark.slow
def test_from_a_job_to_the_modes_of_a_machine(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    (tmp_path / "job.toml").write_text(JOB)
    bands = ("--bands", "numerics")  # of what is not known they take many solutions more
    found = run(
        tmp_path,
        ("ehdmaps.jobs.cli", "generate", "job.toml", "-o", "map.nc", "--workers", "1"),
        ("mbs.cli", "modes", "nu308_rigid", "--map", "map.nc", "-o", "modes.nc", "--plot", "modes.png", *bands),
        # a shipped housing is read without what has reduced it
        ("mbs.cli", "modes", "gearbox", "--law", "hertz", *bands),
    )
    assert [ended.status for ended in found] == [0, 0, 0], found


NEEDY = (
    ("openfoam", "PyFoam", ("ehdmaps.jobs.cli", "generate", "nu308_openfoam")),
    ("openfoam", "PyFoam", ("ehdmaps.jobs.cli", "check", "nu308_openfoam")),
    ("modal", "pyuff", ("mbs.cli", "modal-fit", "hits.uff")),
    ("modal", "pyuff", ("mbs.cli", "campbell", "hits.uff")),
    ("modal", "pyuff", ("mbs.cli", "runup", "nu308_rigid", "--signals", "new.uff")),
    ("flexible", "meshio", ("mbs.cli", "modes", "nu308_rigid", "--shapes-file", "new.vtu")),
    ("modal", "pyuff", ("mbs.cli", "hammer", "n1014_testrig", "--law", "hertz", "-o", "new.uff")),
)
"""Commands that need an extra, and its package."""


@pytest.mark.slow
def test_what_needs_an_extra_names_it_and_all_else_that_is_missing(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    monkeypatch.setenv("EHDMAPS_OPENFOAM", str(tmp_path / "none"))
    (tmp_path / "hits.uff").write_text("any")
    found = run(tmp_path, *(command for _, _, command in NEEDY))
    for (extra, package, command), ended in zip(NEEDY, found, strict=True):
        assert (ended.status, ended.out) == (2, ""), command
        assert f"the package {package} cannot be loaded (No module named '{package}'); install it: " in ended.err
        assert f'pip install "ehdmaps[{extra}]", or pip install {package}' in ended.err
        assert "Traceback" not in ended.err
    assert [path.name for path in tmp_path.iterdir()] == ["hits.uff"]
    told = found[0].err
    assert "needs more than is here: the solver 'openfoam': the package PyFoam cannot be loaded" in told
    assert "needs more than is here: ehlFoam: there is no program" in told


def test_extras_that_messages_name_exist():
    sources = [
        path.read_text(encoding="utf-8")
        for room in ("ehdmaps", "mbs", "examples")
        for path in ROOT.glob(f"{room}/**/*.py")
    ]
    named = {call for text in sources for call in re.findall(r'(?:needs|lacking)\("(\w+)", "([\w-]+)"', text)}
    assert {package for _, package in named} >= {"PyFoam", "meshio", "pymetis", "gmsh", "pyuff", "sdypy-EMA"}
    for extra, package in named:
        assert any(re.match(rf"{package}\b", entry) for entry in PROJECT["optional-dependencies"][extra]), package


@pytest.mark.parametrize("error", [ImportError("none"), OSError("libGLU.so.1: cannot open")])
def test_a_package_that_cannot_be_loaded(error):
    told = r'^a mesh: the package gmsh .*\((none|libGLU.*)\); install it: pip install "'
    with pytest.raises(DependencyError, match=told), needs("solids", "gmsh", "a mesh"):
        raise error


def test_other_errors_pass():
    with pytest.raises(ZeroDivisionError), needs("solids", "gmsh", "a mesh"):
        raise ZeroDivisionError


def test_a_package_that_is_there_lacks_nothing(monkeypatch):
    assert lacking("openfoam", "json", "a test") == ()
    monkeypatch.setitem(sys.modules, "json", None)
    (problem,) = lacking("openfoam", "json", "a test")
    assert problem.startswith("a test: the package json cannot be loaded (import of json halted")
