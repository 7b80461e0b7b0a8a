"""Results of the analyses as labelled datasets with units, and how they are written."""

from __future__ import annotations

import math
from collections.abc import Sequence
from operator import attrgetter
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import numpy.typing as npt
import xarray as xr

from ehdmaps.arrays import ComplexArray, FloatArray, variable
from mbs.bearings.films import SIDES
from mbs.bearings.thermal import BearingState
from mbs.gears.gear import GearMesh
from mbs.model.body import FREEDOMS
from mbs.model.elements import Input, OnRings, Sensor
from mbs.model.equilibrium import Equilibrium
from mbs.model.findings import CARRIES
from mbs.model.on_rings import error_words, ring_matrices
from mbs.model.system import System
from mbs.output.state_text import HIGHEST_LOAD, LOADED
from mbs.scene.assembly import Model
from mbs.spectral.spectra import AmplitudeSpectrum
from mbs.transient.energy import EnergyBalance

if TYPE_CHECKING:
    from mbs.bearings.contact_report import BearingContacts, RollingLoss
    from mbs.linearised.linear import StateSpace
    from mbs.linearised.modes import Modes
    from mbs.transient.run import Recording


_TERMS = (
    ("energy_in", "energy that came in, by source; of an element that does not say what it stores its whole work"),
    ("energy_out", "energy that was dissipated, by whom; integration: by the method of integration"),
    ("energy_stored", "change of stored energy from beginning to end"),
)


def with_energy(dataset: xr.Dataset, energy: EnergyBalance) -> xr.Dataset:
    """A dataset with the energy balance of its run, term by term [J].

    Parameters
    ----------
    dataset : xarray.Dataset
        What a run recorded.
    energy : EnergyBalance
        The balance of the run.
    """
    sources, sinks = {"loads": energy.loads}, dict(energy.parts)
    stores = {"kinetic": energy.kinetic, "elastic": energy.elastic}
    for entry in energy.elements:
        if not entry.told:
            sources[entry.name] = entry.work
            continue
        sources[f"turning of {entry.name}"] = entry.driven or 0.0
        sources[f"speed on {entry.name}"] = entry.by_speed
        sinks[entry.name], stores[entry.name] = entry.dissipated or 0.0, entry.change or 0.0
    sinks["integration"] = energy.numerical
    for (name, words), terms in zip(_TERMS, (sources, sinks, stores), strict=True):
        dim, attributes = f"{name}_term", {"units": "J", "long_name": words}
        dataset = dataset.assign({name: (dim, list(terms.values()), attributes)}).assign_coords({dim: list(terms)})
    words = "what the energy balance of the run does not close"
    return dataset.assign(energy_residual=variable((), energy.residual, "J", words))


def with_spectra(
    dataset: xr.Dataset, spectra: Sequence[Sequence[Sequence[AmplitudeSpectrum]]], sensors: Sequence[str]
) -> xr.Dataset:
    """The dataset of a run with spectra about some speeds; over the dim law where there is more than one run.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result with the dim sensor, and law of several runs.
    spectra : sequence of sequence of sequence of AmplitudeSpectrum
        Spectra about each speed, of each run, of each sensor; all with one window.
    sensors : sequence of str
        Names of these sensors; channels of a file that are none, such as a speed, have no spectrum.
    """
    if not spectra:
        return dataset
    values = np.array([[[spectrum.amplitude for spectrum in run] for run in about] for about in spectra])
    values = np.moveaxis(values, 1, 0)
    dims: tuple[str, ...] = ("law", "spectrum_speed", "sensor", "spectrum_frequency")
    if values.shape[0] == 1:
        values, dims = values[0], dims[1:]
    first = [about[0][0] for about in spectra]
    times, speeds = (np.array([getattr(spectrum, name) for spectrum in first]) for name in ("time", "speed"))
    words = f"amplitude of a sine at each line, window of {first[0].window:.6g} s about the speed"
    found = xr.Dataset(
        {
            "spectrum_amplitude": variable(dims, values, "by signal_unit", words),
            "spectrum_time": variable("spectrum_speed", times, "s", "middle of the window"),
        },
        coords={
            "sensor": list(sensors),
            "spectrum_speed": variable("spectrum_speed", speeds, "rad/s", "speed in the middle of the window"),
            "spectrum_frequency": variable("spectrum_frequency", first[0].frequencies, "Hz", "frequency"),
        },
    )
    found = found.reindex(sensor=dataset["sensor"]).drop_vars("sensor")
    return dataset.assign(found.data_vars).assign_coords(found.coords)


