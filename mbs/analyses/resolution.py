"""What the steps of a run resolve, and what the method of integration takes from oscillations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbs.linearised.modes import free_motions, undamped_modes
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.scene.assembly import Model
from mbs.scene.fields import HERTZ, MICROSECOND, MILLISECOND
from mbs.settings import RunUp
from mbs.transient.numerical_damping import RESOLVED, energy_lost, numerical_damping_ratio


@dataclass(frozen=True)
class Resolution:
    """What the steps of a run resolve.

    Attributes
    ----------
    step, spectral_radius : float
        Length of the steps [s]; spectral radius of the method.
    highest : float
        Highest frequency of which a period has `RESOLVED` steps [Hz].
    lowest_mode : float
        Lowest natural frequency at the first speed, without free motions and damping [Hz]; NaN if there is none.
    excitation : float
        Highest frequency at which gears mesh, or else rollers pass [Hz]; NaN without either.
    looked_at : float
        Highest frequency that is of interest [Hz].
    """

    step: float
    spectral_radius: float
    highest: float
    lowest_mode: float
    excitation: float
    looked_at: float

    @property
    def unresolved(self) -> tuple[str, ...]:
        """What steps are too long for, in words."""
        named = (
            ("the lowest mode of the system is at", self.lowest_mode),
            ("it is excited with up to", self.excitation),
        )
        return tuple(f"{words} {value:.4g} Hz" for words, value in named if value > self.highest)

    @property
    def needed(self) -> float:
        """Longest step that would resolve what is not [s]; the step itself where all is resolved."""
        worst = np.nanmax([self.highest, self.lowest_mode, self.excitation])
        return self.step * self.highest / float(worst)

    def lost(self, frequency: float) -> float:
        """Part of the energy of an oscillation that the method takes in a second, 0 to 1.

        Parameters
        ----------
        frequency : float
            Frequency of the oscillation [Hz].
        """
        return energy_lost(self.spectral_radius, self.step, frequency)

    def ratio(self, frequency: float) -> float:
        """Damping ratio that takes as much.

        Parameters
        ----------
        frequency : float
            Frequency of the oscillation [Hz].
        """
        return numerical_damping_ratio(self.spectral_radius, self.step, frequency)


def resolution(model: Model, course: RunUp) -> Resolution:
    """What the steps of a run resolve of its modes at the first speed, and of its excitation.

    Parameters
    ----------
    model : Model
        Scene with its law.
    course : RunUp
        Speed and steps.

    Raises
    ------
    AnalysisError
        If there is no equilibrium at the first speed.
    """
    balance = equilibrium(model.system, Operation(course.speed.at(0.0)[0]))
    found = undamped_modes(balance).frequency
    swinging = found[~free_motions(found)]
    fastest = float(np.max(np.abs(course.speed.course.values))) / (2.0 * np.pi)
    excitations = [entry for one in model.system.elements if (entry := one.element.excitation) is not None]
    rank = max((entry.rank for entry in excitations), default=0)
    orders = [entry.order for entry in excitations if entry.rank == rank]
    settings = course.settings
    return Resolution(
        settings.step,
        settings.spectral_radius,
        1.0 / (RESOLVED * settings.step),
        float(swinging.min()) if swinging.size else float("nan"),
        max(orders) * fastest if orders else float("nan"),
        model.scene.campbell.highest,
    )


def step_lines(found: Resolution) -> list[str]:
    """Lines on what the steps of a run resolve, and on what the method takes from oscillations.

    Parameters
    ----------
    found : Resolution
        What they resolve.
    """
    high = min(found.highest, found.looked_at)
    losses = " and ".join(_lost(found, part * high) for part in (0.5, 1.0))
    taken = (
        "the method of integration takes no energy (spectral radius 1)"
        if found.spectral_radius == 1.0
        else f"numerical damping (spectral radius {found.spectral_radius:g}) takes {losses} of the energy of an "
        "oscillation in 1 s"
    )
    step = MICROSECOND.text(found.step) if found.step < 1e-3 else MILLISECOND.text(found.step)
    lines = [f"steps of {step}: {RESOLVED:g} a period at {HERTZ.text(found.highest)}; {taken}"]
    if found.unresolved:
        needed = MICROSECOND.text(found.needed, 3) if found.needed < 1e-3 else MILLISECOND.text(found.needed, 3)
        lines.append(
            f"warning: steps of {step} do not resolve what moves here: {', and '.join(found.unresolved)}; this run "
            f"is a row of equilibria at best; take steps of {needed} or less in [runup]"
        )
    return lines


def _lost(found: Resolution, frequency: float) -> str:
    """What an oscillation loses in a second, and the damping ratio that takes as much."""
    part = found.lost(frequency)
    words = f"{100.0 * part:.3g} %" if 1e-6 < part < 0.9995 else "less than 0.0001 %" if part < 0.5 else "all"
    return f"{words} at {HERTZ.text(frequency)} (a damping ratio of {found.ratio(frequency):.2g})"
