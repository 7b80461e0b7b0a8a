"""Bearings at rest under a load for ROSS, CalculiX, Nastran and Ansys: the numbers in files, and what is refused."""

import importlib.util
import re
import shutil
import subprocess
import tomllib
from argparse import ArgumentParser
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from ehdmaps.jobs.cli import main
from ehdmaps.jobs.make.generate import generate
from ehdmaps.jobs.reader import parse_job
from ehdmaps.maps.emap import open_map
from ehdmaps.physics.closed_form import FormulaSolver
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.cli import main as bearing_main
from mbs.exports.linear_table import add_arguments, linear_table
from mbs.exports.ross import BEYOND
from mbs.flexible.nastran_files import read_nastran
from mbs.linearised.linear import frequency_response
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Input, Load, Operation, Sensor
from mbs.model.equilibrium import equilibrium
from mbs.model.system import System
from tests.cases.jobs import SMALL
from tests.cases.programs import needed

RPM = np.pi / 30.0
ENDINGS = {
    "ross": ".toml",
    "calculix": ".inp",
    "abaqus": ".inp",
    "nastran": ".bdf",
    "ansys": ".txt",
    "matrices": ".csv",
}
POINT = ["--load", "2 kN", "--direction", "20 deg", "--clearance", "20 um", "--temperature", "40 degC"]
SPEED, MASS = 400.0 * RPM, 10.0


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("linear") / "map.nc"
    generate(parse_job(SMALL, "map", "map.toml"), path, workers=1, solver=FormulaSolver())
    return path


@pytest.fixture(scope="module")
def force(path):
    emap = open_map(path)
    return BearingForce(Bearing.named("NU308", clearance=20e-6), emap.law("series", outside="error"))


def exported(path, out, target, *options):
    assert main(["export", str(path), "--to", target, "-o", str(out), *POINT, *options]) == 0
    return out.read_text(encoding="utf-8")


def table(path, *options):
    parser = ArgumentParser()
    parser.add_argument("--structural-law")
    parser.add_argument("--roughness")
    add_arguments(parser)
    return linear_table(path, parser.parse_args([*POINT, *options]))


def test_stiffness_is_the_slope_of_the_force_and_the_ring_carries_the_load(path, force):
    """Signs and axes by the force itself: 2e-6 bounds the curvature over the steps, the other term rounding."""
    found = table(path, "--speed", "400 rpm", "--start-angle", "5 deg")
    at = dict(
        cage_angle=np.radians(5.0),
        entrainment_speed=force.bearing.geometry.entrainment_speed(SPEED),
        temperature=313.15,
    )
    place = np.array([0.0, *found.displacement[0], 0.0, 0.0, 0.0])

    def evaluated(pose, velocity):
        return force.evaluate(pose, velocity, **at).force

    load = 2e3 * np.array([np.cos(np.radians(20.0)), np.sin(np.radians(20.0))])
    np.testing.assert_allclose(evaluated(place, np.zeros(6))[1:3], -load, rtol=1e-6)
    for axis in (1, 2, 4, 5):
        step = np.zeros(6)
        step[axis] = 1e-10
        slope = -(evaluated(place + step, np.zeros(6)) - evaluated(place - step, np.zeros(6))) / 2e-10
        rate = -(evaluated(place, step * 1e4) - evaluated(place, -step * 1e4)) / 2e-6
        for matrix, quotient, span in ((found.stiffness, slope, 2e-10), (found.damping, rate, 2e-6)):
            rounding = 4.0 * np.finfo(float).eps * 2e3 / span
            np.testing.assert_allclose(matrix[0, 0][:, axis], quotient, atol=2e-6 * np.abs(quotient).max() + rounding)


