"""Builds the bodies of a scene: matrices of shafts, reduced finite elements. A body of the same content is built once.

Analyses compare several laws, clearances and loads on the same bodies. So bodies are known by what they are made
from, files included, and those of the last scenes are at hand.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from ehdmaps.errors import InputError
from mbs.flexible.attached import attach
from mbs.flexible.kept import file_digest, plan_key, reduced_body
from mbs.flexible.orientation import rotation_of
from mbs.flexible.plan import ReductionPlan, check_reduced
from mbs.flexible.reduced_body import ReducedBody, to_body
from mbs.flexible.reduced_file import read_reduced
from mbs.flexible.shaft import flexible_shaft
from mbs.model.body import Body, rigid_body
from mbs.scene.specs import BodySpec, FlexibleSpec, RigidSpec, ShaftSpec

MOST_AT_HAND = 64
"""Bodies."""


def build_bodies(specs: Iterable[BodySpec]) -> tuple[Body, ...]:
    """Build all bodies of a scene.

    Parameters
    ----------
    specs : iterable of RigidSpec, ShaftSpec, FlexibleSpec or Body
        What they are.

    Raises
    ------
    InputError
        With the problems of all bodies.
    AnalysisError
        If the modes or static shapes of a reduction are not found.
    """
    problems: list[str] = []
    bodies = []
    for spec in specs:
        try:
            bodies.append(build_body(spec))
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(problems)
    return tuple(bodies)


def build_body(spec: BodySpec) -> Body:
    """Build one body, or return it from before; its arrays are read-only.

    Parameters
    ----------
    spec : RigidSpec, ShaftSpec, FlexibleSpec or Body
        What it is. A `Body` is returned as it is.

    Raises
    ------
    InputError
        With everything that does not fit together.
    AnalysisError
        If the modes or static shapes of a reduction are not found.
    """
    if isinstance(spec, Body):
        return spec
    if not isinstance(spec, FlexibleSpec):
        return _built(_ByContent(repr(spec), spec))
    try:
        if isinstance(spec.source, ReducedBody):
            return _flexible(spec)
        rest = repr(dataclasses.replace(spec, source=Path()))
        return _built(_ByContent(f"{_content(spec.source)} {rest}", spec))
    except InputError as error:
        raise InputError([f"flexible body {spec.name!r}: {problem}" for problem in error.problems]) from error


@dataclass(frozen=True)
class _ByContent:
    """A spec that is known by its content: for a body from files, a hash of these."""

    content: str
    spec: RigidSpec | ShaftSpec | FlexibleSpec = field(compare=False)


@functools.lru_cache(maxsize=MOST_AT_HAND)
def _built(given: _ByContent) -> Body:
    """Build a body."""
    spec = given.spec
    if isinstance(spec, RigidSpec):
        body = rigid_body(spec.name, spec.parts, spec.freedoms, spec.position, spec.frames, spec.spin)
    elif isinstance(spec, ShaftSpec):
        body = flexible_shaft(
            spec.name,
            spec.sections,
            spec.discs,
            spec.freedoms,
            spec.position,
            spec.frames,
            spec.spin,
            spec.largest_element,
            spec.cutoff,
            spec.damping_ratio,
        )
    else:
        body = _flexible(spec)
    shared = (body.mass, body.gyroscopic, body.damping, body.stiffness)
    for array in (*shared, *(part for frame in body.frames.values() for part in (frame.position, frame.transform))):
        array.setflags(write=False)  # several systems have it
    return body


def _content(source: Path | ReductionPlan | ReducedBody) -> str:
    """Hash of what is in the files of a source."""
    if isinstance(source, ReductionPlan):
        return plan_key(source)
    assert isinstance(source, Path)
    check_reduced(source)
    return f"{source.suffix}:{file_digest(source)}"


def _flexible(spec: FlexibleSpec) -> Body:
    """Put a reduced body into the system, with what is fixed to it."""
    source = spec.source
    if isinstance(source, ReductionPlan):
        reduced = reduced_body(source)
    else:
        reduced = read_reduced(source) if isinstance(source, Path) else source
    turned = rotation_of(spec.rotation) if spec.rotation else None
    body = to_body(reduced, spec.name, spec.position, spec.damping_ratio, rotation=turned)
    return attach(body, spec.attached)