_STATE = (
    ("inner_raceway_temperature", "K", "temperature of the inner raceway", "inner"),
    ("outer_raceway_temperature", "K", "temperature of the outer raceway", "outer"),
    ("operating_clearance", "m", "diametral clearance in operation", "clearance.operating"),
)
_CHANGES = (
    ("stated_clearance", "m", "diametral clearance at 20 degC, not mounted", "clearance.stated"),
    ("clearance_by_temperature", "m", "what expansion adds to it", "clearance.by_temperature"),
    ("clearance_by_fits", "m", "what the fits add to it", "clearance.by_fits"),
)
_HEAT = (
    ("oil_temperature", "K", "temperature of the oil in the bearing", "oil"),
    ("friction_power", "W", "friction of the bearing", "heat.friction"),
    ("added_power", "W", "what of it the scene adds to the rolling", "heat.added"),
    ("heat_to_shaft", "W", "heat to the shaft", "heat.to_shaft"),
    ("heat_to_housing", "W", "heat to the housing", "heat.to_housing"),
    ("heat_to_oil", "W", "heat that the oil carries away", "heat.to_oil"),
)

_States = Sequence[BearingState] | Sequence[Any]


def with_states(dataset: xr.Dataset, states: _States, dims: tuple[str, ...] = ()) -> xr.Dataset:
    """The dataset with temperatures and clearances of all bearings, and with their heat where there is any.

    Parameters
    ----------
    dataset : xarray.Dataset
        A result.
    states : sequence of BearingState
        One a bearing; nested for each of `dims`.
    dims : tuple of str
        Dims over which there are more of them, such as ("case", "speed").
    """
    table = np.array(states, dtype=object)
    if not table.size:
        return dataset
    rows, heated = list(_STATE), [state.heat is not None for state in table.flat]
    if any(abs(state.clearance.operating - state.clearance.stated) > 0.0 for state in table.flat):
        rows += _CHANGES
    if any(heated):
        rows += _HEAT
    names = np.array([state.name for state in table.reshape(-1, table.shape[-1])[0]], dtype=np.str_)
    variables = {}
    for name, unit, words, path in rows:
        known = heated if path.startswith("heat.") else [True] * table.size
        read = attrgetter(path)
        values = [read(state) if there else math.nan for state, there in zip(table.flat, known, strict=True)]
        variables[name] = variable((*dims, "bearing"), np.reshape(values, table.shape), unit, words)
    added = xr.Dataset(variables, coords={"bearing": names})
    if "bearing" in dataset.coords:  # ball bearings have no states
        return dataset.assign(added.reindex(bearing=dataset["bearing"]).data_vars)
    return dataset.assign_coords(bearing=names).assign(added.data_vars)


_ROUND_OFF = 1e-9
_PARTS = ("tangential", "radial", "axial")


def gear_forces(model: Model, balance: Equilibrium) -> dict[str, tuple[float, float, float]]:
    """Tangential, radial and axial force on the first gear of each mesh [N], by its name.

    Parameters
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium of the model.

    Returns
    -------
    dict of str to (float, float, float)
        Tangential on the pitch circle, positive against the turn +x; radial away from the other gear; axial along x.
    """
    forces = {}
    for index in model.system.select(GearMesh):
        mesh = model.system.elements[index].element
        assert isinstance(mesh, GearMesh)
        force = balance.forces[index][:3]
        # the sum of both normals of the flanks is twice the radial part of one, along the centres
        towards = mesh.rows[0, :3] + mesh.rows[1, :3]
        towards = towards / np.linalg.norm(towards)
        along = np.cross([1.0, 0.0, 0.0], towards)
        forces[mesh.name] = float(-force @ along), float(-force @ towards), float(force[0])
    return forces


