"""What the commands do, called from Python: jobs from values, maps in memory and in files, comparisons, many points."""

from __future__ import annotations

import dataclasses
import tomllib

import numpy as np
import pytest
import xarray as xr

import ehdmaps
from ehdmaps import STEEL, BearingGeometry, Job, LineContact, Lubricant, OperatingPoint
from ehdmaps.errors import InputError, MapError, SolverError
from ehdmaps.maps import schema
from ehdmaps.maps.records import MODEL_ERRORS, SPACING_ERRORS
from ehdmaps.physics.catalogue import estimate, estimate_from_dimensions
from ehdmaps.physics.closed_form import FormulaSolver, HertzSolver
from ehdmaps.physics.solution import ContactSolverDefaults, Status

NU308, FVA3 = BearingGeometry.named("NU308"), Lubricant.named("FVA3")
CONTACT = NU308.contacts(STEEL, "iso16281")[0]
AXES = {"loads": (1e4, 33333.3, 1e5), "entrainment_speeds": (0.7, 2.0), "temperatures": (313.15, 333.15)}
LEFT_OUT = ("solve_seconds", *MODEL_ERRORS, *SPACING_ERRORS)  # a time; what only maps have
SAME = [entry.name for entry in schema.table() if not entry.axis and entry.name not in LEFT_OUT]


def _held(dataset: xr.Dataset) -> list[str]:
    """What the physics of the solver has: at least all that a map needs."""
    assert {entry.name for entry in schema.table() if entry.required} <= set(dataset.variables)
    return [name for name in SAME if name in dataset]


def built(**changes: object) -> Job:
    return Job.build(**{"bearing": NU308, "lubricant": FVA3, "solver": "formula", **AXES, **changes})


OILS = [
    FVA3,
    Lubricant.named("Spirax MA 80W"),
    Lubricant.barus(viscosity=0.1, pressure_viscosity=2e-8, density=880.0),
    Lubricant.barus(viscosity=0.1, pressure_viscosity=0.0, density=880.0, density_law="incompressible"),
    Lubricant.barus(
        viscosity_40=95e-6,
        viscosity_100=10.6e-6,
        pressure_viscosity_40=2.2e-8,
        pressure_viscosity_100=1.5e-8,
        density=880.0,
        density_slope=-0.61,
    ),
    Lubricant.roelands(viscosity_40=95e-6, viscosity_100=10.6e-6, pressure_viscosity="so-klaus", density=880.0),
    Lubricant.roelands(viscosity=0.04, pressure_viscosity=1.7e-8, density=870.0),
    Lubricant.roelands(viscosity=0.04, roelands_z=0.6, pressure_viscosity=1.7e-8, density=870.0),
    Lubricant.roelands(viscosity=0.04, roelands_z=0.6, density=870.0, fitted_pressure=1.1e9),
    Lubricant.fva3(viscosity=0.05, pressure_viscosity=2e-8, density=880.0),
    Lubricant.barus(viscosity=0.1, pressure_viscosity=2e-8, density=880.0, thermal_conductivity=0.14),
    dataclasses.replace(Lubricant.named("Spirax MA 80W"), thermal_conductivity=0.14, heat_capacity=1900.0),
    dataclasses.replace(
        Lubricant.fva3(viscosity=0.05, pressure_viscosity=2e-8, density=880.0), label='"quoted" \\ oil'
    ),
]

OTHERWISE = dataclasses.replace(
    OILS[5], pressure_viscosity=dataclasses.replace(OILS[5].pressure_viscosity, pressure_viscosity_40=1e-8)
)
"""An oil whose record says one thing and whose correlation another."""


@pytest.mark.parametrize("oil", OILS, ids=lambda oil: oil.label or oil.name)
def test_a_job_from_values_is_what_its_text_says(oil):
    job = built(lubricant=oil)
    assert job.lubricant == oil
    assert (job.lubricant.label, job.bearing) == (oil.label, NU308)
    assert (job.loads, job.entrainment_speeds, job.temperatures) == tuple(AXES.values())
    assert tomllib.loads(job.text)["schema"] == 1


