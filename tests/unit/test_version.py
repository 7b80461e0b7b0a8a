from importlib import metadata

import pytest

import ehdmaps.version
from ehdmaps.version import version


def missing(package):
    raise metadata.PackageNotFoundError(package)


def test_an_installed_package_has_its_version():
    assert version("numpy") == metadata.version("numpy")
    assert version("no-such-package") == "not installed"


def test_a_clone_that_is_not_installed_says_so(monkeypatch):
    monkeypatch.setattr(metadata, "version", missing)
    number, _, words = version().partition(" ")
    assert number[0].isdigit() and words == "(not installed)"
    assert version("numpy") == "not installed"


def test_a_damaged_installation_counts_as_none(monkeypatch):
    monkeypatch.setattr(metadata, "version", lambda _: None)
    assert version().endswith(" (not installed)")


@pytest.mark.parametrize("text", [None, "no toml", '[project]\nname = "other"\nversion = "1"\n', "[project]\n"])
def test_neither_installed_nor_a_clone(monkeypatch, tmp_path, text):
    monkeypatch.setattr(metadata, "version", missing)
    (tmp_path / "package").mkdir()
    if text is not None:
        (tmp_path / "pyproject.toml").write_text(text)
    monkeypatch.setattr(ehdmaps.version, "__file__", str(tmp_path / "package" / "version.py"))
    assert version() == "not installed"
