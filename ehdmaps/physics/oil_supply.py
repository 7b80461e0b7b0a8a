"""Oil that a contact gets: flooded, or a layer of a given thickness on the surfaces before it.

A flooded contact takes as much oil as its film needs. On a layer, no more can pass than the layer brings: the film of a
light load, which would be thicker, is capped by it, and a roller that finds a gap wider than the layer runs dry. There
is no side flow, so a layer stands for what is left of the oil before the contact in the steady state.

The layers of the named kinds of lubrication are estimates, from the side flow of a layer against its supply and from
the torque of a catalogue bearing in oil; within a kind they scatter by a factor of two or more. Who knows the layer
gives its thickness.

References
----------
M. T. van Zoelen, C. H. Venner, P. M. Lugt, "Prediction of film thickness decay in starved elasto-hydrodynamically
lubricated contacts using a thin layer flow model", Proc. IMechE Part J 223, 2009, 541 (the balance of side flow and
supply; its formula is known here from later work only).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from ehdmaps.errors import InputError

LAYERS: Mapping[str, float] = MappingProxyType(
    {"flooded": math.inf, "oil bath": 10e-6, "oil air": 2e-6, "grease": 0.7e-6}
)
"""Oil layer before a contact, of both surfaces together [m], by kind of lubrication."""

THINNEST, THICKEST = 1e-9, 1e-3
"""Oil layers that are taken [m]: a nanometre is a molecule; a millimetre floods every contact of a roller."""


@dataclass(frozen=True)
class OilSupply:
    """Oil supply of the contacts of a bearing.

    Attributes
    ----------
    oil_layer : float
        Thickness of the oil before each contact, of both surfaces together [m]; inf where it is flooded.
    lubrication : str, optional
        Kind of lubrication that the layer was taken from, one of `LAYERS`; empty for a layer that was given.

    Raises
    ------
    InputError
        If the layer is out of its limits, or there is no such lubrication.
    """

    oil_layer: float = math.inf
    lubrication: str = ""

    def __post_init__(self) -> None:
        if self.lubrication and self.lubrication not in LAYERS:
            raise InputError(f"supply, lubrication: got {self.lubrication!r}; allowed: {', '.join(LAYERS)}")
        if not (THINNEST <= self.oil_layer <= THICKEST or self.oil_layer == math.inf):
            raise InputError(
                f"supply, oil_layer: got {self.oil_layer!r} m; allowed: {THINNEST:g} to {THICKEST:g} m, or inf"
            )

    @classmethod
    def named(cls, lubrication: str) -> OilSupply:
        """Supply of a kind of lubrication.

        Parameters
        ----------
        lubrication : {"flooded", "oil bath", "oil air", "grease"}
            Kind of lubrication.

        Raises
        ------
        InputError
            If there is no such kind.
        """
        if lubrication not in LAYERS:
            raise InputError(f"supply, lubrication: got {lubrication!r}; allowed: {', '.join(LAYERS)}")
        return cls(LAYERS[lubrication], lubrication)

    @property
    def flooded(self) -> bool:
        """Whether the contacts take all the oil that they need."""
        return self.oil_layer == math.inf

    @property
    def short(self) -> str:
        """Shortest name, for legends: the kind of lubrication, or the layer."""
        return self.lubrication or self.label

    @property
    def label(self) -> str:
        """Name for tables and messages."""
        if self.flooded:
            return "flooded"
        layer = f"oil layer {1e6 * self.oil_layer:.3g} um"
        return f"{self.lubrication} ({layer})" if self.lubrication else layer


FLOODED = OilSupply(math.inf, "flooded")
"""Contacts that take all the oil that they need."""