def test_numbers_are_kept_to_the_digits_of_a_job_file():
    oil = Lubricant.barus(viscosity=0.1 / 3.0, pressure_viscosity=2e-8 / 3.0, density=880.0)
    job = built(loads=(1e5 / 3.0,), lubricant=oil)
    # Half a unit of the fifteenth digit.
    assert job.loads[0] == pytest.approx(1e5 / 3.0, rel=5e-15)
    assert job.lubricant.record()["viscosity"] == pytest.approx(0.1 / 3.0, rel=5e-15)


BEARINGS = [
    NU308,
    dataclasses.replace(NU308, diametral_clearance=20e-6, label="drive end"),
    estimate("NU206"),
]


@pytest.mark.parametrize("bearing", BEARINGS, ids=lambda bearing: bearing.title)
def test_a_job_from_values_keeps_the_bearing(bearing):
    job = built(bearing=bearing)
    assert job.bearing == bearing
    assert job.bearing.label == bearing.label


def test_a_bearing_by_its_dimensions_keeps_them():
    job = built(bearing=dataclasses.replace(NU308, name="mine", rollers=11))
    assert dataclasses.replace(job.bearing, name="mine") == dataclasses.replace(NU308, name="mine", rollers=11)


def test_a_bare_contact_brings_material_and_law():
    contact = LineContact("line", 5.5e-3, dataclasses.replace(STEEL, youngs_modulus=2e11), "half_space", None, 5e-3)
    assert built(bearing=None, contact=contact).contacts == (contact,)
    by_length = LineContact("line", 5.5e-3, STEEL, "palmgren", 15e-3)
    assert built(bearing=None, contact=by_length).contacts == (by_length,)


def test_heat_of_the_solids_is_kept():
    material = dataclasses.replace(STEEL, conductivity=30.0, heat_capacity=800.0)
    assert built(material=material).contacts[0].material == material


def test_solver_keys_and_the_rest_are_kept():
    job = built(solver="reynolds", solver_options={"density": 4.5}, fill="none", backbone="none", law_check=3, name="a")
    assert job.solver_options == {"density": 4.5}
    assert (job.solver, job.fill, job.backbone, job.law_check, job.name) == ("reynolds", "none", "none", 3, "a")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"bearing": None}, "Job.build, bearing and contact: got none; allowed: one of the two"),
        ({"contact": CONTACT}, "Job.build, bearing and contact: got both; allowed: one of the two"),
        ({"loads": (2e4, 1e4)}, r"Job.build: \[grid\] load: got 10 N/mm after 20 N/mm; allowed: rising values"),
        ({"solver": "reynold"}, r"Job.build: \[solver\] name: got 'reynold'"),
        (
            {"bearing": dataclasses.replace(estimate_from_dimensions(30e-3, 62e-3, 16e-3, 38e3), rollers=9)},
            "estimated from more than its designation, or dimensions, and its static rating; allowed: a",
        ),
        (
            {"lubricant": OTHERWISE},
            "Job.build, lubricant: pressure_viscosity_40 of 'own oil' cannot be said in a job file",
        ),
    ],
)
def test_values_that_no_job_may_have_are_refused(changes, message):
    with pytest.raises(InputError, match=message):
        built(**changes)


def test_a_map_in_memory_and_in_a_file_hold_the_same(tmp_path):
    job = built()
    here = ehdmaps.generate(job)
    there = ehdmaps.generate(job, tmp_path / "a.nc")
    for name in _held(here):
        xr.testing.assert_identical(here[name], there[name])
    opened = ehdmaps.open_map(tmp_path / "a.nc")
    assert opened.dataset.attrs["job_toml"] == job.text
    assert ehdmaps.read_job(tmp_path / "a.nc").loads == job.loads
    w, _, _ = ehdmaps.EHDMap(here).law("series")(3e-6, 0.0, 1.0, 313.15)
    assert w == opened.law("series")(3e-6, 0.0, 1.0, 313.15)[0]


