"""Waves, spalls and sizes in C and units of every kind of bearing: `mbs bearing '{ ..., spall = ... }' -o NAME.fmu`."""

from __future__ import annotations

import numpy as np
import pytest

from mbs import assemble, parse_scene
from mbs.cli import main
from mbs.model.elements import Operation
from tests.cases.c_balls import compiled_balls
from tests.cases.fmu import Unit

KEYS = (
    'waviness = [{ on = "inner", waves = 9, amplitude = "0.3 um" }, { on = "elements", element = 2, waves = 3, '
    'amplitude = "0.2 um" }, { on = "outer", waves = [2, 8], amplitude = "0.2 um" }]',
    'size_difference = ["0.4 um", "0 um", "-0.3 um"]',
    'spall = [{ on = "inner", angle = "-90 deg", length = "4 mm", depth = "3 um" }]',
)
DAMPED = "hertz:1.25e-5 s"
KINDS = {
    "NU308": (),
    "6208": (),
    "QJ208": ("--axial", "2 kN"),
    "1208": (),
    "32208": ("--axial", "2 kN"),
    "NUP308": ("--axial", "500 N"),
}
"""Designations, one of each element in C, with the options without which they carry nothing."""

SCENE = """
schema = 1
[operation]
speed = "400 rpm"
temperature = "40 degC"
[lubricant]
name = "FVA3"
[[bodies]]
name = "shaft"
freedoms = ["x", "y", "z", "theta_y", "theta_z"]
spin = 1
mass = "1 kg"
polar_inertia = "1 kg m^2"
transverse_inertia = "1 kg m^2"
[[bodies]]
name = "housing"
freedoms = ["y"]
mass = "1 kg"
polar_inertia = "1 kg m^2"
transverse_inertia = "1 kg m^2"
[[bearings]]
name = "b"
inner = "shaft"
outer = "housing"
bearing = "NAME"
"""
SPEED = 40.0
AXES = {"x": 0, "y": 1, "z": 2, "theta_y": 4, "theta_z": 5}
OUTPUTS = {"force.x": 0, "force.y": 1, "force.z": 2, "moment.y": 4, "moment.z": 5}
SIZES = np.array([3e-6, 5e-6, 5e-6, 0.0, 5e-5, 5e-5])


def of_scene(name, emap):
    """The bearing with its deviations in a scene."""
    text = SCENE.replace("NAME", name) + "\n".join(KEYS)
    if not name[0].isdigit() or name[0] == "6":
        text += '\ndiametral_clearance = "10 um"'
    if name == "NUP308":
        text += "\nslices = 21"
    model = assemble(parse_scene(text, "one", "one"), DAMPED if emap is None else "map", emap)
    return model.system.elements[0].element


@pytest.mark.slow
@pytest.mark.parametrize("name", KINDS)
def test_units_are_the_bearings_of_runs(name, small_map, tmp_path, capsys):
    """Forces at random motions and angles as elements of runs have them in Python, to what Newton's method leaves of
    loads, 1e-11, and of the speed of the cage, 1e-8, which is felt by centrifugal loads of some newtons."""
    emap = small_map if name == "NU308" else None
    given = ["--map", small_map] if emap else ["--law", DAMPED]
    if not name[0].isdigit() or name[0] == "6":
        given += ["--clearance", "10 um"]
    braces = f'{{ name = "{name}", {", ".join(KEYS)} }}'
    ask = ["bearing", braces, "--load", "2 kN", "--speed", "400 rpm", *given, *KINDS[name]]
    for file in ("b.fmu", *(["b.fmi3.fmu", "bearing.c"] if name in ("NU308", "6208") else [])):
        assert main([*ask, "-o", str(tmp_path / file)]) == 0, capsys.readouterr().err
    for source in tmp_path.glob("*.c"):
        compiled_balls(source)
    element, rng = of_scene(name, emap), np.random.default_rng(7)
    start = np.zeros(6)
    start[0] = 20e-6 if KINDS[name] else 0.0
    units = {path.name: Unit(path, tmp_path / f"{path.stem}_unit") for path in tmp_path.glob("*.fmu")}
    models = {key: unit.instance() for key, unit in units.items()}
    felt = 0.0
    for angle in rng.uniform(-300.0, 300.0, 12):
        pose, velocity = start + SIZES * rng.normal(size=6), 30.0 * SIZES * rng.normal(size=6)
        operation = Operation(SPEED, angle=angle)
        with element.deviating(operation):
            wanted = element.evaluate(pose, velocity, operation).force
        perfect = element.evaluate(pose, velocity, operation).force
        largest = max(np.abs(wanted[:3]).max(), 10.0)
        felt = max(felt, np.abs(wanted - perfect)[:3].max() / largest)
        known = {f"pose.{axis}": pose[i] for axis, i in AXES.items()}
        known |= {f"velocity.{axis}": velocity[i] for axis, i in AXES.items()}
        known |= {"spin.inner": angle, "speed.inner": SPEED, "temperature": 313.15}
        for key, unit in units.items():
            own = {variable: value for variable, value in known.items() if variable in unit.references}
            unit.put(models[key], list(own), list(own.values()))
            outputs = [variable for variable in OUTPUTS if variable in unit.references]
            found = unit.get(models[key], tuple(outputs))
            np.testing.assert_allclose(found, wanted[[OUTPUTS[one] for one in outputs]], rtol=0.0, atol=1e-9 * largest)
    assert felt > 1e-3
    for model in models.values():
        model.freeInstance()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["NU308", "6208"])
def test_films_with_memory_follow_deviations(name, small_map, tmp_path, capsys):
    """Films that were begun elsewhere in a turn come to rest where those begun there are, as exp(-time) leaves."""
    given = ["--map", small_map, "--slices", "5"] if name == "NU308" else ["--law", "table"]
    braces, path = f'{{ name = "{name}", {", ".join(KEYS)} }}', tmp_path / "b.fmu"
    ask = ["bearing", braces, "--load", "2 kN", "--speed", "400 rpm", *given, "--films", "memory", "-o", str(path)]
    assert main(ask) == 0, capsys.readouterr().err
    unit, forces = Unit(path, tmp_path / "unit"), []
    names = ["pose.y", "speed.inner", "spin.inner"]
    outputs = ("force.y", "force.z")
    for begin in (0.0, 0.6):
        model = unit.stepped(names, [8e-6, SPEED, begin])
        before = unit.get(model, outputs)
        for step in range(60):
            unit.put(model, names, [8e-6, SPEED, 0.6])
            model.doStep(1e-3 * step, 1e-3)
        forces.append((before, unit.get(model, outputs)))
        model.freeInstance()
    (there, moved), (_, stayed) = forces
    largest = np.abs(stayed).max()
    np.testing.assert_allclose(moved, stayed, rtol=0.0, atol=1e-6 * largest)
    assert np.abs(moved - there).max() > 1e-3 * largest


def test_deviations_without_a_use_are_said(capsys):
    braces = f'{{ name = "6208", {KEYS[1]} }}'
    assert main(["bearing", braces, "--load", "1 kN", "--speed", "1500 rpm"]) == 2
    assert "got size_difference, by which points are not changed" in capsys.readouterr().err
    assert main(["bearing", '{ name = "NU308", spall = 3 }', "--load", "1 kN", "--speed", "1500 rpm", "-o", "a.c"]) == 2
    assert "spall" in capsys.readouterr().err
