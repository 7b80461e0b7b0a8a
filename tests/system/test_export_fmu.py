"""`ehdmaps export --to fmu`: units that FMPy validates, compiles and simulates."""

from __future__ import annotations

import ctypes
import dataclasses
import errno
import gc
import os
import re
import resource
import struct
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.build import build_platform_binary
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from scipy.linalg import expm

from ehdmaps.exports.fmu import binaries
from ehdmaps.jobs.cli import main
from ehdmaps.maps.emap import open_map
from mbs import Bearing, BearingForce
from tests.cases.fmu import OUTPUTS, Unit
from tests.cases.fmu_rotor import Rotor, RotorOnUnits, side_by_side
from tests.cases.fmu_run import coupled_run, stepped_run
from tests.cases.jobs import LINE
from tests.cases.programs import needed
from tests.conftest import made_map

T = 310.0
CLEARANCE = 10e-6
POSE = ["pose.y", "pose.z", "pose.theta_y", "pose.theta_z"]
VELOCITY = ["velocity.y", "velocity.z", "velocity.theta_y", "velocity.theta_z"]
SLICES = 5
MOTION = [*POSE, *VELOCITY, "spin.inner", "speed.inner", "temperature"]
FREE = [1, 2, 4, 5]


@pytest.fixture(scope="module")
def files(small_map, tmp_path_factory):
    """Units by FMI 2.0, of sources alone, and by FMI 3.0, with binaries."""
    needed("gcc", "clang")
    folder = tmp_path_factory.mktemp("fmu")
    for fmi, more in (("2", ["--sources-only"]), ("3", ["--outside", "clamp"])):
        options = ["--to", "fmu", "--fmi", fmi, "-o", str(folder / f"{fmi}.fmu"), "--clearance", "10 um", *more]
        assert main(["export", small_map, *options]) == 0
    return {fmi: folder / f"{fmi}.fmu" for fmi in "23"}


@pytest.fixture(scope="module")
def units(files, tmp_path_factory):
    """Both, unpacked; FMPy compiles the sources of the first one."""
    unpacked = {fmi: Unit(path, tmp_path_factory.mktemp(f"unit{fmi}")) for fmi, path in files.items()}
    needed("gcc")
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


FORMATS = {
    "x86_64-linux": (b"\x7fELF", 18, 62),
    "aarch64-linux": (b"\x7fELF", 18, 183),
    "x86_64-windows": (b"\x64\x86", 0, 0x8664),
    "x86_64-darwin": (b"\xcf\xfa\xed\xfe", 4, 7),
    "aarch64-darwin": (b"\xcf\xfa\xed\xfe", 4, 12),
}
"""What a library, of Windows an object file, begins with, and where the number of its processor is."""


def objects(target, folder, sources, name):
    """Compile as `binaries.compiled` does, and link for Linux alone: for each system zig makes its C library first."""
    if target.folder == "x86_64-linux":
        return binaries.compiled(target, folder, sources, name)
    options = [option for option in binaries._OPTIONS if option != "-shared"]
    made = []
    for source in sources:
        command = [*target.compiler, *options, "-Werror=implicit-function-declaration", "-c", source, "-o", "made.o"]
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
        made.append((folder / "made.o").read_bytes())
    return next(content for content in made if b"Instantiate" in content)


@pytest.mark.slow
@pytest.mark.parametrize(("fmi", "systems"), [("2", "darwin"), ("3", "x86_64-linux x86_64-windows")])
def test_binaries_for_all_systems(small_map, tmp_path, capsys, fmi, systems):
    """Formats and processors of what ziglang compiles; of macOS FMI 2.0 has one folder for both processors."""
    pytest.importorskip("ziglang")
    unit = tmp_path / "b.fmu"
    command = (sys.executable, "-m", "ziglang", "cc", "-s")
    with (
        mock.patch("ehdmaps.exports.fmu.binaries.zig", return_value=command),
        mock.patch("shutil.which", return_value=None),
    ):
        platforms = binaries.platforms()
    assert [platform.folder for platform in platforms] == list(FORMATS)
    assert [platform.compiler[: len(command)] for platform in platforms] == [command] * 5
    chosen = [
        platform for platform in platforms if {platform.folder, platform.folder.split("-")[1]} & set(systems.split())
    ]
    with (
        mock.patch("ehdmaps.exports.fmu.unit.platforms", return_value=chosen),
        mock.patch("ehdmaps.exports.fmu.unit.compiled", objects),
    ):
        assert main(["export", small_map, "--to", "fmu", "--fmi", fmi, "-o", str(unit), "--clearance", "10 um"]) == 0
    told, names = capsys.readouterr(), [platform.folder for platform in chosen]
    assert f"compiling for {names[-1]}, the first time a minute or two" in told.err
    assert f"{', '.join(names)})" in told.out and "none for" not in told.out
    assert validate_fmu(str(unit)) == []
    with zipfile.ZipFile(unit) as archive:
        found = {name.split("/")[1]: archive.read(name) for name in archive.namelist() if name.startswith("binaries/")}
    if fmi == "2":
        whole = found["darwin64"]
        (count,) = struct.unpack_from(">I", whole, 4)
        parts = [struct.unpack_from(">5I", whole, 8 + 20 * number) for number in range(count)]
        assert [part[0] for part in parts] == [0x01000007, 0x0100000C] and all(part[2] % 2**14 == 0 for part in parts)
        found = {name: whole[part[2] : part[2] + part[3]] for name, part in zip(names, parts, strict=True)}
    assert set(found) == set(names)
    for name, library in found.items():
        begin, place, processor = FORMATS[name]
        assert library.startswith(begin)
        assert struct.unpack_from("<H", library, place)[0] == processor
        assert f"fmi{fmi}Instantiate".encode() in library
    if fmi == "3":
        versions = [int(version) for version in re.findall(rb"GLIBC_2\.(\d+)", found["x86_64-linux"])]
        assert max(versions) <= 17


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