def test_ross_has_both_radial_axes_as_x_and_y_over_speed(path, tmp_path):
    speeds = ["--speed", "300 rpm", "600 rpm", "3"]
    text = exported(path, tmp_path / "b.toml", "ross", *speeds, "--node", "7")
    assert text.startswith("# made by ehdmaps ")
    assert "diametral clearance 20 um; cage angle 0 deg; raceways at 40 degC" in text
    element = tomllib.loads(text)["BearingElement_NU308"]
    found = table(path, *speeds)
    # ROSS wants tags that differ: two exports for two nodes have them.
    assert (element["n"], element["tag"]) == (7, "NU308 at 7")
    np.testing.assert_array_equal(element["frequency"], found.speeds)
    for key, i, j in (("xx", 1, 1), ("xy", 1, 2), ("yx", 2, 1), ("yy", 2, 2), ("zz", 0, 0)):
        np.testing.assert_array_equal(element[f"k{key}"], found.stiffness[:, 0, i, j])
        np.testing.assert_array_equal(element[f"c{key}"], found.damping[:, 0, i, j])
    both = exported(path, tmp_path / "c.toml", "ross", *speeds, "--ross", "3", "--frequency", "100 Hz", "1 kHz", "2")
    element = tomllib.loads(both)["BearingElement_NU308"]
    np.testing.assert_array_equal(element["speed"], found.speeds)
    np.testing.assert_allclose(element["frequency"], 2.0 * np.pi * np.array([100.0, 1000.0]), rtol=1e-15)
    assert np.shape(element["kxy"]) == (3, 2)


SLOW_MOTION = "frequencies: 0 Hz; slow motion, K and C of films that follow at once"


@pytest.mark.parametrize(
    ("targets", "options", "words"),
    [
        (ENDINGS, [], SLOW_MOTION),
        (["ross"], ["--films", "slow"], SLOW_MOTION),
        (ENDINGS, ["--frequency", "1 kHz"], "frequencies: 1000 Hz; films with memory"),
        (["ross"], ["--frequency", "1 kHz", "--films", "slow"], "frequencies: 1000 Hz; slow films at any frequency"),
    ],
)
def test_header_says_which_films_the_values_are_of(path, tmp_path, targets, options, words):
    """The line is one for all targets."""
    for target in targets:
        text = exported(path, tmp_path / f"b{ENDINGS[target]}", target, "--speed", "400 rpm", *options)
        (line,) = (line for line in text.splitlines() if "frequencies: " in line)
        assert line.endswith(words), target
        assert "; the export refuses points beyond\n" in text


def test_both_kinds_of_films_have_the_values_of_slow_motion_at_no_frequency(path):
    slow, memory = (table(path, "--speed", "400 rpm", "--films", films) for films in ("slow", "memory"))
    np.testing.assert_array_equal(slow.stiffness, memory.stiffness)
    np.testing.assert_array_equal(slow.damping, memory.damping)


@pytest.fixture(scope="module")
def over_frequency(path):
    """Tables of slow motion and at four frequencies."""
    each = ([], *(["--frequency", frequency] for frequency in ("100 Hz", "1 kHz", "2 kHz", "4 kHz")))
    return [table(path, "--speed", "400 rpm", *options) for options in each]


@pytest.mark.parametrize("target", ENDINGS)
def test_a_table_of_slow_motion_says_how_films_answer_at_frequencies(path, tmp_path, over_frequency, target):
    """Beside the very table at these frequencies: three digits are printed."""
    text = exported(path, tmp_path / f"b{ENDINGS[target]}", target, "--speed", "400 rpm")
    (line,) = (line for line in text.splitlines() if "times that of slow motion" in line)
    told = [[float(v) for v in re.search(rf"{name} ([\d., e-]+)", line)[1].split(",")] for name in ("K", "C", "=")]
    slow, *others = over_frequency
    for index, there in enumerate(others):
        ratio = along(there.stiffness) / along(slow.stiffness), along(there.damping) / along(slow.damping)
        omega = 2.0 * np.pi * there.frequencies[0]
        apart = along(there.stiffness - slow.stiffness) + 1j * omega * along(there.damping - slow.damping)
        wrong = 100.0 * abs(apart / (along(there.stiffness) + 1j * omega * along(there.damping)))
        np.testing.assert_allclose([row[index] for row in told], [*ratio, wrong], rtol=6e-3)


def along(matrices):
    """A term along the load, which is 20 deg from y."""
    direction = np.array([np.cos(np.radians(20.0)), np.sin(np.radians(20.0))])
    return direction @ matrices[0, 0, 1:3, 1:3] @ direction


