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
    from mbs.scene.flexible import build_flexible, content_of

    try:
        content = content_of(spec.source)
        if content is None:
            return build_flexible(spec)
        rest = repr(dataclasses.replace(spec, source=Path()))
        return _built(_ByContent(f"{content} {rest}", spec))
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
        from mbs.scene.shafts.tables import build_shaft

        body = build_shaft(spec)
    else:
        from mbs.scene.flexible import build_flexible

        body = build_flexible(spec)
    shared = (body.mass, body.gyroscopic, body.damping, body.stiffness)
    for array in (*shared, *(part for frame in body.frames.values() for part in (frame.position, frame.transform))):
        array.setflags(write=False)  # several systems have it
    return body
