"""Multibody consumer of the contact maps: bearing force element, statics, linear analysis and time integration.

::

    from mbs import Bearing, BearingForce

    force = BearingForce(Bearing.named("NU308", clearance=20e-6), law)
    f, K, C = force(pose, velocity, entrainment_speed=1.0, temperature=330.0)

The names are loaded when they are first used, so that importing the package is quick.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mbs.bearing import Bearing
    from mbs.bearing_force import BearingForce

__all__ = ["Bearing", "BearingForce"]

_HOMES = {"Bearing": "bearing", "BearingForce": "bearing_force"}


def __getattr__(name: str) -> object:
    """Load a name from its module when it is first used."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value: object = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names."""
    return sorted(__all__)
