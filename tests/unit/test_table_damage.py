"""Damaged files of both film tables: read as what they are or refused in one sentence, never a traceback."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.jobs.cli import main
from ehdmaps.table.file import SHIPPED, shipped_tables
from ehdmaps.table.nodes import nodes_problem
from ehdmaps.table.points import file as points
from examples.tables.files import write_tables

TABLE = Path(points.__file__).parents[1] / SHIPPED
POINTS = Path(points.__file__).parent / points.SHIPPED

AXES = [np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0])]
VALUES, CODES = np.ones((3, 2, 4), dtype=np.float32), np.zeros((2, 1, 5), dtype=np.uint8)


def _shown(path: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """Message of `table show` of a file that is refused."""
    assert main(["table", "show", str(path)]) == 2
    streams = capsys.readouterr()
    assert streams.out == ""
    assert "Traceback" not in streams.err
    return streams.err


@pytest.mark.parametrize("source", [TABLE, POINTS])
@pytest.mark.parametrize("share", [0.0, 1e-4, 0.02, 0.5, 0.999])
def test_a_truncated_table(source: Path, share: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    whole, cut = source.read_bytes(), tmp_path / "cut.nc"
    cut.write_bytes(whole[: int(share * len(whole))])
    assert f"{cut}: cannot be read as a film table" in _shown(cut, capsys)


@pytest.mark.parametrize("source", [TABLE, POINTS])
def test_a_table_with_wrong_bytes(source: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Bytes of the head, of a packed variable and at the end, each of which the libraries trip over elsewhere."""
    whole, damaged = source.read_bytes(), tmp_path / "damaged.nc"
    for place in (9, 48, 300, len(whole) // 3, len(whole) // 2, len(whole) - 40):
        damaged.write_bytes(
            whole[:place] + bytes(255 - byte for byte in whole[place : place + 24]) + whole[place + 24 :]
        )
        code = main(["table", "show", str(damaged)])
        err = capsys.readouterr().err
        # bytes that no reader needs may stand for anything
        assert code == 0 or (code == 2 and str(damaged) in err and "make it again" in err), (place, err)


def test_a_table_that_holds_no_numbers(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Its checksum is right: whoever wrote it wrote that."""
    tables = shipped_tables()
    one = tables.tables["incompressible"]
    values = one.isoviscous.values.copy()
    values[3, 0, 0, 0, 2] = np.nan
    spoilt = replace(one, isoviscous=replace(one.isoviscous, values=values))
    write_tables(tmp_path / "nan.nc", replace(tables, tables={"incompressible": spoilt}))
    assert "nan.nc: holds values that are no finite numbers; make it again" in _shown(tmp_path / "nan.nc", capsys)


@pytest.mark.parametrize(
    ("axes", "values", "codes", "problem"),
    [
        (AXES, VALUES, CODES, ""),
        (AXES, VALUES[:2], CODES, "2 x 2 x 4 numbers where its axes have 3 x 2 x 4"),
        (AXES, VALUES, CODES[:, :, :4], "2 x 1 x 4 numbers where its axes have 2 x 1 x 5"),
        ([AXES[0][::-1], AXES[1]], VALUES, CODES, "an axis that does not rise from number to number"),
        ([np.array([0.0, np.nan, 2.0]), AXES[1]], VALUES, CODES, "an axis that does not rise from number to number"),
        (AXES, VALUES, CODES.astype(float), "numbers of another type"),
        (AXES, np.full_like(VALUES, np.inf), CODES, "values that are no finite numbers"),
    ],
)
def test_numbers_that_make_no_table(axes, values, codes, problem):
    assert nodes_problem(axes, values, 4, codes, 5) == problem
