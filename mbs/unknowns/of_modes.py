"""Bands of frequencies and damping ratios of modes: each look is an equilibrium with its modes, paired by shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray, IntArray
from mbs.analyses.operating import operating
from mbs.linearised.averaged import AveragedEquilibrium, mean_equilibrium
from mbs.linearised.modes import Modes, modes
from mbs.linearised.pairs import in_order, partners
from mbs.model.equilibrium import Equilibrium
from mbs.scene.assembly import Model
from mbs.scene.scene import Scene
from mbs.unknowns.bounds import with_bounds
from mbs.unknowns.held_open import held_open_of
from mbs.unknowns.looks import Band, band

MOST_DAMPED = 0.5
"""Damping ratio up to which a mode has a band: above, looks hardly find it again."""

FREE = 1.0
"""Frequency up to which a motion counts as free, and has no band [Hz]."""


@dataclass(frozen=True, eq=False)
class ModeBands:
    """Bands of modes.

    Attributes
    ----------
    chosen : array of int, shape (modes,)
        Which modes have bands, in the order of `Modes`.
    frequency, damping_ratio : Band
        Bands of these modes, shape (modes,) each [Hz], [1].
    """

    chosen: IntArray
    frequency: Band
    damping_ratio: Band

    @property
    def told(self) -> dict[str, Band]:
        """Both by what they are of, in words."""
        return {"frequency": self.frequency, "damping ratio": self.damping_ratio}

    def place(self, mode: int) -> int | None:
        """Place of a mode among those that have bands; None for one that has none."""
        found = np.flatnonzero(self.chosen == mode)
        return int(found[0]) if found.size else None

    def into(self, dataset: xr.Dataset) -> xr.Dataset:
        """A data set of all modes with their bounds, NaN where there is no band.

        Parameters
        ----------
        dataset : xarray.Dataset
            What `modes_dataset` makes.
        """
        for name, own in (("frequency", self.frequency), ("damping_ratio", self.damping_ratio)):
            dataset = with_bounds(dataset, name, own, self.chosen)
        return dataset


def banded(found: Modes, highest: float) -> IntArray:
    """Modes that have a band: those that swing, up to a frequency [Hz]."""
    seen = (found.frequency <= highest) & (found.frequency > FREE) & (found.damping_ratio <= MOST_DAMPED)
    return np.asarray(np.flatnonzero(seen), dtype=np.int64)


def looked_at(model: Model, like: Equilibrium, standing: bool) -> Equilibrium:
    """Equilibrium of a model as another one was found: at its speed, by means over as many cage angles.

    Parameters
    ----------
    model : Model
        The model.
    like : Equilibrium
        The other one.
    standing : bool
        True for the cage angles of the scene alone.
    """
    operation = like.operation
    angles = len(like.over) if isinstance(like, AveragedEquilibrium) and not standing else 1
    return mean_equilibrium(operating(model, operation.speed).system, operation, angles)


@dataclass(frozen=True, eq=False)
class ModeLook:
    """A look at modes: frequencies and damping ratios of those that a reference has, shape (2, modes).

    Attributes
    ----------
    model : Model
        The model of the reference.
    balance : Equilibrium
        Equilibrium of the machine; a look has the same speed, and means over as many cage angles.
    modes : Modes
        Modes about it.
    chosen : array of int, shape (modes,)
        Which of them are looked for; the same one may be there several times.
    """

    model: Model
    balance: Equilibrium
    modes: Modes
    chosen: IntArray

    @property
    def centre(self) -> FloatArray:
        """The modes as they are printed."""
        return np.array([self.modes.frequency[self.chosen], self.modes.damping_ratio[self.chosen]])

    @property
    def numerics(self) -> FloatArray:
        """Parts that numerics leave open of them."""
        bands = self.modes.bands
        return np.zeros((2, self.chosen.size)) if bands is None else np.array([part[self.chosen] for part in bands[:2]])

    def __call__(self, scene: Scene, standing: bool) -> FloatArray:
        """Look at a changed scene; NaN for modes that it has not."""
        balance = looked_at(self.model.again(scene), self.balance, standing)
        return self.paired(balance, modes(balance, errors=False))

    def paired(self, balance: Equilibrium, found: Modes) -> FloatArray:
        """Values of the modes of the reference in another system."""
        own, places = np.unique(self.chosen, return_inverse=True)
        partner = partners(self.balance.system, self.modes.shapes[:, own], balance.system, found.shapes)
        known = self.modes.frequency[own], self.modes.damping_ratio[own]
        partner = in_order(*known, partner, found.frequency)[places]
        values = np.array([found.frequency[partner], found.damping_ratio[partner]])
        return np.where(partner >= 0, values, np.nan)


def bands_of(model: Model, balance: Equilibrium, found: Modes, highest: float) -> ModeBands:
    """Bands of modes of a model.

    Parameters
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium at which it was linearised.
    found : Modes
        Modes there.
    highest : float
        Frequency up to which modes have bands [Hz].
    """
    chosen = banded(found, highest)
    look = ModeLook(model, balance, found, chosen)
    both = band(look, look.centre, held_open_of(model), look.numerics)
    return ModeBands(chosen, both.of(0), both.of(1))
