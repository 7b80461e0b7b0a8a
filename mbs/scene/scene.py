"""A scene: what a scene file says, in SI. `mbs.scene.reader` reads it, `mbs.scene.assembly` makes a system of it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from mbs.gears.pair import GearPair
from mbs.model.body import Body
from mbs.model.elements import Input, Load, Sensor, Spring
from mbs.settings import CampbellSettings, RunUp, SweepRange


@dataclass(frozen=True)
class SceneBearing:
    """A bearing of a scene.

    Attributes
    ----------
    name, inner, outer : str
        Name and places.
    geometry : BearingGeometry
        With the clearance of the scene.
    profile : {"iso", "straight"}
        Of the rollers.
    slices : int
        Of a roller.
    start_angle : float
        Of the first roller from y [rad].
    rollers_as_bodies : bool
        Whether each roller has a radial freedom, between two contacts with a law each.
    centrifugal : bool
        Whether the centrifugal load of the rollers is taken into account.
    """

    name: str
    inner: str
    outer: str
    geometry: BearingGeometry
    profile: str = "iso"
    slices: int = 41
    start_angle: float = 0.0
    rollers_as_bodies: bool = False
    centrifugal: bool = False


@dataclass(frozen=True, eq=False)
class Scene:
    """All that a scene file says.

    Attributes
    ----------
    name, title, text : str
        Name of the file, its own title, and the file itself.
    speed : float
        Operating speed of the system [rad/s].
    temperature : float
        Of the oil [K].
    lubricant : Lubricant or None
        For the law `formula`.
    bodies : tuple of Body
        Rigid ones, shafts, and reduced finite-element bodies.
    springs, loads, bearings, gears, inputs, sensors : tuple
        The other parts.
    laws : dict of str to (float, float)
        Constant stiffness [N/m] and damping [N s/m] of each contact of a roller, by name.
    frequencies : tuple of float
        Of the linear analysis [Hz].
    run_up : RunUp or None
        Of the analysis in time.
    sweep : SweepRange or None
        Speeds of the analysis over speed.
    campbell : CampbellSettings
        What is drawn of a run-up.
    assumed : tuple of str
        Which of its numbers are assumptions.
    files : tuple of Path
        All files that were read for it: the scene file where it came from one, reduced bodies, matrices, meshes.
    """

    name: str
    title: str
    text: str
    speed: float
    temperature: float
    lubricant: Lubricant | None
    bodies: tuple[Body, ...]
    springs: tuple[Spring, ...]
    loads: tuple[Load, ...]
    bearings: tuple[SceneBearing, ...]
    gears: tuple[GearPair, ...]
    inputs: tuple[Input, ...]
    sensors: tuple[Sensor, ...]
    laws: dict[str, tuple[float, float]]
    frequencies: tuple[float, ...]
    run_up: RunUp | None
    sweep: SweepRange | None
    campbell: CampbellSettings
    assumed: tuple[str, ...]
    files: tuple[Path, ...] = ()
