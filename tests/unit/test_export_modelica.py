"""`ehdmaps export --to modelica`: the numbers of the package are those of the law, and nothing else is written."""

from __future__ import annotations

import re

import numpy as np
import pytest

import ehdmaps
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.generate import generate
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.closed_form import FormulaSolver
from tests.cases.jobs import SMALL

AT = ("--speed", "0.7 m/s", "--temperature", "30 degC")


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("modelica") / "a.nc"
    generate(parse_job(SMALL, 'x"; end EhdContact; é\n', "map.toml"), path, workers=1, solver=FormulaSolver())
    return path


def number(text, name):
    return float(re.findall(rf"constant \w+ {name}(?:\(.*?\))? = (\S+?)[; ]", text)[0])


def test_the_table_gives_the_law(path, tmp_path, capsys):
    """The cubics by numpy, as a second reader of the text: 1e-12, round-off."""
    assert main(["export", str(path), "--to", "modelica", *AT, "-o", str(tmp_path / "a.mo")]) == 0
    text = (tmp_path / "a.mo").read_bytes().decode("ascii")
    assert "contact: series, entrainment speed 0.7 m/s, temperature 30 degC" in text
    table = text.split("cubic[")[1].split("{\n")[1].split('"')[0]
    cubics = np.array([row.split(",") for row in re.findall(r"\{([^{}]+)\}", table)], dtype=float)
    assert len(cubics) == number(text, "cells")
    highest = number(text, "highestApproach")
    approach = np.linspace(-1e-6, highest, 400)
    s = np.arcsinh((approach - number(text, "offset")) * number(text, "inverseScale"))
    x = np.clip((s - number(text, "start")) * number(text, "step"), 0.0, len(cubics))
    cell = np.minimum(x.astype(int), len(cubics) - 1)
    t = (x - cell)[:, None] ** np.arange(4)
    g, log_ratio = (np.sum(cubics[cell, first : first + 4] * t, axis=1) for first in (0, 4))
    load = np.maximum(g, 0.0) ** 3
    w, _, c = ehdmaps.open_map(path).law("series").at(0.7, 303.15)(approach, 0.0)
    np.testing.assert_allclose(load, w, rtol=1e-12, atol=1e-12 * w.max())
    np.testing.assert_allclose(load * np.exp(log_ratio), c, rtol=1e-12, atol=1e-12 * c.max())
    assert w[-1] == pytest.approx(1e6, rel=1e-9), "the table ends where the map ends"


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--temperature", "30 degC"), "--speed: missing"),
        (("--speed", "9 m/s", "--temperature", "30 degC"), "--speed: got '9 m/s'"),
        ((*AT, "--contact", "line"), "--contact: got 'line'"),
        ((*AT, "--name", "x; end"), "--name: got 'x; end'"),
        ((*AT, "--name", "model"), "--name: got 'model'"),
    ],
)
def test_what_is_refused(path, tmp_path, capsys, options, said):
    assert main(["export", str(path), "--to", "modelica", *options, "-o", str(tmp_path / "a.mo")]) == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "a.mo").exists()
