"""The source distribution and the wheel: what they hold, and what an installation of the wheel does elsewhere."""

from __future__ import annotations

import importlib.util
import os
import re
import shlex
import shutil
import subprocess
import sys
import tarfile
import zipfile
from email import message_from_bytes
from pathlib import Path

import pytest

from ehdmaps.kernel import building
from tests.cases.programs import needed, quick_compiler

ROOT = Path(__file__).parents[2]
FOLDERS = ("ehdmaps", "mbs", "openfoam_cases")
FILES = ("pyproject.toml", "setup.py", "build_backend.py", "MANIFEST.in", "README.md", "LICENSE")
LEFT_OUT = shutil.ignore_patterns("__pycache__", "libehd*", "*.egg-info", "polyMesh", "*.pyc")
GPL = "ehdmaps/openfoam_cases/"

PACKAGES = ("ehdmaps", "mbs")
READ_BY_PYTHON = {".toml", ".json", ".css", ".js", ".html", ".mo", ".pyi"}
"""Endings of files that modules read beside them."""

STALE = ("ehdmaps/of_an_older_commit.py", "mbs/gone/__init__.py", "openfoam/__init__.py")

BUILD = """
import sys
import tomllib
with open("pyproject.toml", "rb") as file:
    build = tomllib.load(file)["build-system"]
sys.path[:0] = build["backend-path"]
backend = __import__(build["build-backend"])
print(backend.compiler(), getattr(backend, f"build_{sys.argv[1]}")(sys.argv[2]), sep="\\n")
"""


