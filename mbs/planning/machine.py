"""Verdicts on what a scene file switches: slices, rollers, solids, rings, housing, gears.

An analysis takes these as the scene has them. Each verdict says what that is, how much the other choice would change,
and which key switches it. A size is either a closed form of one contact (`mbs.planning.criteria`), over the loads of
rollers that carry a bearing; or the change of the stiffness of a bearing along its load, by equilibria with and
without, of dry contacts in clearances that the films have taken up (`PlanResult.filled`). What cannot matter to an
analysis has no verdict: an equilibrium has neither masses of rollers nor gears that excite.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.approach import StructuralLaw
from ehdmaps.physics.bearing import with_law
from ehdmaps.units import RPM
from mbs.analyses.operating import held
from mbs.bearings.bearing import MOST_COUPLED
from mbs.bearings.thermal import STEEL_EXPANSION
from mbs.gears.gear_kernel import FORCE
from mbs.linearised.modes import energy_shares
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium, equilibrium
from mbs.planning.criteria import ClosedContact, closed_contact
from mbs.planning.plan import PlanResult
from mbs.planning.verdicts import SHARES, Range, Verdict, beside, percent, up_to
from mbs.scene.assembly import Model, assemble
from mbs.scene.fields import HERTZ, MICROMETRE
from mbs.scene.map_set import TABLE_LAW
from mbs.scene.scene import Scene
from mbs.scene.specs import FlexibleSpec, LocatingSpec

WARMER = 10.0
"""Difference of the temperatures of the rings whose effect is told [K]."""

NARROWER = 10e-6
"""Difference of a clearance whose effect is told [m]."""

_OTHER_LAWS: tuple[StructuralLaw, ...] = ("palmgren", "half_space")
"""Laws of the solids beside which that of planned maps, ISO 16281, is held."""

_STATED_LAW: StructuralLaw = "palmgren"
"""The other law that finite elements of rings in their seats support: what it differs by, no analysis decides.

`half_space` is told and not counted: its depth is exact for a roller, and too stiff for a ring (docs/solids.md).
"""

_SOFT = 1e-9
"""Mass that is added to a singular stiffness, in squares of its mean frequency, as where an equilibrium is sought."""

_UPRIGHT = 1e-9
"""Tilt that is left by round-off [rad]."""

_Changed = Callable[[Scene], Scene]


def machine_verdicts(
    found: PlanResult, ranges: Sequence[Range], frequency: float, flooded: bool
) -> tuple[Verdict, ...]:
    """Judge what the scene file switches, as far as it may matter to the analysis.

    Parameters
    ----------
    found : PlanResult
        The scene as the analysis visits it, with dry contacts. One with [runup] is analysed in time.
    ranges : sequence of Range
        Contacts of each geometry of `found.needed`, then of `found.seen`, in their order.
    frequency : float
        Highest frequency that is looked at [Hz]; 0 for an equilibrium.
    flooded : bool
        Whether no oil supply is stated.
    """
    tolerance, mapped = ranges[0].tolerance, ranges[: len(found.needed)]
    lines = [there for there in ranges if there.of_lines]
    rest = _AtRest(found.filled)
    verdicts = [
        *([centrifugal_verdict(found, tolerance)] if mapped else []),
        *([inertia_verdict(found, tolerance)] if found.seen else []),
        *([rollers_verdict(found, mapped, frequency)] if mapped and frequency > 0.0 else []),
        *([slices_verdict(found, rest, tolerance)] if lines else []),
        *([coupling_verdict(found, rest, tolerance)] if mapped else []),
        rings_verdict(found, rest, tolerance),
        *([structure_verdict(lines)] if lines else []),
        housing_verdict(rest, tolerance),
        *([mesh_verdict(rest, tolerance)] if found.scene.gears and found.scene.run_up is not None else []),
    ]
    return (*verdicts, undecided(rest, flooded))


class _AtRest:
    """Equilibrium of the scene with dry contacts at its operating speed, and of the same with other bearings.

    Parameters
    ----------
    model : Model
        The scene with dry contacts.
    """

    def __init__(self, model: Model) -> None:
        self.model = model
        self.balance = equilibrium(model.system, model.operation)
        self._stiffness = self._along(model, self.balance)

    @staticmethod
    def _along(model: Model, balance: Equilibrium) -> FloatArray:
        """Stiffness of each bearing along its load [N/m]."""
        return np.asarray(stiffness_and_damping(model, balance)[0])

    def change(self, changed: _Changed) -> float:
        """Largest change of the stiffness of a bearing along its load, as a part; NaN where there is no equilibrium.

        Parameters
        ----------
        changed : callable
            Gives another scene, with other bearings.
        """
        try:
            other = assemble(changed(self.model.scene), "hertz")
            stiffness = self._along(other, equilibrium(other.system, other.operation, self.balance.displacement))
        except (AnalysisError, InputError):
            return math.nan
        return largest_change(stiffness, self._stiffness)


def largest_change(new: FloatArray, old: FloatArray) -> float:
    """Largest change of some values, as a part of the old ones; 0 of those that are none.

    Parameters
    ----------
    new, old : array (n,)
        Values of one kind; NaN of what has none.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.nanmax(np.abs(new / old - 1.0), initial=0.0))


