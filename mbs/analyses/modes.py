"""Complex modes of the system linearised at its equilibrium."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import xarray as xr

from mbs.analyses.film_errors import film_errors
from mbs.analyses.operating import operating, settled, states_of
from mbs.analyses.soundness import findings_at_rest, with_findings
from mbs.linearised.averaged import mean_equilibrium
from mbs.linearised.modes import Modes
from mbs.linearised.modes import modes as modes_at
from mbs.linearised.validity import FilmError
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium
from mbs.model.findings import Finding
from mbs.output.files import described
from mbs.output.results import modes_dataset, with_states
from mbs.scene.assembly import Model, law_attributes
from mbs.settings import CAGE_ANGLES, HIGHEST, check_cage_angles

if TYPE_CHECKING:
    from mbs.output.files import Figure
    from mbs.unknowns.of_modes import ModeBands


@dataclass(frozen=True, eq=False)
class ModesResult:
    """Modes, and the equilibrium that they belong to.

    Attributes
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium at which the system was linearised, gear meshes and bearings with their mean stiffness.
    modes : Modes
        Eigenvalues, shapes and strain-energy shares.
    errors : tuple of FilmError
        How wrong the films of each bearing are estimated to be; empty for laws without films.
    dataset : xarray.Dataset
        What `mbs modes -o` writes.
    findings : tuple of Finding
        What is beyond the laws of its bearings.
    """

    model: Model
    balance: Equilibrium
    modes: Modes
    errors: tuple[FilmError, ...]
    dataset: xr.Dataset
    findings: tuple[Finding, ...] = ()

    @property
    def highest(self) -> float:
        """Highest frequency that is of interest [Hz]: that of [linear] of the scene, else 10 kHz."""
        return max(self.model.scene.frequencies, default=HIGHEST)

    @cached_property
    def bands(self) -> ModeBands:
        """Bands of what is not known, of modes up to `highest`: found when they are asked for, in seconds."""
        return self.bands_to(self.highest)

    def bands_to(self, highest: float) -> ModeBands:
        """Bands of what is not known, of modes up to a frequency.

        Parameters
        ----------
        highest : float
            [Hz].
        """
        from mbs.unknowns.of_modes import bands_of

        return bands_of(self.model, self.balance, self.modes, highest)

    def plot(self, highest: float | None = None, bands: ModeBands | None = None) -> Figure:
        """Figure that `mbs modes --plot` writes: frequencies, damping ratios and strain energy of the modes.

        Parameters
        ----------
        highest : float, optional
            Highest frequency that is drawn [Hz]; that of [linear] of the scene, else 10 kHz, if left out.
        bands : ModeBands, optional
            Bands of what is not known of the modes, told below them in place of numerics.
        """
        from mbs.output.modes_plot import modes_figure
        from mbs.output.result_text import above_lines, free_lines, kinds

        highest = self.highest if highest is None else highest
        free, overdamped, swinging = kinds(self.modes)
        inside = self.modes.frequency[swinging] <= highest
        notes = [*free_lines(free, self.model.system), *above_lines(self.modes, swinging[~inside], highest)]
        notes += [f"{overdamped.size} overdamped motions not drawn"] if overdamped.size else []
        limit = min((entry.frequency for entry in self.errors), default=math.inf)
        return modes_figure(self.model, self.modes, swinging[inside], limit, "; ".join(notes), bands)


def modes(
    model: Model,
    operation: Operation | None = None,
    cage_angles: int = CAGE_ANGLES,
    highest: float | None = None,
) -> ModesResult:
    """Find the complex modes.

    Parameters
    ----------
    model : Model
        Scene with its law.
    operation : Operation, optional
        Speed, angle and time of the loads; the operating speed of the scene if left out.
    cage_angles : int
        Angles within one pitch of the rollers over which stiffness and damping of the bearings are averaged; 1 for the
        start angle of the cages alone.
    highest : float, optional
        Frequency up to which modes have no error by the cut-off of shafts that state none [Hz]; the highest of [linear]
        of the scene, else 5 kHz, if left out.

    Raises
    ------
    InputError
        For a number of cage angles that is not possible.
    AnalysisError
        If there is no equilibrium, or its matrices are not finite.

    Examples
    --------
    >>> from mbs import assemble, modes, read_scene
    >>> found = modes(assemble(read_scene("nu308_rigid")))
    >>> found.dataset["frequency"].attrs["units"]
    'Hz'
    """
    check_cage_angles("modes", cage_angles)
    operation = operation or model.operation
    model = operating(settled([model], operation.speed, highest)[0], operation.speed)
    balance = mean_equilibrium(model.system, operation, cage_angles)
    found = modes_at(balance)
    dataset = described(with_states(modes_dataset(found, balance), states_of(model)), **law_attributes(model))
    errors = tuple(film_errors(model, balance.displacement, balance.operation))
    findings = findings_at_rest(model, balance.displacement, balance.operation)
    return ModesResult(model, balance, found, errors, with_findings(dataset, findings), findings)
