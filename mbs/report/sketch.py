"""Sketch of the machine of a report, to scale, seen along z or y: shafts, discs, gears, bearings, housings, masses."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.report.chart import number
from ehdmaps.report.page import Markup, joined, pairs, tag
from ehdmaps.units import LENGTH
from mbs.flexible.shaft_parts import Disc
from mbs.model.body import Body, Inertia
from mbs.model.elements import GROUND
from mbs.model.system import System, load_by_gravity
from mbs.scene.assembly import Model
from mbs.scene.specs import RigidSpec, ShaftSpec

_WIDTH, _EDGE, _LINE = 860.0, 26.0, 14.0
"""Width of the drawing, its margin, and height of a line of text [px]."""

_TALLEST = 560.0
"""Height that a drawing may have [px]."""

_MARK = 5.0
"""Size of the mark of a rigid body, of which no dimensions are known [px]."""

_HARDLY = 1e-9
"""Mass of a body below which none is told [kg]."""


def sketch(model: Model) -> Markup:
    """Return the drawing with the masses of all bodies.

    Parameters
    ----------
    model : Model
        The machine.
    """
    shapes, names = list(_shapes(model)), list(_names(model))
    outline = np.concatenate([np.zeros((0, 2)), *(points for points, _, _ in shapes), *([place] for place, _ in names)])
    if not len(outline):
        return pairs(_masses(model))
    low, high = outline.min(axis=0), outline.max(axis=0)
    span = np.maximum(high - low, 1e-6)
    scale = min((_WIDTH - 2.0 * _EDGE) / span[0], _TALLEST / span[1])
    height = scale * span[1] + 2.0 * _EDGE + 3.0 * _LINE
    left = 0.5 * (_WIDTH - scale * span[0])

    def at(points: FloatArray) -> FloatArray:
        return np.column_stack([left + scale * (points[:, 0] - low[0]), _EDGE + scale * (high[1] - points[:, 1])])

    parts = [tag("path", tag("title", words), d=_path(at(points)), class_=kind) for points, kind, words in shapes]
    taken: list[tuple[float, float, float, float]] = []
    for place, name in names:
        x, y = at(np.array([place]))[0].tolist()
        y += 0.9 * _LINE
        size = 6.2 * len(name)
        while any(abs(x - a) < 0.5 * (size + b) and abs(y - c) < d for a, c, b, d in taken):
            y += _LINE
        taken.append((x, y, size, _LINE))
        parts.append(tag("text", name, x=f"{x:.1f}", y=f"{y:.1f}", text_anchor="middle"))
    height = max(height, *(y + 2.0 * _LINE for _, y, _, _ in taken)) if taken else height
    bar = 10.0 ** math.floor(math.log10(0.4 * span[0]))
    bottom = height - 0.6 * _LINE
    parts += [
        tag("path", d=f"M{_EDGE:g} {bottom:.1f}h{scale * bar:.1f}", class_="outline"),
        tag("text", LENGTH.text(bar), x=f"{_EDGE + scale * bar + 6.0:.1f}", y=f"{bottom + 4.0:.1f}"),
    ]
    across = "yz"[_across(model) - 1]
    return joined(
        tag(
            "figure",
            tag("figcaption", f"The machine to scale, x to the right, {across} upwards"),
            tag("p", "Discs and rigid bodies are drawn as the cylinders that have their inertia.", class_="says"),
            tag(
                "svg", *parts, viewBox=f"0 0 {_WIDTH:g} {height:.0f}", role="img", aria_label="sketch", class_="sketch"
            ),
            class_="single",
        ),
        pairs(_masses(model)),
    )


def _across(model: Model) -> int:
    """Axis that is drawn upwards: that along which shafts are further apart, y if none are."""
    places = np.array([spec.position for spec in model.scene.bodies if isinstance(spec, ShaftSpec | RigidSpec)])
    spread = np.ptp(places, axis=0) if places.size else np.zeros(3)
    return 2 if spread[2] > spread[1] else 1


def _shapes(model: Model) -> Iterator[tuple[FloatArray, str, str]]:
    """Yield the outlines, each with its class and what it is, the hindmost first."""
    axis = _across(model)
    bodies = {body.name: body for body in model.system.bodies}
    for spec in model.scene.bodies:
        body = bodies[spec.name]
        if not isinstance(spec, ShaftSpec | RigidSpec):
            yield from _of_elements(body, axis)
    for spec in model.scene.bodies:
        if not isinstance(spec, ShaftSpec):
            continue
        x, y = spec.position[0], spec.position[axis]
        for part in spec.sections:
            words = f"{spec.name}: {LENGTH.text(part.diameter)}"
            first, last = (part.bore, part.diameter), (part.last_bore, part.last_diameter)
            yield from _turned(x + part.begin, x + part.end, y, first, last, "shaft", words)
        for begin, end, bore, diameter in map(partial(ring_of, spec), spec.discs):
            both = bore, diameter
            yield from _turned(x + begin, x + end, y, both, both, "disc", f"{spec.name}: a disc")
    for spec in model.scene.bodies:
        if isinstance(spec, RigidSpec):
            yield from _rigid(spec, axis)
    for gear in model.scene.gears:
        for place, teeth in zip((gear.on, gear.against), gear.teeth, strict=True):
            if place != GROUND:
                x, y = _seen(model.system, place, axis)
                half, size = 0.5 * gear.face_width, teeth * gear.module / math.cos(gear.helix_angle)
                words = f"{gear.name}: {teeth} teeth"
                yield from _turned(x - half, x + half, y, (0.0, size), (0.0, size), "gear", words)
    for bearing in model.scene.of_all_kinds:
        x, y = _seen(model.system, bearing.inner if bearing.inner != GROUND else bearing.outer, axis)
        yield from _elements(bearing.geometry, x, y, f"{bearing.name}: {bearing.geometry.title}")


def _rigid(spec: RigidSpec, axis: int) -> Iterator[tuple[FloatArray, str, str]]:
    """Yield the parts of a rigid body that have moments of inertia."""
    for part in spec.parts:
        like = _like(part, 0.0)
        if like is not None:
            middle, both = spec.position[0] + part.offset, (0.0, like[1])
            begin, end = middle - 0.5 * like[0], middle + 0.5 * like[0]
            yield from _turned(begin, end, spec.position[axis], both, both, "disc", spec.name)


def ring_of(spec: ShaftSpec, disc: Disc) -> tuple[float, float, float, float]:
    """Ring on a shaft that has the mass and the moments of inertia of a disc: begin, end, bore and diameter [m].

    Parameters
    ----------
    spec : ShaftSpec
        The shaft, whose diameter there is the bore.
    disc : Disc
        The disc; of a point mass the ring has no length.
    """
    at = [part.diameters(disc.position)[0] for part in spec.sections if part.begin <= disc.position <= part.end]
    bore, middle = max(at, default=0.0), disc.position + disc.inertia.offset
    length, diameter = _like(disc.inertia, bore) or (0.0, bore)
    return middle - 0.5 * length, middle + 0.5 * length, bore, diameter


def _like(part: Inertia, bore: float) -> tuple[float, float] | None:
    """Length and diameter of the hollow cylinder of a bore that has some moments of inertia [m]; None without any."""
    if not part.polar > 0.0:
        return None
    length = math.sqrt(max(12.0 * (part.transverse - 0.5 * part.polar) / part.mass, 0.0))
    return length, 2.0 * math.sqrt(max(2.0 * part.polar / part.mass - 0.25 * bore**2, 0.25 * bore**2))


def _of_elements(body: Body, axis: int) -> Iterator[tuple[FloatArray, str, str]]:
    """Yield the outline of a body of finite elements, or of matrices: the hull of its surface, or of its places."""
    from scipy.spatial import ConvexHull, QhullError  # here alone

    places = body.skin.positions if body.skin is not None else np.array([f.position for f in body.frames.values()])
    flat = places.reshape(-1, 3)[:, [0, axis]]
    with contextlib.suppress(QhullError, ValueError):  # on a line: drawn as one
        flat = flat[ConvexHull(flat).vertices]
    if len(flat):
        yield flat, "housing", body.name


def _turned(
    begin: float, end: float, y: float, first: tuple[float, float], last: tuple[float, float], kind: str, words: str
) -> Iterator[tuple[FloatArray, str, str]]:
    """Yield both halves of what turns about an axis: bores and diameters at its ends."""
    for side in (1.0, -1.0):
        heights = [y + 0.5 * side * value for value in (first[0], first[1], last[1], last[0])]
        yield np.column_stack([[begin, begin, end, end], heights]), kind, words


def _elements(geometry: Any, x: float, y: float, words: str) -> Iterator[tuple[FloatArray, str, str]]:
    """Yield the rolling elements above and below the axis: balls as circles, rollers as they lean."""
    pitch = float(geometry.pitch_diameter)
    ball = getattr(geometry, "ball_diameter", None)
    turns = np.linspace(0.0, 2.0 * np.pi, 25)
    for side in (1.0, -1.0):
        middle = np.array([x, y + 0.5 * side * pitch])
        if ball is not None:
            yield middle + 0.5 * ball * np.column_stack([np.cos(turns), np.sin(turns)]), "element", words
            continue
        length, size = geometry.roller_length, geometry.roller_diameter
        corners = 0.5 * np.array([[-length, -size], [length, -size], [length, size], [-length, size]])
        lean = side * math.copysign(math.acos(min(geometry.lean, 1.0)), getattr(geometry, "contact_angle", 1.0))
        turn = np.array([[math.cos(lean), -math.sin(lean)], [math.sin(lean), math.cos(lean)]])
        yield middle + corners @ turn.T, "element", words


def _seen(system: System, place: str, axis: int) -> tuple[float, float]:
    """A place in the drawing [m]."""
    body, _, frame = place.partition(":")
    position = system.body(body).frames[frame or "centre"].position
    return float(position[0]), float(position[axis])


def _names(model: Model) -> Iterator[tuple[tuple[float, float], str]]:
    """Yield names with their places: bearings below their elements, rigid bodies at their positions."""
    axis = _across(model)
    for bearing in model.scene.of_all_kinds:
        x, y = _seen(model.system, bearing.inner if bearing.inner != GROUND else bearing.outer, axis)
        geometry: Any = bearing.geometry
        size = getattr(geometry, "ball_diameter", None) or geometry.roller_diameter
        yield (x, y - 0.5 * (geometry.pitch_diameter + size)), bearing.name
    for spec in model.scene.bodies:
        if isinstance(spec, RigidSpec):
            yield (spec.position[0], spec.position[axis]), f"● {spec.name}"


def _masses(model: Model) -> Iterator[tuple[str, str]]:
    """Yield the mass of each body in words."""
    for spec in model.scene.bodies:
        if isinstance(spec, ShaftSpec):
            shaft, discs = sum(part.mass for part in spec.sections), sum(disc.inertia.mass for disc in spec.discs)
            of_discs = f", {number(discs, 3)} kg of it discs" if discs else ""
            yield spec.name, f"{number(shaft + discs, 4)} kg{of_discs}"
        else:
            parts = spec.parts if isinstance(spec, RigidSpec) else ()
            mass = sum(part.mass for part in parts) or _mass(model.system.body(spec.name))
            yield spec.name, f"{number(mass, 4)} kg" if mass > _HARDLY else "mass not known"


def _mass(body: Body) -> float:
    """Mass of a body of matrices, by the load of gravity on it [kg]; 0 where that is not known."""
    load = load_by_gravity(body)
    if load is None:
        return 0.0
    return float(np.max(np.diag(load.T @ np.linalg.lstsq(body.mass, load, rcond=None)[0]), initial=0.0))


def _path(points: FloatArray) -> str:
    """A closed line through places [px]."""
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points.tolist()) + "z"
