"""The equilibrium of a scene, pressures and films of its contacts, stiffness and damping of its bearings."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from ehdmaps.arrays import FloatArray
from mbs.analyses.losses import contacts_and_losses
from mbs.analyses.operating import operating, states_of
from mbs.analyses.soundness import findings_at_rest, with_findings
from mbs.bearings.contact_report import BearingContacts, RollingLoss
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium, equilibrium, free_lines, free_motions
from mbs.model.findings import Finding, warned
from mbs.output.files import described
from mbs.scene.assembly import Model, law_attributes

if TYPE_CHECKING:
    import xarray as xr

    from mbs.output.files import Figure
    from mbs.scene.scene import Scene
    from mbs.unknowns.looks import Band


@dataclass(frozen=True, eq=False)
class StaticsResult:
    """An equilibrium, and what it means for the bearings.

    Attributes
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Displacements, forces, stiffness and damping.
    contacts : tuple of BearingContacts
        Pressures and films, one a bearing.
    losses : tuple of RollingLoss
        What rolling costs, one a bearing.
    free : tuple of str
        Motions that nothing holds.
    findings : tuple of Finding
        What is beyond the laws of its bearings.
    """

    model: Model
    balance: Equilibrium
    contacts: tuple[BearingContacts, ...]
    losses: tuple[RollingLoss, ...]
    free: tuple[str, ...]
    findings: tuple[Finding, ...] = ()

    @cached_property
    def dataset(self) -> xr.Dataset:
        """Data set that `mbs statics -o` writes; made when it is asked for."""
        from mbs.output.results import statics_dataset, with_states

        model = self.model
        dataset = statics_dataset(self.balance, self.contacts, self.losses, self.free)
        dataset = with_states(dataset, states_of(model))
        if model.gears:
            from mbs.output.results import with_gears

            dataset = with_gears(dataset, model, self.balance)
        return with_findings(described(dataset, **law_attributes(model)), self.findings)

    @cached_property
    def bands(self) -> dict[str, Band]:
        """Bands of what is not known, by the names of variables of the data set; found when they are asked for."""
        from mbs.linearised.bands import law_bands
        from mbs.unknowns.held_open import held_open_of
        from mbs.unknowns.of_variables import variable_bands

        def make(scene: Scene, standing: bool) -> dict[str, FloatArray]:
            return banded_variables(statics(self.model.again(scene), self.balance.operation).dataset)

        laws = law_bands(self.balance)
        both = () if laws is None else laws.of_matrices()
        numerics = dict(zip(("bearing_stiffness", "bearing_damping"), both, strict=False))
        return variable_bands(make, banded_variables(self.dataset), held_open_of(self.model), numerics)

    def bounded(self) -> xr.Dataset:
        """The data set with these bounds."""
        from mbs.unknowns.bounds import bounded

        return bounded(self.dataset, self.bands)

    def plot(self, banded: bool = False) -> Figure:
        """Figure that `mbs statics --plot` writes: loads of the rollers and slices of each bearing.

        Parameters
        ----------
        banded : bool
            Whether it says what is not known of loads, pressures and films.
        """
        from mbs.output.band_text import contact_notes
        from mbs.output.bearing_plot import statics_figure

        names = [str(name) for name in self.dataset["bearing"].values]
        notes = contact_notes(names, self.bands) if banded else []
        return statics_figure(self.model, self.balance, self.contacts, [*warned(self.findings), *notes])


BANDED = (
    "bearing_stiffness",
    "bearing_damping",
    "bearing_force",
    "hertz_pressure",
    "central_film",
    "minimum_film",
    "highest_raceway_load",
)
"""Variables of statics that have bands of what is not known."""


def banded_variables(dataset: xr.Dataset) -> dict[str, FloatArray]:
    """Values of the variables that have bands, as far as a data set has them.

    Parameters
    ----------
    dataset : xarray.Dataset
        That of statics.
    """
    return {name: dataset[name].values for name in BANDED if name in dataset}


def statics(model: Model, operation: Operation | None = None) -> StaticsResult:
    """Find the equilibrium, and what the contacts feel there.

    Parameters
    ----------
    model : Model
        Scene with its law.
    operation : Operation, optional
        Speed, angle and time of the loads; the operating speed of the scene if left out.

    Raises
    ------
    AnalysisError
        If there is no equilibrium.

    Examples
    --------
    >>> from mbs import assemble, read_scene, statics
    >>> found = statics(assemble(read_scene("nu308_rigid")))
    >>> float(found.dataset["bearing_force"].sel(bearing="bearing_left")[1].round(1))
    -100.0
    """
    operation = operation or model.operation
    model = operating(model, operation.speed)
    balance = equilibrium(model.system, operation)
    free = tuple(free_lines(free_motions(balance)))
    found = contacts_and_losses(model, balance.displacement, balance.operation)
    contacts, losses = tuple(state for state, _ in found), tuple(loss for _, loss in found)
    findings = findings_at_rest(model, balance.displacement, balance.operation)
    return StaticsResult(model, balance, contacts, losses, free, findings)
