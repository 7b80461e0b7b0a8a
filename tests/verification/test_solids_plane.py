"""Plane finite elements of roller and rings against closed forms, and what comes with the package."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from importlib import resources

import numpy as np
import pytest

from ehdmaps.errors import DependencyError, InputError
from ehdmaps.physics.approach import FE_LOAD, half_space, shipped_names
from ehdmaps.physics.bearing import BEARINGS, BearingGeometry
from ehdmaps.physics.solids import STEEL, reduced_modulus
from ehdmaps.solids.law import fitted, series_of
from ehdmaps.solids.mesh_plane import ring_mesh, roller_mesh
from ehdmaps.solids.plane import body_yield
from ehdmaps.solids.plane_bearing import solve_contact
from ehdmaps.solids.sections import sections_of

pytest.importorskip("gmsh", exc_type=ImportError)
pytest.importorskip("skfem", exc_type=ImportError)

UNIT = (1.0 - STEEL.poisson_ratio**2) / (math.pi * STEEL.youngs_modulus)
"""(1 - nu^2)/(pi E) of steel [m2/N]."""

MODULUS = reduced_modulus(STEEL, STEEL)
COARSE = 0.3
SHIPPED = resources.files("ehdmaps.physics") / "shipped"
RADIUS = 7e-3
WIDTHS = np.array([2e-5, 8e-5, 3.2e-4])


def roller(grading: float, bore: float = 0.0) -> np.ndarray:
    mesh = roller_mesh(RADIUS, bore, 0.5 * grading * WIDTHS[0], grading)
    return body_yield(mesh, STEEL, WIDTHS, roller=True).compliance


def test_a_roller_between_two_plates():
    """K. L. Johnson, Contact Mechanics, 1985, section 5.6: w (1 - nu^2)/(pi E) [2 ln(4 R/b) - 1] from contact to axis.

    A quarter of 2 w (1 - nu^2)/(pi E) of that lies in the gap between the curved surfaces. 1e-3 bounds the
    discretisation by these coarse elements; with half of their size the error is an eighth or less.
    """
    exact = UNIT * (2.0 * np.log(4.0 * RADIUS / WIDTHS) - 1.5)
    coarse, fine = (np.abs(roller(grading)[:2] / exact[:2] - 1.0) for grading in (COARSE, 0.5 * COARSE))
    assert np.all(coarse < 1e-3)
    assert np.all(fine < coarse / 8.0)


def test_a_half_plane():
    """Surface of a half plane under the pressure of Hertz: slope -(2 (1 - nu^2)/E) (p0/b) (x - sqrt(x^2 - b^2)).

    The block is a thousand times as thick as the contact is wide. 2e-3 bounds discretisation and thickness.
    """
    width = 1e-3
    mesh = ring_mesh(2.0, 1.0, 0.1 * width, 0.2)
    found = body_yield(mesh, STEEL, [width])
    x = 2.0 * np.tan(found.angles)
    place = (x > 0.0) & (x < 30.0 * width)
    fine = np.linspace(0.0, 30.0 * width, 30001)
    slope = fine - np.sqrt(np.maximum(fine**2 - width**2, 0.0))
    sunk = np.concatenate(([0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(fine)))) * 4.0 * UNIT / width**2
    fall = found.surface[0][np.argmin(np.abs(x))] - found.surface[0][place]
    np.testing.assert_allclose(fall, np.interp(x[place], fine, sunk), atol=2e-3 * sunk[-1])


def test_a_shaft_of_its_own():
    """The energy of a body with a balanced load is that of the surface's sinking, which is found on another way.

    Under the pressure of Hertz the middle sinks by (1 - nu^2)/(2 pi E) more than the mean that the energy takes; 1e-3
    bounds the discretisation.
    """
    mesh = ring_mesh(26e-3, 0.0, 0.1 * WIDTHS[0], 0.2, 20e-3)
    found = body_yield(mesh, STEEL, WIDTHS, shaft_radius=20e-3)
    middle = found.surface[:, np.argmin(found.angles)]
    np.testing.assert_allclose(found.compliance, middle - 0.5 * UNIT, rtol=1e-3)


def test_thin_hollow_rollers_are_rings():
    """Half of the shortening of a thin ring under two loads, (pi/8 - 1/pi) w r^3/(E' I), E' = E/(1 - nu^2).

    It leaves out terms with (t/r)^2, so that half of the wall has about a quarter of the difference: 2 % bounds that
    of a wall of a tenth.
    """
    differences = []
    for wall in (0.1, 0.05):
        thickness, mean = wall * RADIUS, (1.0 - 0.5 * wall) * RADIUS
        bending = STEEL.youngs_modulus / (1.0 - STEEL.poisson_ratio**2) * thickness**3 / 12.0
        thin = (math.pi / 8.0 - 1.0 / math.pi) * mean**3 / bending
        differences.append(roller(0.2, RADIUS - thickness)[1] / thin - 1.0)
    assert 0.0 < differences[0] < 0.02
    assert 0.15 < differences[1] / differences[0] < 0.35


def test_the_law_of_a_half_space_comes_back():
    """Compliances of a half space give its law: Hertz' width, approach, slope; round-off."""
    radius, depth = 5.5e-3, 5e-3
    widths = np.geomspace(1e-5, 4e-4, 9)
    compliance = 4.0 / (math.pi * MODULUS) * (np.log(2.0 * depth / widths) + 0.25)
    series = series_of(widths, compliance, radius, MODULUS)
    np.testing.assert_allclose(series.load, math.pi * MODULUS * widths**2 / (8.0 * radius), rtol=1e-6)
    np.testing.assert_allclose(series.approach, half_space(series.load, depth, radius, MODULUS), rtol=1e-6)
    fit = fitted(series, compliance, radius, MODULUS)
    assert fit.fe_approach == pytest.approx(half_space(FE_LOAD, depth, radius, MODULUS), rel=1e-6)
    assert max(fit.approach_error, fit.compliance_error, abs(fit.slope_error)) < 1e-5


@pytest.mark.parametrize("name", sorted(BEARINGS))
def test_what_comes_with_the_package(name):
    """The numbers are those of this program: 5e-4 bounds the coarser mesh. Meshes and CalculiX stood by them."""
    bearing = BearingGeometry.named(name)
    record = json.loads((SHIPPED / f"{name}.json").read_text("utf-8"))
    sections = sections_of(bearing)
    assert record["sections"] == {**sections.record(), "material": {**record["sections"]["material"]}}
    found = solve_contact(bearing, sections, "outer", COARSE)
    assert found.fit.fe_approach == pytest.approx(record["contacts"]["outer"]["fe_approach"], rel=5e-4)
    for contact in record["contacts"].values():
        meshes = contact["convergence"]
        assert abs(meshes["limit"] / contact["fe_approach"] - 1.0) < 2e-5
        assert 3.0 < meshes["order"] < 4.5  # of energies of second-order elements: 4
        assert contact["contact_check"]["difference"] < 5e-4
        assert contact["compliance_error"] < 1e-3


def test_all_named_bearings_come_with_the_package():
    assert shipped_names() == tuple(sorted(BEARINGS))


def test_rigid_seats_and_thin_rings_are_stiffer():
    nu308 = BearingGeometry.named("NU308")
    usual, rigid, hollow = (
        solve_contact(nu308, sections_of(nu308, **given), "inner", COARSE).fit.fe_approach
        for given in ({}, {"seat": "rigid"}, {"roller_bore": 7e-3})
    )
    assert rigid < usual < hollow


def test_without_scikit_fem(monkeypatch):
    mesh = roller_mesh(RADIUS, 0.0, 1e-3, 1.0)
    monkeypatch.setitem(sys.modules, "skfem", None)
    with pytest.raises(DependencyError, match=r'scikit-fem cannot be loaded .*pip install "ehdmaps\[solids\]"'):
        body_yield(mesh, STEEL, [1e-4], roller=True)


def test_impossible_sections():
    nu308 = BearingGeometry.named("NU308")
    with pytest.raises(InputError) as caught:
        sections_of(nu308, bore=52e-3, roller_bore=14e-3, housing_diameter=80e-3)
    assert [problem.split(":")[0] for problem in caught.value.problems] == [
        "solids, roller_bore",
        "solids, bore",
        "solids, outside_diameter",
    ]
    with pytest.raises(InputError, match=r"solids, seat: got 'soft'; allowed: elastic, rigid"):
        sections_of(nu308, seat="soft")
    with pytest.raises(InputError, match=r"solids, shaft_bore: got -1.0 m; allowed: finite and >= 0"):
        sections_of(nu308, shaft_bore=-1.0)
    with pytest.raises(InputError, match="no bore and outside_diameter of the bearing 'own', whose designation"):
        sections_of(BearingGeometry("own", 52e-3, 80e-3, 14e-3, 15e-3, 12, 0.0))


def test_a_pipe_that_breaks_after_meshing_is_an_error_and_not_the_end():
    """gmsh lets SIGPIPE end its process; a sweep with a dead worker writes into a broken pipe."""
    script = (
        "import os\n"
        "from ehdmaps.solids.mesh_plane import gmsh_session\n"
        "with gmsh_session('a test'): pass\n"
        "read, write = os.pipe(); os.close(read)\n"
        "try: os.write(write, b'x')\n"
        "except BrokenPipeError: print('an error')\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "an error\n"), done.stderr
