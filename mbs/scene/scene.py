"""A scene: what a scene file says, in SI. `mbs.scene.reader` reads it, `mbs.scene.assembly` makes a system of it."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ehdmaps.errors import Problems
from ehdmaps.physics.contact import OIL_TEMPERATURES
from ehdmaps.physics.designations.clearance import ClearanceRange, clearance_range
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import Surface
from mbs.gears.pair import GearPair
from mbs.model.elements import Input, Load, Sensor, Spring
from mbs.scene.specs import (
    ORIGIN,
    BearingSpec,
    BodySpec,
    ElementSpec,
    FlexibleSpec,
    LocatingSpec,
    ShaftSpec,
    Triple,
)
from mbs.scene.turning import OrderLoad, Unbalance
from mbs.settings import CampbellSettings, RunUp, SweepRange

if TYPE_CHECKING:
    from ehdmaps.units import Tolerance

_SEQUENCES = (
    "bodies",
    "springs",
    "loads",
    "unbalances",
    "excitations",
    "elements",
    "inputs",
    "sensors",
    "frequencies",
    "assumed",
)


_LOOKED_AT = 200
"""Parts of a run-up at whose ends its speed is looked at."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Scene:
    """All that a scene file says; it may be made without one.

    Attributes
    ----------
    name : str
        Name of the file, or of the scene.
    title, text : str
        Title (the name if left out), and the text of the file (empty without one).
    speed : float
        Operating speed of the system [rad/s].
    temperature : float
        Temperature of the raceways [K].
    lubricant : Lubricant or None
        Oil of the law `formula`, and of planned maps.
    supply : OilSupply or None
        Oil supply of the bearings that have none of their own; None for that which the job of the map states.
    surface : Surface or None
        Surfaces of the contacts; None for those that the job of the map states.
    bodies : tuple of RigidSpec, ShaftSpec, FlexibleSpec or Body
        All bodies, in the order of their coordinates.
    springs : tuple of Spring
        Linear springs.
    loads : tuple of Load
        Prescribed forces.
    unbalances : tuple of Unbalance
        Masses off the axes of bodies that spin.
    excitations : tuple of OrderLoad
        Loads that pulsate by an order of a spin.
    gravity : (float, float, float)
        Acceleration of gravity [m/s2], which acts on all bodies.
    elements : tuple of BearingSpec, GearPair and others
        Machine elements, of the classes that `mbs.scene.kinds` lists.
    inputs, sensors : tuple
        Loads that a linear analysis varies, and motions that it gives.
    laws : dict of str to (float, float)
        Constant stiffness [N/m] and damping [N s/m] of each contact of a roller, by name.
    frequencies : tuple of float
        Frequencies of the linear analysis [Hz].
    run_up : RunUp or None
        Course of the analysis in time.
    sweep : SweepRange or None
        Speeds of the analysis over speed.
    campbell : CampbellSettings
        What is drawn of a run-up.
    assumed : tuple of str
        Which of its numbers are assumptions.
    tolerances : mapping of str to Tolerance
        How well its numbers are known, as far as it is stated, see `mbs.unknowns.statement`.
    file : Path or None
        The scene file.

    Raises
    ------
    InputError
        For a speed or a temperature out of range.

    Examples
    --------
    >>> from mbs import Inertia, RigidSpec, assemble
    >>> mass = RigidSpec("mass", [Inertia(2.0, 0.01, 0.01)], ["y"])
    >>> assemble(Scene(name="one mass", speed=0.0, temperature=313.15, bodies=[mass])).system.coordinates
    ('mass.y',)
    """

    name: str
    title: str = ""
    text: str = ""
    speed: float
    temperature: float
    lubricant: Lubricant | None = None
    supply: OilSupply | None = None
    surface: Surface | None = None
    bodies: Sequence[BodySpec]
    springs: Sequence[Spring] = ()
    loads: Sequence[Load] = ()
    unbalances: Sequence[Unbalance] = ()
    excitations: Sequence[OrderLoad] = ()
    gravity: Triple = ORIGIN
    elements: Sequence[ElementSpec] = ()
    inputs: Sequence[Input] = ()
    sensors: Sequence[Sensor] = ()
    laws: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    frequencies: Sequence[float] = ()
    run_up: RunUp | None = None
    sweep: SweepRange | None = None
    campbell: CampbellSettings = field(default_factory=CampbellSettings)
    assumed: Sequence[str] = ()
    tolerances: Mapping[str, Tolerance] = field(default_factory=dict)
    file: Path | None = None

    def __post_init__(self) -> None:
        for name in _SEQUENCES:
            object.__setattr__(self, name, tuple(getattr(self, name)))
        object.__setattr__(self, "title", self.title or self.name)
        problems = Problems()
        if not math.isfinite(self.speed):
            problems.append(f"scene, speed: got {self.speed!r} rad/s; allowed: finite")
        low, high = OIL_TEMPERATURES
        if not low <= self.temperature <= high:
            problems.append(f"scene, temperature: got {self.temperature!r} K; allowed: {low:g} to {high:g} K")
        problems.check()

    @property
    def bearings(self) -> tuple[BearingSpec, ...]:
        """The bearings among the machine elements."""
        return tuple(entry for entry in self.elements if isinstance(entry, BearingSpec))

    @property
    def located(self) -> tuple[LocatingSpec, ...]:
        """The bearings that carry axial load among the machine elements."""
        return tuple(entry for entry in self.elements if isinstance(entry, LocatingSpec))

    @property
    def has_points(self) -> bool:
        """Tell whether it has bearings whose contacts are points: of balls."""
        return any(entry.of_points for entry in self.located)

    @property
    def located_clearances(self) -> set[float]:
        """Diametral clearances of these [m], of those that have one."""
        return {entry.geometry.clearance for entry in self.located} - {None}

    @property
    def of_all_kinds(self) -> tuple[BearingSpec | LocatingSpec, ...]:
        """Bearings of rollers and balls of all kinds: those without axial load, then the others."""
        return (*self.bearings, *self.located)

    @property
    def has_bearings(self) -> bool:
        """Tell whether it has a bearing of any kind."""
        return bool(self.bearings or self.located)

    @property
    def clearance_ranges(self) -> dict[str, tuple[str, ClearanceRange]]:
        """Ranges of clearances that are not stated, or beside a class: designation and range, by the bearing."""
        found = {}
        for entry in self.of_all_kinds:
            if (reach := clearance_range(entry.geometry)) is not None:
                found[entry.name] = entry.geometry.name, reach
        return found

    @property
    def gears(self) -> tuple[GearPair, ...]:
        """The gear pairs among the machine elements."""
        return tuple(entry for entry in self.elements if isinstance(entry, GearPair))

    @property
    def fastest(self) -> float:
        """Highest speed of operation, sweep and run-up [rad/s]."""
        swept = self.sweep.speeds.tolist() if self.sweep else []
        run = self.run_up.speed.course.values if self.run_up else ()
        return max(abs(float(speed)) for speed in (self.speed, *swept, *run))

    @property
    def operating_range(self) -> tuple[float, float]:
        """Lowest and highest speed of operation [rad/s]: that of the run-up and the operating speed."""
        speeds = [abs(self.speed)]
        if self.run_up is not None:
            times = (self.run_up.duration * k / _LOOKED_AT for k in range(_LOOKED_AT + 1))
            speeds += [abs(float(self.run_up.speed.at(time)[0])) for time in times]
        return min(speeds), max(speeds)

    @property
    def weight(self) -> str:
        """Words on whether the weight of the bodies is in what an analysis finds."""
        if not any(self.gravity):
            return "without weight (no gravity in [operation])"
        axes = [f"{'-' if value < 0.0 else ''}{name}" for name, value in zip("xyz", self.gravity, strict=True) if value]
        words = f"along {axes[0]}" if len(axes) == 1 else f"in {', '.join(axes)}"
        return f"with weight ({math.hypot(*self.gravity):.4g} m/s2 {words})"

    @property
    def files(self) -> tuple[Path, ...]:
        """All files that are read for it: the scene file where there is one, sections, reduced bodies, meshes."""
        own = () if self.file is None else (self.file,)
        bodies = (path for body in self.bodies if isinstance(body, (FlexibleSpec, ShaftSpec)) for path in body.files)
        return tuple(dict.fromkeys((*own, *bodies)))

    def with_bearings(self, bearings: Iterable[BearingSpec]) -> Scene:
        """The scene with other bearings, each in the place of the one in the same order."""
        others = iter(tuple(bearings))
        changed = [next(others) if isinstance(entry, BearingSpec) else entry for entry in self.elements]
        return dataclasses.replace(self, elements=changed)

    def with_located(self, change: Callable[[LocatingSpec], LocatingSpec]) -> Scene:
        """The scene with each bearing that carries axial load changed."""
        changed = [change(entry) if isinstance(entry, LocatingSpec) else entry for entry in self.elements]
        return dataclasses.replace(self, elements=changed)
