"""A roller of finite length: closed forms, limits, and the shipped contacts by finite elements."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.approach import half_space, half_space_compliance
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.hertz import half_width, max_pressure
from ehdmaps.physics.solids import STEEL, reduced_modulus
from ehdmaps.physics.surface import iso_profile
from ehdmaps.solids.finite_line import FiniteLine, depth_term, layer_response
from ehdmaps.solids.slices import plane_depth, slice_coupling, without_ends
from tests.cases.programs import needed
from tests.finite_length.bricks import CORNERS, brick_stiffness
from tests.finite_length.compare import compare_lengths, mesh_change
from tests.finite_length.reference import (
    LengthReference,
    MeshedContact,
    load_by_calculix,
    quarter_model,
    save_reference,
    shipped_reference,
)
from tests.finite_length.slice_loads import balanced_loads, coupled_loads, plane_law
from tests.finite_length.solution import love, solve_length

NU308 = BearingGeometry.named("NU308")
LINE = FiniteLine(NU308.inner_radius, NU308.roller_length, 7e-3, 14e-3)
MODULUS = reduced_modulus(STEEL, STEEL)
WIDEST = 4.0 * LINE.radius * 4e9 / MODULUS
LOAD = 3800.0


def iso(places: FloatArray) -> FloatArray:
    """The profile of ISO 16281."""
    return iso_profile(places, NU308.roller_diameter, NU308.roller_length)


def test_the_plane_law_is_the_inverse_of_the_half_space_law():
    """Newton's method from a table: round-off; and no load without approach."""
    loads = np.geomspace(10.0, 3e6, 30)
    approach = half_space(loads, plane_depth(LINE), LINE.radius, MODULUS)
    found, slope = plane_law(LINE)(approach)
    np.testing.assert_allclose(found, loads, rtol=1e-9)
    np.testing.assert_allclose(slope * half_space_compliance(loads, plane_depth(LINE), LINE.radius, MODULUS), 1.0)
    assert [part.tolist() for part in plane_law(LINE)(np.array([-1e-6, 0.0]))] == [[0.0, 0.0], [0.0, 0.0]]


def test_love_superposes_and_acts_as_a_force_from_afar():
    """Four rectangles with a common corner are one: exact, so to round-off; from 30 sizes away a force, to 1/30^2."""
    whole = love(np.array(0.0), np.array(0.0), 2.0, 3.0)
    quarter = love(np.array(1.0), np.array(1.5), 1.0 * (1 + 1e-15), 1.5 * (1 + 1e-15))
    assert 4.0 * quarter == pytest.approx(whole, rel=1e-12)
    assert love(np.array(30.0), np.array(20.0), 0.5, 0.5) == pytest.approx(1.0 / math.hypot(30.0, 20.0), rel=1e-3)


def test_a_layer_yields_as_in_compression_under_long_waves_and_not_far_from_a_force():
    """Limits of the response, to the next term of each series; the quadrature of the far field to 1e-4 of 1/r."""
    assert layer_response(np.array([1e-3]))[0] == pytest.approx(0.5e-3, rel=1e-5)
    assert layer_response(np.array([15.0]))[0] == pytest.approx(1.0, rel=1e-8)
    # far away the layer is at rest: both parts cancel
    assert depth_term(np.array([8.0]), 1.0)[0] == pytest.approx(-1.0 / 8.0, rel=1e-4)


def test_the_middle_of_a_long_roller_is_the_contact_of_hertz():
    """Of 24 half-width cells the pressures are even over a cell: 0.5 % of the peak."""
    line = FiniteLine(LINE.radius, 0.1, 7e-3, 14e-3)
    found = solve_length(line, np.zeros_like, 25e3, cells=(24, 30))
    middle = found.places.size // 2
    w = found.load_per_length[middle]
    assert w == pytest.approx(25e3 / 0.1, rel=0.01)
    assert found.peak_pressure[middle] == pytest.approx(max_pressure(w, line.radius, MODULUS), rel=5e-3)
    assert found.load == pytest.approx(25e3, rel=1e-12)
    assert line.half_width(w) == pytest.approx(half_width(w, line.radius, MODULUS), rel=1e-12)