def with_gears(dataset: xr.Dataset, model: Model, balance: Equilibrium) -> xr.Dataset:
    """The result of statics with the forces of its gear meshes; the same without gears.

    Parameters
    ----------
    dataset : Dataset
        The result.
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium of the model.
    """
    by_mesh = gear_forces(model, balance)
    if not by_mesh:
        return dataset
    attributes = {"units": "N", "long_name": "force on the first gear: tangential (against +x), radial (apart), axial"}
    forces = xr.DataArray(
        np.array(list(by_mesh.values())),
        {"gear_mesh": list(by_mesh), "part": list(_PARTS)},
        ("gear_mesh", "part"),
        attrs=attributes,
    )
    return dataset.assign(gear_force=forces)


def gear_lines(model: Model, balance: Equilibrium) -> list[str]:
    """Lines on the gear meshes of an equilibrium.

    Parameters
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium of the model.
    """
    pairs = {mesh.name: mesh.pair for mesh in model.gears}
    lines = []
    for name, (tangential, radial, axial) in gear_forces(model, balance).items():
        pair = pairs[name]
        size = max(abs(tangential), abs(radial))
        if abs(axial) <= _ROUND_OFF * size:
            lines.append(f"{name}: {abs(tangential):.6g} N tangential, {radial:.6g} N radial on each gear")
            continue
        lines.append(
            f"{name}: {abs(tangential):.6g} N tangential, {radial:.6g} N radial, {axial:+.6g} N axial on {pair.on}, "
            f"{-axial:+.6g} N on {pair.against}"
        )
        bodies = [place.partition(":")[0] for place in (pair.on, pair.against)]
        rigid = [body for body in bodies if _is_rigid_in_x(model, body)]
        if rigid:
            lines.append(
                f"  {' and '.join(rigid)}: no freedom x, so that the axial force is taken by what is not in the scene; "
                "for a locating bearing give the body the freedom x, and a spring along x"
            )
    return lines


def _is_rigid_in_x(model: Model, body: str) -> bool:
    """Tell whether no coordinate of a body moves any of its frames along x."""
    return not any(np.any(frame.transform[0]) for frame in model.system.body(body).frames.values())


def of_laws(labels: Sequence[str], parts: Sequence[xr.Dataset], shared: Sequence[str]) -> xr.Dataset:
    """The results of several laws over the dim law; what a law has not is not a number.

    Parameters
    ----------
    labels : sequence of str
        What each law is called.
    parts : sequence of xarray.Dataset
        A result each.
    shared : sequence of str
        Variables that are the same whatever the law, where there are such.
    """
    law = xr.DataArray(np.array(labels, dtype=np.str_), dims="law", name="law")
    own = [part.drop_vars(shared, errors="ignore") for part in parts]
    joined = xr.concat(
        own, law, data_vars="all", coords="minimal", compat="override", join="outer", combine_attrs="override"
    )
    return joined.assign({name: parts[0][name] for name in shared if name in parts[0]})


MOTION_UNITS = "m, m/s or m/s2 by the sensor's quantity (rad for rotations)"
RESPONSE_UNITS = f"{MOTION_UNITS}, per N, N m or m"
"""Units of sensors, and of responses to a load or to a transmission error."""

BAND = "band, either way, by errors of known size, of"
"""How datasets call the bands; they are NaN where none is stated."""

STEP_ERROR = {"units": "dB", "long_name": "estimated error of the level by the step, from parts with half of it"}
"""Attributes of the variable `step_error` of runs in time."""

REDUCED = "what modes of bodies above their cut-off leave out, true less found, to first order,"
"""Parts of modes of reduced bodies, as `LEFT_OUT`."""

LEFT_OUT = "what the film law with memory leaves out, true less found, to first order,"
"""How datasets call the part of the film law; it is NaN where it is not known."""

_KINDS = (("translation", "m", "displacement"), ("rotation", "rad", "rotation"), ("modal", "1", "modal amplitude"))
_ORDERS = {"displacement": "", "velocity": "/s", "acceleration": "/s2"}


