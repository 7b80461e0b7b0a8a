"""Multibody consumer of the contact maps: from the bearing force to a machine and its Campbell diagram.

::

    from mbs import Bearing, BearingForce

    force = BearingForce(Bearing.named("NU308", clearance=20e-6), law)
    f, K, C = force(pose, velocity, entrainment_speed=1.0, temperature=330.0)

What is where, in the order of the data:

==================  ====================================================================================
scene file          `reading`, `scene_reader` -> `scene` -> `assembly`
what bodies are     `body`, `flexible` (beams, finite elements, reduction), `housings` (the shipped ones)
what connects them  `elements`, `bearings` (the bearing force), `gears`; `profiles` (what is prescribed)
one bearing         `bearing_point` (its equilibrium under a load, pressures and films), without a scene
the system          `system`; `statics` (its equilibrium), `free_motion`; `planning` (the map that it needs)
linear              `linearised` (modes, responses, over speed); `modal` (identified from hammer hits)
in time             `transient` (method, compiled runs); `spectral` (levels over speed and order)
for people          `output` (datasets, figures), `commands`, `cli`; `systems` (shipped scenes)
==================  ====================================================================================

Names of the package are loaded when they are first used, so that importing it is quick.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    __version__: str

    from mbs.bearings.bearing import Bearing
    from mbs.bearings.bearing_force import BearingForce

__all__ = ["Bearing", "BearingForce"]

_HOMES = {"Bearing": "bearings.bearing", "BearingForce": "bearings.bearing_force"}


def __getattr__(name: str) -> object:
    """Load a name from its module when it is first used; `__version__` is looked up then."""
    value: object
    if name == "__version__":
        value = import_module("ehdmaps.version").version()
    elif name in _HOMES:
        value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names."""
    return sorted(__all__)
