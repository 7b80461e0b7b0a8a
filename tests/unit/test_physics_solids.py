"""Solids: materials, structural laws, contacts, bearing geometry."""

import dataclasses
import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ehdmaps.errors import InputError
from ehdmaps.physics import approach
from ehdmaps.physics.bearing import BEARINGS, BearingGeometry, with_law
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.solids import STEEL, Material, reduced_modulus

ROUND_OFF = 1e-12
LAWS = ("iso16281", "palmgren", "half_space", "fe")


def contact(law="iso16281", material=STEEL):
    return LineContact("line", 5.5e-3, material, law, roller_length=15e-3, reference_depth=5e-3, fe_approach=3e-6)


# --- material --------------------------------------------------------------------------------------------


def test_reduced_modulus_of_steel():
    assert reduced_modulus(STEEL, STEEL) == pytest.approx(210e9 / 0.91, rel=ROUND_OFF)


def test_reduced_modulus_against_a_rigid_body_is_doubled():
    rigid = Material(1e30, 0.3)
    assert reduced_modulus(STEEL, rigid) == pytest.approx(2 * 210e9 / 0.91, rel=1e-12)  # 210e9/1e30: round-off
    assert reduced_modulus(STEEL, rigid) == reduced_modulus(rigid, STEEL)


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ((0.0, 0.3), r"youngs_modulus: got 0.0 Pa; allowed: finite and > 0"),
        ((math.nan, 0.3), r"youngs_modulus: got nan Pa"),
        ((210e9, 0.5), r"poisson_ratio: got 0.5; allowed: -1 < nu < 0.5"),
        ((210e9, -1.0), r"poisson_ratio: got -1.0"),
        ((210e9, math.nan), r"poisson_ratio: got nan"),
        ((210e9, 0.3, -1.0), r"density: got -1.0 kg/m3"),
        ((210e9, 0.3, 7850.0, 0.0), r"conductivity: got 0.0 W/\(m K\); allowed: finite and > 0; steel has 46"),
        ((210e9, 0.3, 7850.0, 46.0, math.inf), r"heat_capacity: got inf J/\(kg K\)"),
    ],
)
def test_impossible_materials_are_refused(values, text):
    with pytest.raises(InputError, match=text):
        Material(*values)


def test_all_problems_of_a_material_are_listed():
    with pytest.raises(InputError) as caught:
        Material(-1.0, 0.7, math.inf)
    assert len(caught.value.problems) == 3


# --- structural laws -------------------------------------------------------------------------------------


def test_iso16281_gives_the_load_of_the_standard_for_both_contacts():
    length_mm, load_on_roller = 15.0, 5000.0
    delta_mm = 2 * 1e3 * approach.iso16281(load_on_roller / 15e-3, roller_length=15e-3)
    assert 35948 * length_mm ** (8 / 9) * delta_mm ** (10 / 9) == pytest.approx(load_on_roller, rel=ROUND_OFF)


def test_palmgren_in_its_usual_form():
    delta_mm = 1e3 * approach.palmgren(5000.0 / 15e-3, roller_length=15e-3)
    assert delta_mm == pytest.approx(3.84e-5 * 5000.0**0.9 / 15.0**0.8, rel=ROUND_OFF)


@pytest.mark.parametrize("length", [9e-3, 15e-3])
def test_iso16281_and_palmgren_agree(length):
    """Both are fits of the same rollers; 10 % bounds their difference (model error), which is 3 to 5 %."""
    ratio = approach.iso16281(1e5, length) / approach.palmgren(1e5, length)
    assert 1.0 < ratio < 1.1


def test_half_space_of_a_roller_agrees_with_the_empirical_law():
    """15 % bounds the difference of the laws (model error) at working loads."""
    inner, _ = BearingGeometry.named("NU308").contacts(STEEL, "half_space")
    ratio = inner.structural_approach(3e5) / approach.iso16281(3e5, 15e-3)
    assert ratio == pytest.approx(1.0, abs=0.15)


