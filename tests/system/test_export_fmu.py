"""`ehdmaps export --to fmu`: units that FMPy validates, compiles and simulates."""

from __future__ import annotations

import dataclasses
import gc
import resource
import zipfile

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.build import build_platform_binary
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from scipy.integrate import solve_ivp

from ehdmaps.jobs.cli import main
from ehdmaps.maps.emap import open_map
from mbs import Bearing, BearingForce
from mbs.bearings.bearing_element import BearingElement
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load
from mbs.model.profiles import SpeedProfile
from mbs.model.system import System
from mbs.settings import Settings
from mbs.transient.run import WITH_STATES, run
from tests.cases.fmu import OUTPUTS, Unit
from tests.cases.jobs import LINE
from tests.conftest import made_map

T = 310.0
CLEARANCE = 10e-6
POSE = ["pose.y", "pose.z", "pose.theta_y", "pose.theta_z"]
VELOCITY = ["velocity.y", "velocity.z", "velocity.theta_y", "velocity.theta_z"]
MOTION = [*POSE, *VELOCITY, "spin.inner", "speed.inner", "temperature"]
FREE = [1, 2, 4, 5]


@pytest.fixture(scope="module")
def files(small_map, tmp_path_factory):
    """Units by FMI 2.0, of sources alone, and by FMI 3.0, with binaries."""
    folder = tmp_path_factory.mktemp("fmu")
    for fmi, more in (("2", ["--sources-only"]), ("3", ["--outside", "clamp"])):
        options = ["--to", "fmu", "--fmi", fmi, "-o", str(folder / f"{fmi}.fmu"), "--clearance", "10 um", *more]
        assert main(["export", small_map, *options]) == 0
    return {fmi: folder / f"{fmi}.fmu" for fmi in "23"}


@pytest.fixture(scope="module")
def units(files, tmp_path_factory):
    """Both, unpacked; FMPy compiles the sources of the first one."""
    unpacked = {fmi: Unit(path, tmp_path_factory.mktemp(f"unit{fmi}")) for fmi, path in files.items()}
    build_platform_binary(unpacked["2"].folder, tmp_path_factory.mktemp("build"), all_warnings=True)
    return unpacked


@pytest.fixture(scope="module")
def element(small_map):
    """The bearing of both."""
    emap = open_map(small_map)
    geometry = dataclasses.replace(emap.bearing, diametral_clearance=CLEARANCE)
    return BearingForce(Bearing(geometry), emap.law("series"))


@pytest.mark.parametrize("fmi", ["2", "3"])
def test_valid(files, fmi):
    """FMPy finds no problem; the headers keep their licence; the same map gives the same unit."""
    assert validate_fmu(str(files[fmi])) == []
    with zipfile.ZipFile(files[fmi]) as archive:
        assert b"2-Clause BSD License" in archive.read(f"sources/fmi{fmi}Functions.h")
        assert b"pi f h" in archive.read("documentation/index.html")
        names = archive.namelist()
    assert any(name.startswith("binaries/") for name in names) == (fmi == "3")


@pytest.mark.parametrize("fmi", ["2", "3"])
def test_force_and_derivatives(units, element, fmi):
    """Forces are those of Python, derivatives by pose and velocity -K and -C of it; by the others difference quotients.

    The quotients are taken here with other steps than in the unit: they agree within the second order of both.
    """
    unit, rng = units[fmi], np.random.default_rng(1)
    model = unit.instance()
    units_of = np.array([1.0, 1.0, 100.0, 100.0])
    motion = np.concatenate(
        [6e-6 * rng.normal(size=4) * units_of, 1e-4 * rng.normal(size=4) * units_of, [0.7, 90.0, T]]
    )
    unit.put(model, MOTION, list(motion))
    pose, velocity = np.zeros((2, 6))
    pose[FREE], velocity[FREE] = motion[:4], motion[4:8]
    bearing = element.bearing
    f, K, C = element(
        pose, velocity, cage_angle=bearing.cage_angle(0.7), temperature=T,
        entrainment_speed=bearing.geometry.entrainment_speed(90.0, 0.0),
    )  # fmt: skip
    np.testing.assert_allclose(unit.get(model), f[FREE], rtol=1e-11, atol=1e-11 * np.max(np.abs(f)))
    for matrix, names in ((K, POSE), (C, VELOCITY)):
        found = np.array([unit.derivatives(model, name) for name in names]).T
        np.testing.assert_allclose(found, -matrix[np.ix_(FREE, FREE)], rtol=1e-11, atol=1e-11 * np.max(np.abs(matrix)))
    for name, step in (("spin.inner", 1e-5), ("speed.inner", 1e-2), ("temperature", 1e-2), ("clearance", 1e-9)):
        begin, sides = unit.get(model, (name,))[0], []
        for side in (step, -step):
            unit.put(model, [name], [begin + side])
            sides.append(unit.get(model))
        unit.put(model, [name], [begin])
        quotient = (sides[0] - sides[1]) / (2.0 * step)
        assert np.max(np.abs(unit.derivatives(model, name) - quotient)) < 1e-4 * np.max(np.abs(quotient))
    model.freeInstance()


