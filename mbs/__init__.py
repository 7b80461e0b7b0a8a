"""Multibody consumer of the contact maps: from the bearing force to a machine and its Campbell diagram.

::

    from mbs import Bearing, BearingForce

    force = BearingForce(Bearing.named("NU308", clearance=20e-6), law)
    f, K, C = force(pose, velocity, entrainment_speed=1.0, temperature=330.0)

and of a whole scene::

    from mbs import assemble, read_scene, statics

    model = assemble(read_scene("nu308_rigid"), emap="nu308.nc", clearance=20e-6)
    found = statics(model)
    found.dataset, found.plot()

What is where, in the order of the data:

==================  ====================================================================================
scene file          `scene`: reader -> specs -> scene -> assembly; `kinds`: the machine elements; `choices`; `settings`
the system          `model`: bodies, elements, what is prescribed; the system and its equilibrium
what bodies are     `flexible` (beams, finite elements, reduction)
what connects them  `bearings` (the bearing force), `gears`
linear              `linearised` (modes, responses, over speed); `modal` (identified from hammer hits)
in time             `transient` (method, runs in C); `spectral` (levels over speed and order); `timedata` (files)
analyses            `analyses`: statics, modes, lsa, sweep, runup, campbell, hammer; `planning`: what a scene requires;
                    `library`: what needs no model
laboratory          `laboratory`: tradeoff, variants, stability
for people          `output` (datasets, figures), `report` (a page to send), `commands`, `cli`; `systems`: scenes
==================  ====================================================================================

Names of the package are loaded when they are first used, so that importing it is quick.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from ehdmaps.errors import AnalysisError

if TYPE_CHECKING:
    __version__: str

    from mbs.analyses.campbell import campbell
    from mbs.analyses.case import Case
    from mbs.analyses.hammer import HammerSettings, hammer
    from mbs.analyses.lsa import LsaSettings, lsa
    from mbs.analyses.modes import modes
    from mbs.analyses.runup import runup
    from mbs.analyses.statics import statics
    from mbs.analyses.sweep import SweepSettings, critical, sweep
    from mbs.bearings.bearing import Bearing
    from mbs.bearings.bearing_force import BearingForce
    from mbs.bearings.thermal import GivenTemperatures, HeatPaths, Mounting, Seat
    from mbs.flexible.plan import Attached, ReductionPlan
    from mbs.flexible.shaft_parts import Disc, Section
    from mbs.gears.pair import GearPair
    from mbs.laboratory.variants import Variation, variants
    from mbs.library import bearing, modal_fit, reduce, write_report
    from mbs.model.body import Inertia
    from mbs.model.drive import Drive
    from mbs.model.elements import Input, Load, Operation, Sensor, Spring
    from mbs.model.profiles import SpeedProfile
    from mbs.planning.auto import automatic
    from mbs.planning.physics import AutoSettings
    from mbs.planning.plan import PlanSettings, plan
    from mbs.scene.assembly import Model, assemble
    from mbs.scene.matrices import MatrixSpec
    from mbs.scene.reader import parse_scene, read_scene, shipped_systems
    from mbs.scene.scene import Scene
    from mbs.scene.specs import BearingSpec, FlexibleSpec, RigidSpec, ShaftSpec
    from mbs.scene.turning import OrderLoad, Unbalance
    from mbs.settings import CampbellSettings, RunUp, Settings, SweepRange

__all__ = [
    "AnalysisError",
    "Attached",
    "AutoSettings",
    "Bearing",
    "BearingForce",
    "BearingSpec",
    "CampbellSettings",
    "Case",
    "Disc",
    "Drive",
    "FlexibleSpec",
    "GearPair",
    "GivenTemperatures",
    "HammerSettings",
    "HeatPaths",
    "Inertia",
    "Input",
    "LawChoice",
    "Load",
    "LsaSettings",
    "MatrixSpec",
    "Model",
    "Mounting",
    "Operation",
    "OrderLoad",
    "PlanSettings",
    "ReductionPlan",
    "RigidSpec",
    "RunUp",
    "Scene",
    "Seat",
    "Section",
    "Sensor",
    "Settings",
    "ShaftSpec",
    "SpeedProfile",
    "Spring",
    "SweepRange",
    "SweepSettings",
    "Unbalance",
    "Variation",
    "assemble",
    "automatic",
    "bearing",
    "campbell",
    "critical",
    "hammer",
    "lsa",
    "modal_fit",
    "modes",
    "parse_scene",
    "plan",
    "read_scene",
    "reduce",
    "runup",
    "shipped_systems",
    "statics",
    "sweep",
    "variants",
    "write_report",
]

_HOMES = {
    "Attached": "flexible.plan",
    "AutoSettings": "planning.physics",
    "Bearing": "bearings.bearing",
    "BearingForce": "bearings.bearing_force",
    "BearingSpec": "scene.specs",
    "CampbellSettings": "settings",
    "Case": "analyses.case",
    "Disc": "flexible.shaft_parts",
    "Drive": "model.drive",
    "FlexibleSpec": "scene.specs",
    "GearPair": "gears.pair",
    "GivenTemperatures": "bearings.thermal",
    "HammerSettings": "analyses.hammer",
    "HeatPaths": "bearings.thermal",
    "Inertia": "model.body",
    "Input": "model.elements",
    "LawChoice": "scene.choices",
    "Load": "model.elements",
    "LsaSettings": "analyses.lsa",
    "MatrixSpec": "scene.matrices",
    "Model": "scene.assembly",
    "Mounting": "bearings.thermal",
    "Operation": "model.elements",
    "OrderLoad": "scene.turning",
    "PlanSettings": "planning.plan",
    "ReductionPlan": "flexible.plan",
    "RigidSpec": "scene.specs",
    "RunUp": "settings",
    "Scene": "scene.scene",
    "Seat": "bearings.thermal",
    "Section": "flexible.shaft_parts",
    "Sensor": "model.elements",
    "Settings": "settings",
    "ShaftSpec": "scene.specs",
    "SpeedProfile": "model.profiles",
    "Spring": "model.elements",
    "SweepRange": "settings",
    "SweepSettings": "analyses.sweep",
    "Unbalance": "scene.turning",
    "Variation": "laboratory.variants",
    "assemble": "scene.assembly",
    "automatic": "planning.auto",
    "bearing": "library",
    "campbell": "analyses.campbell",
    "critical": "analyses.sweep",
    "hammer": "analyses.hammer",
    "lsa": "analyses.lsa",
    "modal_fit": "library",
    "modes": "analyses.modes",
    "parse_scene": "scene.reader",
    "plan": "planning.plan",
    "read_scene": "scene.reader",
    "reduce": "library",
    "runup": "analyses.runup",
    "shipped_systems": "scene.reader",
    "statics": "analyses.statics",
    "sweep": "analyses.sweep",
    "variants": "laboratory.variants",
    "write_report": "library",
}


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