def done(command, folder, status=0, **more):
    """Run a program, without folders of packages that this process was given; its output."""
    environment = {name: text for name, text in os.environ.items() if name != "PYTHONPATH"}
    environment |= {"PIP_NO_COMPILE": "1"} | more  # modules are compiled as they are imported
    parts = [str(part) for part in command]
    result = subprocess.run(parts, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert result.returncode == status, result.stdout + result.stderr
    return result.stdout


def unpack(source: Path, folder: Path) -> None:
    """Unpack a source distribution of ours; Python knows filters from 3.11.4 on."""
    safe = {"filter": "data"} if hasattr(tarfile, "data_filter") else {}
    with tarfile.open(source) as archive:
        archive.extractall(folder, **safe)


@pytest.fixture(scope="module")
def distributions(tmp_path_factory):
    """The source distribution of this clone, and the wheel that is made of it, by the build system of the project."""
    folder = tmp_path_factory.mktemp("a build")
    done([sys.executable, "-m", "venv", "tools"], folder)
    wanted = ["setuptools>=77.0.3"]
    install = [folder / "tools/bin/pip", "install", "--quiet", "--no-compile", *wanted]
    got = subprocess.run(install, capture_output=True, text=True, check=False)
    if got.returncode:
        (pytest.fail if os.environ.get("CI") else pytest.skip)(f"{wanted} cannot be installed: {got.stderr[-300:]}")
    clone = folder / "clone"
    clone.mkdir()
    for name in FOLDERS:
        shutil.copytree(ROOT / name, clone / name, ignore=LEFT_OUT)
    for name in FILES:
        shutil.copy(ROOT / name, clone)
    python = folder / "tools/bin/python"
    source = folder / done([python, "-c", BUILD, "sdist", folder], clone).splitlines()[-1]
    unpack(source, folder)
    unpacked = folder / source.name.removesuffix(".tar.gz")
    # what a build of an older commit left there
    for name in STALE:
        (unpacked / "build/lib" / name).parent.mkdir(parents=True, exist_ok=True)
        (unpacked / "build/lib" / name).write_text("old = True\n")
    compiler = quick_compiler(tmp_path_factory.mktemp("compiler"))
    return source, folder / done([python, "-c", BUILD, "wheel", folder], unpacked, CC=compiler).splitlines()[-1]


@pytest.mark.slow
def test_what_source_distribution_and_wheel_hold(distributions):
    source, wheel = distributions
    with tarfile.open(source) as archive:
        held = {name.partition("/")[2] for name in archive.getnames()}
    for path in (ROOT / "openfoam_cases" / "ehlFoam").rglob("*.[CH]"):
        assert str(path.relative_to(ROOT)) in held
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        told = message_from_bytes(archive.read(next(name for name in names if name.endswith(".dist-info/METADATA"))))
        modes = {name: archive.getinfo(name).external_attr >> 16 for name in names}
    outside = {name.partition("/")[0] for name in names} - {"ehdmaps", "mbs"}
    assert {name.rpartition(".")[2] for name in outside} == {"dist-info"}
    command = [needed("git"), "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard", *PACKAGES]
    if (ROOT / ".git").exists():
        tracked = {name for name in done(command, ROOT).split("\0") if name.endswith(".py") and (ROOT / name).exists()}
        assert {name for name in names if name.endswith(".py")} == tracked
    read = {path for name in PACKAGES for path in (ROOT / name).rglob("*.*") if path.suffix in READ_BY_PYTHON}
    assert len(read) > 25 and {path.relative_to(ROOT).as_posix() for path in read} <= set(names)
    exported = {
        path.relative_to(ROOT).as_posix() for name in PACKAGES for path in (ROOT / name).rglob("exports/**/*.[ch]")
    }
    assert len(exported) > 20 and exported <= set(names)
    kernel = {path.relative_to(ROOT).as_posix() for path in (ROOT / "ehdmaps" / "kernel").rglob("*.[ch]")}
    assert {"ehdmaps/kernel/c/kernel.c", f"ehdmaps/kernel/{building.file_name()}"} <= set(names) and kernel <= set(
        names
    )
    assert {"build_backend.py", *kernel} <= held and not [name for name in held if "libehd" in name]
    assert re.fullmatch(r"ehdmaps-[\d.]+-py3-none-(manylinux_2_17|linux)_\w+\.whl", wheel.name)
    assert not [name for name in names if name.endswith((".png", ".pyc")) or "/tests/" in name]
    cases = {name.partition(GPL)[2]: name for name in names if GPL in name}
    assert {"COPYING", "build", "ehlFoam/ehlFoam.C", "ehlFoam/Make/options", "lineContact/system/fvSchemes"} <= set(
        cases
    )
    assert modes[cases["build"]] & 0o111
    assert told["License-Expression"] == "BSD-3-Clause AND BSD-2-Clause AND GPL-3.0-or-later"
    texts = told.get_all("License-File")
    assert texts == ["LICENSE", "ehdmaps/exports/fmu/headers/LICENSE", "openfoam_cases/COPYING"]
    for text in texts:
        assert any(name.endswith(f".dist-info/licenses/{text}") for name in names)
    assert told["Author"] == "The ehdmaps developers"
    assert told["Description-Content-Type"] == "text/markdown"
    assert "](docs/" not in told.get_payload()


@pytest.mark.slow
def test_a_build_without_a_compiler_takes_one_from_pypi(distributions, tmp_path):
    """It asks for ziglang, which is lent by the environment of the tests, and builds for old systems."""
    found = importlib.util.find_spec("ziglang")
    if found is None:
        pytest.skip("needs the package ziglang, of the extra test")
    source = distributions[0]
    unpack(source, tmp_path)
    unpacked = tmp_path / source.name.removesuffix(".tar.gz")
    options = unpacked / "ehdmaps/kernel/building.py"
    options.write_text(options.read_text("utf-8").replace('"": ("-O3",)', '"": ("-O1",)'), "utf-8")  # it is quicker
    (tmp_path / "lent").mkdir()
    python = source.parent / "tools/bin/python"
    code = BUILD.replace("print(", "sys.path.remove(sys.argv[3])\nasked = backend.compiler()\nprint(asked, ")
    code = code.replace("backend.compiler(), getattr", "sys.path.append(sys.argv[3]), getattr")
    (tmp_path / "lent" / "ziglang").symlink_to(Path(found.origin).parent)
    lent, nothing = str(tmp_path / "lent"), str(tmp_path / "nothing")
    told = done([python, "-c", code, "wheel", tmp_path, lent], unpacked, PATH=nothing, PYTHONPATH=lent, CC="")
    lines = told.splitlines()
    assert "['ziglang>=0.13,<1']" in lines
    wheel = tmp_path / lines[-1]
    assert "-py3-none-manylinux_2_17_" in wheel.name
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "installed")
    # where there is no compiler either, it is taken as it is
    code = "from ehdmaps.kernel import library; print(library.library()._name)"
    told = done([sys.executable, "-c", code], tmp_path / "installed", PATH=nothing)
    assert told.strip() == str(tmp_path / "installed" / "ehdmaps" / "kernel" / building.file_name())