def test_columns_have_the_matrices_and_the_error(path, tmp_path):
    options = ["--speed", "300 rpm", "600 rpm", "2", "--frequency", "500 Hz", "2 kHz", "2"]
    text = exported(path, tmp_path / "b.csv", "matrices", *options)
    rows = np.array([line.split(",") for line in text.splitlines() if line[0].isdigit()], dtype=float)
    found = table(path, *options)
    np.testing.assert_allclose(rows[:, 0], [300.0, 300.0, 600.0, 600.0], rtol=1e-11)
    np.testing.assert_allclose(rows[:, 9], [500.0, 2000.0] * 2)
    # 1e-11: twelve digits are written.
    np.testing.assert_allclose(rows[:, 1:5], found.stiffness[:, :, 1:3, 1:3].reshape(4, 4), rtol=1e-11)
    np.testing.assert_allclose(rows[:, 5:9], found.damping[:, :, 1:3, 1:3].reshape(4, 4), rtol=1e-11)
    np.testing.assert_allclose(rows[:, 10], found.dynamic_error().ravel(), rtol=1e-11)
    assert np.all(rows[:, 10] > 0.0)


def test_abaqus_has_springs_over_frequency(path, tmp_path):
    """Three springs along lines make K again at each frequency: 1e-11, the digits that are written."""
    options = ["--speed", "400 rpm", "--frequency", "500 Hz", "2 kHz", "2"]
    lines = exported(path, tmp_path / "b.inp", "abaqus", *options).splitlines()
    found = table(path, *options)
    for card, matrices in (("SPRING", found.stiffness), ("DASHPOT", found.damping)):
        begins = [i for i, line in enumerate(lines) if line.startswith(f"*{card},")]
        y, z, d = (np.array([lines[i + 2 + n].split(",") for n in (0, 1)], dtype=float) for i in begins)
        np.testing.assert_array_equal(y[:, 1], [500.0, 2000.0])
        k = matrices[0, :, 1:3, 1:3]
        np.testing.assert_allclose(y[:, 0] + 0.5 * d[:, 0], k[:, 0, 0], rtol=1e-10)
        np.testing.assert_allclose(z[:, 0] + 0.5 * d[:, 0], k[:, 1, 1], rtol=1e-10)
        np.testing.assert_allclose(0.5 * d[:, 0], 0.5 * (k[:, 0, 1] + k[:, 1, 0]), rtol=1e-8)


def test_header_of_slow_motion_beside_other_frequencies(path, tmp_path):
    options = ["--speed", "400 rpm", "--ross", "3", "--frequency", "0 Hz", "1 kHz", "2"]
    text = exported(path, tmp_path / "b.toml", "ross", *options)
    assert (
        "frequencies: 0 Hz, 1000 Hz; 0 Hz: slow motion, K and C of films that follow at once; "
        "above: films with memory\n" in text
    )


def test_page_and_file_say_the_same_of_what_ross_does_beyond_the_tables(path, tmp_path):
    page = (Path(__file__).parents[2] / "docs" / "exports.md").read_text(encoding="utf-8")
    section = " ".join(page.split("### ROSS")[1].split("###")[0].split())
    assert f" {BEYOND}. " in section and section.count("beyond") == 1
    text = exported(path, tmp_path / "b.toml", "ross", "--speed", "300 rpm", "600 rpm", "3")
    (line,) = (line for line in text.splitlines() if "ROSS" in line and "beyond" in line)
    assert line == f"# {BEYOND}; stay within the speeds and frequencies above"


@pytest.mark.slow
def test_calculix_answers_as_linear_analysis_does(path, force, tmp_path):
    """A mass on the bearing, its receptances by `mbs lsa` and by CalculiX: 1e-5 is the last digit that ccx prints."""
    ccx = needed("ccx")
    exported(path, tmp_path / "bearing.inp", "calculix", "--speed", "400 rpm", "--films", "slow")
    (tmp_path / "machine.inp").write_text(machine("bearing.inp"), encoding="ascii")
    subprocess.run([ccx, "machine"], cwd=tmp_path, check=True, capture_output=True, timeout=120)
    lines = (tmp_path / "machine.dat").read_text(encoding="ascii").splitlines()
    heads = [i for i, line in enumerate(lines) if "displacements" in line]
    values = np.array([lines[i + 2].split()[2:4] for i in heads], dtype=float)
    frequencies = np.array([lines[i].split()[-1] for i in heads[::2]], dtype=float)
    answer = 1e-3 * (values[::2] + 1j * values[1::2])  # of 1000 N: more digits are printed

    element = BearingElement("bearing", "ring", "ground", force.bearing, force, 313.15, films="slow")
    ring = rigid_body("ring", [Inertia(MASS, 1.0, 1.0)], ["y", "z"])
    load = 2e3 * np.array([0.0, np.cos(np.radians(20.0)), np.sin(np.radians(20.0)), 0.0, 0.0, 0.0])
    system = System([ring], loads=[Load("load", "ring", load)], elements=[element])
    sensors = [Sensor(name, "ring", np.eye(6)[axis]) for axis, name in ((1, "y"), (2, "z"))]
    balance = equilibrium(system, Operation(SPEED))
    ours = frequency_response(balance, [Input("y", "ring", np.eye(6)[1])], sensors, frequencies)[:, :, 0]
    np.testing.assert_allclose(answer, ours, rtol=1e-5, atol=1e-5 * np.abs(ours).max())


