"""Description of bodies and bearings of a scene, in SI: plain frozen values that check themselves and compute nothing.

Springs, loads, sensors and inputs (`mbs.model.elements`) and gear pairs (`mbs.gears.pair`) are such values already.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, Self

from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.designations.clearance import MOUNTED
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import CrownedProfile, TabulatedProfile
from mbs.bearings.thermal import GivenTemperatures, HeatPaths, Mounting
from mbs.frozen import frozen
from mbs.model.body import Body, Inertia, rigid_problems

if TYPE_CHECKING:
    from mbs.bearings.deviating.tables import Deviations
    from mbs.flexible.plan import Attached, ReductionPlan, Turn
    from mbs.flexible.reduced_body import ReducedBody
    from mbs.flexible.shaft_parts import Disc, Section

Triple = tuple[float, float, float]
ORIGIN: Triple = (0.0, 0.0, 0.0)

RIB_KEYS = ("axial_clearance", "axial_offset", "mirrored")
"""Keys of cylindrical roller bearings that only ribs on both rings take."""

HIGHEST_DAMPING_RATIO = 0.99
"""Of the modes of a body of finite elements."""


@dataclass(frozen=True)
class RigidSpec:
    """A rigid body.

    Attributes
    ----------
    name : str
        Name of the body.
    parts : tuple of Inertia
        What it is made of.
    freedoms : tuple of str
        Some of x, y, z, theta_x, theta_y, theta_z; the others are held.
    position : (float, float, float)
        Position of its frame "centre" [m].
    frames : mapping of str to (float, float, float)
        Further frames, from the position [m].
    spin : float
        Speed about x as a multiple of the system's.

    Raises
    ------
    InputError
        With everything that does not fit together.
    """

    name: str
    parts: Sequence[Inertia]
    freedoms: Sequence[str]
    position: Triple = ORIGIN
    frames: Mapping[str, Triple] = field(default_factory=dict, hash=False)
    spin: float = 0.0

    def __post_init__(self) -> None:
        _freeze(self, "parts", "freedoms")
        problems = Problems(rigid_problems(self.name, self.parts, self.freedoms, self.position, self.frames, self.spin))
        problems.check()


@dataclass(frozen=True)
class ShaftSpec:
    """A flexible shaft of beams with rigid discs; see `mbs.flexible.shaft.flexible_shaft`.

    Attributes
    ----------
    name : str
        Name of the body.
    sections : tuple of Section
        Cylinders that bend.
    freedoms : tuple of str
        Some of x, y, z, theta_x, theta_y, theta_z.
    frames : mapping of str to float
        Places on the axis, along x from the position [m]; in this order they are coordinates.
    cutoff : float or None
        Modes with held frames are kept up to this frequency [Hz]; None: no reduction.
    discs : tuple of Disc
        Rigid parts.
    position : (float, float, float)
        Position of x = 0 of sections, discs and frames [m].
    spin : float
        Speed about x as a multiple of the system's.
    largest_element : float or None
        Length of an element [m]; None: as the cut-off needs it.
    damping_ratio : float
        Damping ratio of the modes of the free shaft at rest.
    cutoff_stated : bool
        Whether its cut-off is stated; one that is not is raised in linear analyses until their modes no longer feel it.
    files : tuple of Path
        Files that were read for it; they are no part of what it is.

    Raises
    ------
    InputError
        With everything that does not fit together.
    """

    name: str
    sections: Sequence[Section]
    freedoms: Sequence[str]
    frames: Mapping[str, float] = field(hash=False)
    cutoff: float | None
    discs: Sequence[Disc] = ()
    position: Triple = ORIGIN
    spin: float = 0.0
    largest_element: float | None = None
    damping_ratio: float = 0.0
    cutoff_stated: bool = True
    files: Sequence[Path] = field(default=(), compare=False)

    def __post_init__(self) -> None:
        from mbs.flexible.shaft_parts import shaft_problems

        _freeze(self, "sections", "freedoms", "discs", "files")
        problems = shaft_problems(
            self.sections,
            self.discs,
            self.freedoms,
            self.position,
            self.frames,
            self.spin,
            self.largest_element,
            self.cutoff,
            self.damping_ratio,
        )
        if problems:
            raise InputError([f"shaft {self.name!r}, {problem}" for problem in problems])


@dataclass(frozen=True)
class FlexibleSpec:
    """A body of finite elements, which does not turn.

    Attributes
    ----------
    name : str
        Name of the body.
    source : Path, ReductionPlan or ReducedBody
        A file of a reduced body; or matrices and how to reduce them; or a body that was reduced already.
    position : (float, float, float)
        Position of the origin of the finite elements [m].
    damping_ratio : float
        Damping ratio of every mode of the free body.
    attached : tuple of Attached
        Rigid parts on its frames, along the x of the system.
    rotation : tuple of Turn
        How it is turned about its origin, the first turn first.
    """

    name: str
    source: Path | ReductionPlan | ReducedBody
    position: Triple = ORIGIN
    damping_ratio: float = 0.0
    attached: Sequence[Attached] = ()
    rotation: Sequence[Turn] = ()

    def __post_init__(self) -> None:
        _freeze(self, "attached", "rotation")

    @property
    def spin(self) -> float:
        """0: it does not turn."""
        return 0.0

    @property
    def files(self) -> tuple[Path, ...]:
        """All files that are read for it."""
        from mbs.flexible.plan import ReductionPlan

        if isinstance(self.source, Path):
            return (self.source,)
        return self.source.files if isinstance(self.source, ReductionPlan) else ()


BodySpec = RigidSpec | ShaftSpec | FlexibleSpec | Body
"""What a scene has as bodies; a `Body` of matrices of one's own is taken as it is."""


