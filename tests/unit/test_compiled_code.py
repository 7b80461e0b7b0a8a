"""What compiled functions leave out because it takes seconds to compile, in every process that compiles anything."""

from __future__ import annotations

import ast
import time
from pathlib import Path

import pytest
from numba.core import event

from ehdmaps.compiling import stopwatch

ROOT = Path(__file__).parents[2]


def compiled(tree):
    """Functions that numba compiles."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and any("njit" in ast.unparse(each) for each in node.decorator_list):
            yield node


def one_number(value):
    """Whether a value is a number by its looks: written out, or a constant."""
    if isinstance(value, ast.UnaryOp):
        return one_number(value.operand)
    name = value.attr if isinstance(value, ast.Attribute) else getattr(value, "id", "")
    return isinstance(value, ast.Constant) or name in ("nan", "inf") or (name != "" and name == name.upper())


def slices_of_arrays(text):
    """Assignments of arrays to slices, with their lines."""
    for function in compiled(ast.parse(text)):
        for node in ast.walk(function):
            if not isinstance(node, (ast.Assign, ast.AugAssign)) or one_number(node.value):
                continue
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            parts = [part for target in targets for part in getattr(target, "elts", [target])]
            for part in parts:
                if isinstance(part, ast.Subscript) and any(isinstance(n, ast.Slice) for n in ast.walk(part.slice)):
                    yield f"line {node.lineno}: {ast.unparse(node)}"


FILES = sorted(
    path
    for room in ("ehdmaps", "mbs")
    for path in ROOT.glob(f"{room}/**/*.py")
    if "njit" in path.read_text(encoding="utf-8")
)


def test_no_array_is_assigned_to_a_slice():
    """numba compiles the text of a message about shapes for it; `ehdmaps.copies.put`, or a loop, does the same."""
    found = {str(path.relative_to(ROOT)): list(slices_of_arrays(path.read_text(encoding="utf-8"))) for path in FILES}
    assert len(found) > 10
    assert {path: lines for path, lines in found.items() if lines} == {}


@pytest.mark.parametrize("line", ["out[:] = row", "out[1:n], k = row, 1", "out[:, j] -= 2.0 * row"])
def test_it_finds_them(line):
    assert list(slices_of_arrays(f"@njit(cache=True)\ndef f(out, row, n, j):\n    {line}\n"))
    assert not list(slices_of_arrays(f"def f(out, row, n, j):\n    {line}\n"))


@pytest.mark.parametrize("line", ["out[:] = 0.0", "out[:, j] = -math.inf", "out[:] = PROBE", "out[j] = row[j]"])
def test_numbers_are_no_arrays(line):
    assert not list(slices_of_arrays(f"@njit\ndef f(out, row, j):\n    {line}\n"))


def test_time_of_compiling_is_no_time_of_solving():
    """Compiling is an event of numba; the times of its listener and of the watch are those of one clock."""
    import ehdmaps.compiled  # noqa: F401 - watches listen from its import on

    begin = time.process_time()
    watch = stopwatch()
    with event.trigger_event("numba:compile"):
        busy = time.process_time() + 0.05
        while time.process_time() < busy:
            pass
        during = watch()
    time.sleep(0.05)  # nor is waiting
    assert 0.0 <= during <= watch() <= time.process_time() - begin - 0.05