BALLS = ("7208B", "--load", "1 kN", "--direction", "20 deg", "--axial", "2 kN", "--law", "hertz:1.25e-5 s")


@pytest.fixture(scope="module", params=[BALLS, ("32008", *BALLS[1:])], ids=["balls", "tapered"])
def coupled(tmp_path_factory, request):
    """Files of an angular contact or tapered bearing for other programs, and K and C of the result."""
    folder = tmp_path_factory.mktemp("coupled")
    for ending in ("bdf", "inp", "txt", "toml", "nc"):
        assert bearing_main(["bearing", *request.param, "--speed", "6000 rpm", "-o", str(folder / f"b.{ending}")]) == 0
    with xr.open_dataset(folder / "b.nc") as result:
        matrices = [result[name].values[0, 0] for name in ("stiffness_matrix", "damping_matrix")]
    return folder, matrices


@pytest.mark.slow
def test_calculix_answers_along_all_axes(coupled, tmp_path):
    """Receptances of a mass on it by the symmetric parts of K and C: 1e-5 is the last digit that ccx prints."""
    ccx = needed("ccx")
    folder, matrices = coupled
    k, c = (0.5 * (matrix + matrix.T)[:3, :3] for matrix in matrices)
    free, modes = ("*BOUNDARY\n1, 1, 1\n", "*BOUNDARY\n"), ("\n2\n*END STEP", "\n3\n*END STEP")
    head, step, load = machine("b.inp").replace(*free).replace(*modes).partition("*STEP\n*STEADY")
    steps = (load.replace("*CLOAD\n1, 2,", f"*CLOAD, OP=NEW\n1, {axis},") for axis in (1, 2, 3))
    shutil.copy(folder / "b.inp", tmp_path)
    (tmp_path / "machine.inp").write_text(head + "\n".join(step + each for each in steps), encoding="ascii")
    subprocess.run([ccx, "machine"], cwd=tmp_path, check=True, capture_output=True, timeout=120)
    lines = (tmp_path / "machine.dat").read_text(encoding="ascii").splitlines()
    found = np.array([i for i, line in enumerate(lines) if "displacements" in line]).reshape(3, -1)
    for axis, heads in enumerate(found.tolist(), 1):
        values = np.array([lines[i + 2].split()[1:4] for i in heads], dtype=float)
        frequencies = np.array([lines[i].split()[-1] for i in heads[::2]], dtype=float)
        s = 2j * np.pi * frequencies[:, None, None]
        ours = np.linalg.inv(k + s * c + s**2 * MASS * np.eye(3))[:, :, axis - 1]
        answer = 1e-3 * (values[::2] + 1j * values[1::2])
        np.testing.assert_allclose(answer, ours, rtol=1e-5, atol=1e-5 * np.abs(ours).max())


@pytest.mark.skipif(importlib.util.find_spec("pyNastran") is None, reason="needs pyNastran")
def test_nastran_has_coupled_matrices_whole(coupled, tmp_path):
    """By pyNastran: ten digits of the fields, and the unsymmetric part, which the file says it leaves out."""
    folder, matrices = coupled
    mesh = tmp_path / "grid.bdf"
    mesh.write_text("GRID,1,,0.,0.,0.\n")
    read = read_nastran(folder / "b.bdf", folder / "b.bdf", mesh, ("K900001", "B900001"))
    for found, expected in zip((read.stiffness, read.mass), matrices, strict=True):
        places = np.ix_([0, 1, 2, 4, 5], [0, 1, 2, 4, 5])
        symmetric = 0.5 * (expected + expected.T)[places]
        np.testing.assert_allclose(found.toarray(), symmetric, rtol=1e-9, atol=1e-12 * np.abs(symmetric).max())


