"""What the files beside the packages say of the project agrees."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def test_citation_has_the_version_and_licence_of_the_project():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(r"(?m)^version: (\S+)$", citation)[1] == PROJECT["version"]
    # that of the code of the project itself; the distribution holds files of others too
    assert re.search(r"(?m)^license: (\S+)$", citation)[1] == PROJECT["license"].split(" AND ")[0]


def test_contributing_names_files_that_exist():
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    table = "\n".join(line for line in text.splitlines() if line.startswith("| a"))
    named = [name for name in re.findall(r"`([\w./]+/[\w./]*)`", table) if "NAME" not in name]
    assert len(named) >= 15
    assert [name for name in named if not (ROOT / name).exists()] == []


def test_check_runs_what_contributing_promises():
    check = (ROOT / ".ci" / "check").read_text(encoding="utf-8")
    tools = ("ruff check", "ruff format --check", "codespell", "mypy", "sphinx-build -q -W", "pytest")
    assert [tool for tool in tools if f".venv/bin/{tool}" not in check and f"-m {tool}" not in check] == []
    assert '.ci/environment --editable ".[test]"' in check


def test_the_installation_for_tests_has_all_extras():
    extras = PROJECT["optional-dependencies"]
    # those of large packages are installed alone, or by who needs them
    apart = ("test", "nastran")
    assert extras["test"][0] == f"ehdmaps[{','.join(name for name in extras if name not in apart)}]"
    check = (ROOT / ".ci" / "check").read_text(encoding="utf-8")
    assert f'--no-deps "{extras["nastran"][0]}"' in check


def test_pages_of_the_documentation_are_in_one_of_its_groups():
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    groups = re.findall(r"(?s)```\{toctree\}\n:caption: ([^\n]*)\n.*?\n\n(.*?)```", index)
    assert [title for title, _ in groups] == ["Getting started", "Guides", "Reference", "Evidence"]
    listed = [page for _, pages in groups for page in pages.split()]
    assert sorted(listed) == sorted({page.stem for page in (ROOT / "docs").glob("*.md")} - {"index"})
