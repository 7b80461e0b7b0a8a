"""`ehdmaps export --to c`: the law and the bearing in C are those of Python, at any argument."""

from __future__ import annotations

import dataclasses
import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.errors import OutsideMapError
from ehdmaps.exports.c.kernel import KernelOptions, kernel_files
from ehdmaps.jobs.cli import main
from ehdmaps.maps.emap import EHDMap, open_map
from mbs import Bearing, BearingForce
from tests.cases.c_kernel import Kernel, compiled
from tests.cases.jobs import DRY, LINE
from tests.cases.laws import dataset_of, with_holes
from tests.cases.programs import needed
from tests.conftest import made_map

DATA = Path(__file__).parents[1] / "data" / "c"

EXACT = 1e-12
"""Rounding, as a part of a value and of what it is at the lowest mapped load."""

ABOVE_LOAD, ABOVE_SPEED, OUTSIDE_TEMPERATURE, NOT_FINITE, BAD_CENTRIFUGAL, TOO_FAR, BAD_ARGUMENT = (
    1, 2, 4, 8, 16, 32, 64,
)  # fmt: skip


def exported(path, folder, *options):
    """Folder of an export."""
    assert main(["export", str(path), "--to", "c", "-o", str(folder), *options]) == 0
    return folder


@pytest.fixture(scope="module")
def strict(small_map, tmp_path_factory):
    """The export of a map of NU308 that refuses whatever is outside."""
    return exported(small_map, tmp_path_factory.mktemp("strict") / "c")


@pytest.fixture(scope="module")
def centrifugal(small_map, tmp_path_factory):
    """The library of one that holds at the edges of the map, with centrifugal loads."""
    folder = exported(small_map, tmp_path_factory.mktemp("held") / "c", "--outside", "clamp", "--centrifugal")
    return Kernel(compiled(folder, "-shared", "-fPIC"))


@pytest.fixture(scope="module")
def refusing(strict):
    return Kernel(compiled(strict, "-shared", "-fPIC"))


@pytest.fixture(scope="module")
def law(small_map):
    return open_map(small_map).law("series", "clamp")


def conditions(law, count, q=(0.0,), seed=3):
    """Speeds from standstill to above the map, of both signs, temperatures on both sides of it, centrifugal loads."""
    rng = np.random.default_rng(seed)
    (slow, fast), (cold, hot) = law.speed_range, law.temperature_range
    yield 0.0, cold, 0.0
    for _ in range(count):
        u = np.exp(rng.uniform(np.log(slow / 30.0), np.log(2.0 * fast))) * rng.choice([-1, 1])
        yield float(u), float(rng.uniform(cold - 10.0, hot + 10.0)), float(rng.choice(q))


def approaches(point):
    """From far apart, over lift-off and the whole map, to above the held load; not at it, where k has a kink."""
    reach = point.held_approach - point.lift_off
    near = np.geomspace(1e-7, 0.999, 40) * reach
    return np.concatenate([[-1e-3], point.lift_off - near[::8], point.lift_off + near, [point.held_approach + reach]])


def assert_law(kernel, law, u, T, q):
    """Both ways to call it are the law of Python, for contacts at rest and in motion."""
    kernel.at(u, T, q)
    at = law.at(u, T, q)
    places = approaches(at.point)
    rates = np.resize([0.0, 1e-3, -1e-5, -1e-1], places.size)
    wanted = np.array(at(places, rates))
    at_rest = np.array(at(places, 0.0 * rates))
    lowest = at_rest[:, [np.searchsorted(at_rest[0], law.load_range[0])]]
    for found in (
        np.array([kernel.law_at(d, r)[1] for d, r in zip(places, rates, strict=True)]).T,
        np.array([kernel.law(d, r, u, T, q)[1] for d, r in zip(places, rates, strict=True)]).T,
    ):
        assert np.all(np.abs(found - wanted) <= EXACT * (np.abs(wanted) + np.abs(lowest)))


def test_law(centrifugal, law):
    """From standstill to above the map, with and without centrifugal loads."""
    for u, T, q in conditions(law, 25, q=(0.0, 0.0, 30.0, 3000.0)):
        assert_law(centrifugal, law, u, T, q)


@pytest.mark.parametrize(("job", "options"), [(LINE, ["--law", "line"]), (DRY, [])])
def test_other_laws(tmp_path, job, options):
    """The law of a half-space of a bare contact, and of dry contacts of a bearing."""
    path = made_map(tmp_path, job)
    outside = "asymptote" if options else "clamp"
    folder = exported(path, tmp_path / "c", "--outside", outside, *options)
    kernel = Kernel(compiled(folder, "-shared", "-fPIC"))
    law = open_map(path).law("line" if options else "series", outside)
    T = law.temperature_range[0]
    for u in (0.0, 0.3, 1.0, 7.0):
        assert_law(kernel, law, u, T, 0.0)


