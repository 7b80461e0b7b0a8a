"""Approaches by finite elements that come with the package: what `ehdmaps solids` found for some bearings."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from functools import lru_cache
from importlib import resources
from typing import Any

from ehdmaps.physics.approach import FE_LOAD
from ehdmaps.physics.solids import Material, reduced_modulus

_GEOMETRY = ("inner_raceway_diameter", "outer_raceway_diameter", "roller_diameter", "rollers")
_SAME = 1e-9


def shipped_names() -> tuple[str, ...]:
    """Names of the bearings whose approaches come with the package."""
    return tuple(sorted(_shipped()))


def shipped_record(name: str) -> Mapping[str, Any]:
    """Everything that `ehdmaps solids` wrote about a bearing.

    Parameters
    ----------
    name : str
        One of `shipped_names`.
    """
    return _shipped()[name]


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
    """Whether two numbers are the same."""
    return isinstance(a, (int, float)) and isinstance(b, (int, float)) and math.isclose(a, b, rel_tol=_SAME)


@lru_cache(maxsize=1)
def _shipped() -> dict[str, dict[str, Any]]:
    """All files that come with the package, by the names of the bearings."""
    folder = resources.files("ehdmaps.physics") / "shipped"
    texts = [entry.read_text("utf-8") for entry in folder.iterdir() if entry.name.endswith(".json")]
    records = [json.loads(text) for text in texts]
    return {record["geometry"]["name"]: record for record in records}