def stiffness_and_damping(model: Model, balance: Equilibrium) -> FloatArray:
    """Stiffness [N/m] and damping [N s/m] of each bearing along its load, (2, bearings); NaN without a load.

    Parameters
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium of the model.
    """
    places = model.ring_places
    parts = (balance.element_stiffness, balance.element_damping)
    forces = [balance.forces[place] for place in places]
    return np.array([_along_loads(forces, [part[place] for place in places]) for part in parts])


def _along_loads(forces: Sequence[FloatArray], matrices: Sequence[FloatArray]) -> FloatArray:
    """Stiffness or damping of each bearing along its load; NaN without one."""
    found = []
    for force, matrix in zip(forces, matrices, strict=True):
        size = float(np.linalg.norm(force[:3]))
        along = force[:3] / size if size > 0.0 else np.full(3, math.nan)
        found.append(float(along @ matrix[:3, :3] @ along))
    return np.array(found)


def centrifugal_verdict(found: PlanResult, tolerance: float) -> Verdict:
    """Judge the centrifugal load of the rollers: by equilibria with it and without, on films of the table.

    Parameters
    ----------
    found : PlanResult
        The plan; the highest of its speeds counts.
    tolerance : float
        Accepted change, as a part.
    """
    fastest = found.speeds[1]
    try:
        with_it, without = (_moving(found, centrifugal) for centrifugal in (True, False))
        stiffness, damping = map(largest_change, with_it, without)
    except (AnalysisError, InputError):
        stiffness = damping = math.nan
    size = max(stiffness, damping)
    verdict = _stated(
        "centrifugal load",
        [entry.centrifugal for entry in found.scene.bearings],
        size,
        f"it changes k or c of a bearing by {_told(size, tolerance)} at {RPM.text(fastest)}",
        "centrifugal in [[bearings]]",
    )
    return verdict if math.isnan(size) else dataclasses.replace(verdict, errors=(stiffness, damping))


def _moving(found: PlanResult, centrifugal: bool) -> FloatArray:
    """Stiffness and damping of each bearing along its load at the highest speed, (2, bearings)."""
    scene = found.model.scene
    loaded = (dataclasses.replace(entry, centrifugal=centrifugal, slices_coupled=False) for entry in scene.bearings)
    model = held(assemble(scene.with_bearings(loaded), TABLE_LAW))
    balance = equilibrium(model.system, Operation(found.speeds[1], 0.0))
    return stiffness_and_damping(model, balance)[:, : len(model.bearings)]


def inertia_verdict(found: PlanResult, tolerance: float) -> Verdict:
    """Judge masses of balls and of tapered or ribbed rollers: by dry equilibria with them and without.

    Parameters
    ----------
    found, tolerance
        Same as for `centrifugal_verdict`.
    """
    from mbs.planning.seen import weightless

    operation = Operation(found.speeds[1], 0.0)
    try:
        model = found.filled
        light = dataclasses.replace(model, system=weightless(model.system))
        with_it, without = (
            stiffness_and_damping(one, equilibrium(one.system, operation))[0, len(model.bearings) :]
            for one in (model, light)
        )
        size = largest_change(without, with_it)
    except (AnalysisError, InputError):
        size = math.nan
    words = (
        f"balls, tapered and ribbed rollers always have it; without, k of a bearing changes by {_told(size, tolerance)}"
    )
    return Verdict("centrifugal load and gyroscopic moment", True, size, f"{words} at {RPM.text(operation.speed)}")


