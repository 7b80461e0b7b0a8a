"""`ehdmaps export --to c -o NAME.c`: the small table in C is the law of the map, as closely as it says."""

from __future__ import annotations

import ctypes
import math
import subprocess

import numpy as np
import pytest

from ehdmaps.jobs.cli import main
from ehdmaps.maps.emap import open_map
from tests.cases.programs import needed

HOSTILE = (math.nan, math.inf, -math.inf, 0.0, 1e300, -1e300, 1e-300)


@pytest.fixture(scope="module")
def small(small_map, tmp_path_factory):
    """The text, what was printed, and a call of the compiled table."""
    folder = tmp_path_factory.mktemp("small")
    path, library = folder / "small.c", folder / "small.so"
    assert main(["export", str(small_map), "--to", "c", "-o", str(path), "--prefix", "mine"]) == 0
    gcc = [needed("gcc"), "-std=c99", "-O2", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-shared", "-fPIC"]
    subprocess.run([*gcc, str(path), "-o", str(library), "-lm"], check=True)
    function = ctypes.CDLL(str(library)).mine_small
    function.argtypes = [ctypes.c_double] * 4 + [ctypes.c_void_p]

    def call(*arguments):
        result = np.empty(3)
        return function(*arguments, result.ctypes.data), result

    return path.read_text(encoding="utf-8"), call


def test_it_is_the_law(small, small_map):
    """At loads, speeds and temperatures of its own; the bar is that of real time, 1 % at 95 of 100 places."""
    text, call = small
    assert len(text) < 200e3 and "off the law of the map at 2000 places:" in text
    law = open_map(small_map).law("series", "clamp")
    rng, apart = np.random.default_rng(5), []
    (slow, fast), temperatures = law.speed_range, law.temperature_range
    for _ in range(300):
        u, T = float(np.exp(rng.uniform(np.log(slow), np.log(fast)))), float(rng.uniform(*temperatures))
        at = law.at(u, T)
        along = np.linspace(at.point.lift_off, at.point.held_approach, 400)
        load = np.exp(rng.uniform(np.log(law.load_range[0]), np.log(law.known_load(u, T))))
        approach = float(np.interp(load, at(along, 0.0)[0], along))
        status, found = call(approach, 0.0, u * rng.choice([-1.0, 1.0]), T)
        assert status == 0
        apart.append(np.abs(found / np.array(at(approach, 0.0)) - 1.0))
    assert np.all(np.quantile(apart, 0.95, axis=0) < 0.01)


def test_motion_is_that_of_the_law(small, small_map):
    """Load with damping while surfaces meet and part, none where they are apart."""
    _, call = small
    law = open_map(small_map).law("series")
    at = law.at(1.7, 313.15)
    for rate in (1e-4, -1e-4, -0.3):
        _, found = call(3e-6, rate, 1.7, 313.15)
        assert found[0] == pytest.approx(float(at(3e-6, rate)[0]), rel=0.02)  # twice the bar: of load and damping
    assert call(-1e-3, 0.0, 1.7, 313.15)[0] == 0 and not call(-1e-3, 0.0, 1.7, 313.15)[1].any()


def test_outside_it_refuses(small):
    _, call = small
    for place in range(4):
        for value in HOSTILE:
            arguments = [3e-6, 0.0, 1.7, 313.15]
            arguments[place] = value
            status, found = call(*arguments)
            assert np.isfinite(found).all() if status == 0 else np.isnan(found).all()
            assert status in (0, 1) and (status == 1 or place in (0, 1))


def test_what_a_small_table_has_not(small_map, tmp_path, capsys):
    path = tmp_path / "small.c"
    assert main(["export", str(small_map), "--to", "c", "-o", str(path), "--outside", "clamp"]) == 2
    assert "is a small table, which has no --centrifugal, and no --outside but error" in capsys.readouterr().err
    assert not path.exists()