@pytest.fixture(scope="module")
def installed(distributions, tmp_path_factory):
    """The wheel in an environment of its own, which borrows what ehdmaps needs; in a folder with blanks and umlauts."""
    folder = tmp_path_factory.mktemp("elsewhere") / "else where, für jede"
    done([sys.executable, "-m", "venv", "--without-pip", folder], folder.parent)
    pip = distributions[0].parent / "tools/bin/pip"
    done([pip, "--python", folder / "bin/python", "install", "--quiet", "--no-deps", distributions[1]], folder.parent)
    (packages,) = folder.glob("lib/python*/site-packages")
    borrowed = [path for path in sys.path if path.endswith("site-packages")]
    (packages / "zz_borrowed.pth").write_text("\n".join(borrowed), encoding="utf-8")
    where = "import ehdmaps, mbs; print(ehdmaps.__file__, mbs.__file__, sep='\\n')"
    found = done([folder / "bin/python", "-c", where], folder.parent).splitlines()
    assert found == [str(packages / name / "__init__.py") for name in ("ehdmaps", "mbs")]
    return folder


@pytest.mark.slow
def test_an_installation_elsewhere_finds_what_builds_its_solver(installed, tmp_path):
    (scripts,) = installed.glob("lib/python*/site-packages/ehdmaps/openfoam_cases")
    cache = tmp_path / "cache"
    told = done([installed / "bin/ehdmaps", "openfoam", "--check"], tmp_path, status=1, EHDMAPS_OPENFOAM=str(cache))
    problem, _, script = told.partition("; run ")
    assert problem == f"missing: no {cache}/bin/ehlFoam"
    assert shlex.split(script) == [str(scripts / "build")]  # as a shell reads it
    code = "from ehdmaps.openfoam.installation import cases_folder; print(cases_folder())"
    assert done([installed / "bin/python", "-c", code], tmp_path).strip() == str(scripts)


@pytest.mark.slow
def test_an_installation_elsewhere_has_its_jobs_scenes_exports_and_solids(installed, small_map, tmp_path):
    program, python = installed / "bin/ehdmaps", installed / "bin/python"
    codes = (
        "import ehdmaps.jobs.reader as r; assert len([r.read_job(name) for name in r.shipped_jobs()]) > 2",
        "import mbs.scene.reader as r; assert len([r.read_scene(name) for name in r.shipped_systems()]) > 2",
        "import ehdmaps.table.file as f; from ehdmaps import Lubricant; f.film_table(Lubricant.named('FVA3'))",
        "from ehdmaps.table.points.file import shipped_point_table; shipped_point_table()",
    )
    done([python, "-c", "\n".join(codes)], tmp_path)
    # in Python, as numba would compile all anew for the new place; with the finite elements of the housing
    in_python = {"NUMBA_DISABLE_JIT": "1"}
    done([installed / "bin/mbs", "statics", "gearbox", "--law", "hertz"], tmp_path, **in_python)
    done([program, "export", small_map, "--to", "c", "-o", "c"], tmp_path, **in_python)
    assert "NU308" in done([program, "solids", "nu308"], tmp_path)


@pytest.mark.slow
def test_nothing_is_left_when_it_is_removed(installed, distributions):
    """The last test of these: what was imported is compiled beside the modules, which goes too."""
    pip = distributions[0].parent / "tools/bin/pip"
    done([pip, "--python", installed / "bin/python", "uninstall", "--quiet", "--yes", "ehdmaps"], installed)
    own = ("ehdmaps", "mbs", "openfoam_cases")
    left = [path for path in installed.rglob("*") if path.stem.startswith(own)]
    assert left == [] and not (installed / "share").exists()