def assert_bearing(kernel, force, rng, size, u, T, q, level=False):
    """A bearing at some poses, tilted or level."""
    kernel.prepare(u, T, q)
    at = force.at(u, T, q)
    units = np.array([1.0, 1.0, 1.0, 100.0, 100.0, 100.0])
    arms = 1.0 / units
    scale = np.vstack([arms, np.outer(arms, arms), np.outer(arms, arms)])
    for speed in (0.0, 1e-4, 3e-2):
        pose, velocity = rng.normal(size=(2, 6)) * units * [[size], [speed]]
        if level:
            pose[3:] = velocity[3:] = 0.0
        cage = float(rng.uniform(-7.0, 7.0))
        wanted = at.evaluate(pose, velocity, cage)
        status, found = kernel.force(pose, velocity, cage)
        assert (status != 0) == wanted.outside
        for part, values in (
            (slice(0, 1), wanted.force[None]),
            (slice(1, 7), wanted.stiffness),
            (slice(7, 13), wanted.damping),
        ):
            sizes = np.abs(values) / scale[part]
            assert np.max(np.abs(found[part] - values) / scale[part]) <= EXACT * max(np.max(sizes), 1e-3)


@pytest.mark.parametrize(("clearance", "slices", "q"), [(0.0, 41, 0.0), (20e-6, 5, 0.0), (-5e-6, 12, 300.0)])
def test_bearing(centrifugal, law, small_map, clearance, slices, q):
    """Force, stiffness and damping: above and below the lowest speed, at standstill, above the map."""
    geometry = dataclasses.replace(open_map(small_map).bearing, diametral_clearance=clearance)
    force, rng = BearingForce(Bearing(geometry, slices=slices), law), np.random.default_rng(slices)
    assert centrifugal.make(clearance, slices) == 0
    for u, T, own in conditions(law, 12, q=(0.0, q)):
        for size in (2e-6, 4e-5):
            assert_bearing(centrifugal, force, rng, size, u, T, own)


def test_a_bearing_with_two_rows(small_map, law, tmp_path):
    """Rollers of both rows, at their places, with tilts and moments."""
    emap = open_map(small_map)
    two = dataclasses.replace(emap.bearing, row_distance=1.3 * emap.bearing.roller_length)
    emap = EHDMap(emap.dataset.assign_attrs(geometry=json.dumps(two.record())), emap.backbone)
    for name, text in kernel_files(emap, KernelOptions(outside="clamp", centrifugal=True), ("two rows",)).items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    kernel, geometry = Kernel(compiled(tmp_path, "-shared", "-fPIC")), emap.bearing.with_clearance(1e-6)
    force, rng = BearingForce(Bearing(geometry, slices=4), law), np.random.default_rng(4)
    assert geometry.rolling_elements == 2 * geometry.rollers and kernel.make(1e-6, 4) == 0
    for u, T, own in conditions(law, 4, q=(0.0, 300.0)):
        assert_bearing(kernel, force, rng, 4e-5, u, T, own)


@pytest.mark.parametrize("slices", [1, 2, 5])
def test_level(centrifugal, law, small_map, slices):
    """Level rollers, of which C computes one half: odd and even numbers of slices, slow and fast motion."""
    geometry = dataclasses.replace(open_map(small_map).bearing, diametral_clearance=4e-6)
    force, rng = BearingForce(Bearing(geometry, slices=slices), law), np.random.default_rng(slices)
    assert centrifugal.make(4e-6, slices) == 0
    for u, T, q in conditions(law, 4, q=(0.0, 300.0), seed=slices):
        for size in (4e-6, 4e-5):
            assert_bearing(centrifugal, force, rng, size, u, T, q, level=True)


def test_rollers_that_are_larger_are_felt_as_less_clearance(centrifugal, law, small_map):
    """1 um at one ring and 0.5 um at the other of every roller are 3 um of the diametral clearance, to round-off."""
    u, T = (0.5 * sum(ends) for ends in (law.speed_range, law.temperature_range))
    pose, still = np.array([0.0, 3e-6, -4e-6, 0.0, 1e-5, 0.0]), np.zeros(6)
    answers = []
    for clearance, approaches in ((4e-6, (1e-6, 0.5e-6)), (1e-6, (0.0, 0.0))):
        assert centrifugal.make(clearance, 5) == 0
        added = np.zeros((open_map(small_map).bearing.rollers, 2, 2))
        added[..., 0] = approaches
        centrifugal.deviate(added)
        centrifugal.prepare(u, T)
        status, found = centrifugal.force(pose, still, 0.3)
        assert status == 0
        answers.append(found)
    assert np.abs(answers[0][0]).max() > 1.0
    np.testing.assert_allclose(answers[0], answers[1], rtol=1e-9, atol=1e-9 * np.abs(answers[1]).max())