def test_load_and_moment_are_those_asked_for_and_a_tilt_mirrors():
    """Balances of a linear system: round-off."""
    right, left = (solve_length(LINE, iso, LOAD, sign * 4.0, cells=(8, 30)) for sign in (1.0, -1.0))
    assert (right.load, right.moment) == pytest.approx((LOAD, 4.0), rel=1e-10)
    assert right.tilt == pytest.approx(-left.tilt, rel=1e-9)
    np.testing.assert_allclose(right.load_per_length, left.load_per_length[::-1], rtol=1e-7)


def test_ends_of_bodies_that_end_together_bear_less_than_where_the_raceway_goes_on():
    """The raceway beyond the end supports it; without it, and with the mirror alone, the plane law holds to 0.5 %."""
    flush = FiniteLine(LINE.radius, LINE.length, 7e-3, 14e-3, flush=True)
    mirrored, on = (solve_length(line, np.zeros_like, LOAD, mirrored=1.0) for line in (flush, LINE))
    np.testing.assert_allclose(mirrored.load_per_length, LOAD / LINE.length, rtol=5e-3)
    assert on.load_per_length[0] > 1.3 * LOAD / LINE.length


def test_the_coupling_is_symmetric_and_stable_with_its_law():
    """Symmetry by construction; positive definite with the slope of the law at the static limit, 4 GPa."""
    for count in (11, 41, 61):
        coupling = slice_coupling(LINE, count, WIDEST)
        np.testing.assert_allclose(coupling, coupling.T, rtol=0.0, atol=1e-25)
        np.testing.assert_allclose(coupling, coupling[::-1, ::-1], rtol=0.0, atol=1e-24)
        slope = half_space_compliance(
            math.pi * MODULUS * WIDEST**2 / (8.0 * LINE.radius), plane_depth(LINE), LINE.radius, MODULUS
        )
        assert np.linalg.eigvalsh(coupling + slope * np.eye(count))[0] > 0.0
        off = coupling - np.diag(np.diag(coupling))
        assert off.min() > -1e-3 * off.max() and np.diag(coupling).max() < 0.0


def test_an_even_load_of_a_long_roller_leaves_the_law_alone():
    """The sum of a row in the middle of a roller 20 depths long: the response beyond is zero to 1e-4 of its own."""
    long = FiniteLine(LINE.radius, 0.4, 7e-3, 14e-3)
    coupling = slice_coupling(long, 401, WIDEST)
    assert abs(coupling[200].sum()) < 1e-4 * abs(coupling[200, 200])
    assert without_ends(slice_coupling(LINE, 21, WIDEST)).sum() == pytest.approx(0.0, abs=1e-24)


def test_a_concentrated_load_spreads_as_in_three_dimensions():
    """Beside a loaded slice bodies yield as under a force: to the square of slice over distance, 1/5^2."""
    coupling = slice_coupling(LINE, 61, 1e-4, mirrored=0.0)
    step = LINE.length / 61
    apart = step * 7.0
    expected = 2.0 / apart + depth_term(np.array([apart]), 7e-3)[0] + depth_term(np.array([apart]), 14e-3)[0]
    assert coupling[30, 37] == pytest.approx(LINE.body_compliance * step * expected, rel=0.01)


