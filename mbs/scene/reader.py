"""Read a scene: a TOML file, or the name of a shipped system. Strict: unknown keys are errors, all problems at once."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from importlib import resources
from os import PathLike, fspath
from pathlib import Path
from typing import TypeVar

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.inputs import read_text
from ehdmaps.jobs import table
from ehdmaps.jobs.problem import AxisRule, read_axis, read_lubricant
from ehdmaps.jobs.supply import read_supply, read_surface
from ehdmaps.jobs.table import Table
from ehdmaps.physics.contact import OIL_TEMPERATURES
from ehdmaps.units import DAMPER, RPM, SPRING, TEMPERATURE, Display, Tolerance, closest, read_tolerances, short
from mbs.gears.pair import GearPair
from mbs.model.body import FREEDOMS, Inertia
from mbs.model.drive import Drive, DrivenSpeed, TorqueCurve
from mbs.model.elements import MESH, Input, Load, Sensor, Spring
from mbs.model.profiles import Constant, Course, Harmonic, LoadProfile, SpeedProfile
from mbs.scene import fields, kinds
from mbs.scene.fields import DEGREE, FORCE, HERTZ, LONGEST_FILE, MICROMETRE, MILLISECOND, MOMENT
from mbs.scene.gears import read_mesh_input, spins_by_teeth
from mbs.scene.matrices import MatrixSpec, read_spring
from mbs.scene.scene import Scene
from mbs.scene.shafts.standing import mounts, read_gravity
from mbs.scene.specs import ORIGIN, BodySpec, FlexibleSpec, RigidSpec, ShaftSpec
from mbs.scene.turning import read_excitation, read_unbalance
from mbs.settings import (
    HIGHEST,
    HIGHEST_HIGHEST,
    LONGEST,
    LOWEST_HIGHEST,
    MOST_SPEEDS,
    SHORTEST,
    CampbellSettings,
    RunUp,
    Settings,
    SweepRange,
)
from mbs.unknowns.statement import taken_out

MOST_POINTS = 1000
"""Points of a torque over speed."""

_Built = TypeVar("_Built")

_LARGEST = 1e9
"""Largest torque [N m]."""

_MOST_ORDERS = 50
_LARGEST_ORDER = 1e4
_FASTEST = 1e5
"""Highest speed, either way round [rad/s]."""


def read_drive(section: Table) -> Drive | None:
    """Read a drive; None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    """
    inertia = section.quantity("inertia", "kg m^2", 1e-12, 1e9, Display("kg m^2"), required=True)
    motor = _read_torque(
        section, "motor", 'a torque such as "12 N m", or { speeds = [...], torques = [...] }', -_FASTEST
    )
    load = _read_torque(section, "load", "")
    until = section.quantity("motor_until", "s", 1e-9, 1e6, Display("s"))
    if inertia is None or motor is None or load is None:
        return None
    return section.made(lambda: Drive(inertia, motor, load, math.inf if until is None else until))


def _read_torque(section: Table, key: str, required: str, lowest: float = 0.0) -> TorqueCurve | None:
    """Read a torque, constant or over speeds from a lowest one on; none at all if it may be absent and is."""
    value = section.get(key, required)
    if key not in section:
        return None if required else TorqueCurve.constant(0.0)
    if not isinstance(value, dict):
        torque = section.quantity_of(value, key, "N m", -_LARGEST, _LARGEST, MOMENT)
        return None if torque is None else TorqueCurve.constant(torque)
    table = Table(value, f"{section.where} {key}", section.problems)
    before = len(table.problems)
    speeds, torques = (table.get(name, "a list") for name in ("speeds", "torques"))
    table.close()
    if not (isinstance(speeds, list) and isinstance(torques, list) and 2 <= len(speeds) == len(torques) <= MOST_POINTS):
        table.note("speeds", f"got {short(speeds)} and {short(torques)}; allowed: 2 to {MOST_POINTS} of each, as many")
        return None
    at = [table.quantity_of(part, f"speeds[{k}]", "rad/s", lowest, 1e5, RPM) for k, part in enumerate(speeds)]
    found = [
        table.quantity_of(part, f"torques[{k}]", "N m", -_LARGEST, _LARGEST, MOMENT) for k, part in enumerate(torques)
    ]
    if len(table.problems) > before:
        return None
    given = [part for part in at if part is not None]
    if np.any(np.diff(given) <= 0.0):
        table.note("speeds", f"got {short(speeds)}; allowed: each above the last")
        return None
    return TorqueCurve(tuple(given), tuple(part for part in found if part is not None))


def read_sweep(section: Table) -> SweepRange | None:
    """Read from, to and points; None where a problem was noted.

    Parameters
    ----------
    section : Table
        [sweep]; whoever calls closes it.
    """
    begin = section.quantity("from", "rad/s", 0.0, 1e5, RPM, required=True)
    end = section.quantity("to", "rad/s", 0.0, 1e5, RPM, required=True)
    points = section.integer("points", 2, MOST_SPEEDS, required=True)
    if begin is None or end is None or points is None:
        return None
    return section.made(lambda: SweepRange(begin, end, points))


def read_campbell(section: Table) -> CampbellSettings | None:
    """Read [campbell]; None where a problem was noted. All keys may be left out."""
    before = len(section.problems)
    sensor = fields.text(section, "sensor")
    highest = section.quantity("highest", "Hz", LOWEST_HIGHEST, HIGHEST_HIGHEST, HERTZ)
    window = section.quantity("window", "s", SHORTEST, LONGEST, MILLISECOND)
    orders = _read_orders(section)
    if len(section.problems) > before:
        return None
    return CampbellSettings(sensor, HIGHEST if highest is None else highest, window, orders)


def _read_orders(section: Table) -> tuple[float, ...]:
    """Read a list of orders; empty if absent or wrong."""
    values = section.get("orders")
    if "orders" not in section:
        return ()
    allowed = f"a list of 1 to {_MOST_ORDERS} numbers above 0, up to {_LARGEST_ORDER:g}, such as [21, 42]"
    if not isinstance(values, list) or not 1 <= len(values) <= _MOST_ORDERS:
        section.note("orders", f"got {short(values)}; allowed: {allowed}")
        return ()
    for value in values:
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not number or not 0.0 < value <= _LARGEST_ORDER:
            section.note("orders", f"got {short(value)} in the list; allowed: {allowed}")
            return ()
    return tuple(float(value) for value in values)


_FREQUENCIES = AxisRule("frequencies", "Hz", 1e-3, 1e6, HERTZ, "log")
_QUANTITIES = ("displacement", "velocity", "acceleration")


def shipped_systems() -> tuple[str, ...]:
    """Return the names of the systems that come with the package."""
    folder = resources.files("mbs") / "systems"
    return tuple(sorted(entry.name.removesuffix(".toml") for entry in folder.iterdir() if entry.name.endswith(".toml")))


def read_scene(source: str | PathLike[str]) -> Scene:
    """Read a scene.

    Parameters
    ----------
    source : str or path-like
        Name of a shipped system ("nu308_rigid"), or path of a scene file.

    Raises
    ------
    InputError
        With every problem found.
    """
    source = fspath(source)
    if source in shipped_systems():
        with resources.as_file(resources.files("mbs") / "systems") as folder:
            path = folder / f"{source}.toml"
            scene = parse_scene(path.read_text(encoding="utf-8"), source, f"{source} (shipped)", folder)
            return dataclasses.replace(scene, file=path)
    path, known = Path(source), shipped_systems()
    allowed = f"a scene file in TOML, or a shipped system: {', '.join(known)}{closest(source, known)}"
    scene = parse_scene(read_text(path, LONGEST_FILE, allowed, name=source), path.stem, source, path.parent)
    return dataclasses.replace(scene, file=path)


def parse_scene(text: str, name: str, where: str, folder: Path | None = None) -> Scene:
    """Read a scene from the text of its file.

    Parameters
    ----------
    text : str
        Text in TOML.
    name : str
        Name of the scene.
    where : str
        How messages call the file.
    folder : Path, optional
        Folder of the files that it names; without one it may name none.

    Raises
    ------
    InputError
        With every problem found, each beginning with `where`.
    """
    problems: list[str] = []
    found = table.parse(text, where)
    if "grid" in found and "operation" not in found:
        raise InputError(
            f"{where}: is a job of ehdmaps, no scene; allowed: a scene; jobs are for `ehdmaps generate`, which makes "
            "the map of a contact; `mbs new` begins a scene"
        )
    values, tolerances = taken_out(found, problems)
    scene = _Reader(Table(values, "scene file", problems), folder).scene(text, name, tolerances)
    if problems or scene is None:
        raise InputError([f"{where}: {problem}" for problem in problems])
    return scene


class _Reader:
    """Reads the tables of one file and keeps what is marked as assumed."""

    def __init__(self, top: Table, folder: Path | None) -> None:
        self._top = top
        self._folder = folder
        self._assumed: list[str] = []
        self._mounted = mounts(top.get("shafts"), top.get("bearings"))

    def scene(self, text: str, name: str, tolerances: Mapping[str, Tolerance]) -> Scene | None:
        """Read everything, beside tolerances of its values; None where a problem was noted."""
        top = self._top
        schema = top.get("schema", required="schema = 1")
        if "schema" in top and (isinstance(schema, bool) or schema != 1):
            top.note("schema", f"got {short(schema)}; allowed: 1; this version of mbs reads no other")
        title = fields.text(top, "title") or name
        speed = temperature = gravity = None
        operation = top.table("operation", "[operation]", required="a table with speed and temperature")
        if operation:
            speed = operation.quantity("speed", "rad/s", 0.0, 1e5, RPM, required=True)
            temperature = operation.quantity("temperature", "K", *OIL_TEMPERATURES, TEMPERATURE, required=True)
            gravity = read_gravity(operation, top.get("shafts"))
            self._close(operation)
        section = top.table("lubricant", "[lubricant]")
        lubricant = read_lubricant(section) if section else None
        supply = top.optional("supply", "[supply]", read_supply, self._close)
        surface = top.optional("surface", "[surface]", read_surface, self._close)
        bodies: list[BodySpec] = [
            *self._all("bodies", self._body),
            *self._all("shafts", self._shaft),
            *self._all("flexible", self._flexible),
        ]
        springs = self._all("springs", read_spring)
        loads = self._all("loads", self._load)
        unbalances = self._all("unbalances", read_unbalance)
        excitations = self._all("excitations", read_excitation)
        elements = [entry for kind in kinds.KINDS if kind.key for entry in self._all(kind.key, kind.read)]
        elements += [spring for spring in springs if isinstance(spring, MatrixSpec)]
        if any(getattr(entry, "between_ribs", None) is not None for entry in elements):
            from mbs.scene.locating.ribs import held_by_ribs

            elements = held_by_ribs(elements, bodies, top.problems)
        bodies = spins_by_teeth(bodies, (one for one in elements if isinstance(one, GearPair)), self._typed_spins())
        inputs = self._all("inputs", self._input)
        sensors = self._all("sensors", self._sensor)
        laws = self._laws()
        frequencies: tuple[float, ...] | None = ()
        linear = top.table("linear", "[linear]")
        if linear:
            frequencies = read_axis(linear, _FREQUENCIES)
            self._close(linear)
        drive = top.optional("drive", "[drive]", read_drive, self._close)
        section = top.table("runup", "[runup]")
        run_up = self._run_up(section, drive) if section else None
        if "drive" in top and "runup" not in top:
            top.note("drive", "stands without [runup]; allowed: with a table [runup]; delete it, or add that")
        sweep = top.optional("sweep", "[sweep]", read_sweep, self._close)
        stated = top.optional("tolerances", "[tolerances]", read_tolerances, self._close)
        campbell = top.optional("campbell", "[campbell]", read_campbell, self._close)
        top.close()
        if top.problems or speed is None or temperature is None or frequencies is None:
            return None
        return Scene(
            name=name,
            title=title,
            text=text,
            speed=speed,
            temperature=temperature,
            lubricant=lubricant,
            supply=supply,
            surface=surface,
            bodies=bodies,
            springs=[spring for spring in springs if isinstance(spring, Spring)],
            loads=loads,
            unbalances=unbalances,
            excitations=excitations,
            gravity=gravity or ORIGIN,
            elements=elements,
            inputs=inputs,
            sensors=sensors,
            laws=laws,
            frequencies=frequencies,
            run_up=run_up,
            sweep=sweep,
            campbell=campbell or CampbellSettings(),
            assumed=self._assumed,
            tolerances={**(stated or {}), **tolerances},
        )

    def _typed_spins(self) -> set[str]:
        """Names of the bodies whose spin is typed."""
        tables = [entry for key in ("bodies", "shafts") for entry in self._top.get(key) or []]
        return {str(entry.get("name")) for entry in tables if isinstance(entry, dict) and "spin" in entry}

    def _all(self, key: str, read: Callable[[Table, str], _Built | None]) -> list[_Built]:
        """Read each table of a list of tables; the name of each comes first."""
        entries = self._top.get(key)
        if key not in self._top:
            return []
        if not isinstance(entries, list) or not entries:
            self._top.note(key, f"got {short(entries)}; allowed: tables that begin with [[{key}]]")
            return []
        found = []
        for index, values in enumerate(entries):
            label = values.get("name", index + 1) if isinstance(values, dict) else index + 1
            section = Table(values, f"[[{key}]] {label!s:.60}", self._top.problems)
            name = fields.text(section, "name", required=True)
            thing = read(section, name or "")
            self._close(section)
            if thing is not None:
                found.append(thing)
        return found

    def _close(self, section: Table) -> None:
        """Read the list of assumed keys, then note unknown ones."""
        marked = section.get("assumed")
        if "assumed" in section:
            if not isinstance(marked, list) or not all(isinstance(key, str) and key in section for key in marked):
                section.note("assumed", f"got {marked!r:.80}; allowed: a list of the names of keys of this table")
            else:
                self._assumed += [f"{section.where} {key}" for key in marked]
        section.close()

    def _body(self, section: Table, name: str) -> RigidSpec | None:
        """Read a rigid body."""
        before = len(section.problems)
        freedoms = fields.words(section, "freedoms", FREEDOMS)
        position = fields.lengths(section, "position", section.get("position"))
        spin = section.number("spin", -1e3, 1e3)
        parts = self._parts(section)
        frames = {}
        given = section.table("frames", f"{section.where} frames")
        if given:
            for key in given.entries():
                fields.named(given, key)
                place = fields.lengths(given, key, given.get(key))
                frames[key] = place or (0.0, 0.0, 0.0)
        if len(section.problems) > before or freedoms is None:
            return None
        return section.made(
            lambda: RigidSpec(name, parts, freedoms, position or ORIGIN, frames, spin or 0.0),
        )

    def _shaft(self, section: Table, name: str) -> ShaftSpec | None:
        """Read a flexible shaft."""
        from mbs.scene.shafts.tables import read_shaft

        return read_shaft(section, name, self._folder, self._mounted.get(name))

    def _flexible(self, section: Table, name: str) -> FlexibleSpec | None:
        """Read a body of finite elements, and what is fixed to it."""
        from mbs.scene.flexible import read_flexible

        return read_flexible(section, name, self._folder)

    def _parts(self, section: Table) -> list[Inertia]:
        """Read what a body is made of: cylinders, or mass and moments of inertia."""
        cylinders = section.tables("cylinders", "a list of tables with from, to, diameter")
        found: list[Inertia | None] = [fields.cylinder(table) for table in cylinders]
        mass = section.quantity("mass", "kg", 1e-6, 1e6, Display("kg"))
        unit = Display("kg m^2")
        polar = section.quantity("polar_inertia", "kg m^2", 0.0, 1e6, unit)
        transverse = section.quantity("transverse_inertia", "kg m^2", 0.0, 1e6, unit)
        keys = ("mass", "polar_inertia", "transverse_inertia")
        moments = [key for key in keys[1:] if key in section]
        if "mass" in section or moments:
            if moments and not all(key in section for key in keys):
                section.note(
                    "mass", f"stands without its companions; allowed: {', '.join(keys)} together, or mass alone"
                )
            elif mass is not None and not (moments and (polar is None or transverse is None)):
                found.append(section.made(lambda: Inertia(mass, polar or 0.0, transverse or 0.0)))
        elif "cylinders" not in section:
            section.note("cylinders", f"missing; allowed: cylinders, or {', '.join(keys)}, or both")
        return [part for part in found if part is not None]

    def _load(self, section: Table, name: str) -> Load | None:
        """Read a load."""
        on, against = fields.places(section)
        wrench = fields.wrench(section)
        profile = self._profile(section)
        if on is None or wrench is None:
            return None
        return Load(name, on, wrench, against, profile)

    def _profile(self, section: Table) -> LoadProfile:
        """Read how a load goes over time."""
        frequency = section.quantity("frequency", "Hz", 0.0, 1e6, HERTZ)
        phase = section.quantity("phase", "rad", -100.0, 100.0, DEGREE)
        times, factors = section.get("times"), section.get("factors")
        if "frequency" in section and ("times" in section or "factors" in section):
            section.note("times", "stands beside frequency; allowed: one course over time; delete one")
        if "phase" in section and "frequency" not in section:
            section.note("phase", "stands without frequency; allowed: with it only; delete it")
        if frequency is not None:
            return Harmonic(frequency, phase or 0.0)
        if "times" not in section and "factors" not in section:
            return Constant()
        read = [
            section.quantity_of(value, f"times[{index}]", "s", 0.0, 1e6, Display("s"))
            for index, value in enumerate(times if isinstance(times, list) else [])
        ]
        numbers = fields.real_numbers(factors)
        if numbers is None or len(read) != len(numbers):
            section.note(
                "factors", f"got {short(factors)}; allowed: as many finite numbers as there are times, both as lists"
            )
            return Constant()
        course = tuple(value for value in read if value is not None)
        if course[:2] == (0.0, 0.0):
            section.note(
                "times",
                "jumps at 0 s, from whose loads a run begins at rest; allowed: a jump later; delete the first time",
            )
        return section.made(lambda: Course(course, tuple(numbers))) or Constant()

    def _input(self, section: Table, name: str) -> Input | None:
        """Read an input of the linear analysis."""
        on = fields.place(section, "on")
        if on is not None and on.startswith(MESH):
            return read_mesh_input(section, name, on)
        against = fields.against(section)
        direction = fields.direction(section)
        moment = direction is not None and bool(np.any(direction[3:]))
        unit, display = ("N m", MOMENT) if moment else ("N", FORCE)
        amplitude = section.quantity("amplitude", unit, 1e-12, 1e9, display)
        if on is None or direction is None:
            return None
        return Input(name, on, direction, against, 1.0 if amplitude is None else amplitude)

    def _sensor(self, section: Table, name: str) -> Sensor | None:
        """Read a sensor."""
        on, against = fields.places(section)
        direction = fields.direction(section)
        quantity = section.choice("quantity", _QUANTITIES, required=True)
        if on is None or direction is None or quantity is None:
            return None
        return Sensor(name, on, direction, quantity, against)  # type: ignore[arg-type]

    def _laws(self) -> dict[str, tuple[float, float]]:
        """Read [laws.NAME]: constant stiffness and damping of each contact of a roller."""
        laws = self._top.table("laws", "[laws]")
        found = {}
        for key in laws.entries() if laws else ():
            section = Table(laws.get(key) if laws else None, f"[laws.{key}]", self._top.problems)
            stiffness = section.quantity("stiffness", "N/m", 1.0, 1e13, SPRING, required=True)
            damping = section.quantity("damping", "N s/m", 0.0, 1e9, DAMPER)
            self._close(section)
            if stiffness is not None:
                found[key] = (stiffness, damping or 0.0)
        return found

    def _run_up(self, section: Table, drive: Drive | None) -> RunUp | None:
        """Read [runup]: a ramp, a course by points, or with a drive the first speed alone."""
        driven, pointed = "drive" in self._top, "times" in section or "speeds" in section
        begin = section.quantity("from", "rad/s", -_FASTEST, _FASTEST, RPM, required=not pointed)
        end = section.quantity("to", "rad/s", -_FASTEST, _FASTEST, RPM, required=not (driven or pointed))
        duration = section.quantity("duration", "s", 1e-9, 1e6, Display("s"), required=not pointed)
        for key in ("to", "times", "speeds"):
            if driven and key in section:
                section.note(key, "stands beside [drive], by which the speed follows from torques; delete one of both")
        for key in ("from", "to", "duration"):
            if pointed and key in section:
                section.note(key, "stands beside times and speeds, which say the whole course; delete one of both")
        points = self._points(section) if pointed else None
        step = section.quantity("step", "s", 1e-9, 1.0, MILLISECOND, required=True)
        sample = section.quantity("sample", "s", 1e-9, 1e3, MILLISECOND)
        radius = section.number("spectral_radius", 0.0, 1.0)
        tolerance = section.quantity("tolerance", "m", 1e-15, 1e-3, MICROMETRE)
        self._close(section)
        if step is None or (points is None and (begin is None or duration is None or (end is None and drive is None))):
            return None
        settings = section.made(
            lambda: Settings(
                step,
                step if sample is None else sample,
                0.8 if radius is None else radius,
                math.inf if tolerance is None else tolerance,
            ),
        )
        if settings is None:
            return None
        if points is not None:
            return RunUp(points, points.course.times[-1], settings)
        assert begin is not None and duration is not None
        if end is None:
            assert drive is not None
            return RunUp(DrivenSpeed.of(drive, begin, duration), duration, settings)
        return RunUp(SpeedProfile.ramp(begin, end, duration), duration, settings)

    def _points(self, section: Table) -> SpeedProfile | None:
        """Read times and speeds of a course; None where a problem was noted."""
        times, speeds = section.get("times", "a list"), section.get("speeds", "a list")
        if not (isinstance(times, list) and isinstance(speeds, list) and 2 <= len(times) == len(speeds) <= MOST_POINTS):
            if "times" in section and "speeds" in section:
                allowed = f"2 to {MOST_POINTS} of each, as many, as lists"
                section.note("times", f"got {short(times)} and {short(speeds)}; allowed: {allowed}")
            return None
        at = [section.quantity_of(part, f"times[{k}]", "s", 0.0, 1e6, Display("s")) for k, part in enumerate(times)]
        found = [
            section.quantity_of(part, f"speeds[{k}]", "rad/s", -_FASTEST, _FASTEST, RPM)
            for k, part in enumerate(speeds)
        ]
        known = [(time, speed) for time, speed in zip(at, found, strict=True) if time is not None and speed is not None]
        if len(known) < len(times):
            return None
        return section.made(lambda: SpeedProfile(Course(*map(tuple, zip(*known, strict=True)))))
