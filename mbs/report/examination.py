"""Everything that the report of a scene tells: equilibrium, modes, speeds, responses dry and with films.

What fails is told, too.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ehdmaps.arrays import ComplexArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.trade.record import Trade
from mbs.analyses.lsa import LsaResult, lsa_of
from mbs.analyses.modes import ModesResult, modes
from mbs.analyses.operating import operating
from mbs.analyses.statics import StaticsResult, statics
from mbs.analyses.sweep import CriticalResult, SweepSettings, critical, sweep
from mbs.budget import error_budget
from mbs.linearised.averaged import mean_equilibrium
from mbs.linearised.mode_names import mode_names
from mbs.linearised.modes import modes as modes_at
from mbs.linearised.sweep_result import Sweep
from mbs.model.elements import Operation
from mbs.model.findings import Finding
from mbs.output.result_text import kinds
from mbs.scene.assembly import Model
from mbs.scene.map_set import MapSet
from mbs.scene.scene import Scene
from mbs.scene.subject import Subject, named_law
from mbs.settings import CAGE_ANGLES, SweepRange

R = TypeVar("R")

MOST_SPEEDS = 9
"""Speeds of the short sweep: modes are followed between them."""

_BELOW, _ABOVE = 0.25, 1.5
"""Speeds of a scene without [sweep], as parts of its operating speed."""


_SAME = 1e-3
"""Distance of two eigenvalues, as a part of them, up to which they are those of one mode."""


@dataclass(frozen=True, eq=False)
class Named:
    """Oscillating modes at a speed with their names.

    Attributes
    ----------
    eigenvalues : array, shape (modes,)
        [1/s].
    names : tuple of str
        Names by where their energy is, see `mbs.linearised.mode_names`.
    """

    eigenvalues: ComplexArray
    names: tuple[str, ...]

    def of(self, eigenvalue: complex) -> str:
        """Name of the mode of an eigenvalue; empty where there is none.

        Parameters
        ----------
        eigenvalue : complex
            [1/s], of positive imaginary part.
        """
        if not self.eigenvalues.size or not np.isfinite(eigenvalue):
            return ""
        apart = np.abs(self.eigenvalues - eigenvalue)
        nearest = int(np.argmin(apart))
        return self.names[nearest] if apart[nearest] <= _SAME * abs(eigenvalue) else ""


@dataclass(frozen=True, eq=False)
class OverSpeed:
    """Modes over speed, with names, and what is critical.

    Attributes
    ----------
    sweep : Sweep
        Modes over speed.
    names : tuple of str
        Names of the complex modes of the sweep, at its speed nearest to operation; empty where a mode is not there.
    critical : CriticalResult or None
        Critical speeds and responses to loads that turn; None where no body spins.
    critical_names : tuple of str
        Names of the modes of the critical speeds, there, without their whirl.
    findings : tuple of Finding
        Findings about the bearings.
    """

    sweep: Sweep
    names: tuple[str, ...]
    critical: CriticalResult | None
    critical_names: tuple[str, ...]
    findings: tuple[Finding, ...]


@dataclass(frozen=True, eq=False)
class Examination:
    """Findings about a scene.

    Attributes
    ----------
    statics : StaticsResult
        Equilibrium of the scene.
    modes : ModesResult or str
        Modes at the equilibrium, or why there are none.
    speeds : OverSpeed or str
        Modes over speed, or why there are none.
    maps : MapSet or None
        The maps of its law.
    budget : Trade or str
        Error budget of the machine, or why there is none; empty where it was not looked for.
    banded : bool
        Whether bands of what is not known stand beside modes.
    transfer : tuple of LsaResult or str
        Responses of the sensors to the inputs with the law, then dry where its contacts are not; or why there are none.
    """

    statics: StaticsResult
    modes: ModesResult | str
    speeds: OverSpeed | str
    maps: MapSet | None
    budget: Trade | str = ""
    banded: bool = False
    transfer: tuple[LsaResult, ...] | str = ""

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Findings about the bearings, in operation and over speed."""
        swept = self.speeds.findings if isinstance(self.speeds, OverSpeed) else ()
        known = {(one.bearing, one.cause) for one in self.statics.findings}
        return (*self.statics.findings, *(one for one in swept if (one.bearing, one.cause) not in known))

    @property
    def model(self) -> Model:
        """The model in operation."""
        return self.statics.model


