"""What the project file, setup.py and README say of the distribution: files, licences, the text for an index."""

from __future__ import annotations

import importlib.util
import os
import re
import sys
import tomllib
import types
from importlib import metadata
from pathlib import Path

import pytest

from tests.cases.programs import needed, quick_compiler

ROOT = Path(__file__).parents[2]
TOLD = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PROJECT = TOLD["project"]
README = (ROOT / "README.md").read_text(encoding="utf-8")
CASES = "openfoam_cases"


@pytest.fixture(scope="module")
def setup():
    """Functions of setup.py."""
    specification = importlib.util.spec_from_file_location("ehdmaps_setup", ROOT / "setup.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def test_an_installation_has_the_whole_solver_in_the_same_folders(setup, tmp_path):
    """Each file that the build takes; places and rights are those of the clone."""
    setup.bring_cases(tmp_path)
    found = {path.relative_to(tmp_path) for path in tmp_path.rglob("*") if path.is_file()}
    sources = {
        path.relative_to(ROOT)
        for path in (ROOT / CASES / "ehlFoam").rglob("*")
        if path.suffix in (".C", ".H") or path.parts[-2:] in (("Make", "files"), ("Make", "options"))
    }
    assert len(sources) > 70
    assert sources <= found
    for path in found:
        assert (ROOT / path).read_bytes() == (tmp_path / path).read_bytes()
        assert (ROOT / path).stat().st_mode == (tmp_path / path).stat().st_mode
    top = {path.name for path in (ROOT / CASES).iterdir() if path.is_file()}
    assert {path.name for path in found if path.parent == Path(CASES)} == top == {"build", "COPYING", "README.md"}
    assert {path.parts[1] for path in found} - top == {"ehlFoam", "lineContact"}


def test_licences_are_named_with_their_texts():
    texts = [(ROOT / name).read_text(encoding="utf-8") for name in PROJECT["license-files"]]
    assert PROJECT["license"].split(" AND ") == ["BSD-3-Clause", "BSD-2-Clause", "GPL-3.0-or-later"]
    for text, head in zip(texts, ("BSD 3-Clause License", "2-Clause BSD License", "GNU GENERAL PUBLIC"), strict=True):
        assert head in text[:400]
    assert f'"{PROJECT["license"]}"' in README
    build = TOLD["build-system"]["requires"]
    assert build == ["setuptools>=77.0.3"]  # older ones refuse the expression
    assert not [entry for entry in PROJECT["classifiers"] if entry.startswith("License")]  # refused beside it
    assert "GNU General Public License, version 3 or later" in (ROOT / CASES / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "header", sorted((ROOT / "ehdmaps/exports/fmu/headers").glob("*.h")), ids=lambda path: path.name
)
def test_the_licence_of_the_fmi_headers_is_the_one_that_each_carries(header):
    whole = " ".join((header.parent / "LICENSE").read_text(encoding="utf-8").split())
    carried = " ".join(header.read_text(encoding="utf-8").split())
    start = "Redistribution and use in source"
    length = len(whole) - whole.index(start)
    assert carried[carried.index(start) :][:length] == whole[whole.index(start) :]


_APART = {"nastran": "pyNastran"}
"""Packages of extras that tests do not install, which tell their licence where they are there."""


def test_packages_of_extras_under_the_gpl_are_those_that_readme_names():
    """By what the installed packages say of themselves; extras for tests and documentation are not shipped with it."""
    extras = PROJECT["optional-dependencies"]
    named = {
        extra: [re.match(r"[\w-]+", entry)[0] for entry in entries if not entry.startswith("ehdmaps[")]
        for extra, entries in extras.items()
        if extra not in ("test", "docs") and importlib.util.find_spec(_APART.get(extra, "ehdmaps")) is not None
    }
    under_gpl = set()
    for extra, packages in {"": [re.match(r"[\w-]+", entry)[0] for entry in PROJECT["dependencies"]], **named}.items():
        for package in packages:
            told = metadata.metadata(package)
            fields = [told.get_all(field, []) for field in ("License-Expression", "License", "Classifier")]
            stated = [text[:80] for field in fields for text in field]
            if any(re.search(r"\bA?GPL|GNU General", text) for text in stated):
                under_gpl.add((extra, package))
    assert under_gpl == {("openfoam", "PyFoam"), ("solids", "gmsh")}
    section = README.split("## Licences")[1]
    for extra, package in under_gpl:
        assert package in section and f"`{extra}`" in section
    assert "ehdmaps[flexible,solids]" in extras["housings"] and "`housings`" in section


def test_authors_and_keywords_are_those_of_the_citation():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    for author in PROJECT["authors"]:
        assert f'- name: "{author["name"]}"' in citation
    for word in PROJECT["keywords"]:
        assert f"- {word}\n" in citation


@pytest.fixture
def on_an_index(setup):
    """Function of setup.py."""
    return setup.on_an_index


def test_readme_on_an_index_has_nothing_that_is_relative(on_an_index):
    text = on_an_index(README)
    assert re.findall(r"\]\((?!https?:|#)[^)]*\)", text) == []
    assert "<!--" not in text and "![" not in text
    for block in re.findall(r"^```.*?^```$", README, flags=re.MULTILINE | re.DOTALL):
        assert block in text
    kept = [line for line in README.splitlines() if not re.search(r"\]\(|<!--", line)]
    assert set(kept) <= set(text.splitlines())


@pytest.mark.parametrize(
    ("given", "wanted"),
    [
        ("see [the page](docs/a.md).", "see the page (`docs/a.md`)."),
        ("[`docs/a.md`](docs/a.md#part): words", "`docs/a.md`: words"),
        ("[site](https://example.org/x) and [below](#there)", "[site](https://example.org/x) and [below](#there)"),
        ("![wide, with words](a/b.png)\n\nnext", "next"),
        ("![far](https://example.org/x.png)", "![far](https://example.org/x.png)"),
        ("<!-- figures -->\none\n<!-- end -->\ntwo", "one\ntwo"),
        ("```\n[a](b) <!-- c -->\n```\n", "```\n[a](b) <!-- c -->\n```"),
    ],
)
def test_links_and_pictures_on_an_index(on_an_index, given, wanted):
    assert on_an_index(given).startswith(f"{wanted}\n\nFiles that are named here")


@pytest.mark.parametrize(
    ("plain", "needed", "wanted"),
    [
        ("linux_x86_64", b"\0GLIBC_2.2.5\0GLIBC_2.14\0", "manylinux_2_17_x86_64"),
        ("linux_aarch64", b"\0GLIBC_2.17\0", "manylinux_2_17_aarch64"),
        ("linux_x86_64", b"\0GLIBC_2.2.5\0GLIBC_2.29\0", "linux_x86_64"),
        ("linux_x86_64", b"of another C library", "linux_x86_64"),
        ("macosx_14_0_arm64", b"", "macosx_14_0_arm64"),
    ],
)
def test_the_platform_of_a_wheel(setup, plain, needed, wanted):
    assert setup.platform_tag(plain, needed) == wanted


def test_a_build_asks_for_a_compiler_only_where_there_is_none(monkeypatch, tmp_path):
    needed("gcc", "clang")
    standard = types.ModuleType("setuptools.build_meta")
    for name in ("build_editable", "build_sdist", "build_wheel", "get_requires_for_build_sdist"):
        setattr(standard, name, None)
    for kind in ("wheel", "editable"):
        setattr(standard, f"get_requires_for_build_{kind}", lambda settings: ["setuptools' own"])
        setattr(standard, f"prepare_metadata_for_build_{kind}", None)
    whole = types.ModuleType("setuptools")
    whole.build_meta = standard
    monkeypatch.setitem(sys.modules, "setuptools", whole)
    monkeypatch.setitem(sys.modules, "setuptools.build_meta", standard)
    backend = TOLD["build-system"]["build-backend"]
    specification = importlib.util.spec_from_file_location(backend, ROOT / f"{backend}.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    assert TOLD["build-system"]["backend-path"] == ["."]
    asks = (module.get_requires_for_build_wheel, module.get_requires_for_build_editable)
    assert [ask() for ask in asks] == [["setuptools' own"]] * 2
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert [ask() for ask in asks] == [["setuptools' own", "ziglang>=0.13,<1"]] * 2


def test_the_library_is_built_into_a_folder(setup, tmp_path, monkeypatch):
    monkeypatch.setenv("CC", quick_compiler(tmp_path))
    (tmp_path / "ehdmaps" / "kernel").mkdir(parents=True)
    path = setup.build_library(tmp_path)
    assert path.parent == tmp_path / "ehdmaps" / "kernel" and os.access(path, os.R_OK)
