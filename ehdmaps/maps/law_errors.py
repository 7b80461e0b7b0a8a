"""A contact law that is a little wrong on purpose: its table with another stiffness, damping and film.

Four kinds of error, each relative, at a load, entrainment speed and temperature:

- numerical: the estimates of the map at its points, `stiffness_error`, `damping_error` and `film_offset_error`,
  linear in ln(load), ln(speed) and temperature between them and held at the edges;
- of the law: what its check against fresh solves found, the 95 % quantile over the map, in the damping valley the
  larger one of that and the quantile of the valley;
- of the spacing, of a law that is made from the points of a map alone: `film_offset_spacing_error` and those of k and
  c, likewise linear between the points, of which each has the largest error around it;
- of the model: `stiffness_model_error` and `damping_model_error`, where the map has them.

All are taken as systematic: an estimate that has one sign at one point has it at all
loads, in both contacts of a roller, and in all bearings that share the map. So the kinds are added, and so are the
contacts of a roller. Where signs alternate, as those of an interpolation do, that is more than need be.

What a map does not state is in no bound: physics that its solver leaves out (heat, starvation, roughness, shear
thinning, slip), the structural law, geometry, and the relaxation of the film beyond slow motion, which linear analyses
add. A bound of 0.1 % of a map without model errors says that the equations are solved that well, and nothing of how
well they are chosen.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, Protocol

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.maps import schema
from ehdmaps.maps.backbone_plan import VALLEY
from ehdmaps.maps.film_field import valley_loads
from ehdmaps.maps.kernels.tables import ApproachTable
from ehdmaps.maps.records import MODEL_ERRORS, SPACING_ERRORS
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant


class MapPoints(Protocol):
    """Source of errors: a map, with or without a dataset."""

    @property
    def attributes(self) -> Mapping[str, Any]:
        """Its other statements on itself."""

    def axis(self, name: str) -> FloatArray:
        """Values of an axis; see `ehdmaps.maps.emap.EHDMap.axis`."""

    def points(self, name: str) -> FloatArray | None:
        """A variable at all points; see `ehdmaps.maps.emap.EHDMap.points`."""


class LawChange(NamedTuple):
    """Changes of a law, at all loads, speeds and temperatures alike.

    Attributes
    ----------
    stiffness, damping : float
        Relative changes of k and c at an approach, above -1; the load at it changes by as much as k.
    film : float
        What films are thicker by [m]: contacts touch at an approach that is so much less.
    """

    stiffness: float = 0.0
    damping: float = 0.0
    film: float = 0.0

    def times(self, signs: tuple[float, float, float]) -> LawChange:
        """The change with a factor for each of its three parts."""
        return LawChange(*(sign * part for sign, part in zip(signs, self, strict=True)))


def changed_table(table: ApproachTable, change: LawChange) -> ApproachTable:
    """The table of a changed law; exact, as its splines take factors and constants as they are.

    Parameters
    ----------
    table : ApproachTable
        Table of the law as it is.
    change : LawChange
        Change of the law.
    """
    coefficients, place = table.coefficients.copy(), table.place.copy()
    coefficients[..., 0::2] *= math.cbrt(1.0 + change.stiffness)
    coefficients[..., 1::2] += math.log((1.0 + change.damping) / (1.0 + change.stiffness))
    place[..., 0] -= change.film
    return table._replace(coefficients=coefficients, place=place)


QUANTILES = {"median": 0.5, "95 %": 0.95, "99 %": 0.99, "largest": 1.0}
"""Words and numbers of the quantiles that the check of a law writes."""

TAKEN = "95 %"
"""Quantile of the errors of a law that a bound takes."""

NOT_IN = "physics that the solver leaves out, the structure of the solids and the geometry are not in it"
"""What no bound has, for people."""

_NUMBER = r"([0-9.eE+-]+)"


def quantiles_text(errors: FloatArray) -> str:
    """Quantiles of errors in words, as attributes of a map have them.

    Parameters
    ----------
    errors : array (n,)
        Relative errors, n > 0.

    Examples
    --------
    >>> quantiles_text(np.array([0.01, 0.02, 0.03]))
    'median 0.02, 95 % 0.029, 99 % 0.03, largest 0.03'
    """
    values = np.quantile(errors, list(QUANTILES.values()))
    return ", ".join(f"{word} {value:.2g}" for word, value in zip(QUANTILES, values, strict=True))


def quantile_of(text: object, word: str = TAKEN) -> float | None:
    """One of the quantiles that `quantiles_text` wrote; None where the text has none.

    Parameters
    ----------
    text : object
        The attribute.
    word : str
        Key of `QUANTILES`.

    Examples
    --------
    >>> quantile_of("median 0.02, 95 % 0.029, 99 % 0.03, largest 0.03")
    0.029
    """
    found = re.search(rf"{re.escape(word)} {_NUMBER}", str(text))
    return float(found.group(1)) if found else None


@dataclass(frozen=True)
class LawBounds:
    """Bounds of the errors of a law at some loads.

    Attributes
    ----------
    stiffness, damping : array (n,)
        Relative errors of k and c at the load.
    film_offset : array (n,)
        Error of the approach at the load [m]: how much thicker or thinner the films may be.
    """

    stiffness: FloatArray
    damping: FloatArray
    film_offset: FloatArray


@dataclass(frozen=True)
class _Checked:
    """Findings of the check of the laws in a region: relative errors of film compliance, k, c and film offset."""

    film_compliance: float
    damping: float
    stiffness: float | None
    film_offset: float | None

    @classmethod
    def of(cls, attributes: Mapping[str, Any], region: str) -> _Checked | None:
        """Those of a region of the map, by its check or the confirmation of its tolerance; None without either."""
        names = ("film_compliance", "damping", "stiffness", "film_offset")
        for check in ("law", "tolerance"):
            found = [quantile_of(attributes.get(f"{check}{region}_{name}_error", "")) for name in names]
            if any(value is not None for value in found):
                return cls(found[0] or 0.0, found[1] or 0.0, found[2], found[3])
        return None

    def relative_stiffness(self, share: FloatArray) -> FloatArray:
        """Relative error of k for films with a share (n,) of the compliance, which older maps state no other way."""
        return share * self.film_compliance if self.stiffness is None else np.full(share.shape, self.stiffness)


class LawErrors:
    """Bounds of the errors of the laws of a map.

    Parameters
    ----------
    source : MapPoints
        The map; read when errors are first asked for.
    contacts : sequence of LineContact
        Contacts of the map, in the order of its first axis.
    lubricant : Lubricant
        Oil of the map, for the place of the damping valley.
    """

    def __init__(self, source: MapPoints, contacts: Sequence[LineContact], lubricant: Lubricant) -> None:
        self._source = source
        self._contacts = {contact.name: (index, contact) for index, contact in enumerate(contacts)}
        self._lubricant = lubricant

    def _points(self, name: str) -> FloatArray | None:
        """A variable at the points with a speed; None where the map does not hold it."""
        found = self._source.points(name)
        return None if found is None else found[:, :, self._source.axis("entrainment_speed") > 0.0].astype(np.float64)

    @cached_property
    def _axes(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Logarithms of loads and speeds, and temperatures."""
        loads, speeds, kelvins = (self._source.axis(name) for name in schema.DIMS[1:])
        return np.log(loads), np.log(speeds[speeds > 0.0]), kelvins

    @cached_property
    def _checked(self) -> _Checked | None:
        """Findings of the check of the laws."""
        return _Checked.of(self._source.attributes, "")

    @cached_property
    def _in_valley(self) -> _Checked | None:
        """Those in the damping valley."""
        return _Checked.of(self._source.attributes, "_valley")

    @property
    def checked_points(self) -> int:
        """Number of points at which the laws were checked."""
        attributes = self._source.attributes
        points = attributes.get("law_check_usable", attributes.get("tolerance_points"))
        return 0 if self._checked is None or points is None else int(points)

    @property
    def has_model_errors(self) -> bool:
        """True where the map states errors of its model."""
        return any(self._source.points(name) is not None for name in MODEL_ERRORS)

    @property
    def has_spacing_errors(self) -> bool:
        """True where the map states what its laws lose between its points."""
        return any(self._source.points(name) is not None for name in SPACING_ERRORS)

    @cached_property
    def _read(self) -> tuple[FloatArray, tuple[str, ...]]:
        """Data that bounds are read from, and the errors that the map does not state; read when first asked for.

        Laws are made without it: from the films of a map alone.
        """
        of_points = ("stiffness", "film_compliance", "loss_compliance", "film_offset")
        values = {name: points for name in of_points if (points := self._points(name)) is not None}
        needed = ("stiffness", "damping", "film_offset")
        names = (*(f"{name}_error" for name in needed), *MODEL_ERRORS, *SPACING_ERRORS)
        found = {name: self._error(name) for name in names}
        size = values["stiffness"].size and self._axes[1].size
        unknown = tuple(f"{name}_error" for name in needed if found[f"{name}_error"] is None and size)
        errors = {
            name: np.zeros(values["stiffness"].shape) if error is None else error for name, error in found.items()
        }
        offset = np.abs(values["film_offset"])
        # One array, so that it is read at a speed and temperature at once.
        grid = np.stack(
            [
                errors["stiffness_error"] + errors[MODEL_ERRORS[0]] + errors[SPACING_ERRORS[1]],
                errors["damping_error"] + errors[MODEL_ERRORS[1]] + errors[SPACING_ERRORS[2]],
                (errors["film_offset_error"] + errors[SPACING_ERRORS[0]]) * offset,
                offset,
                1.0 / values["stiffness"],
                np.abs(values["loss_compliance"]),
                np.abs(values["film_compliance"]) * values["stiffness"],
            ],
            axis=1,
        )
        return np.nan_to_num(grid), unknown

    def _error(self, name: str) -> FloatArray | None:
        """Magnitudes of an error; where it is unknown at some points, the largest known one; None where at all."""
        found = self._points(name)
        if found is None:
            return None
        found = np.abs(found)
        known = np.isfinite(found)
        return np.where(known, found, found[known].max()) if np.any(known) else None

    @property
    def unknown(self) -> tuple[str, ...]:
        """Errors that the map does not state."""
        return self._read[1]

    @property
    def words(self) -> str:
        """Statement of what is in the bounds and what is not, for people."""
        parts = ["numerical errors of the map"]
        if self._checked is not None:
            parts.append(f"errors of its law ({TAKEN} of {self.checked_points} checked points)")
        if self.has_spacing_errors:
            parts.append("errors of its law between its points")
        if self.has_model_errors:
            parts.append("errors of its model")
        told = self._checked is not None or self.has_spacing_errors
        lacking = [
            *([] if told else ["errors of its law between its points (it was not checked)"]),
            *([] if self.has_model_errors else ["errors of its model (none stated)"]),
            *(f"{name} (not known)" for name in self.unknown),
        ]
        without = f"; without {', '.join(lacking)}" if lacking else ""
        return f"{' and '.join(parts)}{without}; {NOT_IN}"

    def bounds(
        self,
        names: Sequence[str],
        loads: FloatArray,
        speed: float,
        temperature: float,
        added: Mapping[str, LawBounds] | None = None,
    ) -> LawBounds | None:
        """Bounds of one contact, or of several in series.

        Of contacts in series compliances add, and losses c/k^2 do: their relative errors are means with these weights.

        Parameters
        ----------
        names : sequence of str
            Contacts of the law.
        loads : array (n,)
            w [N/m]; held at the ends of the map.
        speed, temperature : float
            u [m/s], of either sign, and T [K]; held likewise.
        added : mapping of str to LawBounds, optional
            Errors of each contact besides, of films that are continued outside the map.

        Returns
        -------
        LawBounds or None
            None at standstill, and for maps that have no speed: the contact is dry, of which a map states no errors.
        """
        loads = np.asarray(loads, dtype=np.float64)
        if speed == 0.0 or not self._axes[1].size:
            return None
        single = [self._of_contact(name, loads, abs(speed), temperature) for name in names]
        for i, name in enumerate(names if added is not None else ()):
            more = (added or {})[name]
            k, c, offset, soft, lossy = single[i]
            single[i] = k + more.stiffness, c + more.damping, offset + more.film_offset, soft, lossy
        compliance = np.array([one[3] for one in single])
        loss = np.array([one[4] for one in single])
        whole = compliance.sum(axis=0)
        weights = compliance / np.where(whole > 0.0, whole, np.nan)  # of a hole nothing is known
        loss_weights = loss / np.maximum(loss.sum(axis=0), 1e-300)
        by_stiffness = np.array([one[0] for one in single])
        stiffness = np.sum(weights * by_stiffness, axis=0)
        damping = np.sum(
            loss_weights * np.array([one[1] for one in single])
            # c = loss k^2: what the weights of the losses do not account for
            + 2.0 * np.abs(weights - loss_weights) * by_stiffness,
            axis=0,
        )
        return LawBounds(stiffness, damping, np.sum([one[2] for one in single], axis=0))

    def _of_contact(
        self, name: str, loads: FloatArray, speed: float, temperature: float
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
        """Relative errors of k and c, error of the film offset [m], 1/k and the loss compliance of one contact."""
        index, contact = self._contacts[name]
        log_loads, log_speeds, kelvins = self._axes
        log_speed = float(np.clip(np.log(speed), log_speeds[0], log_speeds[-1]))
        kelvin = float(np.clip(temperature, kelvins[0], kelvins[-1]))
        lines = _at(kelvins, kelvin, _at(log_speeds, log_speed, self._read[0][index], 2), 2)
        logs = np.log(np.maximum(loads, 1e-300))
        k, c, offset, film, compliance, loss, share = (np.interp(logs, log_loads, line) for line in lines)
        if self._checked is not None:
            valley = valley_loads(contact, self._lubricant, np.array([np.exp(log_speed)]), np.array([kelvin]))[0, 0]
            k, c, offset = (
                numerical + added
                for numerical, added in zip(
                    (k, c, offset), self._of_law(logs - np.log(valley), share, film), strict=True
                )
            )
        return k, c, offset, compliance, loss

    def _of_law(self, zeta: FloatArray, share: FloatArray, film: FloatArray) -> tuple[FloatArray, ...]:
        """Errors of the law: relative ones of k and c, and that of the film offset [m]."""
        assert self._checked is not None
        inside: BoolArray = (zeta > VALLEY[0]) & (zeta < VALLEY[1])
        regions = [self._checked] if self._in_valley is None else [self._checked, self._in_valley]
        found = [
            (
                region.relative_stiffness(share),
                np.full(share.shape, region.damping),
                (region.film_offset or 0.0) * film,
            )
            for region in regions
        ]
        return tuple(
            np.where(inside, np.maximum.reduce(parts), parts[0]) for parts in map(list, zip(*found, strict=True))
        )


def _at(nodes: FloatArray, place: float, values: FloatArray, axis: int) -> FloatArray:
    """Values at a place within the nodes of one axis, linear between them."""
    if nodes.size == 1:
        return np.asarray(values.take(0, axis))
    cell = int(np.clip(np.searchsorted(nodes, place) - 1, 0, nodes.size - 2))
    part = (place - nodes[cell]) / (nodes[cell + 1] - nodes[cell])
    return np.asarray((1.0 - part) * values.take(cell, axis) + part * values.take(cell + 1, axis))