def test_half_space_closed_form():
    w, depth, radius, modulus = 1e5, 5e-3, 5.5e-3, 230e9
    b = math.sqrt(8 * w * radius / (math.pi * modulus))
    expected = 4 * w / (math.pi * modulus) * (math.log(2 * depth / b) + 0.5)
    assert approach.half_space(w, depth, radius, modulus) == pytest.approx(expected, rel=ROUND_OFF)


def test_reference_depth_of_a_roller():
    assert approach.roller_reference_depth(14e-3) == pytest.approx(14e-3 / math.e, rel=ROUND_OFF)


@pytest.mark.parametrize("law", ["iso16281", "palmgren"])
def test_another_material_scales_the_steel_laws(law):
    soft = Material(105e9, 0.3)
    ratio = contact(law, soft).structural_approach(1e5) / contact(law).structural_approach(1e5)
    assert ratio == pytest.approx(2**0.9, rel=ROUND_OFF)


@given(law=st.sampled_from(LAWS), load=st.floats(1.0, 1e6))
def test_compliance_is_the_derivative_of_the_approach(law, load):
    """Central differences with a relative step of 1e-5: truncation ~1e-10, round-off ~1e-10."""
    line, step = contact(law), 1e-5 * load
    difference = (line.structural_approach(load + step) - line.structural_approach(load - step)) / (2 * step)
    assert line.structural_compliance(load) == pytest.approx(difference, rel=1e-8)


@given(law=st.sampled_from(LAWS), load=st.floats(1e-3, 1e6))
def test_approach_rises_and_stiffens_with_load(law, load):
    line = contact(law)
    assert line.structural_approach(1.1 * load) > line.structural_approach(load) > 0
    assert line.structural_compliance(1.1 * load) < line.structural_compliance(load)


@pytest.mark.parametrize("law", LAWS)
def test_no_load_no_approach_no_stiffness(law):
    line = contact(law)
    for load in (0.0, -5.0):
        assert line.structural_approach(load) == 0.0
        assert line.structural_compliance(load) == math.inf


@pytest.mark.parametrize("law", LAWS)
def test_arrays_and_floats_agree(law):
    line, loads = contact(law), np.array([-1.0, 0.0, 10.0, 1e5])
    assert isinstance(line.structural_approach(10.0), float)
    assert type(line.structural_compliance(10.0)) is float
    for method in (line.structural_approach, line.structural_compliance):
        np.testing.assert_array_equal(method(loads), [method(float(load)) for load in loads])


def test_half_space_refuses_a_contact_wider_than_its_depth():
    line = LineContact("line", 5.5e-3, STEEL, "half_space", reference_depth=1e-4)
    text = r"half_space law: got a contact half-width of .* m .* 1e\+06 N/m; .* reference_depth 0.0001 m"
    with pytest.raises(InputError, match=text):
        line.structural_approach(1e6)
    with pytest.raises(InputError, match=text):
        line.structural_compliance(np.array([1.0, 1e6]))


def test_finite_elements_have_the_form_of_the_half_space():
    """The law is that of a half space whose depth gives the stated approach at 100 N/mm: round-off."""
    half, loads = contact("half_space"), np.geomspace(1.0, 1e6, 7)
    line = LineContact("line", half.radius, STEEL, "fe", fe_approach=half.structural_approach(approach.FE_LOAD))
    np.testing.assert_allclose(line.structural_approach(loads), half.structural_approach(loads), rtol=1e-9)
    np.testing.assert_allclose(line.structural_compliance(loads), half.structural_compliance(loads), rtol=1e-9)


def test_finite_elements_refuse_a_contact_that_is_too_wide():
    """A half-width of a quarter of the radius, by the formula of Hertz."""
    line = LineContact("line", 5.5e-3, STEEL, "fe", fe_approach=3e-6)
    most = approach.highest_fe_load(3e-6, 5.5e-3)
    half_width = math.sqrt(8.0 * most * 5.5e-3 / (math.pi * line.reduced_modulus))
    assert half_width == pytest.approx(5.5e-3 / 4.0, rel=ROUND_OFF)
    with pytest.raises(InputError, match=r"fe law: got the load 1e\+09 N/m; allowed: at most 3\.115e\+07 N/m, where"):
        line.structural_approach(1e9)
    shallow = approach.highest_fe_load(1.2e-6, 5.5e-3)  # bodies of little depth limit the load before
    assert shallow < 0.1 * most
    assert approach.finite_elements_compliance(shallow, 1.2e-6, 5.5e-3) > 0.0


