"""Maps as values: opening, refusing, contacts and oil from the attributes, the laws of a map."""

from __future__ import annotations

import dataclasses
import json
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

import ehdmaps
from ehdmaps.errors import InputError, MapError, OutsideMapError
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.film_field import LOSS_FLOOR
from ehdmaps.maps.records import DERIVED, bearing_from_json, contacts_from_json, contacts_json, lubricant_from_json
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import LUBRICANTS, Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import Status
from tests.cases.laws import CONTACTS, LINE, NU308, OIL, dataset_of, dry_dataset


@pytest.fixture(scope="module")
def emap():
    return EHDMap(dataset_of())


def changed(dataset, name, index, value):
    """Copy of a dataset with one value changed, and without what follows from its films."""
    copy = dataset.copy(deep=True)
    copy[name].values[index] = value
    return copy.drop_vars(list(DERIVED), errors="ignore")


def test_map_stands_alone(emap, tmp_path):
    path = tmp_path / "map.nc"
    emap.dataset.to_netcdf(path)
    opened = open_map(path)
    assert opened.contacts == CONTACTS
    assert opened.lubricant == OIL
    assert opened.bearing == NU308
    assert opened.backbone is None
    xr.testing.assert_identical(opened.dataset["stiffness"], emap.dataset["stiffness"])
    for ours, theirs in zip(
        opened.law("inner")(1e-6, 0.0, 1.0, 330.0), emap.law("inner")(1e-6, 0.0, 1.0, 330.0), strict=True
    ):
        assert ours == theirs


@pytest.mark.parametrize("kind", ["series", "inner", "outer"])
def test_law_gives_the_map_back_at_its_points(emap, kind):
    data = emap.dataset
    law = emap.law(kind)
    names = ["inner", "outer"] if kind == "series" else [kind]
    for i, j, k in ((0, 0, 0), (5, 1, 2), (9, 3, 1), (18, 3, 3), (18, 0, 0), (12, 2, 0)):
        place = {"load": i, "entrainment_speed": j, "temperature": k}
        values = data.sel(contact=names).isel(place)
        stiffness, damping = values["stiffness"].values, values["damping"].values
        k_all = 1.0 / np.sum(1.0 / stiffness)
        w, k_got, c_got = law(
            float(values["approach"].sum()),
            0.0,
            float(values["entrainment_speed"]),
            float(values["temperature"]),
        )
        # Errors of the table and, for film compliance and c, of reading a line of 19 loads off its nodes.
        assert w == pytest.approx(float(values["load"]), rel=3e-4)
        assert k_got == pytest.approx(k_all, rel=1e-3)
        assert c_got == pytest.approx(np.sum(damping * (k_all / stiffness) ** 2), rel=1e-2)


def test_bare_contact(emap):
    bare = EHDMap(dataset_of(contacts=(LINE,), speeds=(0.5, 1.0), temperatures=(330.0,), bearing=None))
    assert bare.bearing is None
    law = bare.law("line")
    assert law(LINE.structural_approach(1e4), 0.0, 0.0, 330.0)[0] == pytest.approx(1e4, rel=1e-10)
    for kind in ("series", "inner"):
        with pytest.raises(InputError, match=f"kind: got '{kind}'; allowed in this map: line"):
            bare.law(kind)
    with pytest.raises(InputError, match="kind: got 'line'; allowed in this map: series, inner, outer"):
        emap.law("line")
    with pytest.raises(InputError, match="outside: got 'no'"):
        emap.law("inner", outside="no")


@pytest.mark.parametrize("speeds", [(0.0, 0.3, 1.0), (0.0,)])
def test_dry_maps_make_the_dry_law(speeds):
    law = EHDMap(dry_dataset(speeds=speeds)).law("series")
    loads = np.array([1e-2, 30.0, 1e3, 1e4, 9e5])
    delta = sum(contact.structural_approach(loads) for contact in CONTACTS)
    w, k, c = law(delta, [[1.0], [-1.0]], speeds[-1], 330.0)
    assert w == pytest.approx(np.array([loads, loads]), rel=1e-9)
    compliance = sum(contact.structural_compliance(loads) for contact in CONTACTS)
    assert k == pytest.approx(np.array([1.0 / compliance] * 2), rel=1e-8)
    assert np.all(c == 0.0)
    assert law(-1e-9, 1.0, speeds[-1], 330.0) == (0.0, 0.0, 0.0)
    with pytest.raises(OutsideMapError, match="entrainment_speed"):
        law(1e-6, 0.0, 5.0, 330.0)
    for outside in ("clamp", "asymptote"):
        other = EHDMap(dry_dataset(speeds=speeds)).law("series", outside=outside)
        assert other(delta, 0.0, 5.0, 330.0)[0] == pytest.approx(loads, rel=1e-9)