@pytest.mark.parametrize("fmi", ["2", "3"])
def test_calls_that_are_none_are_errors(units, fmi):
    """Derivatives by what is neither input, parameter nor state, and states that are not given."""
    unit = units[fmi]
    model = unit.instance()
    force, names = unit.references["force.y"], unit.references
    for known in (names["force.z"], 10**6):
        with pytest.raises(FMICallException):
            model.getDirectionalDerivative([force], [known], [1.0])
    assert model.getDirectionalDerivative([force], [names["pose.y"]], [0.0]) == [0.0]
    library, c, error = model.dll, model.component, 3
    null, size, room = ctypes.c_void_p(), ctypes.c_size_t(), ctypes.create_string_buffer(8)
    state, size_of, serialize, deserialize = (
        ("fmi2SetFMUstate", "fmi2SerializedFMUstateSize", "fmi2SerializeFMUstate", "fmi2DeSerializeFMUstate")
        if fmi == "2"
        else ("fmi3SetFMUState", "fmi3SerializedFMUStateSize", "fmi3SerializeFMUState", "fmi3DeserializeFMUState")
    )
    component, eight = ctypes.c_void_p(c), ctypes.c_size_t(8)
    assert library[state](component, null) == error
    assert library[size_of](component, null, ctypes.byref(size)) == error
    assert library[serialize](component, null, room, eight) == error
    assert library[deserialize](component, room, eight, null) == error
    # of nothing to free the standard says that it is no error
    free = "fmi2FreeFMUstate" if fmi == "2" else "fmi3FreeFMUState"
    assert library[free](component, null) == library[free](component, ctypes.byref(null)) == 0
    assert np.all(np.isfinite(unit.get(model)))
    model.freeInstance()


