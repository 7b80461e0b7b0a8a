"""What needs no compiled Python, and kernels as Python under NUMBA_DISABLE_JIT=1, for debuggers and for coverage."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

from ehdmaps.ehl.dense import factorised, solved

BEARING = ("bearing", "NU308", "--load", "5 kN", "--speed", "500 rpm", "--slices", "5", "--law")
COMMANDS = (
    (*BEARING, "map", "--map", "MAP"),
    ("bearing", "6208", "--load", "2 kN", "--speed", "1500 rpm", "--bands", "numerics"),
    ("sweep", "nu308_rigid", "--speed", "500 rpm", "900 rpm", "2", "--bands", "numerics"),
    ("hammer", "nu308_rigid", "--map", "MAP", "--films", "memory", "--hits", "1", "--duration", "10 ms", "-o", "h.uff"),
)
"""Kinds of bearings and of commands, with films of maps and of the film table, and a run in time."""


WITHOUT = """
import json, sys
sys.modules["numba"] = None  # whoever imports it gets an ImportError
from mbs import cli
print("FOUND", json.dumps([cli.main(command) for command in json.loads(sys.argv[1])]))
"""

LINES = """
import json, sys
seen = set()
def trace(frame, event, _):
    if frame.f_code.co_filename.endswith("ehdmaps/ehl/dense.py"):
        if event == "line":
            seen.add(frame.f_lineno)
        return trace
import numpy as np
import pytest
from ehdmaps.ehl.dense import factorised, solved
matrix, right = map(np.array, json.loads(sys.argv[1]))
sys.settrace(trace)
found = solved(factorised(matrix), right)
sys.settrace(None)
print("FOUND", json.dumps([len(seen), found.tolist()]))
"""


def told(program, given, folder, **environment):
    """What a program tells at its end."""
    result = subprocess.run(
        [sys.executable, "-c", program, json.dumps(given)],
        capture_output=True,
        check=False,
        text=True,
        env={**os.environ, **environment},
        cwd=folder,
    )
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout.rpartition("FOUND ")[2])


@pytest.mark.slow
def test_bearings_are_asked_without_numba(small_map, tmp_path):
    commands = [[small_map if word == "MAP" else word for word in command] for command in COMMANDS]
    assert told(WITHOUT, commands, tmp_path) == [0] * len(COMMANDS)


def test_a_kernel_in_python_gives_what_compiled_code_gives(tmp_path):
    """A debugger, or what measures coverage, sees its lines; a warning of numpy would be told to users."""
    random = np.random.default_rng(3)
    matrix, right = random.normal(size=(9, 9)), random.normal(size=9)
    given, python = (
        [matrix.tolist(), right.tolist()],
        {"NUMBA_DISABLE_JIT": "1", "PYTHONWARNINGS": "error::RuntimeWarning"},
    )
    lines, found = told(LINES, given, tmp_path, **python)
    assert lines > 10
    np.testing.assert_allclose(
        found, solved(factorised(matrix.copy()), right), rtol=1e-10
    )  # round-off, of the condition