def test_beyond_the_cells(centrifugal, law, small_map):
    """Rollers as far in and out as a pose may be: farther than the table of a prepared law reaches."""
    force, rng = BearingForce(Bearing(open_map(small_map).bearing, slices=8), law), np.random.default_rng(5)
    assert centrifugal.make(open_map(small_map).bearing.diametral_clearance, 8) == 0
    for u, T, q in conditions(law, 6, q=(0.0, 300.0)):
        assert_bearing(centrifugal, force, rng, 2e-3, u, T, q, level=True)


def test_profile(centrifugal, law, small_map):
    """Rollers of another profile, and numbers of slices that are not allowed."""
    bearing = Bearing(open_map(small_map).bearing, slices=7, profile=tuple(np.linspace(0.0, 6e-6, 7)))
    assert centrifugal.make(bearing.geometry.diametral_clearance, 7, bearing.profile_depths) == 0
    force, rng = BearingForce(bearing, law), np.random.default_rng(0)
    for level in (False, True):
        assert_bearing(centrifugal, force, rng, 1e-5, 1.0, law.temperature_range[0], 0.0, level=level)
    for slices in (0, 202):
        assert centrifugal.make(0.0, slices) == BAD_ARGUMENT


def test_refused(refusing, small_map):
    """Whatever is outside has a status of its own and gives NaN, never a number; Python raises there."""
    law = open_map(small_map).law("series")
    (_, fast), (cold, hot) = law.speed_range, law.temperature_range
    inside = (1e-6, 0.0, 1.0, cold, 0.0)
    asked = {
        (1e-3, 0.0, 1.0, cold, 0.0): ABOVE_LOAD,
        (1e-6, 0.0, -1.01 * fast, cold, 0.0): ABOVE_SPEED,
        (1e-6, 0.0, 1.0, hot + 1.0, 0.0): OUTSIDE_TEMPERATURE,
        (1e-6, 0.0, 1.01 * fast, 0.0, 0.0): ABOVE_SPEED | OUTSIDE_TEMPERATURE,
        (1e-6, 0.0, 1.0, cold, 1.0): BAD_CENTRIFUGAL,
        **{(*inside[:i], np.nan, *inside[i + 1 :]): NOT_FINITE for i in range(5)},
    }
    for arguments, status in asked.items():
        got, found = refusing.law(*arguments)
        assert got == status
        assert np.all(np.isnan(found))
        if status < NOT_FINITE:
            with pytest.raises(OutsideMapError):
                law(*arguments)
    assert refusing.law(*inside)[0] == 0
    refusing.make(0.0, 41)
    for pose, u, status in (
        ([0.0, 1.0, 0.0, 0.0, 0.0, 0.0], 1.0, TOO_FAR),
        ([0.0, 5e-4, 0.0, 0.0, 0.0, 0.0], 1.0, ABOVE_LOAD),
        ([0.0, 0.0, 0.0, 0.0, 0.0, 0.0], 2.0 * fast, ABOVE_SPEED),
        ([np.inf, 0.0, 0.0, 0.0, 0.0, 0.0], 1.0, NOT_FINITE),
    ):
        got, found = refusing.call(np.array(pose), u, cold)
        assert got == status
        assert np.all(np.isnan(found))
    assert refusing.call(np.zeros(6), 1.0, cold)[0] == 0


