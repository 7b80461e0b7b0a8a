"""Where compiled code is kept: under one hash of what it is made from, and what becomes of it where none can be."""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

from ehdmaps import compiled, provenance

ROOT = Path(__file__).parents[2]
OLD = [f"{number:016x}-0123abcd" for number in range(8)]

TWICE = """
from ehdmaps.compiled import njit

@njit
def inner(x):
    return {factor} * x
"""
CALLER = """
from ehdmaps.{callee} import inner
from ehdmaps.compiled import njit

@njit(error_model="numpy")
def outer(x):
    return inner(x) + 1.0
"""


@pytest.fixture
def site(tmp_path):
    """An installation of the package's first modules, with a compiled function that calls that of another file."""
    package = tmp_path / "a path" / "mit Umläuten" / "ehdmaps"
    package.mkdir(parents=True)
    for name in (
        "__init__",
        "compiled",
        "provenance",
        "outputs",
        "program",
        "interrupts",
        "errors",
        "extras",
        "netcdf_structure",
    ):
        (package / f"{name}.py").write_bytes((ROOT / "ehdmaps" / f"{name}.py").read_bytes())
    (package / "__init__.pyi").write_bytes((ROOT / "ehdmaps" / "__init__.pyi").read_bytes())
    (package / "callee.py").write_text(TWICE.format(factor=2.0))
    (package / "caller.py").write_text(CALLER.format(callee="callee"))
    return package.parent


def outer(site, cache, **variables):
    """What the compiled function says of 1, and what was told on stderr, in a process of its own."""
    kept = {name: value for name, value in os.environ.items() if name not in ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME")}
    # Python knows a changed file by its second and its length: a test that changes a digit within a second would read
    # bytecode of the old one
    kept |= {"XDG_CACHE_HOME": str(cache), "PYTHONPATH": str(site), "PYTHONDONTWRITEBYTECODE": "1", **variables}
    code = "from ehdmaps.caller import outer; print(outer(1.0), len(outer.stats.cache_hits))"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=kept, cwd=site, check=True)
    return found.stdout.split(), found.stderr


def folders(cache):
    return sorted(path.name for path in (cache / "ehdmaps" / "compiled").iterdir())


@pytest.mark.slow
def test_a_caller_in_an_unchanged_file_sees_that_its_callee_changed(site, tmp_path):
    cache = tmp_path / "cache"
    assert outer(site, cache) == (["3.0", "0"], "")
    assert outer(site, cache) == (["3.0", "1"], "")
    (site / "ehdmaps" / "callee.py").write_text(TWICE.format(factor=5.0))
    assert outer(site, cache) == (["6.0", "0"], "")
    assert len(folders(cache)) == 2
    # nothing lies beside the sources, so that an uninstalled package leaves no folder behind
    assert not list(site.rglob("*.nb?"))


@pytest.mark.slow
def test_only_what_compiled_code_is_made_from_compiles_it_anew(site, tmp_path):
    """A constant behind two imports is frozen in compiled code; a module that no compiled one imports is not in it."""
    package, cache = site / "ehdmaps", tmp_path / "cache"
    (package / "report.py").write_text("from ehdmaps.caller import outer\n")
    (package / "deep").mkdir()
    (package / "deep" / "__init__.py").write_text("")
    (package / "deep" / "numbers.py").write_text("FACTOR = 2.0\n")
    (package / "between.py").write_text("from ehdmaps.deep import (\n    numbers,\n)\n\nFACTOR = numbers.FACTOR\n")
    text = TWICE.format(factor="FACTOR")
    (package / "callee.py").write_text(f"from ehdmaps.between import FACTOR\n{text}")
    assert outer(site, cache) == (["3.0", "0"], "")
    (package / "report.py").write_text("from ehdmaps.caller import outer\n\nTITLE = 'new'\n")
    assert outer(site, cache) == (["3.0", "1"], "")
    (package / "deep" / "numbers.py").write_text("FACTOR = 5.0\n")
    assert outer(site, cache) == (["6.0", "0"], "")