@pytest.mark.parametrize("real", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_a_full_folder_for_temporary_files_is_said(small_map, tmp_path, monkeypatch, capsys, real):
    full = tmp_path / "full"
    full.mkdir()
    if real:
        mount = subprocess.run(
            [needed("mount"), "-t", "tmpfs", "-o", "size=8k", "tmpfs", str(full)], capture_output=True, check=False
        )
        if mount.returncode:
            pytest.skip("file systems are mounted by root only")
    else:

        def write(*_, **__):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

        monkeypatch.setattr(Path, "write_text", write)
    monkeypatch.setattr(tempfile, "tempdir", str(full))
    try:
        assert main(["export", small_map, "--to", "fmu", "-o", str(tmp_path / "a.fmu")]) == 2
    finally:
        if real:
            subprocess.run([needed("umount"), str(full)], check=True)
    assert "folder for temporary files (No space left on device); it takes some MB there" in capsys.readouterr().err
    assert not (tmp_path / "a.fmu").exists()


@pytest.mark.slow
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


ROTOR = Rotor(
    mass=20.0, polar=0.1, transverse=0.15, arm=0.07, place=0.02, load=(300.0, 800.0), unbalance=0.01,
    clearance=CLEARANCE, temperature=T, speeds=(50.0, 90.0), duration=0.03, step=4e-6, sample=1e-4,
)  # fmt: skip
"""A rotor whose films and rollers give it a motion of some 1 um beside that by its unbalance."""


@pytest.mark.slow
def test_rotor(units, small_map, tmp_path):
    """A rigid rotor that runs up on a unit of each version, in FMPy's CVODE: that of `mbs runup` within 1e-4.

    The difference is a part of what each coordinate moves. Its bound is the error of the steps of `mbs`, which are of
    second order: some 3e-5 at 4 us, a fourth of that at half the step. That of CVODE is below 1e-6.
    """
    found = side_by_side(ROTOR, small_map, (units["2"], units["3"]), tmp_path, 1e-9)
    assert np.all(found.moved > [1e-7, 1e-7, 1e-7, 1e-7])
    assert np.all(found.differences < 1e-4), found.differences


@pytest.fixture(scope="module")
def remembering(small_map, tmp_path_factory):
    """Units of both versions whose films have a memory, with few slices."""
    folder, found = tmp_path_factory.mktemp("memory"), {}
    for fmi in "23":
        options = ["--fmi", fmi, "--films", "memory", "--slices", str(SLICES), "--clearance", "10 um"]
        assert main(["export", small_map, "--to", "fmu", "-o", str(folder / f"{fmi}.fmu"), *options]) == 0
        assert validate_fmu(str(folder / f"{fmi}.fmu")) == []
        found[fmi] = Unit(folder / f"{fmi}.fmu", folder / fmi)
    return found


@pytest.fixture(scope="module")
def sliced(element):
    """The bearing of those."""
    return BearingForce(Bearing(element.bearing.geometry, slices=SLICES), element.law)


def film_names(unit, kind="film.xi"):
    """Names of all states, or of their rates."""
    return tuple(name for name in unit.references if name.startswith(kind))


@pytest.mark.parametrize("fmi", ["2", "3"])
def test_films(remembering, sliced, fmi):
    """Films begin in equilibrium, where the force is that of Python at rest and states stay as they are.

    The force is that of cells of another table, right within 1e-5. Derivatives are difference quotients of the unit,
    but where a slice lifts off within the steps of these.
    """
    unit, pose = remembering[fmi], [3e-6, 9e-6, 2e-4, -1e-4]
    model = unit.instance(begun=False)
    assert unit.description.numberOfContinuousStates == 12 * SLICES
    model.enterInitializationMode()
    unit.put(model, [*POSE, "spin.inner", "speed.inner", "temperature"], [*pose, 0.7, 90.0, T])
    model.exitInitializationMode()
    at = sliced.at(sliced.bearing.geometry.entrainment_speed(90.0, 0.0), T)
    whole = np.zeros(6)
    whole[FREE] = pose
    wanted = at(whole, cage_angle=sliced.bearing.cage_angle(0.7))[0][FREE]
    np.testing.assert_allclose(unit.get(model), wanted, rtol=0.0, atol=1e-5 * np.max(np.abs(wanted)))
    states, rates = film_names(unit), film_names(unit, "der(film.xi")
    assert np.max(np.abs(unit.get(model, rates))) < 1e-6  # of motions of up to 10 mm/s
    unit.put(model, ["pose.y"], [pose[0] + 2e-7])
    assert np.max(np.abs(unit.get(model, rates))) > 1e-4
    unknowns = (*OUTPUTS, *rates)
    for name, step in (("pose.z", 1e-12), ("pose.theta_y", 1e-11), (states[4], 1e-12), ("temperature", 2e-3)):
        begin, sides = unit.get(model, (name,))[0], []
        for side in (step, -step):
            unit.put(model, [name], [begin + side])
            sides.append(unit.get(model, unknowns))
        unit.put(model, [name], [begin])
        quotient, found = (sides[0] - sides[1]) / (2.0 * step), unit.derivatives(model, name, unknowns)
        for part in (slice(0, 4), slice(4, None)):
            assert np.max(np.abs(found - quotient)[part]) < 2e-3 * np.max(np.abs(quotient[part]))
    model.freeInstance()


@pytest.mark.parametrize("fmi", ["2", "3"])
def test_films_kept(remembering, fmi):
    """States come back as they were, through bytes too; a wrong number of them is refused."""
    unit = remembering[fmi]
    model, names = unit.instance(), film_names(unit)
    unit.put(model, ["pose.y", "speed.inner", names[0]], [3e-6, 50.0, 2e-6])
    kept, found = model.getFMUState(), unit.get(model, (*OUTPUTS, *names))
    data = model.serializeFMUState(kept)
    unit.put(model, ["pose.y", *names], [-2e-6] * (1 + len(names)))
    model.setFMUState(model.deserializeFMUState(data))
    np.testing.assert_array_equal(unit.get(model, (*OUTPUTS, *names)), found)
    room = (ctypes.c_double * 3)()
    with pytest.raises(FMICallException):
        model.getContinuousStates(room, 3)
    model.freeFMUState(kept)
    model.freeInstance()


def test_films_far_off(remembering):
    """Solvers try states far from where they end: loads above the map refuse the force, and its reason is told."""
    for unit in remembering.values():
        model, count = unit.instance(), unit.description.numberOfContinuousStates
        room = (ctypes.c_double * count)(*[-1e-3] * count)
        unit.put(model, ["pose.y", "speed.inner", "temperature"], [2e-4, 90.0, T])
        model.setContinuousStates(room, count)
        rates = model.getDerivatives if unit.second else model.getContinuousStateDerivatives
        rates(room, count)
        assert np.all(np.isfinite(list(room))) and np.max(room) > 1.0
        with pytest.raises(FMICallException):
            unit.get(model)
        model.freeInstance()


@pytest.mark.slow
def test_rotor_on_films(remembering, small_map, tmp_path):
    """The rotor on two units with memory, all states in FMPy's CVODE: that of `mbs runup` within 1e-4.

    The bound is the error of the steps of `mbs`, some 5e-5 at 1.25 us. The speed changes slowly: `mbs` reads its tables
    of films anew every eight steps. In Co-Simulation with steps of 20 us a master that extrapolates the force is within
    3 %, its error of second order; one that holds it is not.
    """
    rotor = dataclasses.replace(ROTOR, speeds=(80.0, 81.0), duration=0.01, step=1.25e-6, slices=SLICES)
    found = side_by_side(rotor, small_map, (remembering["2"], remembering["3"]), tmp_path, 1e-8)
    assert np.all(found.moved > [1e-7, 1e-7, 1e-7, 1e-7])
    assert np.all(found.differences < 1e-4), found.differences
    mover, pair = RotorOnUnits(rotor, found.start), (remembering["2"], remembering["3"])
    for extrapolated in (True, False):
        stepped = stepped_run(mover, pair, found.times, 20e-6, extrapolated)[:, :4]
        within = np.all(found.difference(stepped) < 0.03)
        assert within == extrapolated, found.difference(stepped)


STIFF, DRAG = 1e6, 200.0
"""Spring [N/m] and damper [N s/m] in series, which are a unit with one state, and the spring of a mass of 1 kg."""


class InSeries:
    """A unit that is a spring and a damper in series; its state is the place between them."""

    second = True
    description = SimpleNamespace(numberOfContinuousStates=1)

    def instance(self, begun):
        model = mock.Mock(end=0.0, state=0.0)
        model.getContinuousStates = lambda room, size: room.__setitem__(0, model.state)
        model.getNominalsOfContinuousStates = lambda room, size: room.__setitem__(0, 1e-6)
        model.getDerivatives = lambda room, size: room.__setitem__(0, STIFF * (model.end - model.state) / DRAG)
        model.setContinuousStates = lambda room, size: setattr(model, "state", room[0])
        model.completedIntegratorStep = lambda: (False, False)
        return model

    def put(self, model, names, values):
        model.end = values[0]

    def get(self, model):
        return np.array([STIFF * (model.state - model.end)])


class OnSprings:
    """A mass on its own spring and on both units."""

    start, nominals = np.array([1e-6, 0.0]), np.array([1e-6, 1e-3])

    def inputs(self, time, states):
        return [{"end": states[0]}] * 2

    def rates(self, time, states, outputs):
        return np.array([states[1], outputs[0][0] + outputs[1][0] - STIFF * states[0]])


def test_units_with_states():
    """What runs the rotor takes states of units into its own: a linear system, against the exponential of its matrix.

    The bound is the tolerance of CVODE over the periods that the mass swings, a thousand times it.
    """
    times = np.linspace(0.0, 0.02, 50)
    found, _ = coupled_run(OnSprings(), (InSeries(), InSeries()), times, 1e-9)
    rate = STIFF / DRAG
    matrix = np.array(
        [
            [0.0, 1.0, 0.0, 0.0],
            [-3.0 * STIFF, 0.0, STIFF, STIFF],
            [rate, 0.0, -rate, 0.0],
            [rate, 0.0, 0.0, -rate],
        ]
    )
    wanted = np.array([expm(matrix * time) @ [1e-6, 0.0, 0.0, 0.0] for time in times])[:, 0]
    assert np.max(np.abs(found[:, 0] - wanted)) < 1e-6 * 1e-6


def test_bare_contact(tmp_path, capsys):
    """A map of a bare contact is no bearing."""
    path = made_map(tmp_path, LINE)
    assert main(["export", path, "--to", "fmu"]) == 2
    assert "the map of a bearing" in capsys.readouterr().err
