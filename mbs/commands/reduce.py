"""`mbs reduce`: reduce a finite-element body once, and write it to a file that scenes use."""

from __future__ import annotations

import argparse
import time
import tomllib
from pathlib import Path

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.jobs.table import Table
from ehdmaps.units import LENGTH
from ehdmaps.version import version
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.reduced_file import SUFFIXES, write_reduced
from mbs.reading.fields import HERTZ
from mbs.reading.flexible import Reduction, read_reduction
from mbs.scene_reader import LONGEST_FILE

_SHOWN = 30


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Read BODY.toml, reduce, write."""
    source, target = Path(arguments.body), Path(arguments.output or Path(arguments.body).with_suffix(".nc"))
    problems = []
    if target.suffix not in SUFFIXES or not target.parent.is_dir():
        problems.append(f"-o: got {target}; allowed: a {' or '.join(SUFFIXES)} file in a folder that is there")
    plan = None
    try:
        plan = read_body_file(source)
    except InputError as error:
        problems += error.problems
    if problems or plan is None:
        raise InputError(problems)
    began = time.perf_counter()
    reduced = plan.carry_out({"command": f"mbs reduce {source.name} -o {target.name}", **_versions()})
    seconds = time.perf_counter() - began
    write_reduced(target, reduced)
    return "\n".join([*_lines(reduced, source, seconds), f"{target}: written"]), 0


def read_body_file(path: Path) -> Reduction:
    """Read a file that says what is reduced and how.

    Parameters
    ----------
    path : Path
        TOML with the keys of a `[[flexible]]` table that has matrices, at top level.

    Raises
    ------
    InputError
        With every problem found, each beginning with the path.
    """
    try:
        with path.open("rb") as file:
            head = file.read(LONGEST_FILE + 1)
        values = tomllib.loads(head[: LONGEST_FILE + 1].decode("utf-8"))
    except (OSError, UnicodeDecodeError, ValueError, RecursionError) as error:
        raise InputError(f"{path}: cannot be read as TOML ({error}); allowed: a body file") from error
    problems: list[str] = []
    top = Table(values, "body file", problems)
    plan = read_reduction(top, path.parent)
    # What is an assumption concerns the reader of the file only.
    top.get("assumed")
    top.close()
    if problems or plan is None:
        raise InputError([f"{path}: {problem}" for problem in problems])
    return plan


def _lines(reduced: ReducedBody, source: Path, seconds: float) -> list[str]:
    """What was found."""
    squares = np.diag(reduced.stiffness)
    kept = [np.sqrt(squares[k]) / (2.0 * np.pi) for k, unit in enumerate(reduced.units) if unit == "1"]
    count = reduced.size - len(kept)
    lines = [
        f"{source}: {reduced.attributes['finite_element_freedoms']} degrees of freedom to {reduced.size}: {count} of "
        f"interfaces, {len(kept)} modes up to {reduced.attributes['cutoff']}; {seconds:.3g} s",
        "",
        f"{'place':<20}{'x, mm':>12}{'y, mm':>12}{'z, mm':>12}",
    ]
    for name, frame in reduced.frames.items():
        lines.append(f"{name:<20}" + "".join(f"{LENGTH.value(value):>12.4f}" for value in frame.position))
    lines += ["", "modes with all interfaces held:"]
    lines += [f"{k + 1:>6}  {HERTZ.text(value, 6)}" for k, value in enumerate(kept[:_SHOWN])]
    if len(kept) > _SHOWN:
        lines.append(f"        ... and {len(kept) - _SHOWN} more")
    return lines


def _versions() -> dict[str, str]:
    """Versions of what computed the reduction."""
    return {f"{package}_version": version(package) for package in ("ehdmaps", "numpy", "scipy")}