def test_standstill_on_the_axis_does_not_matter(emap):
    with_standstill = EHDMap(dataset_of(speeds=(0.0, 0.3, 0.6, 1.2, 2.4)))
    for speed in (0.0, 0.1, 0.7):
        assert with_standstill.law("inner")(1e-6, 0.0, speed, 330.0) == pytest.approx(
            emap.law("inner")(1e-6, 0.0, speed, 330.0), rel=1e-12
        )


def test_isolated_filled_points_are_taken_and_clusters_are_holes(emap):
    data = changed(emap.dataset, "status", (0, 3, 1, 2), int(Status.DIVERGED))
    data = changed(data, "filled", (0, 3, 1, 2), 1)
    filled = EHDMap(data)
    assert filled.law("inner")(1e-6, 0.0, 1.0, 330.0) == emap.law("inner")(1e-6, 0.0, 1.0, 330.0)
    assert filled.reach().whole
    assert EHDMap(changed(data, "filled", (0, 4, 2, 2), 1)).reach().whole
    for neighbour in ((0, 4, 1, 2), (0, 3, 0, 2), (0, 3, 1, 3)):
        cluster = EHDMap(changed(data, "filled", neighbour, 1))
        assert not cluster.reach(("inner",)).whole
        assert cluster.reach(("outer",)).whole


@pytest.mark.parametrize(("name", "word"), [("film_offset", "film offset"), ("film_compliance", "stiffness")])
def test_impossible_values_are_refused(emap, name, word):
    wrong = changed(emap.dataset, name, (1, 3, 1, 2), -1e-9)
    with pytest.raises(MapError, match=f"1 points whose {word} is not positive, outer at"):
        EHDMap(wrong).law("series")


def test_negative_damping_is_lifted(emap):
    law = EHDMap(changed(emap.dataset, "loss_compliance", (0, 9, 1, 2), -1e-20)).law("inner")
    values = emap.dataset.isel(contact=0, load=9, entrainment_speed=1, temperature=2)
    _, _, c = law(float(values["approach"]), 0.0, 0.6, float(values["temperature"]))
    inner = law.contacts[0]
    half = float(half_width(float(values["load"]), inner.radius, inner.reduced_modulus))
    # Where the loss is zero the lifted one is 1.6 of its floor; the damping of these maps is not far above it.
    assert 0.0 < c < 2.0 * LOSS_FLOOR * float(values["stiffness"]) * half / 0.6


def test_broken_files_and_attributes_are_refused(emap, tmp_path):
    with pytest.raises(MapError, match=r"nothing\.nc: cannot be read .*expected a map file"):
        open_map(tmp_path / "nothing.nc")
    (tmp_path / "text.nc").write_text("no map")
    with pytest.raises(MapError, match=r"text\.nc: cannot be read"):
        open_map(tmp_path / "text.nc")
    with pytest.raises(MapError, match="map: variable film_compliance is missing"):
        EHDMap(emap.dataset.drop_vars("film_compliance"))
    for attribute, text in (
        ("contacts", "[{}]"),
        ("contacts", '[{"material": {"youngs_modulus": -1, "poisson_ratio": 0.3}}]'),
        ("lubricant", "null"),
        ("lubricant", "not JSON"),
        ("geometry", '{"name": 1}'),
    ):
        names = {"contacts": "contacts", "lubricant": "lubricant", "geometry": "bearing"}
        with pytest.raises(MapError, match=f"attribute {attribute}: does not read .*generate the map again"):
            getattr(EHDMap(emap.dataset.assign_attrs({attribute: text})), names[attribute])
    swapped = json.dumps(json.loads(emap.dataset.attrs["contacts"])[::-1])
    with pytest.raises(MapError, match="attribute contacts: names outer, inner; the contact axis has inner, outer"):
        _ = EHDMap(emap.dataset.assign_attrs(contacts=swapped)).contacts


TAIT_DOOLITTLE = {
    "doolittle_slope": 4.5,
    "occupied_fraction": 0.66,
    "occupied_expansion": -7e-4,
    "volume_expansion": 8e-4,
    "bulk_modulus": 8.7e9,
    "bulk_modulus_decay": 6.3e-3,
    "bulk_modulus_slope": 11.0,
    "reference_temperature": 313.15,
}