def test_refused(units, capfd):
    """Outside the map the unit by FMI 2.0 discards, and says why; it goes on when it is back."""
    unit = units["2"]
    model = unit.instance()
    unit.put(model, ["speed.inner", "pose.y"], [90.0, 1e-6])
    inside = unit.get(model)
    for name, value, reason in (
        ("speed.inner", 1e4, "an entrainment speed above the map"),
        ("temperature", 500.0, "a temperature outside the map"),
        ("pose.y", 1e-3, "a load above the map"),
        ("pose.y", 1.0, "a pose beyond reason"),
    ):
        before = unit.get(model, (name,))[0]
        unit.put(model, [name], [value])
        capfd.readouterr()
        with pytest.raises(FMICallException):
            unit.get(model)
        assert reason in capfd.readouterr().out
        unit.put(model, [name], [before])
    with pytest.raises(FMICallException):
        unit.put(model, ["pose.y"], [np.nan])
    with pytest.raises(FMICallException):
        unit.put(model, ["force.y"], [1.0])
    np.testing.assert_array_equal(unit.get(model), inside)
    model.freeInstance()


def test_held(units, element):
    """Where the policy is to hold, a hot bearing is one at the highest temperature."""
    unit = units["3"]
    model = unit.instance()
    hottest = element.law.temperature_range[1]
    unit.put(model, ["speed.inner", "pose.y", "temperature"], [90.0, 1e-6, hottest])
    at_edge = unit.get(model)
    unit.put(model, ["temperature"], [hottest + 50.0])
    np.testing.assert_array_equal(unit.get(model), at_edge)
    model.freeInstance()


def test_states(units):
    """A state comes back as it was, through bytes too; a reset is a start."""
    unit = units["3"]
    model = unit.instance()
    start = unit.get(model)
    unit.put(model, ["pose.y", "speed.inner"], [3e-6, 50.0])
    kept, forces = model.getFMUState(), unit.get(model)
    data = model.serializeFMUState(kept)
    unit.put(model, ["pose.y"], [-2e-6])
    model.setFMUState(model.deserializeFMUState(data))
    np.testing.assert_array_equal(unit.get(model), forces)
    model.freeFMUState(kept)
    model.reset()
    np.testing.assert_array_equal(unit.get(model), start)
    model.freeInstance()


def test_many_instances(units):
    """A thousand instances, one after the other, leave no memory behind: each one takes 200 kB."""
    unit = units["2"]
    keep = unit.instance()  # keeps the library loaded

    def many(count):
        for _ in range(count):
            model = unit.instance()
            unit.get(model)
            model.freeInstance()
        gc.collect()
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    before = many(100)
    assert many(1000) - before < 20_000  # kB; a leak would be 200 MB
    keep.freeInstance()


