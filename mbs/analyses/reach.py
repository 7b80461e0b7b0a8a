"""How far a law reaches: speeds below its films, where it fades to the dry contact, and what lies outside its map."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.maps.law import ContactLaw
from ehdmaps.units import LOAD
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.contact_report import axes_left
from mbs.bearings.table_law import TableLaw
from mbs.model.elements import Operation
from mbs.model.matrices import MatrixElement
from mbs.scene.assembly import Model


@dataclass(frozen=True)
class Fade:
    """Where the films of a law begin; between rest and there they are blended with the dry contact.

    Attributes
    ----------
    speed : float
        Speed of the system below which a bearing lies below the lowest speed of its law [rad/s].
    entrainment_speed : float
        That lowest speed [m/s].
    source : str
        What begins there: "the map", or "the table of the film formula".
    """

    speed: float
    entrainment_speed: float
    source: str

    def below(self, speeds: npt.ArrayLike) -> BoolArray:
        """Which speeds of the system [rad/s] lie in the fade; of the shape of `speeds`."""
        return np.asarray(np.abs(np.asarray(speeds, dtype=np.float64)) < self.speed)


POINTS = "the points of its law"
"""What is left by a bearing whose dry law is given by points."""


def source_of(model: Model) -> str:
    """What a law is read from, in words: "the map", "the table of the film formula", or `POINTS`.

    Parameters
    ----------
    model : Model
        Model with its law.
    """
    if model.law.startswith("table "):
        return POINTS
    return "the map" if model.law.startswith(("map ", "maps ")) else "the table of the film formula"


SPEED_ROUND_OFF = 1e-9
"""Of a speed, relative: a map that ends at it has it."""

SPEED_TABLE = "its table of speeds"
"""What is left by a bearing or spring of matrices over speed."""


def sources_of(model: Model) -> dict[str, str]:
    """What each element reads, in words: `source_of` the laws of bearings, `SPEED_TABLE` of matrices over speed.

    Parameters
    ----------
    model : Model
        Model with its law.
    """
    elements = [entry.element for entry in model.system.elements]
    source = source_of(model)
    return {entry.name: SPEED_TABLE if isinstance(entry, MatrixElement) else source for entry in elements}


def fade_of(model: Model) -> Fade | None:
    """Where the films of the model begin; None for laws without films, and for bearings that do not turn."""
    found: list[Fade] = []
    for bearing in model.bearings:
        law = bearing.force.law if isinstance(bearing.force, BearingForce) else None
        if not isinstance(law, ContactLaw) or not bearing.rates[1] > 0.0 or not law.speed_range[0] > 0.0:
            continue
        lowest = law.speed_range[0]
        found.append(Fade(lowest / bearing.rates[1], lowest, source_of(model)))
    return max(found, key=lambda fade: fade.speed, default=None)


def share_below(model: Model, speeds: FloatArray) -> float:
    """Part of some speeds [rad/s] that lies below the law's films, from 0 to 1; 0 for laws without films."""
    fade = fade_of(model)
    return float(np.mean(fade.below(speeds))) if fade is not None and speeds.size else 0.0


def faster_than_laws(model: Model, speed: float) -> set[str]:
    """Bearings whose entrainment speed lies above their law, and elements whose table over speed ends below.

    Parameters
    ----------
    model : Model
        Model with its law.
    speed : float
        Highest speed of the system that is visited, without sign [rad/s].
    """
    found = {
        entry.element.name
        for entry in model.system.elements
        if isinstance(entry.element, MatrixElement) and entry.element.beyond(speed)
    }
    for bearing in model.bearings:
        law = bearing.force.law if isinstance(bearing.force, BearingForce) else None
        fastest = bearing.entrainment_speed(Operation(speed))
        if isinstance(law, ContactLaw) and fastest > law.speed_range[1] * (1.0 + SPEED_ROUND_OFF):
            found.add(bearing.name)
    return found


def axes_outside(model: Model, speed: float, loads: Mapping[str, float] | None = None) -> dict[str, str]:
    """Where each bearing leaves the map, if it does: the axis with its value, or where its load ends.

    Parameters
    ----------
    model : Model
        Model with its temperature.
    speed : float
        Speed of the system [rad/s]; the highest one of a run.
    loads : mapping of str to float, optional
        Largest load of a slice [N/m] by bearing; of a run it is not recorded.
    """
    found = {}
    for bearing in model.bearings:
        law = bearing.force.law if isinstance(bearing.force, BearingForce) else None
        if not isinstance(law, ContactLaw | TableLaw):
            continue
        load = (loads or {}).get(bearing.name, 0.0)
        axes = axes_left(law, load, bearing.entrainment_speed(Operation(speed)), bearing.temperature)
        if isinstance(law, TableLaw):
            end = f"{LOAD.text(float(law.line_load[-1]))}, the last one"
        else:
            end = f"{LOAD.text(law.load_range[1])}, where the map ends"
        words = "; ".join(axes) or f"a load above {end}"
        found[bearing.name] = words.replace("the map", source_of(model))
    return found
