"""Kernels as Python under NUMBA_DISABLE_JIT=1, for debuggers and for coverage: the same numbers, lines to stop at."""

import json
import math
import os
import subprocess
import sys

import netCDF4
import numpy as np
import pytest

import ehdmaps
from ehdmaps.compiled import in_python
from ehdmaps.maps.kernels.lines import log
from mbs import cli

# Off the symmetry, where a displacement is rounding, and with clearance: of a roller just where contact begins the
# stiffness hangs on the last digit.
LOADED = ("--load", "5 kN", "--direction", "7 deg", "--speed", "500 rpm", "--clearance", "20 um", "--slices", "5")
BEARING = ("bearing", "NU308", *LOADED, "--law")
COMMANDS = {
    "hertz": (*BEARING, "hertz", "-o", "hertz.nc"),
    "map": (*BEARING, "map", "--map", "MAP", "-o", "map.nc"),
    "statics": ("statics", "nu308_rigid", "--law", "hertz:1.25e-5 s", "--clearance", "20 um", "-o", "statics.nc"),
}
POINT = (2e-6, 1e-4, 1.2, 310.0)
KERNELS = ("ehdmaps/maps/kernels/lines.py",)

PROGRAM = """
import json, sys
lines = {name: set() for name in sys.argv[2:]}
def trace(frame, event, _):
    for name, seen in lines.items():
        if frame.f_code.co_filename.endswith(name):
            if event == "line":
                seen.add(frame.f_lineno)
            return trace
sys.settrace(trace)
import ehdmaps
from mbs import cli
given = json.loads(sys.argv[1])
status = [cli.main(command) for command in given["commands"]]
found = [float(value) for value in ehdmaps.open_map(given["map"]).law("series")(*given["point"])]
from ehdmaps.maps.kernels.lines import exp, log
exp(log(2.0))
print("FOUND", json.dumps([status, found, {name: len(seen) for name, seen in lines.items()}]))
"""


def numbers(path):
    """All numbers of a file, in a row for each variable."""
    with netCDF4.Dataset(path) as file:
        return {
            name: np.ma.filled(v[...], np.nan)
            for name, v in file.variables.items()
            if v.dtype is not str and v.dtype.kind == "f"
        }


def test_commands_and_a_law_in_python_give_what_compiled_code_gives(small_map, tmp_path, monkeypatch, capsys):
    commands = [[small_map if word == "MAP" else word for word in command] for command in COMMANDS.values()]
    (tmp_path / "python").mkdir()
    asked = json.dumps({"commands": commands, "map": small_map, "point": POINT})
    # A warning of numpy, on an overflow that compiled code knows nothing of, would be told to users.
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONWARNINGS": "error::RuntimeWarning"}
    result = subprocess.run(
        [sys.executable, "-c", PROGRAM, asked, *KERNELS],
        capture_output=True,
        check=False,
        text=True,
        env=environment,
        cwd=tmp_path / "python",
    )
    assert result.returncode == 0, result.stderr
    status, law, lines = json.loads(result.stdout.rpartition("FOUND ")[2])
    assert status == [0, 0, 0]
    # A debugger, or what measures coverage, sees the lines of the kernels.
    assert min(lines.values()) > 10, lines
    np.testing.assert_allclose(law, ehdmaps.open_map(small_map).law("series")(*POINT), rtol=1e-12)
    monkeypatch.chdir(tmp_path)
    for name, command in zip(COMMANDS, commands, strict=True):
        assert cli.main(command) == 0
        before, after = numbers(f"{name}.nc"), numbers(f"python/{name}.nc")
        assert before.keys() == after.keys()
        for key, value in before.items():
            # round-off of other orders of summation, after Newton iterations that end within 1e-10
            scale = np.nanmax(np.abs(value), initial=0.0) + 1e-6  # moments by symmetry are 1e-17 N m; films 1e-7 m
            np.testing.assert_allclose(after[key], value, rtol=1e-8, atol=1e-9 * scale, err_msg=f"{name}: {key}")


@pytest.mark.parametrize("x", [2.3e-308, 1e-9, 0.7, math.sqrt(0.5), 1.0, 1.5, 6e7, 1.7e308])
def test_logarithms_in_python_are_those_of_compiled_code(x):
    assert in_python(log)(x) == pytest.approx(log(x), rel=1e-15, abs=1e-15)  # warnings, of overflows, are errors
    assert log(x) == pytest.approx(math.log(x), rel=1e-15, abs=4e-16)