def test_cosimulation(files, element):
    """FMPy's own loop over communication points: the force is that of the motion at the begin of a step, and lags."""
    frequency, step, amplitude = 320.0, 100e-6, 1e-7
    time = np.arange(401) * step / 4.0
    motion = 3e-6 + amplitude * np.sin(2.0 * np.pi * frequency * time)
    signals = np.array(list(zip(time, motion, strict=True)), dtype=[("time", float), ("pose.z", float)])
    found = simulate_fmu(
        str(files["3"]), fmi_type="CoSimulation", stop_time=0.01, output_interval=step, input=signals,
        start_values={"speed.inner": 90.0, "temperature": T}, output=["force.z"],
    )  # fmt: skip
    at = element.at(element.bearing.geometry.entrainment_speed(90.0, 0.0), T)
    places = np.interp(found["time"][:-1], time, motion)
    wanted = [at([0.0, 0.0, z, 0.0, 0.0, 0.0])[0][2] for z in places]
    np.testing.assert_allclose(found["force.z"][1:], wanted, rtol=1e-9)
    assert np.pi * frequency * step == pytest.approx(0.1, rel=0.01)  # what the description warns of


MASS, TRANSVERSE, ARM, OFFSET = 20.0, 0.1, 0.07, 0.02
"""Mass [kg] and transverse inertia [kg m2] of a shaft, half the distance of its bearings, and place of its load [m]."""


def test_rotor(units, element):
    """A rigid shaft that runs up on two units, against `mbs` with the same law: 1e-4 of what it moves.

    Polar inertia, which both would have to agree about how it acts while the speed changes, is left out. The errors are
    that of the step of mbs, of second order, and of its tables over the speed, some 1e-6.
    """
    duration, speed = 4e-3, SpeedProfile.ramp(50.0, 90.0, 4e-3)
    load = np.array([0.0, 300.0, 800.0])
    shaft = rigid_body(
        "shaft", [Inertia(MASS, 1e-12, TRANSVERSE)], ["y", "z", "theta_y", "theta_z"], spin=1.0,
        frames={"left": [-ARM, 0.0, 0.0], "right": [ARM, 0.0, 0.0], "load": [OFFSET, 0.0, 0.0]},
    )  # fmt: skip
    bearings = [
        BearingElement(side, f"shaft:{side}", "ground", element.bearing, element, T) for side in ("left", "right")
    ]
    system = System([shaft], [], [Load("load", "shaft:load", np.pad(load, (0, 3)))], bearings)
    start = np.array([2e-6, 8e-6, 0.0, 0.0])
    settings = Settings(2e-6, 1e-4, spectral_radius=1.0)
    wanted = run(system, speed, duration, settings, (), start, None, None, WITH_STATES).states.displacement

    unit = units["2"]
    models = [unit.instance(), unit.instance()]
    inertia = np.array([MASS, MASS, TRANSVERSE, TRANSVERSE])
    moments = np.array([load[1], load[2], -OFFSET * load[2], OFFSET * load[1]])

    def rates(time, state):
        w, angle = speed.at(time)
        total = moments.copy()
        for model, x in zip(models, (-ARM, ARM), strict=True):
            pose, velocity = (
                np.array([part[0] + x * part[3], part[1] - x * part[2], part[2], part[3]])
                for part in (state[:4], state[4:])
            )
            unit.put(model, MOTION, [*pose, *velocity, angle, w, T])
            f = unit.get(model, OUTPUTS)
            total += [f[0], f[1], f[2] - x * f[1], f[3] + x * f[0]]
        return np.concatenate([state[4:], total / inertia])

    times = np.linspace(0.0, duration, len(wanted))
    found = solve_ivp(
        rates,
        (0.0, duration),
        np.concatenate([start, np.zeros(4)]),
        method="DOP853",
        t_eval=times,
        rtol=1e-7,
        atol=1e-12,
    )
    assert found.success
    for model in models:
        model.freeInstance()
    moved = np.ptp(wanted, axis=0)
    assert np.all(moved > [1e-6, 1e-6, 1e-5, 1e-5])
    assert np.max(np.abs(found.y[:4].T - wanted) / moved) < 1e-4


def test_bare_contact(tmp_path, capsys):
    """A map of a bare contact is no bearing."""
    path = made_map(tmp_path, LINE)
    assert main(["export", path, "--to", "fmu"]) == 2
    assert "the map of a bearing" in capsys.readouterr().err