def rollers_verdict(found: PlanResult, ranges: Sequence[Range], frequency: float) -> Verdict:
    """Judge whether rollers have a mass of their own: by the dynamic stiffness of both contacts with it between them.

    Parameters
    ----------
    found : PlanResult
        The plan.
    ranges : sequence of Range
        Contacts of each geometry.
    frequency : float
        Highest frequency that is looked at [Hz].

    Notes
    -----
    With Z = k + i omega c of each contact and the mass m, the inner ring feels Z_i - Z_i^2/(Z_i + Z_o - m omega^2),
    which is beside the same with m = 0.
    """
    omega, sizes = 2.0 * math.pi * frequency, []
    for needed, there in zip(found.needed, ranges, strict=True):
        bearing = next(entry.bearing for entry in found.model.bearings if entry.name in needed.bearings)
        mass = bearing.roller_mass / bearing.geometry.roller_length
        pairs = len(there.states) // 2  # speeds of the inner contact, then of the outer one
        for inner, outer in zip(there.states[:pairs], there.states[pairs:], strict=True):
            carrying = inner.load >= SHARES[0] * there.highest * (1.0 - 1e-9)
            first, second = ((state.stiffness + 1j * omega * state.damping)[carrying] for state in (inner, outer))
            massless, massive = (first - first**2 / (first + second - load) for load in (0.0, mass * omega**2))
            sizes.append(float(np.max(np.abs(massive - massless) / np.abs(massless))))
    size, tolerance = max(sizes), ranges[0].tolerance
    return _stated(
        "rollers as bodies",
        [entry.rollers_as_bodies for entry in found.scene.bearings],
        size,
        f"it changes the stiffness of a roller by {up_to(size)} at {HERTZ.text(frequency)} ({beside(size, tolerance)})",
        "rollers in [[bearings]]",
    )


def slices_verdict(found: PlanResult, rest: _AtRest, tolerance: float) -> Verdict:
    """Judge the slices of the rollers: one of them would know neither profile nor tilt.

    Parameters
    ----------
    found : PlanResult
        The plan.
    rest : _AtRest
        Equilibrium of the scene with dry contacts.
    tolerance : float
        Accepted change, as a part.
    """
    scene = found.scene
    counts = [entry.slices for entry in scene.bearings] + [entry.slices for entry in scene.tapered]
    fewest = 1 if scene.bearings else 2
    coarse = rest.change(lambda entry: _sliced(entry, lambda slices: fewest))
    finer = rest.change(lambda entry: _sliced(entry, lambda slices: 2 * slices))
    places = rest.model.ring_places
    tilts = [
        float(np.hypot(*(rest.model.system.elements[place].transform @ rest.balance.displacement)[4:6]))
        for place in places
    ]
    numbers = "/".join(map(str, dict.fromkeys(counts)))
    tilt = f"tilt by up to {1e6 * max(tilts):.3g} urad" if max(tilts) > _UPRIGHT else "do not tilt"
    few = "a single one changes" if fewest == 1 else "two change"
    words = (
        f"{numbers} a roller, whose rings {tilt} at rest; {few} k of a bearing by "
        f"{_told(coarse, tolerance)}, twice as many by {_told(finer, tolerance)}; slices in [[bearings]]"
    )
    return Verdict("slices", max(counts) > 1, coarse, words)


def _sliced(scene: Scene, change: Callable[[int], int]) -> Scene:
    """The scene with other numbers of slices, none coupled."""
    bearings = [dataclasses.replace(one, slices=change(one.slices), slices_coupled=False) for one in scene.bearings]
    return scene.with_bearings(bearings).with_located(lambda entry: entry.sliced(lambda n: max(change(n), 2)))


def coupling_verdict(found: PlanResult, rest: _AtRest, tolerance: float) -> Verdict:
    """Judge whether slices need to know of their neighbours.

    Parameters
    ----------
    found, rest, tolerance
        Same as for `slices_verdict`.
    """
    size = rest.change(
        lambda scene: scene.with_bearings(
            dataclasses.replace(entry, slices=min(entry.slices, MOST_COUPLED), slices_coupled=not entry.slices_coupled)
            for entry in scene.bearings
        )
    )
    return _stated(
        "coupled slices",
        [entry.slices_coupled for entry in found.scene.bearings],
        size,
        f"it changes k of a bearing by {_told(size, tolerance)}",
        "slices_coupled in [[bearings]]",
    )