@pytest.mark.parametrize(
    ("profile", "moment", "local"), [(iso, 0.0, 0.03), (iso, 5.7, 0.03), (np.zeros_like, 0.0, 0.04)]
)
def test_coupled_slices_bear_what_the_solution_in_three_dimensions_does(profile, moment, local):
    """41 slices: approach 0.3 %, tilt 1 %; loads 3 to 4 % of the mean, where they change by 20 % a slice."""
    solid = solve_length(LINE, profile, LOAD, moment, cells=(12, 80))
    coupling = slice_coupling(LINE, 41, WIDEST)
    places, w, approach, tilt = balanced_loads(LINE, plane_law(LINE), coupling, profile, LOAD, moment)
    ends = np.concatenate([[0.0], np.cumsum(solid.load_per_length * solid.widths)])
    edges = np.concatenate([[-0.5 * LINE.length], np.cumsum(solid.widths) - 0.5 * LINE.length])
    half = 0.5 * LINE.length / 41
    expected = (np.interp(places + half, edges, ends) - np.interp(places - half, edges, ends)) / (2.0 * half)
    mean = LOAD / LINE.length
    assert np.abs(w - expected).max() < local * mean
    assert approach == pytest.approx(solid.approach, rel=3e-3)
    assert tilt == pytest.approx(solid.tilt, rel=0.01, abs=1e-9)
    assert (w.sum() * 2.0 * half, (w * places).sum() * 2.0 * half) == pytest.approx((LOAD, moment), rel=1e-8, abs=1e-9)
    alone = balanced_loads(LINE, plane_law(LINE), np.zeros((41, 41)), profile, LOAD, moment)[1]
    assert np.abs(alone - expected).max() > 0.15 * mean


def test_stiffness_of_coupled_slices_is_the_derivative_of_their_loads():
    """Central differences of 0.1 nm: their own error is 1e-4."""
    coupling = slice_coupling(LINE, 11, WIDEST)
    overlap = 8e-6 - iso(((np.arange(11) + 0.5) / 11 - 0.5) * LINE.length)

    def power(s: FloatArray) -> tuple[FloatArray, FloatArray]:
        positive = np.maximum(s, 1e-30)
        return np.where(s > 0.0, 1e11 * positive**1.1, 0.0), np.where(s > 0.0, 1.1e11 * positive**0.1, 0.0)

    _, stiffness = coupled_loads(overlap, power, coupling)
    for i in (0, 3, 5):
        step = np.zeros(11)
        step[i] = 1e-10
        change = coupled_loads(overlap + step, power, coupling)[0] - coupled_loads(overlap - step, power, coupling)[0]
        np.testing.assert_allclose(change / 2e-10, stiffness[:, i], rtol=1e-4, atol=1e-4 * stiffness[5, 5])


def test_what_is_wrong_is_said():
    """Every message."""
    with pytest.raises(InputError, match=r"finite line, radius: got 0.0 m.*\n.*race_depth: got -1.0 m; allowed"):
        FiniteLine(0.0, 1.0, 1.0, -1.0)
    with pytest.raises(InputError, match=r"finite line, load: got -1.0 N; allowed: finite and > 0"):
        solve_length(LINE, iso, -1.0)
    with pytest.raises(InputError, match=r"slice coupling: got 0 slices"):
        slice_coupling(LINE, 0, WIDEST)
    with pytest.raises(AnalysisError, match=r"contact: the places that touch did not settle"):
        solve_length(LINE, iso, LOAD, LOAD * LINE.length, cells=(4, 12))
    with pytest.raises(AnalysisError, match=r"slice coupling: no loads after 60 steps; the contact may be wider"):
        coupled_loads(np.full(3, 1e-6), lambda s: (1e11 * s, np.full(3, 1e11)), np.diag(np.full(3, -1e-11)))


@pytest.mark.parametrize("name", ["NU308", "N1014"])
def test_pressures_are_those_of_the_finite_elements_within_5_percent(name):
    """The bar: load over the length 5 % of its mean, largest pressure 5 %; 10 % at an edge, where both are singular."""
    found = compare_lengths(shipped_reference(name), BearingGeometry.named(name), (10, 48))
    assert {(entry.case.profile, entry.case.moment > 0.0) for entry in found} == {
        (name, tilted) for name in ("iso", "straight") for tilted in (False, True)
    }
    for entry in found:
        assert entry.load_error < 0.05
        assert abs(entry.pressure_error) < 0.05
        assert entry.edge_error < 0.1
        assert entry.solution.approach == pytest.approx(entry.case.approach, rel=0.03)
        widths = np.convolve(np.diff(entry.case.places), [0.5, 0.5])
        assert entry.case.load_per_length @ widths == pytest.approx(entry.case.load, rel=1e-5)
        assert entry.case.load_per_length @ (widths * entry.case.places) == pytest.approx(entry.case.moment, abs=0.01)