_CONTACTS = (
    ("hertz_pressure", "Pa", "largest Hertz pressure of rollers or balls on the raceway"),
    ("central_film", "m", "smallest central film of rollers or balls on the raceway; none of dry contacts"),
    ("minimum_film", "m", "smallest film of rollers or balls on the raceway; none of dry contacts"),
)


def statics_dataset(
    balance: Equilibrium,
    contacts: Sequence[BearingContacts] = (),
    losses: Sequence[RollingLoss] = (),
    warnings: Sequence[str] = (),
) -> xr.Dataset:
    """Equilibrium: displacements, bearing forces, K and C of the bearings, what their contacts feel and rolling costs.

    Parameters
    ----------
    balance : Equilibrium
        What is described.
    contacts : sequence of BearingContacts
        Pressures and films, one a bearing; left out if there are none.
    losses : sequence of RollingLoss
        What rolling costs, one a bearing; left out if there are none.
    warnings : sequence of str
        Why the result may not hold; becomes the attribute `warnings`.
    """
    variables = {
        **_by_kind(balance.system, balance.displacement, (), "displacement"),
        **_ring_variables(balance.system, balance.forces, ()),
    }
    bearings = _bearings(balance.system)
    pairs = [ring_matrices(balance.element_stiffness[i], balance.element_damping[i]) for i in bearings]
    for index, (name, unit) in enumerate((("stiffness", "N/m"), ("damping", "N s/m"))):
        rings = [pair[index] for pair in pairs]
        variables[f"bearing_{name}"] = variable(
            ("bearing", "freedom", "with_respect_to"),
            np.stack(rings) if rings else np.zeros((0, 6, 6)),
            f"{unit}, N m and rad in place of N and m for tilts",
            f"{name} of the bearing on its inner ring",
        )
    variables |= _element_loads(balance, bearings)
    coordinates = {
        "bearing": _bearing_names(balance.system),
        "freedom": list(FREEDOMS),
        "with_respect_to": list(FREEDOMS),
    }
    if contacts:
        coordinates["contact"] = list(SIDES)
        for name, unit, words in _CONTACTS:
            values = np.array([getattr(state, name) for state in contacts])
            variables[name] = variable(("bearing", "contact"), values, unit, words)
    if losses:
        from mbs.bearings.contact_report import TRACTION  # there where losses are

        known = "films only; none of laws without rolling forces"
        ends = f"torque that drilling of balls and ends of rollers at ribs take, at a traction of {TRACTION:g}"
        for name, key, unit, words in (
            ("rolling_torque", "torque", "N m", f"torque that rolling takes; {known}"),
            ("rolling_power", "total", "W", f"power that the films of all rollers or balls take; {known}"),
            ("sliding_torque", "sliding_torque", "N m", ends),
        ):
            variables[name] = variable("bearing", np.array([getattr(loss, key) for loss in losses]), unit, words)
    attributes = {**_operation(balance), "warnings": "\n".join(warnings)}
    return xr.Dataset(variables, coords={**_coordinates(balance.system), **coordinates}, attrs=attributes)


def _element_loads(balance: Equilibrium, bearings: Sequence[int]) -> dict[str, Any]:
    """Loads of the rolling elements of each bearing; NaN where none are known, nothing where no bearing tells them."""
    known = []
    for place in bearings:
        connected = balance.system.elements[place]
        element = cast("OnRings", connected.element)
        known.append(element.element_loads(connected.transform @ balance.displacement, balance.operation))
    if all(loads is None for loads in known):
        return {}
    highest = [math.nan if loads is None else float(np.max(loads)) for loads in known]
    loaded = [math.nan if loads is None else np.count_nonzero(loads > CARRIES * np.max(loads)) for loads in known]
    return {
        "highest_raceway_load": variable("bearing", np.array(highest), "N", HIGHEST_LOAD),
        "loaded_elements": variable("bearing", np.array(loaded, dtype=np.float64), "1", LOADED),
    }