def rings_verdict(found: PlanResult, rest: _AtRest, tolerance: float) -> Verdict:
    """Judge temperatures of the rings and fits, by the clearance that an inner ring takes up that is warmer.

    Parameters
    ----------
    found, rest, tolerance
        Same as for `slices_verdict`.

    Notes
    -----
    Rollers have the mean of both rings, so that the clearance falls by alpha dT times the pitch diameter.
    """
    warm = STEEL_EXPANSION * WARMER
    size = rest.change(lambda scene: _narrower(scene, lambda diameter: warm * diameter))
    scene = found.scene
    pitches = [entry.geometry.pitch_diameter for entry in scene.bearings]
    pitches += [entry.geometry.pitch_diameter for entry in scene.located]
    words = (
        f"an inner ring {WARMER:g} K warmer takes {MICROMETRE.text(warm * max(pitches), 2)} of the clearance, which "
        f"changes k of a bearing by {_told(size, tolerance)}"
    )
    name = "ring temperatures and fits"
    if scene.bearings:
        has = [entry.changes_in_operation for entry in scene.bearings]
        return _stated(name, has, size, words, "thermal and mounting in [[bearings]]")
    return Verdict(name, False, size, f"{words}; clearance and offset are those in operation")


def structure_verdict(ranges: Sequence[Range]) -> Verdict:
    """Judge the law of the solids, which is that of ISO 16281, beside others.

    Parameters
    ----------
    ranges : sequence of Range
        Contacts of each geometry.
    """
    sizes: dict[str, tuple[float, float]] = {}
    for law in _OTHER_LAWS:
        for there in ranges:
            for state in there.slowest_and_fastest:
                loads = np.geomspace(*SHARES, _LOADS) * there.highest
                contacts = (state.contact, with_law(state.contact, law, None))
                own, other = (
                    closed_contact(contact, there.lubricant, loads, state.speed, state.temperature)
                    for contact in contacts
                )
                before, here = sizes.get(law, (0.0, 0.0)), _changes(own, other)
                sizes[law] = max(before[0], here[0]), max(before[1], here[1])
    size = max(max(pair) for pair in sizes.values())
    words = ", ".join(f"by {up_to(max(pair))} with {law}" for law, pair in sizes.items())
    told = f"iso16281; k or c of a contact changes {words} ({beside(size, ranges[0].tolerance)})"
    counted = f"bands count {_STATED_LAW} alone, as half_space is too stiff for rings"
    words = f"{told}; {counted}"
    if all(there.has_map for there in ranges):
        words += "; --structural-law beside --map has another"
    return Verdict("structural law", None, size, words, errors=sizes[_STATED_LAW])


def housing_verdict(rest: _AtRest, tolerance: float) -> Verdict:
    """Judge bodies of finite elements: which part of the strain energy they have under the loads of the scene.

    Parameters
    ----------
    rest, tolerance
        Same as for `slices_verdict`.
    """
    name, balance = "flexible housing", rest.balance
    bodies = [body.name for body in rest.model.scene.bodies if isinstance(body, FlexibleSpec)]
    if not bodies:
        words = "what holds the rings is rigid, or on springs; how much another gives way is not known without its mesh"
        return Verdict(name, False, math.nan, f"{words}; [[flexible]] has it")
    system = balance.system
    soft = _SOFT * max(float(np.trace(balance.stiffness) / np.trace(system.mass)), 1.0)
    motion: FloatArray = np.linalg.solve(balance.stiffness + soft * system.mass, system.loads(0.0)).astype(np.float64)
    shares = energy_shares(balance, motion[:, None])[:, 0]
    size = float(sum(share for part, share in zip(balance.parts, shares, strict=True) if part in bodies))
    words = (
        f"{', '.join(bodies)} gives way by {percent(size)} of what the scene does under its loads "
        f"({beside(size, tolerance)}); a rigid body in place of [[flexible]] leaves that out"
    )
    return Verdict(name, True, size, words)