def test_approaches_that_come_with_the_package():
    nu308 = BearingGeometry.named("NU308")
    inner, outer = nu308.contacts(STEEL, "fe")
    assert inner.fe_approach > outer.fe_approach > 2e-6
    assert with_law(inner, "iso16281", nu308) == nu308.contacts(STEEL, "iso16281")[0]
    assert with_law(nu308.contacts(STEEL, "iso16281")[0], "fe", nu308) == inner
    stated = dataclasses.replace(inner, fe_approach=3e-6)
    assert with_law(with_law(stated, "iso16281", nu308), "fe", nu308) == stated
    for other in (Material(210e9, 0.28), STEEL):
        bearing = nu308 if other is not STEEL else dataclasses.replace(nu308, rollers=11)
        with pytest.raises(
            InputError, match=r"law fe: got the bearing 'NU308', .*; allowed: N1014, NU308 with nu = 0\.3"
        ):
            bearing.contacts(other, "fe")


def test_a_softer_bearing_has_the_same_law_of_the_same_width():
    """Linear bodies: delta over the half-width depends on the half-width alone, whatever the modulus; round-off."""
    soft = Material(100e9, 0.3)
    lines = [BearingGeometry.named("NU308").contacts(material, "fe")[1] for material in (STEEL, soft)]
    loads = [line.reduced_modulus * 1e-6 for line in lines]
    first, second = (line.structural_approach(load) for line, load in zip(lines, loads, strict=True))
    assert second == pytest.approx(first, rel=1e-12)


# --- contact ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ((0.0, "half_space", None, 1e-3), r"contact 'line', radius: got 0.0 m; allowed: finite and > 0"),
        (
            (1e-3, "iso16281", None, 1e-3),
            r"roller_length: got none; the iso16281 law needs it; give the length",
        ),
        ((1e-3, "palmgren", None, None), r"roller_length: got none; the palmgren law needs it"),
        (
            (1e-3, "half_space", 1e-3, None),
            r"reference_depth: got none; the half_space law needs it; give the depth",
        ),
        (
            (1e-3, "hertz", 1e-3, None),
            r"structural_law: got 'hertz'; allowed: iso16281, palmgren, half_space, fe",
        ),
        ((1e-3, "fe", 1e-3, 1e-3), r"fe_approach: got none; the fe law needs it; .* that `ehdmaps solids` finds"),
        ((1e-3, "iso16281", math.nan, None), r"roller_length: got nan m"),
        ((1e-3, "half_space", None, -1.0), r"reference_depth: got -1.0 m"),
    ],
)
def test_impossible_contacts_are_refused(arguments, text):
    radius, law, length, depth = arguments
    with pytest.raises(InputError, match=text):
        LineContact("line", radius, STEEL, law, length, depth)


def test_contacts_are_values():
    line = contact()
    assert pickle.loads(pickle.dumps(line)) == line
    assert line.reduced_modulus == reduced_modulus(STEEL, STEEL)
    assert line != contact("palmgren")


# --- bearing ---------------------------------------------------------------------------------------------


def test_reduced_radii_and_ratio():
    nu308 = BearingGeometry.named("NU308")
    assert nu308.pitch_diameter == pytest.approx(66e-3, rel=ROUND_OFF)
    assert nu308.gamma == pytest.approx(14 / 66, rel=ROUND_OFF)
    assert nu308.inner_radius == pytest.approx(7e-3 * (1 - 14 / 66), rel=ROUND_OFF)
    assert nu308.outer_radius == pytest.approx(7e-3 * (1 + 14 / 66), rel=ROUND_OFF)


def test_reduced_radii_are_those_of_the_raceways_for_zero_clearance():
    """1/R = 2/D + 2/d_i and 2/D - 2/d_o: exact, since the raceway diameters are d_m -/+ D."""
    n1014 = BearingGeometry.named("N1014")
    assert 1 / n1014.inner_radius == pytest.approx(2 / 9e-3 + 2 / 82e-3, rel=ROUND_OFF)
    assert 1 / n1014.outer_radius == pytest.approx(2 / 9e-3 - 2 / 100e-3, rel=ROUND_OFF)