def test_files_of_compiled_code():
    """All that they import of the packages stands at the left margin, or where compiled code sees nothing of it."""
    sources = provenance._sources(ROOT)
    files = provenance.kernel_files(sources)
    assert {"ehdmaps/physics/isotherm.py", "ehdmaps/arrays.py", "ehdmaps/ehl/newton.py"} <= set(files)
    assert not {"mbs/cli.py", "ehdmaps/jobs/cli.py", "mbs/output/run_plot.py"} & set(files)
    assert len(files) < 0.4 * len(sources)
    assert "ehdmaps/kernel/c/kernel.c" in sources and not [name for name in files if not name.endswith(".py")]
    assert provenance.kernel_files({"ehdmaps/kernel/c/a.c": b"/* not njit */"}) == []
    for name in files:
        tree = ast.parse(sources[name])
        hidden = [node for node in tree.body if isinstance(node, (ast.If, ast.Try, ast.With, ast.For))]
        of_types = [node for node in hidden if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"]
        for node in (one for block in hidden if block not in of_types for one in ast.walk(block)):
            assert not (isinstance(node, ast.Import) and any(_own(one.name) for one in node.names)), name
            assert not (isinstance(node, ast.ImportFrom) and _own(node.module)), name
        imports = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
        assert not any(node.level or node.names[0].name == "*" for node in imports), name


def _own(module):
    return module is not None and module.split(".")[0] in provenance.PACKAGES


@pytest.mark.slow
def test_without_a_folder_for_caches_code_is_kept_among_temporary_files(site, tmp_path):
    (tmp_path / "tmp").mkdir()
    where = {"HOME": "/dev/null/home", "XDG_CACHE_HOME": "/dev/null/cache", "TMPDIR": str(tmp_path / "tmp")}
    found, told = outer(site, tmp_path, **where)
    assert found == ["3.0", "0"]
    (folder,) = (tmp_path / "tmp").iterdir()
    assert told == (
        "ehdmaps: no folder for caches can be written ($XDG_CACHE_HOME, ~/.cache): compiled code is kept in "
        f"{folder}; $NUMBA_CACHE_DIR names another folder\n"
    )
    assert folder.stat().st_mode & 0o077 == 0
    assert outer(site, tmp_path, **where)[0] == ["3.0", "1"]


@pytest.mark.slow
def test_where_others_may_write_nothing_is_kept(site, tmp_path):
    """Code that is read there is run: a folder that others may write in, or a link, is none of ours."""
    folder = tmp_path / "tmp" / f"ehdmaps-compiled-{os.getuid()}"
    folder.mkdir(parents=True)
    folder.chmod(0o777)
    where = {"XDG_CACHE_HOME": "/dev/null/cache", "TMPDIR": str(folder.parent)}
    found, told = outer(site, tmp_path, **where)
    assert found == ["3.0", "0"]
    assert "compiled code is not kept, and each process compiles anew" in told
    assert not list(folder.iterdir())


def test_without_numba_s_compiler_functions_are_python(site, tmp_path):
    code = (
        "from ehdmaps import caller, compiled; print(caller.outer(1), compiled.in_python(caller.outer) is caller.outer)"
    )
    cache = tmp_path / "cache"
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONPATH": str(site), "XDG_CACHE_HOME": str(cache)}
    command = [sys.executable, "-c", code]
    found = subprocess.run(command, capture_output=True, text=True, env=environment, cwd=site, check=True)
    assert found.stdout.split() == ["3.0", "True"]
    assert not cache.exists()


def test_folders_of_other_states_are_removed_but_for_the_last_used(tmp_path):
    kept = tmp_path / "somebody's own folder"
    kept.mkdir()
    for age, name in enumerate(OLD):
        (tmp_path / name).mkdir()
        os.utime(tmp_path / name, (1e9 - age, 1e9 - age))
    compiled._use(tmp_path / "ffffffffffffffff-00000000")
    left = sorted(path.name for path in tmp_path.iterdir())
    assert left == sorted([*OLD[: compiled.MOST_KEPT], kept.name, "ffffffffffffffff-00000000"])


def test_the_hash_changes_with_sources_and_with_the_compiler(monkeypatch):
    found = {provenance.code_hash.__wrapped__()}
    monkeypatch.setattr(provenance, "sources_hash", lambda: "other sources")
    found.add(provenance.code_hash.__wrapped__())
    monkeypatch.setattr(provenance.metadata, "version", lambda name: f"other {name}")
    found.add(provenance.code_hash.__wrapped__())
    assert len(found) == 3
    assert all(len(each) == 16 for each in found)