def mesh_verdict(rest: _AtRest, tolerance: float) -> Verdict:
    """Judge the excitation by gear meshes: transmission error and varying stiffness over the mean force of the mesh.

    Parameters
    ----------
    rest, tolerance
        Same as for `slices_verdict`.
    """
    name, sizes, on = "gear mesh excitation", [], False
    still = np.zeros(12)
    elements = rest.model.system.elements
    for mesh in rest.model.gears:
        place = next(entry.transform for entry in elements if entry.element.name == mesh.name)
        steady = mesh.steady()
        force = float(np.max(steady.flanks(place @ rest.balance.displacement, still, rest.balance.operation)[:, FORCE]))
        pair = mesh.pair
        varying = force * float(np.sum(np.abs(pair.stiffness_harmonics)))
        error = pair.mean_stiffness * float(np.sum(np.abs(pair.transmission_error)))
        on = on or varying + error > 0.0
        sizes.append((varying + error) / force if force > 0.0 else math.inf)
    size = max(sizes)
    words = (
        f"varying stiffness and transmission error change the force of a mesh at rest by {up_to(size)} "
        f"({beside(size, tolerance)}); harmonics and transmission_error in [[gears]]"
    )
    return Verdict(name, on, size, words)


def undecided(rest: _AtRest, flooded: bool) -> Verdict:
    """Name what no analysis can decide: what the scene states of the clearance, and of the oil.

    Parameters
    ----------
    rest : _AtRest
        Equilibrium with dry contacts.
    flooded : bool
        Whether no oil supply is stated.
    """
    size = rest.change(lambda scene: _narrower(scene, lambda diameter: NARROWER))
    change = "has no equilibrium" if math.isnan(size) else f"changes k of a bearing by {up_to(size)}"
    layer = "none is stated, all contacts are flooded" if flooded else "as stated"
    taken = {reach.taken for _, reach in rest.model.scene.clearance_ranges.values()}
    kinds = [words for kind, words in _TAKEN.items() if kind in taken] or ["as stated"]
    clearance = f"clearance ({', '.join(kinds)}; {MICROMETRE.text(NARROWER)} less {change})"
    words = f"{clearance} and oil layer ({layer}): measure them"
    return Verdict("not decided", None, size, words)


_TAKEN = {"zero": "none is an assumption", "middle": "the middle of a class", "stated": "as stated"}
"""Clearances of bearings by what they have of their class, in words."""

_LOADS = 9


def _changes(plain: ClosedContact, other: ClosedContact) -> tuple[float, float]:
    """Largest changes of k and of c, as parts of the plain values."""
    parts = ((other.stiffness, plain.stiffness), (other.damping, plain.damping))
    stiffness, damping = (float(np.max(np.abs(new / old - 1.0))) for new, old in parts)
    return stiffness, damping


def _narrower(scene: Scene, by: Callable[[float], float]) -> Scene:
    """The scene with smaller clearances, by pitch diameters; where bearings stand one way, with more offset."""

    def of_located(entry: LocatingSpec) -> LocatingSpec:
        geometry, less = entry.geometry, by(entry.geometry.pitch_diameter)
        if geometry.contact_angle == 0.0:
            return entry.with_clearance(geometry.clearance - less)
        offset = entry.axial_offset + math.copysign(less, geometry.contact_angle)
        return dataclasses.replace(entry, axial_offset=offset)

    bearings = []
    for entry in scene.bearings:
        clearance = entry.geometry.diametral_clearance - by(entry.geometry.pitch_diameter)
        bearings.append(
            dataclasses.replace(entry, geometry=dataclasses.replace(entry.geometry, diametral_clearance=clearance))
        )
    return scene.with_bearings(bearings).with_located(of_located)


def _told(size: float, tolerance: float) -> str:
    """A size with what it is beside the tolerance; that there is none where no equilibrium was found."""
    if math.isnan(size):
        return "an unknown part, as it has no equilibrium"
    return f"{up_to(size)} ({beside(size, tolerance)})"


def _stated(physics: str, has: Sequence[bool], size: float, words: str, key: str) -> Verdict:
    """A verdict on what bearings of the scene have, or some of them."""
    some = f"in {sum(has)} of {len(has)} bearings, " if any(has) and not all(has) else ""
    return Verdict(physics, any(has), size, f"{some}as the scene has it; {words}; {key}")