def test_ansys_and_ross_have_the_radial_part_and_say_what_is_left_out(coupled):
    """To the eight digits of its fields."""
    folder, matrices = coupled
    lines = (folder / "b.txt").read_text(encoding="utf-8").splitlines()
    for line, matrix in zip(lines[5:7], matrices, strict=True):
        np.testing.assert_allclose(np.array(line.split(), dtype=float), matrix[1:3, 1:3].ravel(), rtol=1e-7, atol=1e-6)
    assert lines[-1] == "left out: stiffness and damping along the axis and of tilts"
    k = matrices[0]
    element = tomllib.loads((folder / "b.toml").read_text(encoding="utf-8"))
    (ross,) = (value for name, value in element.items() if name.startswith("BearingElement"))
    for key, i, j in (("xx", 1, 1), ("xy", 1, 2), ("yx", 2, 1), ("yy", 2, 2), ("zz", 0, 0)):
        assert ross[f"k{key}"] == pytest.approx(k[i, j], rel=1e-15)
    for ending in ("txt", "toml", "inp"):
        text = (folder / f"b.{ending}").read_text(encoding="utf-8")
        (place,) = re.findall(r"radial forces act at x = (\S+)(?: to \S+)? mm", text)
        at = np.eye(6)
        at[1, 5], at[2, 4] = -1e-3 * float(place), 1e-3 * float(place)  # of the node, by y and z of that point
        there = at.T @ k @ at
        # digits of the place, and that both planes have their own
        assert abs(there[1, 5]) < 0.02 * abs(k[1, 5]) and abs(there[2, 4]) < 0.02 * abs(k[2, 4])
        assert (f"{np.max(np.abs(k[0, 1:3])) / np.max(np.abs(k[1:3, 1:3])):.1e} of K" in text) == (ending != "inp")


def test_a_deck_of_a_ball_bearing_is_of_one_speed(capsys, tmp_path):
    out = tmp_path / "b.inp"
    ask = ["bearing", *BALLS, "--speed", "0 rpm", "6000 rpm", "2", "-o", str(out)]
    assert bearing_main(ask) == 2 and not out.exists()
    assert "for 1 loads and 2 speeds; allowed: one load, one speed, or a file .nc or .csv" in capsys.readouterr().err


def machine(name):
    """Deck of a mass at node 1 in the radial plane; other masses, far stiffer and apart, are what its solver needs."""
    others = range(101, 131)
    return "\n".join(
        [
            "*NODE, NSET=ALL",
            "1, 0., 0., 0.",
            *(f"{n}, {n}., 0., 0." for n in others),
            "*NSET, NSET=RING",
            "1",
            "*ELEMENT, TYPE=MASS, ELSET=MASSES",
            "1, 1",
            *(f"{100 + n}, {n}" for n in others),
            "*MASS, ELSET=MASSES",
            f"{MASS}",
            "*ELEMENT, TYPE=SPRING1, ELSET=APART",
            *(f"{300 + n}, {n}" for n in others),
            "*SPRING, ELSET=APART",
            "2",
            "1.e13",
            f"*INCLUDE, INPUT={name}",
            "*BOUNDARY",
            "1, 1, 1",
            *(f"{n}, {axis}, {axis}" for n in others for axis in (1, 3)),
            "*STEP",
            "*FREQUENCY, STORAGE=YES",
            "2",
            "*END STEP",
            "*STEP",
            "*STEADY STATE DYNAMICS",
            "100., 3000., 5",
            "*CLOAD",
            "1, 2, 1000.",
            "*NODE PRINT, NSET=RING",
            "U",
            "*END STEP",
        ]
    )


def wide(lines, name):
    """Fields of 16 characters of all entries of a name."""
    found = []
    for i, line in enumerate(lines):
        if line[:8].strip() != f"{name}*":
            continue
        rows = [line]
        for following in lines[i + 1 :]:
            if not following.startswith("*"):
                break
            rows.append(following)
        found.append([row[k : k + 16].strip() for row in (r.ljust(72) for r in rows) for k in (8, 24, 40, 56)])
    return found