OILS = [
    *(Lubricant.named(name) for name in LUBRICANTS),
    Lubricant.barus(viscosity=0.1, pressure_viscosity=2e-8, density=880.0, density_law="incompressible"),
    Lubricant.roelands(viscosity_40=1e-4, viscosity_100=1e-5, density=870.0, roelands_z=0.6),
    Lubricant.fva3(viscosity=0.05, density=880.0, pressure_viscosity_40=2e-8, pressure_viscosity_100=1.5e-8),
    Lubricant.own("tait-doolittle", TAIT_DOOLITTLE, viscosity_40=2e-5, viscosity_100=4e-6, density=810.0),
]


@pytest.mark.parametrize("oil", OILS, ids=lambda oil: oil.name)
def test_oils_come_back_from_their_records(oil):
    from ehdmaps.maps.records import record_json

    assert lubricant_from_json(record_json(oil.record())) == oil


@pytest.mark.parametrize("key", ["viscosity_law", "viscosity_over_temperature"])
def test_unknown_laws_of_an_oil_are_refused(key):
    record = OIL.record() | {key: "own"}
    with pytest.raises(MapError, match=r"attribute lubricant: does not read .*own"):
        lubricant_from_json(json.dumps(record))


def test_the_heat_of_steel_stays_out_of_records():
    warm = dataclasses.replace(CONTACTS[0], material=dataclasses.replace(STEEL, conductivity=30.0))
    assert "conductivity" not in contacts_json(CONTACTS)
    assert json.loads(contacts_json([warm]))[0]["material"]["conductivity"] == 30.0
    assert contacts_from_json(contacts_json([warm])) == (warm,)


def test_contacts_and_bearing_come_back_from_their_records(emap):
    assert contacts_from_json(emap.dataset.attrs["contacts"]) == CONTACTS
    assert bearing_from_json("null") is None


@pytest.mark.parametrize("dry", [False, True])
def test_a_law_of_one_load_is_refused_for_that_reason(dry):
    emap = EHDMap((dry_dataset() if dry else dataset_of()).isel(load=[2]))
    told = r"law of inner, outer: the map has one load, .* N/mm; a law needs two or more; add some to `load`"
    for refused in (lambda: emap.law("series"), emap.check_usable):
        with pytest.raises(MapError, match=told):
            refused()
    if dry:
        assert emap.film_field().dry
    else:
        with pytest.raises(MapError, match=told):
            emap.film_field()


def test_solve_one_point():
    point = OperatingPoint(5e4, 1.0, 330.0)
    solution = ehdmaps.solve(CONTACTS[0], OIL, point, solver="formula")
    assert solution.status is ehdmaps.Status.CONVERGED
    same = ehdmaps.solve(CONTACTS[0], OIL, point, solver=FormulaSolver())
    np.testing.assert_equal(dataclasses.asdict(solution), dataclasses.asdict(same))  # NaN where no error is stated
    with pytest.raises(InputError, match="solver: got 'magic'; allowed: hertz, formula, reynolds"):
        ehdmaps.solve(CONTACTS[0], OIL, point, solver="magic")


def test_public_names():
    for name in ehdmaps.__all__:
        assert getattr(ehdmaps, name) is not None
    assert set(ehdmaps.__all__) <= set(dir(ehdmaps))
    with pytest.raises(AttributeError, match="'ehdmaps' has no attribute 'nothing'"):
        _ = ehdmaps.nothing


def test_import_is_light():
    heavy = ("numba", "xarray", "matplotlib", "PyFoam", "scipy", "pint", "netCDF4")
    code = f"import sys, ehdmaps; print([name for name in {heavy} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_law_is_made_once_and_counts_for_each_that_asked():
    """The second law of a map shares its tables, so that numbers are equal, and has counts of its own."""
    emap = EHDMap(dataset_of())
    first, second = (emap.law("series", outside="clamp") for _ in range(2))
    assert first is not second
    assert first.plain_table is second.plain_table
    fast = 10.0 * first.speed_range[1]
    numbers = first.at(fast, 330.0).memory.table.cells
    assert np.array_equal(numbers, second.at(fast, 330.0).memory.table.cells)
    assert first.outside_counts == second.outside_counts
    second.at(fast, 330.0)
    assert first.outside_counts != second.outside_counts
    assert emap.law("series", outside="error").plain_table is not first.plain_table
    # with a centrifugal load too
    assert first.table.inner is emap.law("series", outside="clamp").table.inner