def test_a_map_in_memory_can_be_written_and_opened(tmp_path):
    dataset = ehdmaps.generate(built(solver="reynolds", solver_options={"density": 4.5}, temperatures=(333.15,)))
    dataset.to_netcdf(tmp_path / "a.nc")
    assert ehdmaps.open_map(tmp_path / "a.nc").backbone is None


def test_the_solver_of_a_job_may_be_another(tmp_path):
    assert ehdmaps.generate(built(), solver="hertz").attrs["solver"] == "hertz"
    assert ehdmaps.generate(built(), solver=HertzSolver()).attrs["solver"] == "hertz"
    (tmp_path / "job.toml").write_text(built().text)
    assert ehdmaps.generate(tmp_path / "job.toml", solver="formula").attrs["solver"] == "formula"
    with pytest.raises(InputError, match="solver: got 'hurtz'; allowed: hertz, formula, reynolds, openfoam"):
        ehdmaps.generate(built(), solver="hurtz")


def test_a_map_is_not_written_over_its_job(tmp_path):
    (tmp_path / "job.toml").write_text(built().text)
    with pytest.raises(InputError, match=r"output: got .*job.toml, which would be written over"):
        ehdmaps.generate(tmp_path / "job.toml", tmp_path / "job.toml")


def test_maps_are_compared_from_files_and_from_memory(tmp_path):
    first = ehdmaps.generate(built(), tmp_path / "a.nc")
    second = ehdmaps.generate(built(solver="hertz"))
    for one in (first, ehdmaps.EHDMap(first), tmp_path / "a.nc"):
        found = ehdmaps.compare(one, second)
        assert (found.common, found.solved, found.points) == (24, 24, (24, 24))
        assert "solver" in found.differing
        expected = second["stiffness"] / first["stiffness"] - 1.0
        # Rounding of a difference of two nearly equal numbers.
        np.testing.assert_allclose(found.relative["stiffness"], expected, atol=1e-14)
    apart = ehdmaps.compare(first, ehdmaps.generate(built(loads=(2e4, 3e4))))
    assert apart.common == 0 and apart.between is not None and not apart.differences
    with pytest.raises(MapError, match="first and second: no load in common"):
        ehdmaps.compare(first, ehdmaps.generate(built(loads=(2e5, 3e5))))


GRID = xr.Dataset(
    coords={
        "load": list(AXES["loads"]),
        "entrainment_speed": list(AXES["entrainment_speeds"]),
        "temperature": list(AXES["temperatures"]),
    }
)


@pytest.mark.parametrize("solver", ["formula", "reynolds"])
def test_points_over_three_dims_are_those_of_a_map(solver):
    short = GRID.isel(temperature=[0])
    found = ehdmaps.solve_points(NU308.contacts(STEEL, "iso16281"), FVA3, short, solver)
    solved = {"films": "solved"} if solver == "reynolds" else {}
    made = ehdmaps.generate(built(solver=solver, temperatures=AXES["temperatures"][:1], solver_options=solved))
    assert found["stiffness"].dims == schema.DIMS
    for name in (name for name in _held(made) if name != "filled"):
        xr.testing.assert_identical(found[name], made[name])


def test_single_points_are_those_of_solve():
    points = xr.Dataset({"load": ("point", [1e4, 5e4]), "entrainment_speed": ("point", [1.0, 2.0])})
    found = ehdmaps.solve_points(CONTACT, FVA3, points.assign(temperature=313.15), "formula")
    assert found["stiffness"].dims == ("contact", "point")
    for index, (load, speed) in enumerate(((1e4, 1.0), (5e4, 2.0))):
        one = ehdmaps.solve(CONTACT, FVA3, OperatingPoint(load, speed, 313.15), "formula")
        assert found["stiffness"].values[0, index] == one.stiffness
        assert found["damping"].values[0, index] == one.damping
    assert found["load"].attrs["units"] == "N m-1"
    assert found["entrainment_speed"].dims == ("point",)


def test_numbers_alone_are_one_point():
    points = xr.Dataset({"load": 1e4, "entrainment_speed": 1.0, "temperature": 313.15})
    assert ehdmaps.solve_points(CONTACT, FVA3, points, "hertz")["approach"].dims == ("contact",)