def test_nastran_has_the_principal_axes_and_tables_over_frequency(path, tmp_path):
    frequencies = ["--speed", "400 rpm", "--frequency", "100 Hz", "2 kHz", "3"]
    lines = exported(path, tmp_path / "b.bdf", "nastran", *frequencies, "--node", "5").splitlines()
    found = table(path, *frequencies)
    (system,), (bush,), (values,) = wide(lines, "CORD2R"), wide(lines, "CBUSH"), wide(lines, "PBUSH")
    assert bush[:4] == ["900001", "900001", "5", ""] and bush[7] == "900001"
    z = np.array(system[5:8], dtype=float)
    y = np.cross(z, [1.0, 0.0, 0.0])
    k = found.stiffness[0, :, 1:3, 1:3]
    along = [np.einsum("i,kij,j->k", v[1:], k, v[1:]) for v in (y, z)]
    assert abs(y[1:] @ k[0] @ z[1:]) < 1e-9 * along[0][0]
    # 1e-9: digits of the fields
    np.testing.assert_allclose(np.array(values[3:5], dtype=float), [along[0][0], along[1][0]], rtol=1e-8)
    tables = {
        one[0]: np.array([v for v in one[8:] if v and v != "ENDT"], dtype=float) for one in wide(lines, "TABLED1")
    }
    (ids,) = wide(lines, "PBUSHT")
    np.testing.assert_allclose(tables[ids[3]][1::2], along[0], rtol=1e-8)
    np.testing.assert_allclose(tables[ids[3]][::2], found.frequencies, rtol=1e-8)


def test_ansys_has_its_columns(path, tmp_path):
    """Read by the widths of the documented format; a part in 1e7 is its last digit."""
    speeds = ["--speed", "300 rpm", "600 rpm", "2"]
    lines = exported(path, tmp_path / "b.txt", "ansys", *speeds).splitlines()
    found = table(path, *speeds)
    assert all(len(line) <= 80 for line in lines[:3])
    assert [int(lines[3][i : i + 10]) for i in (0, 10, 20)] == [2, 0, 0]
    for index in range(2):
        head, k, c = lines[4 + 3 * index : 7 + 3 * index]
        assert int(head[:10]) == index + 1
        np.testing.assert_allclose(float(head[10:20]), found.speeds[index], rtol=1e-5)
        for line, matrix in ((k, found.stiffness), (c, found.damping)):
            numbers = [float(line[i : i + 15]) for i in (0, 15, 30, 45)]
            np.testing.assert_allclose(numbers, matrix[index, 0, 1:3, 1:3].ravel(), rtol=1e-7)


@pytest.mark.parametrize(
    ("target", "options", "says"),
    [
        ("ross", [], "--speed: it is missing"),
        ("ross", ["--speed", "400 rpm", "--node", "-1"], "--node: got '-1'"),
        (
            "ross",
            ["--speed", "400 rpm", "500 rpm", "2", "--frequency", "1 Hz", "2 Hz", "2"],
            "ROSS 2 takes one of both",
        ),
        ("ross", ["--speed", "60000 rpm"], "outside of the map"),
        ("ross", ["--speed", "400 rpm", "--films", "none"], "--films: got 'none'"),
        ("ross", ["--speed", "400 rpm", "--start-angle", "5 mm"], "--start-angle"),
        ("ross", ["--speed", "400 rpm", "--frequency", "-1 Hz"], "--frequency: got"),
        ("calculix", ["--speed", "300 rpm", "600 rpm", "2"], "--speed: got 2 values"),
        ("calculix", ["--speed", "400 rpm", "--at", "0,nan,0"], "--at: got"),
        ("nastran", ["--speed", "400 rpm", "--first-id", "x"], "--first-id: got"),
        ("ansys", ["--speed", "400 rpm", "--frequency", "1 Hz", "2 Hz", "2"], "Ansys' file has speeds only"),
    ],
)
def test_what_a_format_cannot_hold_is_refused_and_nothing_is_written(path, tmp_path, capsys, target, options, says):
    out = tmp_path / "out"
    ending = ENDINGS[target]
    name = str(out.with_suffix(ending))
    assert main(["export", str(path), "--to", target, "-o", name, *POINT, *options]) == 2
    assert says in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_not_ours_stays(path, tmp_path, capsys):
    out = tmp_path / "deck.inp"
    out.write_text("*NODE\n", encoding="ascii")
    assert main(["export", str(path), "--to", "calculix", "-o", str(out), *POINT, "--speed", "400 rpm"]) == 2
    assert "is not a bearing for CalculiX" in capsys.readouterr().err
    assert out.read_text(encoding="ascii") == "*NODE\n"
