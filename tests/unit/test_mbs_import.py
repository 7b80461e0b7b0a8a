"""`mbs import`: what is taken of a rotor of ROSS, what is refused, and the scene that is written."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from ehdmaps.errors import InputError
from mbs import assemble, cli, parse_scene, read_scene
from mbs.imports.ross_file import read_ross
from mbs.imports.ross_scene import ross_scene
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from tests.cases.ross_files import ROTOR, beam, bearing, changed, saved


def scene_of(rotor, folder):
    return parse_scene(ross_scene(read_ross(saved(folder, rotor)), "scene.toml", "a rotor"), "scene", "scene")


def named(scene, name):
    return next(entry for entry in (*scene.bodies, *scene.elements) if entry.name == name)


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    return scene_of(ROTOR, tmp_path_factory.mktemp("rotor"))


def test_elements_are_sections_as_they_are(scene):
    shaft = named(scene, "rotor")
    a, b, c, layer = shaft.sections
    assert (a.begin, a.end, a.diameter, a.tapered) == (0.0, 0.2, 0.04, False)
    assert (b.diameter, b.last_diameter, b.bore, b.last_bore) == (0.04, 0.06, 0.0, 0.02)
    assert (c.begin, c.bore) == (pytest.approx(0.3), 0.02)
    assert (layer.begin, layer.bore, layer.youngs_modulus) == (c.begin, 0.06, 6894.75)
    # E and G_s of ROSS; a scene has 15 digits.
    assert a.poisson_ratio == pytest.approx(211e9 / (2 * 81.2e9) - 1.0, rel=1e-13)
    assert shaft.spin == 1.0
    assert shaft.freedoms == ("y", "z", "theta_y", "theta_z")


def test_discs_and_masses_are_parts_of_the_shaft_or_of_supports(scene):
    wheel, mass = named(scene, "rotor").discs
    pedestal = named(scene, "pedestal")
    assert (wheel.position, wheel.inertia.polar, wheel.inertia.transverse) == (pytest.approx(0.3), 0.035, 0.02)
    assert (mass.position, mass.inertia.mass, mass.inertia.polar) == (0.2, 3.0, 0.0)
    assert (pedestal.parts[0].mass, pedestal.freedoms, pedestal.position[0]) == (20.0, ("y", "z"), pytest.approx(0.5))


def test_bearings_have_the_axes_of_the_scene(scene):
    left, right, foot, seal = (named(scene, name) for name in ("left", "right", "foot", "seal"))
    assert (left.on, left.against) == ("rotor:left", "ground")
    assert np.diag(left.damping[0])[:3].tolist() == [0.0, 300.0, 200.0]
    assert (right.on, right.against) == ("rotor:right", "pedestal")
    assert (foot.on, foot.against) == ("pedestal", "ground")
    assert (seal.stiffness[-1, 1, 2], seal.stiffness[-1, 2, 1]) == (pytest.approx(5e5), pytest.approx(-5e5))


def test_tables_go_along_cubics(scene):
    seal = named(scene, "seal")
    curve = CubicSpline([100.0, 200.0, 300.0, 400.0, 500.0], [1e5, 2e5, 4e5, 7e5, 11e5], bc_type="not-a-knot")
    for speed in (100.0, 137.0, 251.3, 466.6, 500.0):
        # Lines in place of the cubic: a thousandth of its bulge of a few percent.
        found = np.interp(speed, seal.speeds, seal.stiffness[:, 1, 1])
        assert found == pytest.approx(float(curve(speed)), rel=1e-4)
        assert abs(found / np.interp(speed, seal.speeds[::32], seal.stiffness[::32, 1, 1]) - 1.0) < 0.1


@pytest.mark.parametrize(
    ("values", "wanted"),
    [([1.0, 3.0], 2.5), ([1.0, 3.0, 6.0], 2.40625)],
    ids=["two speeds: a line", "three: a parabola"],
)
def test_short_tables_go_along_lower_powers(values, wanted, tmp_path):
    table = bearing("seal", 1, [1e5 * value for value in values], frequency=[0.0, 100.0, 200.0][: len(values)])
    seal = named(scene_of(changed(None, SealElement_seal=table), tmp_path), "seal")
    assert np.interp(75.0, seal.speeds, seal.stiffness[:, 1, 1]) == pytest.approx(1e5 * wanted, rel=1e-3)


def test_speeds_of_the_file_are_those_of_the_scene(scene, tmp_path):
    assert (scene.speed, scene.sweep.begin, scene.sweep.end) == (400.0, 100.0, 600.0)
    silent = scene_of(changed(None, parameters={}), tmp_path)
    assert (silent.speed, silent.sweep.begin, silent.sweep.end) == (300.0, 100.0, 500.0)


def test_weight_is_against_y_of_ross(scene):
    balance = equilibrium(assemble(scene).system, Operation(0.0))
    assert scene.gravity == (0.0, 0.0, -9.80665)
    pairs = zip(balance.forces, balance.system.elements, strict=True)
    total = sum(float(force[2]) for force, entry in pairs if entry.element.name in ("left", "seal", "foot"))
    mass = sum(part.mass for part in named(scene, "rotor").sections) + 8.0 + 3.0 + 20.0
    # Round-off of the equilibrium.
    assert total == pytest.approx(9.80665 * mass, rel=1e-8)


def test_axial_stiffness_frees_the_axis(tmp_path):
    scene = scene_of(changed("BearingElement_left", kzz=[1e6]), tmp_path)
    assert all("x" in body.freedoms for body in scene.bodies)
    assert named(scene, "left").stiffness[0, 0, 0] == 1e6


def test_a_name_that_no_scene_may_have_is_changed(tmp_path):
    rotor = changed(None, BearingElement_left=None)
    rotor['BearingElement_"]\n:.rotor'] = bearing("x", 0, [1e7])
    rotor["BearingElement_rotor"] = bearing("y", 3, [1e7])
    names = [entry.name for entry in scene_of(rotor, tmp_path).elements]
    assert "rotor 2" in names
    assert "rotor 3" in names


CHAIN = "allowed: one shaft whose nodes follow each other from 0"


@pytest.mark.parametrize(
    ("rotor", "texts"),
    [
        (changed(None, ross_version="3.1.0"), ["ross_version: got '3.1.0'; allowed: 2, such as '2.3.0'"]),
        (changed(None, ross_version=2), ["ross_version: got 2"]),
        (changed(None, parameters=5), ["parameters: got 5; allowed: a table"]),
        (changed(None, parameters={"rated_w": "fast"}), ["parameters rated_w: got 'fast'"]),
        (changed(None, CouplingElement_k={"n": 1}), ["got the element 'CouplingElement'; allowed: ShaftElement,"]),
        (changed(None, GearElement_g={"n": 1}), ["'GearElement_g': got the element 'GearElement'"]),
        (changed(None, ShaftElement_a=[1]), ["ShaftElement_a: got a list of 1 entries; allowed: a table"]),
        (changed("ShaftElement_a", n=-1), ["ShaftElement_a n: got -1; allowed: a node"]),
        (changed("ShaftElement_a", n=None), ["ShaftElement_a n: got None"]),
        (changed("ShaftElement_a", n=True), ["ShaftElement_a n: got True"]),
        (changed("ShaftElement_c", n=5), [f"'c': got n = 5 after 2; {CHAIN}"]),
        (changed("ShaftElement_layer", L=0.1), ["'layer': got L = 0.1 m upon an element of 0.2 m"]),
        (changed("ShaftElement_a", L=0.0), ["ShaftElement_a L: got 0.0; allowed: 1e-06 to 100"]),
        (changed("ShaftElement_a", odl="5 cm"), ["ShaftElement_a odl: got '5 cm'; allowed: a bare number"]),
        (changed("ShaftElement_a", wobble=1), ["ShaftElement_a wobble: unknown key"]),
        (changed("ShaftElement_a", torque=5.0), ["torque: got 5.0; allowed: 0; no shaft of mbs is twisted"]),
        (changed("ShaftElement_a", axial_force=5.0), ["axial_force: got 5.0; allowed: 0"]),
        (changed("ShaftElement_a", gyroscopic=False), ["gyroscopic: got False; allowed: true"]),
        (changed("ShaftElement_a", shear_method_calc="hutchinson"), ["shear_method_calc: got 'hutchinson'"]),
        (changed("ShaftElement_a", material=None), ["material: missing; allowed: a table with rho, E and G_s"]),
        (changed("ShaftElement_a", material={"rho": 7810.0, "E": 2e11, "G_s": 1e10}), ["G_s: got 1e+10 Pa with E"]),
        (changed("DiskElement_wheel", m=0.0), ["DiskElement_wheel m: got 0.0"]),
        (changed("DiskElement_wheel", Ip=1.0), ["at most twice the transverse"]),
        (changed("DiskElement_wheel", n=9), ["'wheel': got node 9; allowed: 0 to 3 on the shaft"]),
        (changed("PointMass_pedestal", mx=10.0), ["mx: got 20, 10, 20 kg; allowed: the same along x and y"]),
        (changed("PointMass_pedestal", m=None, mx=None, my=None), ["PointMass_pedestal m: missing"]),
        (changed(None, PointMass_pedestal=None), ["'right': got node 4", "'foot': got node 4"]),
        (
            changed(
                None,
                PointMass_pedestal=None,
                BearingElement_foot=None,
                BearingElement_right=bearing("right", 3, [3e7], n_link=1),
            ),
            ["'right': got n_link = 1, which is on the shaft"],
        ),
        (changed("BearingElement_left", kxx=[1.0, 2.0]), ["kxx: got 2 values; allowed: 1, as many as there are"]),
        (changed("BearingElement_left", kxx=["stiff"]), ["kxx: got 'stiff'; allowed: numbers of up to 1e+15"]),
        (changed("BearingElement_left", kxx=None), ["BearingElement_left kxx: missing"]),
        (changed("BearingElement_left", mxx=[2.0]), ["mxx: got a mass; allowed: 0; add a PointMass"]),
        (changed("BearingElement_left", cxx=[-2.0]), ["damping y: got '-2 N s/m'"]),
        (changed("SealElement_seal", frequency=[1.0, 2.0, 2.0, 4.0, 5.0]), ["frequency: got a list of 5 entries; al"]),
        (changed("SealElement_seal", frequency=[0.0] * 1001), ["frequency: got 1001 values; allowed: 1 to 1000"]),
        (changed("ShaftElement_layer", idl=0.05), ["both fill x = 300 to 500 mm"]),
        (changed("ShaftElement_a", L=10**400), ["ShaftElement_a L: got a number of 1329 bits"]),
        (changed("BearingElement_left", kxx=[10**400]), ["kxx: got a number of 1329 bits"]),
        (changed("BearingElement_left", kxx=[math.nan]), ["kxx: got nan"]),
        ({"ross_version": "2.3.0"}, ["got no ShaftElement"]),
        ([], ["got a list of 0 entries; allowed: a rotor as Rotor.save"]),
    ],
)
def test_what_is_not_taken_is_refused(rotor, texts, tmp_path, capsys):
    path = saved(tmp_path, rotor)
    assert cli.main(["import", str(path), "-o", str(tmp_path / "scene.toml")]) == 2
    said = capsys.readouterr().err
    for text in texts:
        assert text in said
    assert not (tmp_path / "scene.toml").exists()


def test_what_all_elements_have_is_said_once(tmp_path):
    rotor = changed(None)
    for key in ("a", "b", "c"):
        rotor[f"ShaftElement_{key}"]["alpha"] = 8.05
    with pytest.raises(InputError) as caught:
        read_ross(saved(tmp_path, rotor))
    (problem,) = caught.value.problems
    assert "ShaftElement_a and 2 more, alpha: got 8.05; allowed: 0; state the damping of the shaft as" in problem


@pytest.mark.parametrize(
    ("name", "content", "text"),
    [
        ("a.json", "[" * 100_000, "is not JSON"),
        ("a.json", '{"a": ', "is not JSON"),
        ("a.toml", "a = [" * 1000, "is not TOML"),
        ("a.toml", "ross_version = '2'\n[a]\n[a]", "is not TOML"),
        ("a.toml", "x = {}", "'x': got the element 'x'"),
        ("a.txt", "", "got the ending '.txt'; allowed: a rotor as Rotor.save of ROSS 2 writes it"),
        ("a.json", "\udcff", "is not UTF-8"),
    ],
)
def test_a_file_that_is_no_rotor_is_refused(name, content, text, tmp_path):
    (tmp_path / name).write_bytes(content.encode("utf-8", "surrogateescape"))
    with pytest.raises(InputError, match=re.escape(text)):
        read_ross(tmp_path / name)


def test_a_long_file_and_no_file_are_refused(tmp_path):
    with pytest.raises(InputError, match="No such file"):
        read_ross(tmp_path / "none.toml")
    with open(tmp_path / "long.toml", "wb") as file:
        file.truncate(10_000_001)
    with pytest.raises(InputError, match="longer than 10000000 bytes"):
        read_ross(tmp_path / "long.toml")


def test_the_command_writes_a_scene_once(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    saved(tmp_path, ROTOR)
    assert cli.main(["import", "rotor.json"]) == 0
    said = capsys.readouterr().out
    assert said.strip().startswith(
        "rotor_scene.toml: written, of 4 elements, 2 discs, 1 point masses, 3 bearings, 1 se"
    )
    assert "Passed over, without part in the motion: scale_factor, " in (tmp_path / "rotor_scene.toml").read_text()
    assert read_scene("rotor_scene.toml").speed == 400.0
    assert cli.main(["import", "rotor.json"]) == 2
    assert "rotor_scene.toml" in capsys.readouterr().err


def test_a_thick_shaft_gets_a_cutoff_that_beams_bear(tmp_path):
    rotor = {"ShaftElement_a": beam("a", 0, 3.0, 1.0), "BearingElement_b": bearing("b", 0, [1e9])}
    (shaft,) = scene_of(rotor, tmp_path).bodies
    assert 100.0 < shaft.cutoff < 5e3


def test_between_goes_with_speeds(tmp_path):
    text = ross_scene(read_ross(saved(tmp_path, ROTOR)), "scene.toml", "a rotor")
    text = text.replace('position = "0 m"\n', 'position = "0 m"\nbetween = "cubic"\n')
    with pytest.raises(InputError, match="between: stands without speeds; allowed: with a table over speed"):
        parse_scene(text, "scene", "scene")
