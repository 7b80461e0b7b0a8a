"""Job that a job file asks for, as a frozen value in SI."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.jobs.solids import NO_SOLIDS, SolidsKeys
from ehdmaps.maps.backbone_plan import STEPS, Steps
from ehdmaps.physics.approach import StructuralLaw
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.surface import Surface
from ehdmaps.units import Tolerance

MOST_POINTS = 2_000_000
"""Points of one map: a week of the default solver, and 300 MB. More is a slip in the job file."""

MOST_CHECKS = 100_000
"""Random points for the check of the contact laws."""


DEFAULT_CORRECTION_POINTS = 16
"""Points of the dearer solver, where a job asks for a correction and does not say how many."""


@dataclass(frozen=True)
class CorrectedBy:
    """By what the map of a job is corrected.

    Attributes
    ----------
    solver : str
        Name of the dearer solver.
    points : int
        How many points it is asked for.
    options : mapping
        The dearer solver's own keys, those that the file gives in [correction].
    """

    solver: str
    points: int
    options: Mapping[str, Any]


@dataclass(frozen=True)
class Job:
    """One map to be made.

    Attributes
    ----------
    name : str
        Name for titles and for the default output file ("nu308").
    text : str
        Exact text of the job file.
    bearing : BearingGeometry or None
        None for a bare [contact].
    contacts : tuple of LineContact
        Contacts in the order of the contact axis.
    lubricant : Lubricant
        The oil.
    loads : tuple of float
        Loads per unit length [N/m], rising.
    entrainment_speeds : tuple of float
        [m/s], rising.
    temperatures : tuple of float
        [K], rising.
    solver : str
        Name of the solver.
    solver_options : mapping
        The solver's own keys, those that the file gives.
    fill : str
        "neighbours" or "none".
    backbone : str
        "law": solve the lines that a contact law needs, where the solver is made for it; "none": leave them out.
    law_check : int
        Random points at which the contact laws are compared with fresh solves.
    line_steps : Steps
        Largest steps of these lines, with which a map begins.
    supply : OilSupply or None
        Oil supply that the contact laws of the map have by default; None where the job states none, which is flooded.
        The points of the map are those of flooded films.
    surface : Surface or None
        Surfaces that the contact laws of the map have by default; None where the job states none, which is smooth. The
        points of the map are those of smooth surfaces.
    corrected_by : CorrectedBy or None
        Dearer solver by a few points of which the films of the map are corrected, see
        `ehdmaps.jobs.make.correction`; None where they are those of `solver`.
    solids : SolidsKeys
        What the job says of its solids: dimensions for finite elements, and what they found.
    assumed : tuple of str
        What the job leaves to the program, in words: oil, axes, solver.
    tolerances : mapping of str to Tolerance
        Half-widths of what is not known, by keys of [tolerances]: they have bands in words, and change no point.
    """

    name: str
    text: str
    bearing: BearingGeometry | None
    contacts: tuple[LineContact, ...]
    lubricant: Lubricant
    loads: tuple[float, ...]
    entrainment_speeds: tuple[float, ...]
    temperatures: tuple[float, ...]
    solver: str
    solver_options: Mapping[str, Any]
    fill: str = "neighbours"
    backbone: str = "law"
    law_check: int = 0
    line_steps: Steps = STEPS
    supply: OilSupply | None = None
    surface: Surface | None = None
    corrected_by: CorrectedBy | None = None
    solids: SolidsKeys = NO_SOLIDS
    assumed: tuple[str, ...] = field(default=(), compare=False)
    tolerances: Mapping[str, Tolerance] = field(default_factory=dict, compare=False)

    @classmethod
    def build(
        cls,
        *,
        lubricant: Lubricant,
        loads: Iterable[float],
        entrainment_speeds: Iterable[float],
        temperatures: Iterable[float],
        bearing: BearingGeometry | None = None,
        contact: LineContact | None = None,
        material: Material = STEEL,
        supply: OilSupply | None = None,
        surface: Surface | None = None,
        solver: str = "reynolds",
        solver_options: Mapping[str, str | int | float | bool] | None = None,
        structural_law: StructuralLaw = "iso16281",
        fe_approaches: Mapping[str, float] | None = None,
        fill: str = "neighbours",
        backbone: str = "law",
        law_check: int = 0,
        line_steps: Steps = STEPS,
        corrected_by: str | None = None,
        correction_points: int = DEFAULT_CORRECTION_POINTS,
        correction_options: Mapping[str, str | int | float | bool] | None = None,
        name: str = "job",
    ) -> Job:
        """Make a job from values, all in SI.

        Its `text` is written from the values and read again by the reader of job files: the map of such a job carries
        a job file like any other, and what a job file may not say is refused here too. Numbers are kept to the 15
        digits of a job file. An own oil is called "own oil" and a bearing by its dimensions, as there; give them a
        label.

        Parameters
        ----------
        lubricant : Lubricant
            A named oil, or one made by `barus`, `roelands` or `fva3`.
        loads, entrainment_speeds, temperatures : iterable of float
            Axes of the map [N/m], [m/s], [K], rising.
        bearing : BearingGeometry, optional
            Or `contact`.
        contact : LineContact, optional
            A bare line contact; it brings its material and structural law.
        material : Material
            Material of the bearing.
        supply : OilSupply, optional
            Oil supply that contact laws have by default; none is stated if left out.
        surface : Surface, optional
            Rough surfaces that contact laws have by default; none are stated if left out.
        solver : str
            hertz, formula, reynolds or openfoam.
        solver_options : mapping, optional
            The solver's own keys, as in [solver].
        structural_law : {"iso16281", "palmgren", "half_space", "fe"}
            Structural law of the bearing's contacts.
        fe_approaches : mapping of str to float, optional
            Approaches by finite elements of the bearing's contacts by their names [m]; for the law fe those that come
            with the package if left out.
        fill, backbone, law_check, line_steps
            See the attributes.
        corrected_by : str, optional
            Name of a dearer solver whose few points correct the films of `solver`.
        correction_points : int
            How many points it is asked for.
        correction_options : mapping, optional
            The dearer solver's own keys, as in [correction].
        name : str
            Name of the job.

        Raises
        ------
        InputError
            With every value that a job may not have.

        Examples
        --------
        >>> job = Job.build(
        ...     bearing=BearingGeometry.named("NU308"),
        ...     lubricant=Lubricant.named("FVA3"),
        ...     loads=[1e4, 1e5],
        ...     entrainment_speeds=[1.0, 2.0],
        ...     temperatures=[313.15],
        ... )
        >>> job.shape
        (2, 2, 2, 1)
        """
        from ehdmaps.jobs.job_text import job_text, steps_keys
        from ehdmaps.jobs.reader import parse_job

        solids = contact or bearing
        if solids is None or (contact and bearing):
            got = "both" if solids else "none"
            raise InputError(f"Job.build, bearing and contact: got {got}; allowed: one of the two")
        if not corrected_by and correction_options:
            raise InputError("Job.build, correction_options: got some without corrected_by; allowed: together with it")
        text = job_text(
            solids,
            contact.material if contact else material,
            lubricant,
            (loads, entrainment_speeds, temperatures),
            {
                "name": solver,
                "structural_law": contact.structural_law if contact else structural_law,
                "fill": fill,
                "backbone": backbone,
                "law_check": law_check,
                **({} if line_steps == STEPS else {"line_steps": steps_keys(line_steps)}),
                **({"corrected_by": corrected_by, "correction_points": correction_points} if corrected_by else {}),
                **(solver_options or {}),
            },
            supply,
            surface,
            correction_options,
            fe_approaches if contact is None else ({"line": contact.fe_approach} if contact.fe_approach else None),
        )
        job = parse_job(text, name, "Job.build")
        check_oil(lubricant, job, "Job.build, ")
        return job

    @property
    def sha256(self) -> str:
        """Hash of the job file's text."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    @property
    def points(self) -> int:
        """Number of points of the map."""
        return math.prod(self.shape)

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Lengths of the axes contact, load, entrainment speed, temperature."""
        return (len(self.contacts), len(self.loads), len(self.entrainment_speeds), len(self.temperatures))

    @property
    def title(self) -> str:
        """Name of what the contacts belong to, in words."""
        if self.bearing is None:
            return f"line contact R = {self.contacts[0].radius * 1e3:.4g} mm"
        return self.bearing.title

    @property
    def estimates(self) -> tuple[str, ...]:
        """Lines on what of the bearing is estimated, to follow a heading; none where nothing is."""
        return (f"  bearing: {self.bearing.estimated}",) if self.bearing and self.bearing.estimated else ()


def check_oil(oil: Lubricant, job: Job, where: str = "") -> None:
    """Make sure that a job that was written for an oil has this oil.

    Parameters
    ----------
    oil : Lubricant
        The oil that was meant.
    job : Job
        The job, read back from its text.
    where : str
        What the message begins with.

    Raises
    ------
    InputError
        With what of the oil a job file cannot say.
    """
    lost = _differing(oil.record(), job.lubricant.record())
    if lost:
        raise InputError(
            f"{where}lubricant: {', '.join(lost)} of {oil.name!r} cannot be said in a job file; allowed: a named oil, "
            "or one made by Lubricant.barus, roelands, fva3 or own"
        )


_NAMES = ("name", "label", "verified")
"""Entries of a record that are words about it, not numbers of it."""


def _differing(first: Mapping[str, object], second: Mapping[str, object]) -> list[str]:
    """Names of the entries in which two records differ, but for words."""
    estimated = _ESTIMATED if first.get("correlation") and first.get("correlation") == second.get("correlation") else ()
    return sorted(
        key
        for key in first.keys() | second.keys()
        if key not in _NAMES and not _alike(first.get(key), second.get(key), 1e-9 if key in estimated else 1e-14)
    )


_ESTIMATED = "pressure_viscosity_40", "pressure_viscosity_100"
"""Entries that a correlation gives, with the round-off of its powers."""


def _alike(a: object, b: object, tolerance: float) -> bool:
    """Tell whether two entries are the same, to the 15 digits that a job file keeps, or so far."""
    if isinstance(a, float) and isinstance(b, float):
        return math.isclose(a, b, rel_tol=tolerance)
    return a == b