def modes_dataset(found: Modes, balance: Equilibrium) -> xr.Dataset:
    """Modes: frequency, damping ratio, shapes and strain-energy shares."""
    real, imaginary = (
        _by_kind(balance.system, part.T, ("mode",), f"shape_{name}")
        for name, part in (("real", found.shapes.real), ("imaginary", found.shapes.imag))
    )
    none = np.full(found.frequency.shape, np.nan)
    film_share = 0.0 if found.bands is None else found.bands.film_share
    beside = {
        f"{name}_{kind}": variable("mode", none if parts is None else parts[k], unit, f"{words} the {of}")
        for kind, parts, words in (
            ("error", found.bands, BAND),
            ("film_law", found.film_law, f"{LEFT_OUT} of"),
            ("reduction", found.reduction, f"{REDUCED} of"),
        )
        for k, (name, unit, of) in enumerate(
            (("frequency", "Hz", "frequency"), ("damping_ratio", "1", "damping ratio"))
        )
    }
    variables = {
        "frequency": variable("mode", found.frequency, "Hz", "|eigenvalue|/(2 pi)"),
        "damping_ratio": variable("mode", found.damping_ratio, "1", "damping ratio"),
        **beside,
        "eigenvalue_real": variable("mode", found.eigenvalues.real, "1/s", "decay"),
        "eigenvalue_imaginary": variable("mode", found.eigenvalues.imag, "rad/s", "damped frequency"),
        "energy_share": variable(("part", "mode"), found.shares, "1", "part of the strain energy of the mode"),
        **real,
        **imaginary,
    }
    coordinates = {"part": list(found.parts), "mode": np.arange(1, found.eigenvalues.size + 1)}
    return xr.Dataset(
        variables, coords={**_coordinates(balance.system), **coordinates}, attrs=_operation(balance, film_share)
    )


def linear_dataset(
    balance: Equilibrium,
    space: StateSpace,
    responses: ComplexArray,
    frequencies: FloatArray,
    inputs: Sequence[Input],
    sensors: Sequence[Sensor],
    level_error: FloatArray | None = None,
    film_share: float = 0.0,
) -> xr.Dataset:
    """State space and frequency responses.

    Parameters
    ----------
    balance : Equilibrium
        The equilibrium.
    space : StateSpace
        State space about it.
    responses : ndarray
        Shape (frequencies, sensors, inputs).
    frequencies : ndarray
        [Hz].
    inputs : sequence of Input
        Inputs, where forces act.
    sensors : sequence of Sensor
        Sensors, where motion is measured.
    level_error : ndarray, optional
        Bands of the levels [dB], in the shape of the responses; NaN if left out.
    film_share : float
        Part of these bands that is what films with memory leave out.
    """
    names = list(balance.system.coordinates)
    films = space.A.shape[0] - 2 * len(names)
    states = [*names, *(f"{name}.rate" for name in names), *(f"film_{index + 1}" for index in range(films))]
    dims = ("frequency", "sensor", "input")
    quantities = [sensor.quantity for sensor in sensors]
    variables = {
        "response_real": variable(dims, responses.real, RESPONSE_UNITS, "real part of the response"),
        "response_imaginary": variable(dims, responses.imag, RESPONSE_UNITS, "imaginary part of the response"),
        "response_level_error": variable(
            dims,
            np.full(responses.shape, np.nan) if level_error is None else level_error,
            "dB",
            f"{BAND} the level of the response",
        ),
        "A": variable(("state", "of_state"), space.A, "SI", "system matrix"),
        "B": variable(("state", "input"), space.B, "SI", "input matrix"),
        "C": variable(("sensor", "of_state"), space.C, "SI", "output matrix"),
        "D": variable(("sensor", "input"), space.D, "SI", "feedthrough"),
        "quantity": variable("sensor", quantities, "", "what the sensor measures"),
        "amplitude": variable("input", [entry.amplitude for entry in inputs], "N, N m or m", "amplitude in operation"),
    }
    coordinates = {
        "frequency": variable("frequency", frequencies, "Hz", "frequency"),
        "sensor": [sensor.name for sensor in sensors],
        "input": [entry.name for entry in inputs],
        "state": states,
        "of_state": states,
    }
    return xr.Dataset(variables, coords=coordinates, attrs=_operation(balance, film_share))