class ElementSpec(Protocol):
    """Machine element of a scene: a frozen value of a class that `mbs.scene.kinds` knows."""

    @property
    def name(self) -> str:
        """For messages and results."""
        ...


@dataclass(frozen=True)
class BearingSpec:
    """A bearing between two places.

    Attributes
    ----------
    name : str
        Name of the bearing.
    inner, outer : str
        Places of its rings.
    geometry : BearingGeometry
        Raceways, rollers and the clearance of the scene.
    profile : {"iso", "straight"}, CrownedProfile or TabulatedProfile
        Profile of the rollers.
    slices : int
        Slices of a roller.
    start_angle : float
        Angle of the first roller from y [rad].
    rollers_as_bodies : bool
        Whether each roller has a radial freedom, between two contacts with a law each.
    centrifugal : bool
        Whether the centrifugal load of the rollers is taken into account.
    thermal : GivenTemperatures, HeatPaths or None
        Temperatures of its raceways, or where its heat goes; None for the temperature of the scene, and no heat.
    mounting : Mounting or None
        Fits, and how it expands; None for the expansion of steel alone where it has `thermal`, else for a clearance
        that is the one in operation.
    supply : OilSupply or None
        Oil supply of this bearing; None for that of the scene.
    slices_coupled : bool
        Whether the slices of a roller know of their neighbours.
    pocket_clearance : float or None
        Clearance of a roller in its pocket of the cage [m]; None for rollers that roll without slip.
    between_ribs : TaperedSpec or None
        The same bearing as ribs on both rings hold it, for a shaft that moves along x; None without such ribs.
    deviations : Deviations or None
        Deviations from its form, see `mbs.bearings.deviating.tables`.
    of_points : bool
        Whether its contacts are points, see `LocatingSpec`; they are lines.
    """

    of_points: ClassVar[bool] = False
    name: str
    inner: str
    outer: str
    geometry: BearingGeometry
    profile: str | CrownedProfile | TabulatedProfile = "iso"
    slices: int = 41
    start_angle: float = 0.0
    rollers_as_bodies: bool = False
    centrifugal: bool = False
    thermal: GivenTemperatures | HeatPaths | None = None
    mounting: Mounting | None = None
    supply: OilSupply | None = None
    slices_coupled: bool = False
    pocket_clearance: float | None = None
    between_ribs: TaperedSpec | None = None
    deviations: Deviations | None = None

    def __post_init__(self) -> None:
        reach = self.geometry.clearance_range
        fitted = self.mounting is not None and self.mounting.shaft is not None
        if fitted and reach is not None and reach.taken == MOUNTED:
            # what the fit takes of a clearance by its class is known then, and taken in operation
            object.__setattr__(self, "geometry", self.geometry.delivered(reach.unmounted))

    @property
    def changes_in_operation(self) -> bool:
        """True where its temperatures and its clearance in operation are others than the scene states."""
        return self.thermal is not None or self.mounting is not None


