"""`mbs check`: every problem of a scene at once, and what will be solved; no film is solved."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator

from ehdmaps.errors import InputError
from ehdmaps.units import LENGTH, RPM, SPRING
from mbs.analyses.campbell import campbell_problems
from mbs.analyses.hammer import hammer_problems
from mbs.analyses.lsa import lsa_problems
from mbs.analyses.runup import runup_problems
from mbs.analyses.sweep import sweep_problems
from mbs.commands.auto import judged
from mbs.commands.cases import load_model
from mbs.commands.common import Looked
from mbs.model.body import Body
from mbs.output.model_text import heading
from mbs.scene.assembly import Model
from mbs.scene.fields import DEGREE, HERTZ, MICROMETRE
from mbs.scene.locating.ribs import open_sides
from mbs.scene.scene import Scene
from mbs.scene.specs import BearingSpec, LocatingSpec, RigidSpec, ShaftSpec
from mbs.unknowns.held_open import held_open_of
from mbs.unknowns.words import open_list


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Put the scene together, and tell what it is."""
    arguments.output = arguments.plot = None
    model = load_model(arguments)
    scene = model.scene
    lines = [*heading(model, scene.speed), *_oil(scene), "", *_bodies(model), *_bearings(model)]
    lines += _gears(scene)
    lines += [f"  load {load.name}: on {load.on}" for load in scene.loads]
    found = open_sides(scene)
    ends = [f"problem: {problem}" for problem in found] or ["no problem found"]
    physics = _physics(arguments, model)
    lines += open_list(scene, held_open_of(model))
    return "\n".join([*lines, "", *_analyses(scene), *physics, *ends]), 1 if found else 0


def _physics(arguments: argparse.Namespace, model: Model) -> Iterator[str]:
    """Lines on the physics that matters to films of the film table, up to the highest frequency of the scene."""
    highest = max(model.scene.frequencies, default=model.scene.campbell.highest)
    for verdict in judged(arguments, Looked(model.scene, highest)):
        if verdict.matters:
            yield f"  {verdict.line}"
    if model.balls and model.scene.lubricant is not None:
        from mbs.scene.locating.ball_films import FilmsOfPoints

        given = (one.films for one in model.balls)
        found = {films.conditions.words: None for films in given if isinstance(films, FilmsOfPoints)}
        words = f"{next(iter(found), '')}, " if found else ""
        yield f"  films of balls are {words}Newtonian; what that leaves out is not weighed"


def _oil(scene: Scene) -> Iterator[str]:
    """A line on what of the scene's oil is assumed or estimated."""
    if scene.lubricant is not None and scene.lubricant.estimated:
        yield f"  oil {scene.lubricant.title}: {scene.lubricant.estimated}"


def _bodies(model: Model) -> Iterator[str]:
    """Lines of the bodies, and of the coordinates of all of them."""
    sizes = {body.name: len(body.coordinates) for body in model.system.bodies}
    for spec in model.scene.bodies:
        spin = f", turns {spec.spin:g} x the speed" if spec.spin else ""
        yield f"  {_kind(spec)} {spec.name}: {_words(spec)}{sizes[spec.name]} coordinates{spin}"
    yield f"  {model.system.size} coordinates in all, {len(model.scene.springs)} springs"


def _kind(spec: object) -> str:
    """Kind of a body."""
    return {ShaftSpec: "shaft", RigidSpec: "rigid body", Body: "body of matrices"}.get(type(spec), "flexible body")


def _words(spec: object) -> str:
    """Size and mass of a body where its table says them; a comma follows."""
    if isinstance(spec, RigidSpec):
        return f"{sum(part.mass for part in spec.parts):.4g} kg, "
    if not isinstance(spec, ShaftSpec):
        return ""
    begin, end = min(part.begin for part in spec.sections), max(part.end for part in spec.sections)
    mass = sum(part.mass for part in spec.sections)
    discs = sum(disc.inertia.mass for disc in spec.discs)
    cutoff = "no reduction" if spec.cutoff is None else f"modes up to {HERTZ.text(spec.cutoff)} with held places"
    cutoff += "" if spec.cutoff_stated else ", or higher where modes feel it"
    return f"{LENGTH.text(end - begin, 5)}, {mass:.4g} kg and discs of {discs:.4g} kg, {cutoff}, "