class Failing(FormulaSolver):
    """Gives up below 2 m/s."""

    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        if entrainment_speed < 2.0:
            raise SolverError("too slow for me")
        return super().solve_line(contact, lubricant, loads, entrainment_speed, temperature)


class Old:
    """A solver without what `ContactSolverDefaults` gives."""

    name = "old"
    version = None

    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        return FormulaSolver().solve_line(contact, lubricant, loads, entrainment_speed, temperature)

    def settings(self):
        return {}


class Complete(ContactSolverDefaults, Old):
    """The same with it."""


def test_a_solver_that_lacks_members_is_told_which():
    for call in (
        lambda: ehdmaps.solve_points(CONTACT, FVA3, GRID, Old()),
        lambda: ehdmaps.generate("nu308", solver=Old()),
    ):
        with pytest.raises(InputError, match=r"inherit from .*\.ContactSolverDefaults") as caught:
            call()
        lacking = [problem.split(":")[0] for problem in caught.value.problems]
        assert lacking == [
            "solver Old, slow",
            "solver Old, wants_backbone",
            "solver Old, natural_frequencies",
            "solver Old, provenance",
            "solver Old, film_spectrum",
            "solver Old, line_spectra",
        ]
    found = ehdmaps.solve_points(CONTACT, FVA3, GRID, Complete())
    np.testing.assert_array_equal(found["stiffness"], ehdmaps.solve_points(CONTACT, FVA3, GRID, "formula")["stiffness"])


@pytest.mark.parametrize("wrong", ["5e4", None, 1j, [1.0], 10**400])
@pytest.mark.parametrize("name", ["load", "entrainment_speed", "temperature"])
def test_a_point_of_what_is_no_number_is_refused(name, wrong):
    values = {"load": 5e4, "entrainment_speed": 1.0, "temperature": 313.15} | {name: wrong}
    with pytest.raises(InputError, match=rf"{name}: got .*, no number of type float; allowed: \["):
        ehdmaps.OperatingPoint(**values)


@pytest.mark.parametrize("solver", [None, 3, FormulaSolver])
def test_what_is_no_solver_is_told_in_one_line(solver):
    point = ehdmaps.OperatingPoint(5e4, 1.0, 313.15)
    with pytest.raises(InputError, match=r"solver: got .*, which is no solver; allowed: hertz, formula") as caught:
        ehdmaps.solve(CONTACT, FVA3, point, solver)
    assert len(caught.value.problems) == 1


def test_points_that_fail_are_results():
    found = ehdmaps.solve_points(CONTACT, FVA3, GRID, Failing())
    slow, fast = (found.isel(entrainment_speed=index) for index in (0, 1))
    assert np.all(slow["status"] == int(Status.FAILED))
    assert set(slow["reason"].values.ravel()) == {"too slow for me"}
    assert np.all(np.isnan(slow["stiffness"]))
    assert np.all(fast["status"] == int(Status.CONVERGED))


@pytest.mark.parametrize(
    ("points", "contacts", "message"),
    [
        (GRID.drop_vars("load"), CONTACT, "points, load: missing; allowed: a number, or an array over any dims"),
        (GRID.assign_coords(load=[-1.0, 1e4, 1e5]), CONTACT, "points, load: got -1.0 N/m; allowed: finite and > 0"),
        (GRID.assign_coords(temperature=[200.0, 300.0]), CONTACT, "points, lubricant 'FVA3', temperature"),
        (GRID.expand_dims(contact=["inner"]), CONTACT, "points: got the dim contact; allowed: other dims"),
        (GRID, (CONTACT, CONTACT), "contacts: got inner, inner; allowed: at least one, with names apart"),
        (GRID, (), "contacts: got none; allowed: at least one, with names apart"),
        (GRID.isel(load=[]), CONTACT, "points: got none; allowed: at least one"),
    ],
)
def test_points_that_are_none_are_refused(points, contacts, message):
    with pytest.raises(InputError, match=message):
        ehdmaps.solve_points(contacts, FVA3, points, "formula")
