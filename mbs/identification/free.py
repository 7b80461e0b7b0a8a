"""Unknowns that are set free, read from words such as "left.clearance", "temperature" or "foot.stiffness".

==========================  =================================  ==================================================
words                       unknown                            range, where none is stated
==========================  =================================  ==================================================
clearance                   of each bearing that has one       0 to the larger of 60 um and three times its own
BEARING.clearance           of one
temperature                 of all raceways [K]                283.15 to 383.15 K
alpha                       factor of the pressure-viscosity   0.5 to 2, about 1 within 15 %
LOAD.force                  size of a load or preload          a fifth to five times
SPRING.stiffness, .damping  each freedom it has                a fifth, a twentieth to five, twenty times
SPRING.stiffness.y          one freedom
BODY.damping_ratio          of a shaft or a flexible body      a tenth to ten times
SENSOR.gain                 factor of a channel                0.5 to 2
==========================  =================================  ==================================================

"NAME = LOW to HIGH" states another range. What is positive is searched by its logarithm. A tolerance that a scene or
`--know` states of an unknown that is set free is what is known beforehand: uniform within its half-width a, taken as a
deviation of a/sqrt(3).
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems, closest, short
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.units import DAMPER, SPRING, Display, quantity
from mbs.model.body import FREEDOMS
from mbs.scene.changes import with_clearance_of, with_damping_ratio, with_temperature
from mbs.scene.fields import MICROMETRE
from mbs.scene.scene import Scene
from mbs.scene.specs import FlexibleSpec, ShaftSpec
from mbs.unknowns.statement import tolerance_of

COLDEST, HOTTEST = 283.15, 383.15
"""Range of a temperature [K]."""

ALPHAS = (0.85, 1.0, 1.15)
"""Factors of the pressure-viscosity at which laws are made; between them responses are interpolated."""

ALPHA_KNOWN = 0.15
"""Part within which a pressure-viscosity is known beforehand."""

WIDEST_CLEARANCE = 60e-6
"""Largest clearance of a range that is not stated [m]."""

Change = Callable[[Scene, float], Scene]
"""Makes the scene with another value of an unknown; it goes to other processes, and so is a function of a module."""


def _unchanged(scene: Scene, _: float) -> Scene:
    """The scene of an unknown that it has no part in."""
    return scene


def _with_clearance(name: str, scene: Scene, value: float) -> Scene:
    """The scene with another clearance of a bearing."""
    return with_clearance_of(scene, name, value)


def _with_alpha(oil: Lubricant, temperature: float, scene: Scene, factor: float) -> Scene:
    """The scene with another pressure-viscosity of its oil, stated at a temperature."""
    other = oil if factor == 1.0 else oil.with_alpha(factor, temperature)
    if other is None:
        raise InputError("--free: got 'alpha' of an oil whose numbers are as measured; allowed: of other oils")
    return dataclasses.replace(scene, lubricant=other)


def _with_force(name: str, force: FloatArray, size: float, scene: Scene, value: float) -> Scene:
    """The scene with another size of a load."""
    changed = (value / size) * force
    loads = [dataclasses.replace(one, force=changed) if one.name == name else one for one in scene.loads]
    return dataclasses.replace(scene, loads=loads)


def _with_spring(name: str, kind: str, freedom: int, scene: Scene, value: float) -> Scene:
    """The scene with another stiffness or damping of a spring along one freedom."""
    springs = []
    for one in scene.springs:
        if one.name == name:
            matrix = np.array(getattr(one, kind))
            matrix[freedom, freedom] = value
            change: dict[str, Any] = {kind: matrix}
            one = dataclasses.replace(one, **change)  # noqa: PLW2901
        springs.append(one)
    return dataclasses.replace(scene, springs=springs)


def _with_damping(name: str, scene: Scene, value: float) -> Scene:
    """The scene with another damping ratio of a body."""
    return with_damping_ratio(scene, name, value)


@dataclass(frozen=True, eq=False, kw_only=True)
class Free:
    """An unknown that is set free.

    Attributes
    ----------
    name : str
        Name in results, such as "left.clearance".
    unit : str
        SI unit of its values.
    display : Display
        How people see them.
    low, high, start : float
        Range of the search, and the value of the scene.
    change : callable
        The scene with another value of it.
    log : bool
        Whether it is searched by its logarithm.
    prior : (float, float) or None
        What is known beforehand: value, and standard deviation in the coordinate of the search.
    group, of : str
        Key of [tolerances] whose place it takes, and the bearing; empty for none.
    sensor : str
        Sensor whose channel it multiplies; empty for what changes the scene.
    law : str
        Law of the machine in place of its own, with a place for the value: of a damper; empty for all others.
    nodes : tuple of float
        Values at which the machine is looked at, where each costs new laws; between them results are interpolated.
    """

    name: str
    unit: str
    display: Display
    low: float
    high: float
    start: float
    change: Change = _unchanged
    log: bool = False
    prior: tuple[float, float] | None = None
    group: str = ""
    of: str = ""
    sensor: str = ""
    law: str = ""
    nodes: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low < self.high):
            raise InputError(f"{self.name}: got the range {self._text(self.low)} to {self._text(self.high)}; it rises")
        if self.log and not self.low > 0.0:
            raise InputError(f"{self.name}: got a range from {self._text(self.low)}; allowed: above 0")

    def _text(self, value: float) -> str:
        return self.display.text(value)

    @property
    def ends(self) -> tuple[float, float]:
        """Range in the coordinate of the search."""
        return self.coordinate(self.low), self.coordinate(self.high)

    def coordinate(self, value: float) -> float:
        """Coordinate of the search of a value."""
        return math.log(value) if self.log else value

    def value(self, coordinate: float) -> float:
        """Value of a coordinate."""
        return math.exp(coordinate) if self.log else coordinate


def read_free(texts: Iterable[str], scene: Scene) -> tuple[Free, ...]:
    """Read the unknowns that are set free.

    Parameters
    ----------
    texts : iterable of str
        Words as at the head of this module, each with a range behind "=" or without.
    scene : Scene
        The scene.

    Raises
    ------
    InputError
        With every problem.

    Examples
    --------
    >>> from mbs import read_scene
    >>> [one.name for one in read_free(["clearance", "temperature"], read_scene("nu308_rigid"))]
    ['bearing_left.clearance', 'bearing_right.clearance', 'temperature']
    """
    problems = Problems()
    found: dict[str, Free] = {}
    for text in texts:
        with problems:
            for one in _read(text, scene):
                found[one.name] = one
    problems.check()
    if not found:
        raise InputError("--free: got nothing to find; allowed: such as --free clearance --free temperature")
    return tuple(found.values())


def _read(text: str, scene: Scene) -> Iterator[Free]:
    """Unknowns of one text."""
    words, equals, ends = (part.strip() for part in text.partition("="))
    made = list(_named(words, scene))
    for one in made:
        yield _ranged(one, ends, text) if equals else one


def _ranged(one: Free, ends: str, text: str) -> Free:
    """An unknown with the range that is stated."""
    low, to, high = (part.strip() for part in ends.partition(" to "))
    if not to:
        raise InputError(f"--free: got {short(text)}; allowed: a range, such as '{one.name} = LOW to HIGH'")
    unit = "" if one.unit == "1" else one.unit
    values = [float(end) if not unit else quantity(end, unit) for end in (low, high)]
    start = min(max(one.start, values[0]), values[1])
    return dataclasses.replace(one, low=values[0], high=values[1], start=start)


def _named(words: str, scene: Scene) -> Iterator[Free]:
    """Unknowns of a name."""
    bearings = {entry.name: entry for entry in scene.of_all_kinds}
    springs = {spring.name: spring for spring in scene.springs}
    loads = {load.name: load for load in scene.loads}
    bodies = {body.name: body for body in scene.bodies if isinstance(body, (ShaftSpec, FlexibleSpec))}
    sensors = {sensor.name: sensor for sensor in scene.sensors}
    name, _, rest = words.partition(".")
    kind, _, freedom = rest.partition(".")
    if words == "clearance":
        with_one = [entry for entry in bearings.values() if _clearance(entry) is not None]
        if not with_one:
            raise InputError("--free: got 'clearance'; the scene has no bearing that has one")
        yield from (_of_clearance(scene, entry) for entry in with_one)
    elif words == "temperature":
        yield _of_temperature(scene)
    elif words == "alpha":
        yield _of_alpha(scene)
    elif name in bearings and rest == "clearance" and _clearance(bearings[name]) is not None:
        yield _of_clearance(scene, bearings[name])
    elif name in loads and rest == "force":
        yield _of_force(scene, loads[name])
    elif name in springs and kind in ("stiffness", "damping"):
        yield from _of_spring(springs[name], kind, freedom, words)
    elif name in bodies and rest == "damping_ratio":
        yield _of_body(bodies[name])
    elif name in sensors and rest == "gain":
        yield Free(name=words, unit="1", display=Display("", 1.0), low=0.5, high=2.0, start=1.0, log=True, sensor=name)
    else:
        allowed = (
            *(["clearance"] if any(_clearance(entry) is not None for entry in bearings.values()) else []),
            *(f"{one}.clearance" for one, entry in bearings.items() if _clearance(entry) is not None),
            *(["temperature", "alpha"] if bearings and scene.lubricant else []),
            *(f"{one}.force" for one in loads),
            *(f"{one}.{what}" for one in springs for what in ("stiffness", "damping")),
            *(f"{one}.damping_ratio" for one in bodies),
            *(f"{one}.gain" for one in sensors),
        )
        raise InputError(f"--free: got {short(words)}{closest(words, allowed)}; allowed: {', '.join(allowed)}")


def _clearance(entry: Any) -> float | None:
    """Clearance of a bearing [m]; None where it has none."""
    from mbs.unknowns.held_open import clearance_of

    return clearance_of(entry)


def known_beforehand(scene: Scene, group: str, of: str, value: float) -> tuple[float, float] | None:
    """Value and deviation that a statement of a scene gives an unknown; None where nothing is stated.

    Parameters
    ----------
    scene : Scene
        The scene.
    group, of : str
        Key of [tolerances], and the bearing.
    value : float
        Value that is stated.

    Raises
    ------
    InputError
        If it is stated to be exact.
    """
    stated = tolerance_of(scene, group, of)
    if stated is None:
        return None
    if stated.exact:
        what = f"{group} of {of}" if of else group
        raise InputError(f"--free: {what} is stated to be exact ({stated.text}); allowed: state how well it is known")
    return value, stated.half_width(value) / math.sqrt(3.0)


def _of_clearance(scene: Scene, entry: Any) -> Free:
    """The clearance of a bearing."""
    own = float(_clearance(entry) or 0.0)
    name = entry.name
    return Free(
        name=f"{name}.clearance",
        unit="m",
        display=MICROMETRE,
        low=0.0,
        high=max(WIDEST_CLEARANCE, 3.0 * own),
        start=max(own, 0.0),
        change=partial(_with_clearance, name),
        prior=known_beforehand(scene, "clearance", name, own),
        group="clearance",
        of=name,
    )


def _of_temperature(scene: Scene) -> Free:
    """The temperature of all raceways."""
    if not scene.has_bearings:
        raise InputError("--free: got 'temperature'; the scene has no bearings")
    own = scene.temperature
    return Free(
        name="temperature",
        unit="K",
        display=Display("K"),
        low=min(COLDEST, own),
        high=max(HOTTEST, own),
        start=own,
        change=with_temperature,
        prior=known_beforehand(scene, "temperature", "", own),
        group="temperature",
    )


def _of_alpha(scene: Scene) -> Free:
    """The pressure-viscosity of the oil, as a factor."""
    oil, temperature = scene.lubricant, scene.temperature
    if oil is None:
        raise InputError("--free: got 'alpha'; the scene has no [lubricant]")
    change = partial(_with_alpha, oil, temperature)
    change(scene, ALPHAS[-1])
    stated = tolerance_of(scene, "pressure_viscosity")
    part = ALPHA_KNOWN if stated is None or stated.exact else stated.size / math.sqrt(3.0)
    return Free(
        name="alpha",
        unit="1",
        display=Display("", 1.0),
        low=0.5,
        high=2.0,
        start=1.0,
        change=change,
        log=True,
        prior=(1.0, part),
        group="pressure_viscosity",
        nodes=ALPHAS,
    )


def _of_force(scene: Scene, load: Any) -> Free:
    """The size of a load."""
    size = float(np.linalg.norm(load.force))
    if not size > 0.0:
        raise InputError(f"--free: got '{load.name}.force'; the load has no force")
    name = load.name
    group = "preload" if "preload" in name.lower() else "load"
    unit = "N" if np.any(load.force[:3]) else "N m"
    return Free(
        name=f"{name}.force",
        unit=unit,
        display=Display(unit),
        low=size / 5.0,
        high=5.0 * size,
        start=size,
        change=partial(_with_force, name, load.force, size),
        log=True,
        prior=_relative(known_beforehand(scene, group, "", size)),
        group=group,
    )


def _relative(prior: tuple[float, float] | None) -> tuple[float, float] | None:
    """Knowledge beforehand of what is searched by its logarithm."""
    return None if prior is None else (prior[0], prior[1] / prior[0])


def _of_spring(spring: Any, kind: str, freedom: str, words: str) -> Iterator[Free]:
    """Stiffness or damping of a spring, of each freedom that has one."""
    matrix = getattr(spring, kind)
    there = [k for k, _ in enumerate(FREEDOMS) if matrix[k, k] > 0.0]
    wanted = there if not freedom else [k for k in there if FREEDOMS[k] == freedom]
    if not wanted:
        names = ", ".join(FREEDOMS[k] for k in there)
        raise InputError(f"--free: got {short(words)}; {spring.name} has {kind} along {names or 'nothing'}")
    if np.any(matrix - np.diag(np.diag(matrix))):
        raise InputError(f"--free: got {short(words)}; {spring.name} couples its freedoms; allowed: of springs without")
    name, wide = spring.name, 5.0 if kind == "stiffness" else 20.0
    for k in wanted:
        own, plain = float(matrix[k, k]), "N/m" if kind == "stiffness" else "N s/m"
        turning = "N m/rad" if kind == "stiffness" else "N m s/rad"
        shown = SPRING if kind == "stiffness" else DAMPER
        yield Free(
            name=f"{name}.{kind}.{FREEDOMS[k]}",
            unit=plain if k < 3 else turning,
            display=shown if k < 3 else Display(turning),
            low=own / wide,
            high=wide * own,
            start=own,
            change=partial(_with_spring, name, kind, k),
            log=True,
        )


def _of_body(body: Any) -> Free:
    """The damping ratio of a shaft or a flexible body."""
    if not body.damping_ratio > 0.0:
        raise InputError(f"--free: got '{body.name}.damping_ratio'; the scene states none to begin with")
    return Free(
        name=f"{body.name}.damping_ratio",
        unit="1",
        display=Display("%", 100.0),
        low=body.damping_ratio / 10.0,
        high=min(10.0 * body.damping_ratio, 0.5),
        start=body.damping_ratio,
        change=partial(_with_damping, body.name),
        log=True,
    )
