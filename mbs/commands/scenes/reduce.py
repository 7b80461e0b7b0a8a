"""`mbs reduce`: reduce a finite-element body, or a mesh, once, and write it to a file that scenes use."""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np

from ehdmaps.errors import InputError, Problems
from ehdmaps.outputs import Output, output_problems
from ehdmaps.units import LENGTH
from ehdmaps.version import version
from mbs.commands.common import out_of_place
from mbs.commands.scenes.reduce_mesh import reduced_mesh
from mbs.flexible.carry_out import read_model, reduce_model
from mbs.flexible.finite_elements import Extent, FiniteElementModel, extent
from mbs.flexible.plan import ReductionPlan
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.reduced_file import REDUCED, write_reduced
from mbs.flexible.rigid_motion import Strained, strained
from mbs.flexible.solid_mesh import MESHES
from mbs.scene.fields import HERTZ
from mbs.scene.flexible import read_body_file

_SHOWN = 30


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Read BODY.toml or a mesh, reduce, write."""
    source = Path(arguments.body)
    target = Path(arguments.output or source.with_suffix(".nc"))
    began = time.process_time()
    if source.suffix.lower() in MESHES:
        plan, model, reduced, said = reduced_mesh(arguments)
        words = ""
    else:
        plan, model, reduced = _reduced_file(source, target, arguments)
        said, words = [], f"; {time.process_time() - began:.3g} s of processor time"
    found = extent(model)
    as_one = strained(model)
    sentences = (*found.warnings(plan.units), *as_one.warnings())
    warnings = [f"warning: {source}: {sentence}" for sentence in sentences]
    write_reduced(target, reduced)
    return "\n".join([*said, *_lines(reduced, found, as_one, source, words), *warnings, f"{target}: written"]), 0


def _reduced_file(
    source: Path, target: Path, arguments: argparse.Namespace
) -> tuple[ReductionPlan, FiniteElementModel, ReducedBody]:
    """Reduce what a file in TOML says."""
    problems = Problems()
    of_meshes = ("seat", "foot", "point", "units", "material", "cutoff")
    problems += out_of_place(arguments, of_meshes, f"stands beside {source}, which says it; allowed: with a mesh")
    plan = None
    with problems:
        plan = read_body_file(source)
    problems += output_problems([Output("-o", target, REDUCED)], [source, *(plan.files if plan else ())])
    if problems or plan is None:
        raise InputError(problems)
    model = read_model(plan)
    about = {"command": f"mbs reduce {source.name} -o {target.name}", **_versions()}
    return plan, model, reduce_model(plan, model, about)


def _lines(reduced: ReducedBody, found: Extent, as_one: Strained, source: Path, words: str) -> list[str]:
    """Lines on what was found."""
    squares = np.diag(reduced.stiffness)
    kept = [np.sqrt(squares[k]) / (2.0 * np.pi) for k, unit in enumerate(reduced.units) if unit == "1"]
    count = reduced.size - len(kept)
    lines = [
        f"{source}: {reduced.attributes['finite_element_freedoms']} degrees of freedom to {reduced.size}: {count} of "
        f"interfaces, {len(kept)} modes up to {reduced.attributes['cutoff']}{words}",
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
