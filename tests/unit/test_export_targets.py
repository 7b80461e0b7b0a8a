"""Targets of `ehdmaps export`: how they are found, listed, and refused."""

import importlib.metadata

import pytest

from ehdmaps.exports import target
from ehdmaps.jobs.cli import main


def _with(monkeypatch, *points):
    found = importlib.metadata.EntryPoints(importlib.metadata.EntryPoint(*point, target.GROUP) for point in points)
    monkeypatch.setattr(target, "entry_points", lambda group: found.select(group=group))


def test_every_registered_target_loads_and_is_listed(capsys):
    assert main(["export", "--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == ["target", *target.registered()]
    for name in target.registered():
        assert target.find(name).summary


def test_a_target_of_another_package_is_found_by_its_entry_point(monkeypatch):
    _with(monkeypatch, ("mine", "ehdmaps.exports.csv:TARGET"))
    assert list(target.registered()) == ["mine"]
    assert target.find("mine") is target.find("mine")


@pytest.mark.parametrize(
    ("value", "says"),
    [("no.such.module:TARGET", "cannot be loaded"), ("ehdmaps.outputs:MARK", "is no target")],
)
def test_a_target_that_cannot_be_loaded_is_listed_with_the_reason(monkeypatch, capsys, value, says):
    _with(monkeypatch, ("broken", value))
    assert main(["export", "--list"]) == 0
    assert says in capsys.readouterr().out
    with pytest.raises(SystemExit, match="2"):
        main(["export", "map.nc", "--to", "broken"])
    assert says in capsys.readouterr().err


def test_an_unknown_target_and_a_missing_map_are_told(capsys):
    with pytest.raises(SystemExit, match="2"):
        main(["export", "map.nc", "--to", "rosss", "--load", "1 N"])
    assert "--to: got 'rosss'; allowed: " in capsys.readouterr().err
    assert main(["export", "--to", "csv"]) == 2
    assert "JOB: missing; allowed: a job or map, or --bearing" in capsys.readouterr().err