@dataclass(frozen=True)
class LocatingSpec:
    """A bearing that carries axial load, between two places.

    Attributes
    ----------
    name : str
        Name of the bearing.
    inner, outer : str
        Places of its rings, of tapered rollers in the middles of the rollers.
    geometry : BallGeometry or TaperedGeometry
        Raceways and rolling elements; which way it stands by the sign of its contact angle, or by what it carries.
    start_angle : float
        Angle of the first rolling element from y [rad].
    axial_offset : float
        Way of the inner ring along x against the outer one where both places have not moved [m].
    deviations : Deviations or None
        Deviations from its form, see `mbs.bearings.deviating.tables`.
    of_points : bool
        Whether its contacts are points, else lines.
    """

    of_points: ClassVar[bool] = False
    name: str
    inner: str
    outer: str
    geometry: Any
    start_angle: float = 0.0
    axial_offset: float = 0.0
    deviations: Deviations | None = None

    @property
    def elements(self) -> str:
        """Its rolling elements in words."""
        raise NotImplementedError

    def with_clearance(self, clearance: float) -> Self:
        """The bearing with another diametral clearance [m], if it has one."""
        return replace(self, geometry=self.geometry.with_clearance(clearance))

    def sliced(self, change: Callable[[int], int]) -> Self:
        """The bearing with another number of slices of a roller, by the number of before, if it has rollers."""
        return self


@dataclass(frozen=True)
class BallSpec(LocatingSpec):
    """A ball bearing, see `LocatingSpec`."""

    of_points: ClassVar[bool] = True

    @property
    def elements(self) -> str:
        """Its rolling elements in words."""
        return f"{self.geometry.rolling_elements} balls"


@dataclass(frozen=True)
class TaperedSpec(LocatingSpec):
    """A tapered roller bearing, or one of cylindrical rollers between ribs, see `LocatingSpec`.

    Attributes
    ----------
    profile : {"iso", "straight"}, CrownedProfile or TabulatedProfile
        Profile of the rollers.
    slices : int
        Slices of a roller.
    without, given : tuple of str
        Keys that were given and that it does not take, and keys of its ribs, until its bodies are known; then none.
    """

    profile: str | CrownedProfile | TabulatedProfile = "iso"
    slices: int = 21
    without: Sequence[str] = ()
    given: Sequence[str] = ()

    @property
    def elements(self) -> str:
        """Its rolling elements in words."""
        return f"{self.geometry.rolling_elements} rollers"

    def sliced(self, change: Callable[[int], int]) -> Self:
        """See `LocatingSpec.sliced`."""
        return replace(self, slices=change(self.slices))


def _freeze(spec: object, *names: str) -> None:
    """Make tuples of what may be given as lists, and frozen copies of mappings."""
    for name in names:
        object.__setattr__(spec, name, tuple(getattr(spec, name)))
    if hasattr(spec, "frames"):
        object.__setattr__(spec, "frames", frozen(spec.frames))
