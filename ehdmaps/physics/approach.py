"""Structural laws: the elastic part of the approach of one contact over its load, and its derivative.

A plane log kernel has no absolute approach, so it is taken from one of four laws that name their
reference: `iso16281` and `palmgren` for a steel roller of finite length, `half_space` for a stated depth, and
`finite_elements` for roller, rings and their seats as they are.
Each law is zero for loads at and below zero, where its compliance is inf (an unloaded contact has no
stiffness).
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from functools import lru_cache
from importlib import resources
from typing import Any, Literal

import numpy as np

from ehdmaps.arrays import FloatArray, Values, as_given
from ehdmaps.errors import InputError
from ehdmaps.physics.solids import STEEL, Material, reduced_modulus

StructuralLaw = Literal["iso16281", "palmgren", "half_space", "fe"]
STRUCTURAL_LAWS: tuple[StructuralLaw, ...] = ("iso16281", "palmgren", "half_space", "fe")

STEEL_REDUCED_MODULUS = reduced_modulus(STEEL, STEEL)
ISO_LINE_CONSTANT = 35948.0
"""c_L/L^(8/9) of ISO/TS 16281 for the total approach of both contacts of a roller, N and mm."""

FE_LOAD = 1e5
"""Load [N/m] at which the law of finite elements states its approach: 100 N/mm."""

_LOAD_EXPONENT = 0.9
_WIDEST_FE = 0.25
"""Half-width over reduced radius up to which the law of finite elements holds."""
_LARGEST_EXPONENT = 700.0


def iso16281(load: Values, roller_length: float, reduced_modulus: float = STEEL_REDUCED_MODULUS) -> Values:
    """Elastic approach of one contact of a roller after ISO/TS 16281 [m].

    delta [mm] = 1/2 [(w/1000) L^(1/9) / 35948]^0.9 (E'_steel/E')^0.9, w in N/m, L in mm. The constant
    35948 L^(8/9) N/mm^(10/9) of the standard belongs to the total approach of both contacts; they are taken
    as alike, hence the half.

    Parameters
    ----------
    load : float or array
        w [N/m]; negative loads are taken as zero.
    roller_length : float
        Effective length L of the whole roller [m], never of a slice.
    reduced_modulus : float
        E' [Pa]. The standard is for steel; other materials are scaled.

    References
    ----------
    ISO/TS 16281:2008, Rolling bearings - Methods for calculating the modified reference rating life for
    universally loaded bearings; DIN 26281:2010.

    Examples
    --------
    A load of 10 kN on a roller of 15 mm:

    >>> round(1e6 * iso16281(10e3 / 15e-3, roller_length=15e-3), 3)
    18.113
    """
    length_mm = 1e3 * roller_length
    coefficient = 0.5e-3 * (1e-3 * length_mm ** (1.0 / 9.0) / ISO_LINE_CONSTANT) ** _LOAD_EXPONENT
    return _power_law(load, coefficient * _material_factor(reduced_modulus))


def iso16281_compliance(load: Values, roller_length: float, reduced_modulus: float = STEEL_REDUCED_MODULUS) -> Values:
    """d(delta)/dw of `iso16281` [m2/N]; inf at and below zero load.

    Parameters
    ----------
    load : float or array
        w [N/m].
    roller_length : float
        Effective length L of the whole roller [m], never of a slice.
    reduced_modulus : float
        E' [Pa].
    """
    return _power_law_slope(load, iso16281(load, roller_length, reduced_modulus))


def palmgren(load: Values, roller_length: float, reduced_modulus: float = STEEL_REDUCED_MODULUS) -> Values:
    """Elastic approach of one contact of a roller after Palmgren [m].

    delta [mm] = 3.84e-5 (w/1000)^0.9 L^0.1 (E'_steel/E')^0.9, w in N/m, L in mm; that is
    3.84e-5 Q^0.9 / L^0.8 with the load Q = w L of the roller in N.

    Parameters
    ----------
    load : float or array
        w [N/m]; negative loads are taken as zero.
    roller_length : float
        Length L of the whole roller [m], never of a slice: slices of it do not add up to the law.
    reduced_modulus : float
        E' [Pa]. The law is for steel; other materials are scaled.

    References
    ----------
    A. Palmgren, Ball and Roller Bearing Engineering, 3rd ed., Burbank, Philadelphia, 1959.

    Examples
    --------
    A load of 10 kN on a roller of 15 mm:

    >>> round(1e6 * palmgren(10e3 / 15e-3, roller_length=15e-3), 3)
    17.517
    """
    length_mm = 1e3 * roller_length
    coefficient = 1e-3 * 3.84e-5 * 1e-3**_LOAD_EXPONENT * length_mm**0.1
    return _power_law(load, coefficient * _material_factor(reduced_modulus))


def palmgren_compliance(load: Values, roller_length: float, reduced_modulus: float = STEEL_REDUCED_MODULUS) -> Values:
    """d(delta)/dw of `palmgren` [m2/N]; inf at and below zero load.

    Parameters
    ----------
    load : float or array
        w [N/m].
    roller_length : float
        Effective length L of the whole roller [m], never of a slice.
    reduced_modulus : float
        E' [Pa].
    """
    return _power_law_slope(load, palmgren(load, roller_length, reduced_modulus))


def half_space(load: Values, reference_depth: float, radius: float, reduced_modulus: float) -> Values:
    """Elastic approach of two bodies against points at a stated depth [m].

    delta = (4 w/(pi E')) [ln(2 d*/b) + 1/2], b the half-width of Hertz.

    Parameters
    ----------
    load : float or array
        w [N/m]; negative loads are taken as zero.
    reference_depth : float
        d* [m], the geometric mean of the depths of the two bodies: see `roller_reference_depth`; of a
        half plane with nu = 0.3 it is 0.49 times the depth of the point (Johnson, section 5.6). It is a depth far
        below the contact, so b <= d* is asked for.
    radius : float
        Reduced radius R [m].
    reduced_modulus : float
        E' [Pa].

    Raises
    ------
    InputError
        If the contact is wider than the reference depth.

    References
    ----------
    K. L. Johnson, Contact Mechanics, Cambridge, 1985, section 5.6.

    Examples
    --------
    >>> delta = half_space(100e3, reference_depth=5e-3, radius=5.515e-3, reduced_modulus=230.77e9)
    >>> round(1e6 * delta, 4)
    2.9537
    """
    positive, ratio = _half_space_terms(load, reference_depth, radius, reduced_modulus)
    with np.errstate(divide="ignore", invalid="ignore"):
        delta = 4.0 * positive / (math.pi * reduced_modulus) * (np.log(2.0 * ratio) + 0.5)
    return as_given(np.where(positive > 0.0, delta, 0.0), load)


def half_space_compliance(load: Values, reference_depth: float, radius: float, reduced_modulus: float) -> Values:
    """d(delta)/dw of `half_space`, (4/(pi E')) ln(2 d*/b) [m2/N]; inf at and below zero load.

    Parameters
    ----------
    load : float or array
        w [N/m].
    reference_depth : float
        d* [m], see `roller_reference_depth`.
    radius : float
        R [m].
    reduced_modulus : float
        E' [Pa].
    """
    _, ratio = _half_space_terms(load, reference_depth, radius, reduced_modulus)
    return as_given(4.0 / (math.pi * reduced_modulus) * np.log(2.0 * ratio), load)


def finite_elements(
    load: Values, fe_approach: float, radius: float, reduced_modulus: float = STEEL_REDUCED_MODULUS
) -> Values:
    """Elastic approach of roller and ring as finite elements give it, between roller's axis and seat of the ring [m].

    delta = w [delta_0/w_0 + (2/(pi E')) ln(w_0/w)] with w_0 = `FE_LOAD`. Bodies are linear, so that the approach over
    the load depends on the load by the width of the contact alone, as in `half_space`, of which this is the form with
    the depth that roller, ring and seat have: the number delta_0 holds all of their shape. See `ehdmaps.solids`, which
    finds it.

    Parameters
    ----------
    load : float or array
        w [N/m]; negative loads are taken as zero.
    fe_approach : float
        delta_0, the approach at `FE_LOAD` [m].
    radius : float
        Reduced radius R [m]; it limits the load, see `highest_fe_load`.
    reduced_modulus : float
        E' [Pa].

    Raises
    ------
    InputError
        If the contact is too wide for the law.

    Examples
    --------
    >>> round(1e6 * finite_elements(1e5, fe_approach=3e-6, radius=5.5e-3), 3)
    3.0
    """
    positive = _checked_load(load, fe_approach, radius, reduced_modulus)
    slope = 2.0 / (math.pi * reduced_modulus)
    loaded = np.where(positive > 0.0, positive, FE_LOAD)
    delta = positive * (fe_approach / FE_LOAD + slope * np.log(FE_LOAD / loaded))
    return as_given(delta, load)


def finite_elements_compliance(
    load: Values, fe_approach: float, radius: float, reduced_modulus: float = STEEL_REDUCED_MODULUS
) -> Values:
    """d(delta)/dw of `finite_elements`, delta/w - 2/(pi E') [m2/N]; inf at and below zero load.

    Parameters
    ----------
    load : float or array
        w [N/m].
    fe_approach, radius, reduced_modulus
        See `finite_elements`.
    """
    positive = _checked_load(load, fe_approach, radius, reduced_modulus)
    slope = 2.0 / (math.pi * reduced_modulus)
    with np.errstate(divide="ignore"):
        logarithm = np.log(np.divide(FE_LOAD, positive))
    return as_given(fe_approach / FE_LOAD + slope * (logarithm - 1.0), load)


def highest_fe_load(fe_approach: float, radius: float, reduced_modulus: float = STEEL_REDUCED_MODULUS) -> float:
    """Load up to which `finite_elements` holds [N/m].

    There the contact is as wide as a quarter of the reduced radius, b = R/4, or as the depth that stands for the
    bodies, where d(delta)/dw has fallen to (4/(pi E')) ln 2.

    Parameters
    ----------
    fe_approach, radius, reduced_modulus
        See `finite_elements`.

    Examples
    --------
    >>> round(1e-3 * highest_fe_load(3e-6, 5.515e-3))
    31237
    """
    slope = 2.0 / (math.pi * reduced_modulus)
    wide = math.pi * reduced_modulus * radius * _WIDEST_FE**2 / 8.0
    deep = fe_approach / FE_LOAD / slope - 1.0 - 2.0 * math.log(2.0)
    return min(wide, FE_LOAD * math.exp(min(deep, _LARGEST_EXPONENT)))


def roller_reference_depth(roller_diameter: float) -> float:
    """Depth d* = D/e [m] that stands for the centre of a roller of diameter D [m].

    With it the share of the roller in the half space law is w (1 - nu^2)/(pi E) [2 ln(2 D/b) - 1], the
    compression between the contact and the centre of a roller loaded on opposite sides
    (K. L. Johnson, Contact Mechanics, Cambridge, 1985, section 5.6).

    Examples
    --------
    >>> round(1e3 * roller_reference_depth(14e-3), 3)
    5.15
    """
    return roller_diameter / math.e


def _material_factor(reduced_modulus: float) -> float:
    """Scale of the approach of a material that is not steel."""
    return float((STEEL_REDUCED_MODULUS / reduced_modulus) ** _LOAD_EXPONENT)


def _power_law(load: Values, coefficient: float) -> Values:
    """Coefficient times load^0.9, zero for negative loads."""
    return as_given(coefficient * np.maximum(load, 0.0) ** _LOAD_EXPONENT, load)


def _power_law_slope(load: Values, approach: Values) -> Values:
    """0.9 delta/w, inf at zero."""
    loaded = np.asarray(load) > 0.0
    return as_given(np.where(loaded, _LOAD_EXPONENT * approach / np.where(loaded, load, 1.0), np.inf), load)


def _checked_load(load: Values, fe_approach: float, radius: float, reduced_modulus: float) -> FloatArray:
    """Load without its negative part."""
    positive = np.maximum(np.asarray(load, dtype=np.float64), 0.0)
    most, highest = float(np.max(positive, initial=0.0)), highest_fe_load(fe_approach, radius, reduced_modulus)
    if most > highest:
        raise InputError(
            f"fe law: got the load {most:.6g} N/m; allowed: at most {highest:.4g} N/m, where the contact is too wide "
            f"for the law (approach of {fe_approach:.4g} m at {FE_LOAD:g} N/m); lower the load or check that approach"
        )
    return positive


def _half_space_terms(
    load: Values, reference_depth: float, radius: float, reduced_modulus: float
) -> tuple[Values, Values]:
    """Load without its negative part, and d*/b."""
    positive = np.maximum(load, 0.0)
    half_width = np.sqrt(8.0 * positive * radius / (math.pi * reduced_modulus))
    widest = float(np.max(half_width, initial=0.0))
    if widest > reference_depth:
        raise InputError(
            f"half_space law: got a contact half-width of {widest:.4g} m at the load "
            f"{float(np.max(positive)):.6g} N/m; "
            f"allowed: at most the reference_depth {reference_depth:.4g} m; "
            "lower the load or give the real depth"
        )
    with np.errstate(divide="ignore"):
        return as_given(positive, load), as_given(np.divide(reference_depth, half_width), load)


_GEOMETRY = ("inner_raceway_diameter", "outer_raceway_diameter", "roller_diameter", "rollers")
_SAME = 1e-9


def shipped_names() -> tuple[str, ...]:
    """Names of the bearings whose approaches come with the package."""
    return tuple(sorted(_shipped()))


def shipped_approaches(geometry: Mapping[str, Any], material: Material) -> dict[str, float] | None:
    """Approaches of both contacts at `FE_LOAD` by their names [m]; None where none come with the package.

    Parameters
    ----------
    geometry : mapping
        Name and dimensions of the bearing, as of `BearingGeometry.record`.
    material : Material
        Material of all bodies. Another modulus is accounted for exactly; another Poisson's ratio is another solid.

    Examples
    --------
    >>> shipped_approaches({"name": "NU310"}, Material(210e9, 0.3)) is None
    True
    """
    found = _shipped().get(str(geometry.get("name")))
    if found is None or any(not _same(geometry.get(key), found["geometry"][key]) for key in _GEOMETRY):
        return None
    made_of = found["sections"]["material"]
    if not _same(material.poisson_ratio, made_of["poisson_ratio"]):
        return None
    own = reduced_modulus(material, material)
    made = Material(made_of["youngs_modulus"], made_of["poisson_ratio"])
    return {
        name: rescaled(contact["fe_approach"], reduced_modulus(made, made), own)
        for name, contact in found["contacts"].items()
    }


def rescaled(fe_approach: float, made: float, own: float) -> float:
    """Approach at `FE_LOAD` of the same bodies of another modulus [m].

    The approach over the load falls as 1/E', and the contact is narrower: delta_0 E'/w_0 rises by (2/pi) times the
    logarithm of the ratio of the moduli.

    Parameters
    ----------
    fe_approach : float
        Approach [m] of the bodies of the modulus `made`.
    made, own : float
        E' [Pa] of both.

    Examples
    --------
    >>> rescaled(3e-6, 230e9, 230e9)
    3e-06
    """
    return (fe_approach * made + FE_LOAD * 2.0 / math.pi * math.log(own / made)) / own


def _same(a: object, b: object) -> bool:
    """Tell whether two numbers are the same."""
    return isinstance(a, (int, float)) and isinstance(b, (int, float)) and math.isclose(a, b, rel_tol=_SAME)


@lru_cache(maxsize=1)
def _shipped() -> dict[str, dict[str, Any]]:
    """All files that come with the package, by the names of the bearings."""
    folder = resources.files("ehdmaps.physics") / "shipped"
    texts = [entry.read_text("utf-8") for entry in folder.iterdir() if entry.name.endswith(".json")]
    records = [json.loads(text) for text in texts]
    return {record["geometry"]["name"]: record for record in records}