def _bearings(model: Model) -> Iterator[str]:
    """Lines of the bearings; of cylindrical rollers with their oil and films."""
    for spec, bearing in zip(model.scene.bearings, model.bearings, strict=True):
        assert bearing.source is not None  # bearings of scenes have one
        yield (
            f"  bearing {spec.name}: {spec.geometry.title}{' (estimated)' if spec.geometry.estimated else ''}, "
            f"{spec.geometry.rolling_elements} rollers{spec.geometry.row_words}, "
            f"clearance {MICROMETRE.text(spec.geometry.diametral_clearance)}, "
            f"{_where(model.scene, spec)}; {bearing.source.words}"
        )
    for other in model.scene.located:
        yield f"  bearing {other.name}: {_located(other)}, {_where(model.scene, other)}"


def _gears(scene: Scene) -> Iterator[str]:
    """A line for each gear pair: places, how its teeth meet, mean stiffness."""
    for pair in scene.gears:
        try:
            transverse, overlap = pair.contact_ratios
            ratios = f"contact ratio {transverse:.3g} transverse, {overlap:.3g} by the helix"
        except InputError:  # of teeth whose harmonics are given
            ratios = "contact ratio not known"
        yield (
            f"  gear pair {pair.name}: {pair.on} against {pair.against}, {ratios}, working pressure angle "
            f"{DEGREE.text(pair.working_pressure_angle)}, mean stiffness {SPRING.text(pair.mean_stiffness)}"
        )


def _located(spec: LocatingSpec) -> str:
    """Bearing that holds a ring along the axis too: its elements, and how it stands."""
    geometry, angle = spec.geometry, math.degrees(spec.geometry.contact_angle)
    estimated = " (estimated)" if geometry.estimated else ""
    words = [spec.elements]
    if geometry.has_clearance:
        words.append(f"clearance {MICROMETRE.text(geometry.clearance)}")
    if ways := getattr(geometry, "ways", ""):  # of rollers between ribs
        words.append(f"ribs carry {ways}, axial clearance {MICROMETRE.text(geometry.axial_clearance)}")
    words += [f"contact angle {abs(angle):.3g} deg"] * (angle != 0.0) + ["mirrored"] * (angle < 0.0)
    words += [f"inner ring offset by {MICROMETRE.text(spec.axial_offset)}"] * (spec.axial_offset != 0.0)
    return f"{geometry.title}{estimated}, {', '.join(words)}"


def _where(scene: Scene, spec: BearingSpec | LocatingSpec) -> str:
    """Places of a bearing; on a shaft with the position along it."""
    body, _, frame = spec.inner.partition(":")
    shaft = next((entry for entry in scene.bodies if isinstance(entry, ShaftSpec) and entry.name == body), None)
    along = "" if shaft is None or frame not in shaft.frames else f" at {LENGTH.text(shaft.frames[frame], 5)}"
    return f"{spec.inner}{along} in {spec.outer}"


def _analyses(scene: Scene) -> Iterator[str]:
    """Lines of the analyses that the tables of the scene allow, with their size, or of what they lack."""
    swept = "" if scene.sweep is None else f"{scene.sweep.points} speeds up to {RPM.text(scene.sweep.end)}"
    turning = any(spec.spin for spec in scene.bodies)
    idle = [] if turning else [f"{scene.name}: no body spins"]
    course = "" if scene.run_up is None else f"{math.ceil(scene.run_up.duration / scene.run_up.settings.step)} steps"
    for name, size, lacking in (
        ("statics, modes, report", "one speed", []),
        ("lsa", f"{len(scene.frequencies)} frequencies", lsa_problems(scene)),
        ("sweep", swept, sweep_problems(scene)),
        ("critical", swept, [*sweep_problems(scene), *idle]),
        ("runup", course, runup_problems(scene)),
        ("campbell", course, runup_problems(scene) or campbell_problems(scene, scene.campbell)),
        ("hammer", f"{len(scene.inputs)} inputs", hammer_problems(scene)),
    ):
        told = "; ".join(problem.removeprefix(f"{scene.name}: ") for problem in lacking)
        yield f"  mbs {name}: {f'not yet: {told}' if lacking else size}"