@pytest.mark.slow
@pytest.mark.parametrize(("outside", "calls"), [("error", "2000"), ("clamp", "2000")])
def test_hostile(small_map, tmp_path, outside, calls):
    """Neither the address sanitizer nor that of undefined behaviour finds anything, whatever numbers come."""
    folder = exported(small_map, tmp_path / "c", "--outside", outside)
    shutil.copy(DATA / "hostile.c", folder)
    program = compiled(
        folder, "-O0", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all", str(folder / "hostile.c"),
        name="run",
    )  # fmt: skip
    result = subprocess.run([program, calls], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr


def test_fortran(refusing, strict, tmp_path):
    """The interface module gives what C gives, by gfortran's strictest reading of the standard."""
    folder = shutil.copytree(strict, tmp_path / "c")
    compiled(folder, "-c", name="ehd.o", link=False)
    program = ["ehd.f90", str(DATA / "values.f90"), "ehd.o", "-o", "run", "-lm"]
    subprocess.run([needed("gfortran"), "-std=f2008", "-Wall", "-Werror", *program], cwd=folder, check=True)
    printed = subprocess.run([folder / "run"], capture_output=True, text=True, check=True).stdout.split()
    numbers = np.array(printed, dtype=float)
    pose, velocity = [0.0, 4e-6, -2e-6, 0.0, 1e-4, -2e-4], [0.0, 1e-4, 2e-4, 0.0, 0.0, 1e-3]
    refusing.make(1e-5, 41)
    refusing.prepare(1.0, 310.0)
    _, law = refusing.law(2e-6, 1e-4, 1.0, 310.0)
    status, force = refusing.force(np.array(pose), np.array(velocity), 0.3)
    assert status == 0
    refusing.film_at(1.0, 310.0)
    state = refusing.film_settled(2e-6)[1]
    _, advanced, after = refusing.film_advance(state, 3e-6, 1e-5, 0.0)
    states = refusing.settled(np.array(pose), 0.3, 12 * 41)[1]
    pose[1] = 5e-6
    film = [
        *(0.0, *after, *advanced), *(0.0, *refusing.film_rate(2.1e-6, 2e-6)[1]),
        *(0.0, *refusing.advance(states, np.array(pose), 0.3, 1e-5, 0.0)[1].reshape(-1)),
    ]  # fmt: skip
    np.testing.assert_allclose(numbers, [0.0, *law, 0.0, *force.reshape(-1), *film], rtol=1e-15)


@pytest.mark.slow
def test_windows(strict, tmp_path):
    """The same source is clean for the compiler of 64-bit Windows."""
    pytest.importorskip("ziglang")
    folder = shutil.copytree(strict, tmp_path / "c")
    zig = (sys.executable, "-m", "ziglang", "cc", "-target", "x86_64-windows-gnu")
    # not linked: for that zig compiles a C library for Windows, in a minute
    program = compiled(folder, "-c", compiler=zig, name="ehd.obj", link=False)
    assert program.read_bytes()[:2] == b"\x64\x86"  # x86-64


def test_prefix_and_cplusplus(small_map, tmp_path, capsys):
    """Another prefix leaves no name of the first; the header is one of C++ too; a folder of others is left alone."""
    folder = exported(small_map, tmp_path / "c", "--prefix", "left", "--clearance", "20 um", "--slices", "5")
    assert sorted(file.name for file in folder.iterdir()) == ["left.c", "left.f90", "left.h"]
    head = (folder / "left.h").read_text()
    assert "ehd_" not in head and "EHD_" not in head
    assert "#define LEFT_CLEARANCE 2e-05 " in head
    (folder / "use.cpp").write_text(
        '#include "left.h"\nint main() { return left_law(0, 0, 1, 300, 0, nullptr) == 0; }\n'
    )
    subprocess.run([needed("g++"), "-Wall", "-Werror", "-c", "use.cpp", "-o", "use.o"], cwd=folder, check=True)
    capsys.readouterr()
    assert main(["export", str(small_map), "--to", "c", "-o", str(folder)]) == 2
    assert "which no export made" in capsys.readouterr().err


@pytest.fixture(scope="module")
def corner(tmp_path_factory):
    """A map without the heaviest loads at its highest speed and lowest temperature; three temperatures, four speeds."""
    path, whole = tmp_path_factory.mktemp("corner") / "map.nc", dataset_of(temperatures=(313.15, 328.15, 343.15))
    EHDMap(with_holes(whole, (0, slice(13, None), 3, 0))).dataset.to_netcdf(path)
    return path


def test_loads_end_where_points_of_the_map_are_missing(corner, tmp_path):
    folder = exported(corner, tmp_path / "c", "--outside", "clamp", "--centrifugal")
    kernel = Kernel(compiled(folder, "-shared", "-fPIC", "-O0"))  # the tables are long
    law = open_map(corner).law("series", "clamp")
    ends = [law.known_load(u, T) for u, T in ((2.4, 313.15), (1.7, 316.0), (1.2, 313.15), (-0.1, 340.0))]
    assert ends[0] < ends[1] < ends[2] == pytest.approx(ends[3], rel=1e-14)  # round-off
    for u, T in ((2.4, 313.15), (1.7, 316.0), (3.0, 310.0), (-0.1, 340.0)):
        for q in (0.0, 3e3):
            assert_law(kernel, law, u, T, q)
    assert kernel.at(2.4, 313.15, 0.99 * ends[0]) == 0
    assert kernel.at(2.4, 313.15, 1.01 * ends[0]) == BAD_CENTRIFUGAL
    assert kernel.at(1.2, 313.15, 1.01 * ends[0]) == 0


def test_a_load_that_is_not_known_is_refused(corner, tmp_path):
    kernel = Kernel(compiled(exported(corner, tmp_path / "c"), "-shared", "-fPIC", "-O0"))
    law = open_map(corner).law("series", "clamp")
    for u, status in ((2.4, ABOVE_LOAD), (1.2, 0)):
        delta = law.at(2.4, 313.15).point.held_approach + 1e-6
        found, force = kernel.law(float(delta), 0.0, u, 313.15)
        assert found == status and np.isnan(force[0]) == bool(status)
