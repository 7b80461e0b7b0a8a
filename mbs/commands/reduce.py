"""`mbs reduce`: reduce a finite-element body once, and write it to a file that scenes use."""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np

from ehdmaps.errors import InputError, Problems
from ehdmaps.outputs import Output, output_problems
from ehdmaps.units import LENGTH
from ehdmaps.version import version
from mbs.flexible.carry_out import read_model, reduce_model
from mbs.flexible.finite_elements import Extent, extent
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.reduced_file import REDUCED, write_reduced
from mbs.flexible.rigid_motion import Strained, strained
from mbs.scene.fields import HERTZ
from mbs.scene.flexible import read_body_file

_SHOWN = 30


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Read BODY.toml, reduce, write."""
    source, target = Path(arguments.body), Path(arguments.output or Path(arguments.body).with_suffix(".nc"))
    problems = Problems()
    plan = None
    with problems:
        plan = read_body_file(source)
    problems += output_problems([Output("-o", target, REDUCED)], [source, *(plan.files if plan else ())])
    if problems or plan is None:
        raise InputError(problems)
    began = time.process_time()
    model = read_model(plan)
    found = extent(model)
    reduced = reduce_model(plan, model, {"command": f"mbs reduce {source.name} -o {target.name}", **_versions()})
    seconds = time.process_time() - began
    as_one = strained(model)
    sentences = (*found.warnings(plan.units), *as_one.warnings())
    warnings = [f"warning: {source}: {words}" for words in sentences]
    write_reduced(target, reduced)
    return "\n".join([*_lines(reduced, found, as_one, source, seconds), *warnings, f"{target}: written"]), 0


def _lines(reduced: ReducedBody, found: Extent, as_one: Strained, source: Path, seconds: float) -> list[str]:
    """Lines on what was found."""
    squares = np.diag(reduced.stiffness)
    kept = [np.sqrt(squares[k]) / (2.0 * np.pi) for k, unit in enumerate(reduced.units) if unit == "1"]
    count = reduced.size - len(kept)
    lines = [
        f"{source}: {reduced.attributes['finite_element_freedoms']} degrees of freedom to {reduced.size}: {count} of "
        f"interfaces, {len(kept)} modes up to {reduced.attributes['cutoff']}; {seconds:.3g} s of processor time",
        f"{found.mass:.6g} kg without what fixed nodes have of it",
        f"{as_one.held.size} of {as_one.nodes} nodes are next to what is held",
        "",
        f"{'place':<20}{'x, mm':>12}{'y, mm':>12}{'z, mm':>12}",
    ]
    places = [("centre of mass", found.centre), ("box from", found.lower), ("box to", found.upper)]
    for name, position in [*places, *((name, frame.position) for name, frame in reduced.frames.items())]:
        lines.append(f"{name:<20}" + "".join(f"{LENGTH.value(value):>12.4f}" for value in position))
    lines += ["", "modes with all interfaces held:"]
    lines += [f"{k + 1:>6}  {HERTZ.text(value, 6)}" for k, value in enumerate(kept[:_SHOWN])]
    if len(kept) > _SHOWN:
        lines.append(f"        ... and {len(kept) - _SHOWN} more")
    return lines


def _versions() -> dict[str, str]:
    """Versions of what computed the reduction."""
    return {f"{package}_version": version(package) for package in ("ehdmaps", "numpy", "scipy")}
