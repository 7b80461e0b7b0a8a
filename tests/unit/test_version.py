"""Version of this distribution and of others, and the state of the sources that it names."""

import os
import re
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest

import ehdmaps
import ehdmaps.version
import mbs
from ehdmaps.jobs.make.assemble import package_versions
from ehdmaps.provenance import source_state
from ehdmaps.version import version
from tests.cases.programs import needed

ROOT = Path(__file__).parents[2]
OURS = re.compile(r"\d+\.\d+\.\d+\+(g[0-9a-f]{10}(\.dirty\.[0-9a-f]{10})?|src\.[0-9a-f]{10})")
PROJECT = '[project]\nname = "ehdmaps"\nversion = "1.2.3"\n'


def missing(package):
    raise metadata.PackageNotFoundError(package)


def git(folder, *arguments):
    who = ["-c", "user.name=n", "-c", "user.email=e", "-c", "commit.gpgsign=false", "-c", "core.hooksPath=/nowhere"]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    command = [needed("git"), *who, "-C", str(folder), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True, env=environment).stdout.strip()


@pytest.fixture(autouse=True)
def looked_up_anew():
    """Versions of packages are looked up once a process, here once a test."""
    ehdmaps.version._installed.cache_clear()
    yield
    ehdmaps.version._installed.cache_clear()


@pytest.fixture
def copy(tmp_path, monkeypatch):
    """A small copy of the distribution, not a clone yet, from which the version is looked up."""
    for package in ("ehdmaps", "mbs"):
        (tmp_path / package).mkdir()
        (tmp_path / package / "a.py").write_text("x = 1\n")
    (tmp_path / "pyproject.toml").write_text(PROJECT)
    monkeypatch.setattr(ehdmaps.version, "__file__", str(tmp_path / "ehdmaps" / "version.py"))
    source_state.cache_clear()
    yield tmp_path
    source_state.cache_clear()


@pytest.fixture
def clone(copy):
    needed("git")
    git(copy, "init", "--quiet")
    git(copy, "add", ".")
    git(copy, "commit", "--quiet", "--message", "one")
    return copy


def test_an_installed_package_has_its_version():
    assert version("numpy") == metadata.version("numpy")
    assert version("no-such-package") == "not installed"


def test_version_names_the_state_of_the_sources_everywhere():
    assert OURS.fullmatch(version())
    assert ehdmaps.__version__ == mbs.__version__ == package_versions()["ehdmaps"] == version()


def test_a_second_process_in_the_same_tree_gives_the_same_text():
    command = [sys.executable, "-c", "import mbs; print(mbs.__version__)"]
    result = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    assert result.stdout.strip() == version()


def test_a_clone_names_its_commit_and_whether_it_was_changed(clone, monkeypatch):
    monkeypatch.setattr(metadata, "version", missing)
    commit = git(clone, "rev-parse", "HEAD")[:10]
    assert version() == f"1.2.3+g{commit}"
    source_state.cache_clear()
    (clone / "mbs" / "new.py").write_text("not tracked")
    assert version() == f"1.2.3+g{commit}"
    source_state.cache_clear()
    (clone / "mbs" / "a.py").write_text("x = 2\n")
    assert re.fullmatch(rf"1\.2\.3\+g{commit}\.dirty\.[0-9a-f]{{10}}", version())


def test_tags_and_variables_of_git_do_not_change_the_text(clone, monkeypatch, tmp_path):
    before = version()
    source_state.cache_clear()
    git(clone, "tag", "v9")
    monkeypatch.setenv("GIT_DIR", str(tmp_path / "elsewhere"))
    assert version() == before


def test_the_project_file_beside_the_package_goes_before_an_installation(copy, monkeypatch):
    monkeypatch.setattr(metadata, "version", lambda _: "7.7.7")
    assert version().startswith("1.2.3+src.")
    (copy / "pyproject.toml").unlink()
    assert version().startswith("7.7.7+src.")


def test_without_git_the_sources_are_hashed(clone, monkeypatch):
    monkeypatch.setenv("PATH", str(clone / "nothing"))
    first = version()
    assert re.fullmatch(r"1\.2\.3\+src\.[0-9a-f]{10}", first)
    source_state.cache_clear()
    assert version() == first
    source_state.cache_clear()
    (clone / "mbs" / "a.py").write_text("x = 3\n")
    assert version() != first
    source_state.cache_clear()
    second = version()
    for text in ("int x;\n", "int y;\n"):
        (clone / "ehdmaps" / "kernel" / "c" / "part").mkdir(parents=True, exist_ok=True)
        (clone / "ehdmaps" / "kernel" / "c" / "part" / "a.h").write_text(text)
        source_state.cache_clear()
        assert version() not in (first, second)
        second = version()


def test_a_git_that_hangs_or_refuses_counts_as_none(clone, monkeypatch):
    def hang(command, timeout, **_):
        raise subprocess.TimeoutExpired(command, timeout)

    (clone / ".git" / "HEAD").write_text("nonsense")
    assert "+src." in version()
    source_state.cache_clear()
    monkeypatch.setattr(subprocess, "run", hang)
    assert "+src." in version()


def test_a_clone_around_the_installation_is_not_ours(clone, monkeypatch):
    site = clone / "site-packages"
    (site / "ehdmaps").mkdir(parents=True)
    (site / "ehdmaps" / "a.py").write_text("x = 1\n")
    monkeypatch.setattr(ehdmaps.version, "__file__", str(site / "ehdmaps" / "version.py"))
    monkeypatch.setattr(metadata, "version", lambda _: "7.7.7")
    assert version().startswith("7.7.7+src.")


@pytest.mark.parametrize("unreadable", [False, True])
def test_sources_that_cannot_be_hashed_leave_the_number(copy, unreadable):
    for package in ("ehdmaps", "mbs"):
        (copy / package / "a.py").unlink()
        if unreadable:
            (copy / package / "a.py").mkdir()
    assert version() == "1.2.3"


@pytest.mark.parametrize("text", [None, "no toml", '[project]\nname = "other"\nversion = "1"\n', "[project]\n"])
@pytest.mark.parametrize("installed", [missing, lambda _: None], ids=["missing", "damaged"])
def test_neither_installed_nor_a_clone(monkeypatch, copy, text, installed):
    monkeypatch.setattr(metadata, "version", installed)
    (copy / "pyproject.toml").unlink()
    if text is not None:
        (copy / "pyproject.toml").write_text(text)
    assert version() == "not installed"