@pytest.mark.parametrize("name", ["NU308", "N1014"])
def test_the_finite_elements_have_converged_and_calculix_agrees(name):
    """Between the last two meshes loads change by less than half of the bar; CalculiX' penalty yields by 0.3 %."""
    reference = shipped_reference(name)
    assert mesh_change(reference) < 0.03
    assert reference.check["load_by_calculix"] == pytest.approx(reference.check["load"], rel=5e-3)
    assert max(reference.unknowns.values()) > 1e5


def test_a_brick_has_six_rigid_motions_and_even_strains_in_any_shape():
    """Eigenvalues and the patch test: round-off."""
    random = np.random.default_rng(3)
    corners = 0.5 * CORNERS + 0.1 * random.standard_normal((8, 3))
    stiffness = brick_stiffness(corners[None], STEEL)[0]
    values = np.linalg.eigvalsh(stiffness)
    assert np.abs(values[:6]).max() < 1e-12 * values[-1] < values[6]
    # an even stretch along x gives the stress of Hooke's law on the nodes: energy = volume E_oedometric/2
    strained = np.zeros((8, 3))
    strained[:, 0] = 1e-3 * corners[:, 0]
    parts = np.linalg.det(np.einsum("ni,nj->ij", CORNERS, corners)) > 0.0
    assert parts
    shifted = strained + np.array([1.0, -2.0, 0.5])
    np.testing.assert_allclose(
        stiffness @ strained.ravel(), stiffness @ shifted.ravel(), atol=1e-6 * np.abs(stiffness).max()
    )
    energy = strained.ravel() @ stiffness @ strained.ravel()
    constrained = 210e9 * 0.7 / (1.3 * 0.4)
    assert energy == pytest.approx(constrained * 1e-6 * _volume(corners), rel=1e-12)


def _volume(corners: FloatArray) -> float:
    """Volume of a brick by Gauss' rule with two points, exact for trilinear bricks."""
    total = 0.0
    for place in CORNERS / math.sqrt(3.0):
        factors = 1.0 + CORNERS * place
        slopes = [0.125 * CORNERS[:, i] * factors[:, (i + 1) % 3] * factors[:, (i + 2) % 3] for i in range(3)]
        total += float(np.linalg.det(np.stack(slopes) @ corners))
    return total


def test_a_coarse_mesh_gives_the_contact_of_the_fine_one(tmp_path):
    """Elements three times as large: approach 3 %; load and moment exactly; files keep six digits."""
    model, shipped = quarter_model(NU308), shipped_reference("NU308")
    contact = MeshedContact(model, 3.0)
    assert np.abs(contact.compliance - contact.compliance.T).max() < 1e-9 * contact.compliance.max()
    case = contact.solve("straight", np.zeros(contact.places.size), LOAD, 3.0)
    assert case.load_per_length @ contact.widths == pytest.approx(LOAD, rel=1e-9)
    assert case.load_per_length @ (contact.widths * contact.places) == pytest.approx(3.0, rel=1e-9)
    reference = next(entry for entry in shipped.finest if entry.profile == "straight" and entry.moment == 0.0)
    assert case.approach == pytest.approx(reference.approach * LOAD / reference.load, rel=0.03)
    save_reference(LengthReference("X", model, {3.0: [case]}, {3.0: contact.unknowns}, {}), tmp_path / "X.json")
    with pytest.raises(InputError, match=r"reference over the length: got 'X'; allowed: .*NU308; for others run"):
        shipped_reference("X")


@pytest.mark.slow
def test_calculix_finds_the_load_of_the_same_bricks(tmp_path):
    """CalculiX' own contact yields by its penalty: 0.5 % of the load."""
    needed("ccx")
    contact = MeshedContact(quarter_model(NU308), 4.0)
    case = contact.solve("straight", np.zeros(contact.places.size), LOAD, 0.0)
    layers = contact.roller.positions.shape[0]
    found = load_by_calculix(contact.roller, contact.race, np.zeros(layers), STEEL, case.approach, tmp_path)
    assert found == pytest.approx(LOAD, rel=5e-3)