def examined(
    model: Model,
    maps: MapSet | None,
    speeds: SweepRange | None,
    swept: bool = True,
    subject: Subject | None = None,
    banded: bool = False,
    found: CriticalResult | None = None,
) -> Examination:
    """Find it.

    Parameters
    ----------
    model : Model
        Scene with its law.
    maps : MapSet or None
        The maps of the law.
    speeds : SweepRange or None
        Speeds of the sweep; a few of [sweep] of the scene, or about its operating speed, if None.
    swept : bool
        Whether there is a sweep at all.
    subject : Subject, optional
        The scene with its law, of which there is an error budget, and a dry machine beside it; none if left out.
    banded : bool
        Whether bands of what is not known stand beside modes.
    found : CriticalResult or None
        Critical speeds over these speeds with the same law, where they are known already, with their bands.

    Raises
    ------
    AnalysisError
        If there is no equilibrium.
    """
    budget: Trade | str = ""
    if subject is not None and model.bearings:
        budget = _or_reason(lambda: error_budget(subject, highest_of(model.scene)))
    return Examination(
        statics(model),
        _or_reason(lambda: modes(model)),
        _or_reason(lambda: _over_speed(model, speeds, found)) if swept else "",
        maps,
        budget,
        banded and model.scene.has_bearings,
        _or_reason(lambda: _transfer(model, subject)),
    )


def highest_of(scene: Scene) -> float:
    """Highest frequency that matters to a scene [Hz].

    Parameters
    ----------
    scene : Scene
        The scene.
    """
    return float(max(scene.frequencies, default=scene.campbell.highest))


def speeds_of(scene: Scene) -> SweepRange | None:
    """Speeds of the Campbell diagram where none are given: those of [sweep], or around the operating speed.

    Parameters
    ----------
    scene : Scene
        The scene; None for one that stands still and has no [sweep].
    """
    if scene.sweep is not None:
        return SweepRange(scene.sweep.begin, scene.sweep.end, min(scene.sweep.points, MOST_SPEEDS))
    return SweepRange(_BELOW * scene.speed, _ABOVE * scene.speed, MOST_SPEEDS) if scene.speed > 0.0 else None


def _over_speed(model: Model, speeds: SweepRange | None, found: CriticalResult | None) -> OverSpeed:
    """Modes over a few speeds without frequency responses, and critical speeds where a body spins."""
    scene = model.scene
    speeds = speeds or speeds_of(scene)
    if speeds is None:
        raise AnalysisError("the scene stands still and has no [sweep]; --speed gives speeds")
    if found is None and any(body.spin for body in scene.bodies):
        found = critical(model, SweepSettings(speeds, besides=(*scene.operating_range, abs(scene.speed))))
    if found is not None:
        swept, findings = found.sweep, found.findings
    else:
        bare = dataclasses.replace(model, scene=dataclasses.replace(scene, frequencies=()))
        result = sweep(bare, SweepSettings(speeds))
        swept, findings = result.sweeps[0], result.findings[0]
    own = found.model if found is not None else model
    place = int(np.argmin(np.abs(np.abs(swept.speeds) - abs(scene.speed))))
    named = named_at(own, float(swept.speeds[place]), whirl=True)
    names = tuple(map(named.of, swept.damped.eigenvalues[place].tolist()))
    told = (
        tuple(named_at(own, one.speed, whirl=False).of(one.eigenvalue) for one in found.found)
        if found is not None
        else ()
    )
    return OverSpeed(swept, names, found, told, findings)


def named_at(model: Model, speed: float, *, whirl: bool) -> Named:
    """Oscillating modes at a speed, with their names.

    Parameters
    ----------
    model : Model
        Scene with its law.
    speed : float
        Speed of the system [rad/s].
    whirl : bool
        Whether names end with the direction of whirl.
    """
    balance = mean_equilibrium(operating(model, speed).system, Operation(speed), CAGE_ANGLES)
    found = modes_at(balance, errors=False)
    swinging = kinds(found)[2]
    return Named(found.eigenvalues[swinging], tuple(mode_names(balance, found, swinging, whirl).values()))


def _transfer(model: Model, subject: Subject | None) -> tuple[LsaResult, ...]:
    """Responses with the law, and dry beside them."""
    models = [model]
    if subject is not None and subject.law.may_relax and model.scene.has_bearings:
        models.append(dataclasses.replace(subject, law=named_law("hertz", subject.scene)).model())
    return tuple(lsa_of(models))


def _or_reason(find: Callable[[], R]) -> R | str:
    """The result, or why there is none."""
    try:
        return find()
    except (AnalysisError, InputError) as error:
        return str(error)
