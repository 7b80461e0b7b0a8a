"""Gear pairs of a scene: a table [[gears]] is read, and becomes an element of the system."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Collection, Iterable, Sequence
from typing import TYPE_CHECKING, Literal, cast

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.jobs.table import Table
from ehdmaps.units import DAMPER, LENGTH, STIFFNESS, Display, closest, short
from mbs.gears.pair import FEWEST_TEETH, MOST_HARMONICS, MOST_TEETH, STEEPEST, GearPair
from mbs.model.elements import GROUND, MESH, Input, MeshInput, OnRings, Operation
from mbs.model.system import System
from mbs.scene import fields
from mbs.scene.fields import DEGREE, FORCE, MICROMETRE
from mbs.scene.specs import BodySpec, FlexibleSpec

if TYPE_CHECKING:
    from mbs.gears.relief import Relief
    from mbs.scene.surroundings import Built, Surroundings

_WORDS_HARMONICS = f"a whole number from 0 to {MOST_HARMONICS}, or a list of at most as many numbers, parts of the mean"

_ROUND_OFF = 1e-9


def read_gears(section: Table, name: str) -> GearPair | None:
    """Read a gear pair; None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    name : str
        Name of the pair.
    """
    before = len(section.problems)
    on = fields.place(section, "on")
    against = section.get("against", 'a place such as "shaft_2:gear"')
    if "against" in section and not isinstance(against, str):
        section.note("against", f'got {short(against)}; allowed: a place such as "shaft_2:gear"')
    teeth = _teeth(section)
    module = section.quantity("module", "m", 1e-5, 1.0, LENGTH, required=True)
    pressure_angle = section.quantity(
        "pressure_angle", "rad", math.radians(1.0), math.radians(45.0), DEGREE, required=True
    )
    helix_angle = section.quantity("helix_angle", "rad", -STEEPEST, STEEPEST, DEGREE)
    face_width = section.quantity("face_width", "m", 1e-5, 10.0, LENGTH, required=True)
    stiffness = section.quantity("stiffness", "N/m^2", 1e6, 1e13, STIFFNESS)
    backlash = section.quantity("backlash", "m", 0.0, 1.0, LENGTH, required=True)
    damping = section.quantity("damping", "N s/m", 0.0, 1e9, DAMPER)
    harmonics = _harmonics(section)
    harmonic_phases = _quantities(section, "harmonic_phases", "rad", 10.0, DEGREE)
    error = _quantities(section, "transmission_error", "m", 1e-2, MICROMETRE)
    error_phases = _quantities(section, "transmission_error_phases", "rad", 10.0, DEGREE)
    phase = section.quantity("phase", "rad", -10.0, 10.0, DEGREE)
    shifts = _shifts(section)
    distance = section.quantity("working_distance", "m", 1e-5, 100.0, LENGTH)
    tips = _quantities(section, "tip_diameters", "m", 100.0, LENGTH)
    force = section.quantity("tangential_force", "N", 1e-3, 1e9, FORCE)
    relief = _relief(section)
    if (
        len(section.problems) > before
        or on is None
        or teeth is None
        or module is None
        or pressure_angle is None
        or face_width is None
        or backlash is None
    ):
        return None
    return section.made(
        lambda: GearPair(
            name=name,
            on=on,
            against=against,
            teeth=teeth,
            module=module,
            pressure_angle=pressure_angle,
            face_width=face_width,
            stiffness=stiffness,
            backlash=backlash,
            damping=damping or 0.0,
            harmonics=harmonics,
            harmonic_phases=harmonic_phases,
            transmission_error=error,
            transmission_error_phases=error_phases,
            phase=phase or 0.0,
            helix_angle=helix_angle or 0.0,
            profile_shift=shifts,
            working_distance=distance,
            tip_diameters=tips or None,  # type: ignore[arg-type]  # the pair says how many there are
            tangential_force=force,
            relief=relief,
        ),
    )


def gear_problems(spec: GearPair, surroundings: Surroundings) -> list[str]:
    """Problems with the places of a gear pair.

    Parameters
    ----------
    spec : GearPair
        The pair.
    surroundings : Surroundings
        What it is built into.
    """
    return [
        f"gear pair {spec.name!r}: a gear on the ground cannot turn; name a body"
        for place in (spec.on, spec.against)
        if place == GROUND
    ]


def build_gears(spec: GearPair, surroundings: Surroundings) -> Built:
    """The element of a gear pair.

    Parameters
    ----------
    spec : GearPair
        The pair; its places exist.
    surroundings : Surroundings
        What it is built into.

    Raises
    ------
    InputError
        If the gears are not where they mesh, or do not turn as their teeth ask for.
    """
    from mbs.gears.gear import gear_mesh
    from mbs.scene.surroundings import Built

    places = surroundings.places
    positions = [places.position(place).tolist() for place in (spec.on, spec.against)]
    mesh = gear_mesh(spec, *positions, *(places.spin(place) for place in (spec.on, spec.against)))
    return Built(mesh, mesh)


def _teeth(section: Table) -> tuple[int, int] | None:
    """Read the numbers of teeth."""
    allowed = f"two whole numbers from {FEWEST_TEETH} to {MOST_TEETH}, such as [21, 23]"
    value = section.get("teeth", allowed)
    if "teeth" not in section:
        return None
    whole = isinstance(value, list) and all(isinstance(z, int) and not isinstance(z, bool) for z in value)
    if not whole or len(value) != 2 or not all(FEWEST_TEETH <= z <= MOST_TEETH for z in value):
        section.note("teeth", f"got {value!r:.60}; allowed: {allowed}")
        return None
    return value[0], value[1]


def _harmonics(section: Table) -> int | tuple[float, ...]:
    """Read how many harmonics, or their amplitudes."""
    value = section.get("harmonics")
    if "harmonics" not in section:
        return 5
    if isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= MOST_HARMONICS:
        return value
    if isinstance(value, list) and len(value) <= MOST_HARMONICS:
        numbers = [part for part in value if isinstance(part, (int, float)) and not isinstance(part, bool)]
        if len(numbers) == len(value) and all(abs(part) <= 1.0 for part in numbers):
            return tuple(float(part) for part in numbers)
    section.note("harmonics", f"got {value!r:.60}; allowed: {_WORDS_HARMONICS}, each from -1 to 1")
    return 0


def _shifts(section: Table) -> tuple[float, ...]:
    """Read the profile shifts; empty if absent or wrong."""
    value = section.get("profile_shift")
    if "profile_shift" not in section:
        return ()
    if isinstance(value, list) and 1 <= len(value) <= 2:
        numbers = [part for part in value if isinstance(part, (int, float)) and not isinstance(part, bool)]
        if len(numbers) == len(value):
            return tuple(float(part) for part in numbers)
    section.note("profile_shift", f"got {short(value)}; allowed: x1 and x2, such as [0.3, -0.1], or [x1] alone")
    return ()


def _relief(section: Table) -> Relief | None:
    """Read the relief of the tips; None if absent or wrong."""
    if "tip_relief" not in section and "relief_length" not in section:
        return None
    from mbs.gears.relief import LARGEST, Relief

    amounts = _quantities(section, "tip_relief", "m", LARGEST, MICROMETRE)
    lengths = _quantities(section, "relief_length", "m", 1.0, LENGTH)
    if lengths and "tip_relief" not in section:
        section.note("relief_length", "stands without tip_relief; allowed: with it")
    return section.made(lambda: Relief(amounts, lengths)) if amounts else None


def read_mesh_input(section: Table, name: str, on: str) -> MeshInput:
    """Read an input whose place is a gear mesh; problems are noted.

    Parameters
    ----------
    section : Table
        A table [[inputs]].
    name, on : str
        Name of the input, and the place `mesh:NAME`.
    """
    quantity = section.choice("quantity", ("force", "transmission_error")) or "force"
    unit, largest, display = ("N", 1e9, FORCE) if quantity == "force" else ("m", 1e-2, MICROMETRE)
    amplitude = section.quantity("amplitude", unit, 1e-12, largest, display)
    for key in ("against", "direction"):
        if key in section:
            section.get(key)
            section.note(key, "stands beside a mesh; allowed: nothing, for a mesh has its line of action; delete it")
    usual = 1.0 if quantity == "force" else 1e-6
    quantity = cast("Literal['force', 'transmission_error']", quantity)
    return MeshInput(name, on, np.zeros(6), amplitude=usual if amplitude is None else amplitude, quantity=quantity)


def mesh_input_problems(inputs: Iterable[Input], pairs: Iterable[GearPair]) -> list[str]:
    """Inputs of meshes that the scene has not.

    Parameters
    ----------
    inputs : iterable of Input
        Inputs of the scene.
    pairs : iterable of GearPair
        Gear pairs of the scene.
    """
    names = tuple(pair.name for pair in pairs)
    allowed = ", ".join(MESH + name for name in names) or "a place of a body, for there are no gears"
    return [
        f"input {entry.name!r}: there is no gear pair {entry.pair!r}{closest(entry.pair, names)}; allowed: {allowed}"
        for entry in inputs
        if isinstance(entry, MeshInput) and entry.pair not in names
    ]


def spins_by_teeth(bodies: Sequence[BodySpec], pairs: Iterable[GearPair], typed: Collection[str]) -> list[BodySpec]:
    """The bodies with the spins that the teeth ask for, through any chain of meshes, where none is typed.

    Parameters
    ----------
    bodies : sequence of BodySpec
        The bodies.
    pairs : iterable of GearPair
        The gear pairs between them.
    typed : collection of str
        Names of the bodies whose spin is typed, which stays.
    """
    known = {body.name: body.spin for body in bodies if body.name in typed}
    meshes = [(pair.on.partition(":")[0], pair.against.partition(":")[0], *pair.teeth) for pair in pairs]
    meshes += [(other, one, theirs, own) for one, other, own, theirs in meshes]
    for seed in (None, *bodies):
        if seed is not None and seed.spin and seed.name not in known:
            known[seed.name] = seed.spin  # of a shaft by lengths, where no teeth ask for another one
        while found := {two: -known[one] * z1 / z2 for one, two, z1, z2 in meshes if one in known and two not in known}:
            known |= found
    return [
        dataclasses.replace(body, spin=known[body.name])
        if body.name in known and not isinstance(body, FlexibleSpec)
        else body
        for body in bodies
    ]


def _quantities(section: Table, key: str, unit: str, largest: float, display: Display) -> tuple[float, ...]:
    """Read a list of quantities, each within +- `largest`; empty if absent or wrong."""
    value = section.get(key)
    if key not in section:
        return ()
    if not isinstance(value, list) or len(value) > MOST_HARMONICS:
        section.note(key, f"got {short(value)}; allowed: a list of at most {MOST_HARMONICS} quantities")
        return ()
    read = [
        section.quantity_of(part, f"{key}[{index}]", unit, -largest, largest, display)
        for index, part in enumerate(value)
    ]
    return tuple(part if part is not None else 0.0 for part in read)


def axial_problems(system: System, pairs: Sequence[GearPair], operation: Operation) -> list[str]:
    """Name the bodies that helical gears push along x while nothing holds them there.

    Parameters
    ----------
    system : System
        The system that they are in.
    pairs : sequence of GearPair
        Gear pairs of the system.
    operation : Operation
        Speed at which elements are looked at.

    Notes
    -----
    A body with several helical gears may float between their axial forces, and is not looked at.
    """
    pushed: dict[str, list[str]] = {}
    for pair in pairs:
        for place in (pair.on, pair.against) if pair.helix_angle else ():
            pushed.setdefault(place.partition(":")[0], []).append(pair.name)
    return [
        f"gear pair {names[0]!r}: its helix pushes {body!r} along x, and nothing holds {body!r} there; give it a "
        "locating bearing, such as a ball bearing, or a spring with a stiffness x, or take x from its freedoms"
        for body, names in pushed.items()
        if len(names) == 1 and _free_along_x(system, body, operation)
    ]


def _free_along_x(system: System, body: str, operation: Operation) -> bool:
    """Tell whether a body moves along x, and neither spring nor bearing resists."""
    from mbs.gears.gear import GearMesh

    own = np.array([name.partition(".")[0] == body and name.endswith(".x") for name in system.coordinates])
    moved = own.astype(np.float64)
    if not np.any(moved) or _resists(system.stiffness, moved):
        return False
    still = np.zeros(system.size)
    for connected in system.elements:
        if isinstance(connected.element, OnRings) and connected.element.locating:
            if np.any((connected.transform @ moved)[:1]):
                return False
        elif not isinstance(connected.element, GearMesh):
            stiffness = connected.evaluate(still, still, operation).stiffness
            if _resists(connected.transform.T @ stiffness @ connected.transform, moved):
                return False
    return True


def _resists(stiffness: FloatArray, motion: FloatArray) -> bool:
    """Tell whether a motion of the whole body has a stiffness, beyond the round-off of what bends in it."""
    inner = float(np.sum(np.abs(motion) @ np.abs(stiffness) @ np.abs(motion)))
    return float(motion @ stiffness @ motion) > _ROUND_OFF * inner