def test_entrainment_speed():
    nu308 = BearingGeometry.named("NU308")
    omega = 500 * 2 * math.pi / 60
    assert nu308.entrainment_speed(omega) == pytest.approx(0.825, abs=5e-4)  # three printed digits
    assert nu308.entrainment_speed(0.0, omega) == nu308.entrainment_speed(omega) == nu308.entrainment_speed(-omega)
    assert nu308.entrainment_speed(omega, omega) == 0.0


def test_entrainment_speed_is_the_surface_speed_relative_to_the_cage():
    nu308, omega = BearingGeometry.named("NU308"), 100.0
    cage = 0.5 * omega * (1 - nu308.gamma)
    surface = (omega - cage) * 0.5 * (nu308.pitch_diameter - nu308.roller_diameter)
    assert nu308.entrainment_speed(omega) == pytest.approx(surface, rel=ROUND_OFF)


def test_contacts_of_a_bearing():
    nu308 = BearingGeometry.named("NU308")
    inner, outer = nu308.contacts(STEEL, "half_space")
    assert (inner.name, outer.name) == ("inner", "outer")
    assert (inner.radius, outer.radius) == (nu308.inner_radius, nu308.outer_radius)
    assert inner.reference_depth == pytest.approx(14e-3 / math.e, rel=ROUND_OFF)
    assert inner.roller_length == outer.roller_length == 15e-3


def make(**changes):
    values = {
        "name": "own",
        "inner_raceway_diameter": 52e-3,
        "outer_raceway_diameter": 80e-3,
        "roller_diameter": 14e-3,
        "roller_length": 15e-3,
        "rollers": 12,
        "diametral_clearance": 0.0,
    }
    return BearingGeometry(**(values | changes))


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"inner_raceway_diameter": math.nan}, r"bearing 'own', inner_raceway_diameter: got nan m"),
        (
            {"outer_raceway_diameter": 50e-3},
            r"outer_raceway_diameter: got 0.05 m; allowed: > the inner_raceway_d",
        ),
        ({"roller_diameter": 70e-3}, r"roller_diameter: got 0.07 m; allowed: < the pitch diameter 0.066 m"),
        ({"roller_length": 0.0}, r"roller_length: got 0.0 m; allowed: finite and > 0"),
        ({"rollers": 0}, r"rollers: got 0; allowed: a whole number >= 1"),
        ({"rollers": 12.0}, r"rollers: got 12.0; allowed: a whole number"),
        ({"rollers": True}, r"rollers: got True; allowed: a whole number"),
        (
            {"rollers": 15},
            r"rollers: got 15, which overlap on the pitch circle of 0.066 m; allowed: at most 14",
        ),
        ({"diametral_clearance": math.inf}, r"diametral_clearance: got inf m; allowed: finite"),
        (
            {"diametral_clearance": 25.0},
            r"diametral_clearance: got 25.0 m; allowed: smaller than the roller_d",
        ),
    ],
)
def test_impossible_bearings_are_refused(changes, text):
    with pytest.raises(InputError, match=text):
        make(**changes)


def test_all_problems_of_a_bearing_are_listed():
    with pytest.raises(InputError) as caught:
        make(roller_diameter=-1.0, rollers=0, diametral_clearance=math.nan)
    assert len(caught.value.problems) == 3


def test_possible_bearings_pass():
    assert make(rollers=14).rollers == 14  # as many as fit
    assert make(rollers=1).rollers == 1
    assert make(diametral_clearance=-5e-6).diametral_clearance == -5e-6  # preload
    assert make(diametral_clearance=25e-6).inner_radius == make().inner_radius  # independent of the raceways


def test_unknown_bearing():
    with pytest.raises(InputError, match=r"bearing name: got '6308'; allowed: N1014, NU308; give other bearings"):
        BearingGeometry.named("6308")
    assert all(BearingGeometry.named(name).name == name for name in BEARINGS)