def run_dataset(system: System, run: Recording) -> xr.Dataset:
    """Trajectory of a run: forces of the bearings, and motion of all coordinates where that was recorded.

    Parameters
    ----------
    system : System
        Whose run it is.
    run : Recording
        What was recorded.
    """
    variables: dict[str, Any] = {
        "speed": variable("time", run.speed, "rad/s", "speed of the system"),
        "angle": variable("time", run.angle, "rad", "angle turned"),
        **_ring_variables(system, run.forces, ("time",)),
    }
    for order, values in (
        ("displacement", run.states.displacement),
        ("velocity", run.states.velocity),
        ("acceleration", run.states.acceleration),
    ):
        if values.shape[0] > 0:
            variables |= _by_kind(system, values, ("time",), order)
    names = _bearing_names(system)
    variables["outside_calls"] = variable(
        "bearing",
        np.array([run.outside[str(name)] for name in names], dtype=np.int64),
        "1",
        "law calls outside the map",
    )
    coordinates: dict[str, Any] = {
        "time": variable("time", run.time, "s", "time"),
        "bearing": names,
    }
    if run.states.displacement.shape[0] > 0:
        coordinates |= _coordinates(system)
    attributes = {"steps": run.steps, "steps_halved": run.halved, "newton_iterations": run.iterations}
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)


def _by_kind(system: System, values: FloatArray, dims: tuple[str, ...], order: str) -> dict[str, Any]:
    """Variables of a quantity of all coordinates, apart by unit; the last axis is that of the coordinates."""
    variables = {}
    units = np.array(system.units)
    for dim, unit, words in _KINDS:
        here = units == unit
        if here.any():
            per = _ORDERS.get(order, "")
            shape = order.startswith("shape")
            name = order if dim == "translation" else f"{dim}_{order}"
            if dim == "rotation" and order == "displacement":
                name = "rotation"
            variables[name] = variable(
                (*dims, f"{dim}_coordinate"),
                values[..., here],
                f"{unit}, scaled" if shape else f"{unit}{per}",
                f"{order.replace('_', ' ')}, {words}" if shape or per else words,
            )
    return variables


def _coordinates(system: System) -> dict[str, Any]:
    """Names of the coordinates, apart by unit."""
    names, units = np.array(system.coordinates), np.array(system.units)
    return {f"{dim}_coordinate": names[units == unit].tolist() for dim, unit, _ in _KINDS if (units == unit).any()}


def _ring_variables(
    system: System, forces: Sequence[FloatArray], dims: tuple[str, ...]
) -> dict[str, tuple[tuple[str, ...], FloatArray, dict[str, str]]]:
    """Force and moment of the bearings on their inner rings."""
    bearings = _bearings(system)
    if not bearings:
        return {}
    rings = np.stack([forces[i][..., :6] for i in bearings], axis=len(dims))
    return {
        name: variable(
            (*dims, "bearing", "direction"),
            rings[..., part],
            unit,
            f"{name.split('_')[1]} of the bearing on its inner ring: x, y, z",
        )
        for name, unit, part in (("bearing_force", "N", slice(0, 3)), ("bearing_moment", "N m", slice(3, 6)))
    }


def _bearings(system: System) -> tuple[int, ...]:
    """Indices of the bearings among the elements, of rollers and of balls."""
    return system.select(OnRings)


def _bearing_names(system: System) -> npt.NDArray[np.str_]:
    """Names of the bearings; texts also where there is none."""
    return np.array([system.elements[i].element.name for i in _bearings(system)], dtype=np.str_)


def _operation(balance: Equilibrium, film_share: float = 0.0) -> dict[str, Any]:
    """Speed and quality of an equilibrium, and the errors in bands of which films leave out a share."""
    return {
        "speed_rad_per_s": balance.operation.speed,
        "angle_rad": balance.operation.angle,
        "bands": error_words(balance.system, film_share),
        "residual": balance.residual,
        "newton_steps": balance.steps,
    }
