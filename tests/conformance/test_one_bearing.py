"""`mbs bearing` of every kind of bearing: one page, one table, one dataset, one CSV, one figure."""

from __future__ import annotations

import csv
import re
import tomllib

import numpy as np
import pytest
import xarray as xr

from tests.cases.commands import check_units, run

KINDS = {
    "NU308": (),
    "NA4908": (),
    "NN3014": (),
    "NNCF5010": (),
    "6208": (),
    "3208": (),
    "QJ208": ("--axial", "2 kN"),
    "1208": (),
    "7208B": ("--axial", "2 kN"),
    "51208": ("--axial", "20 kN"),
    "32208": ("--axial", "2 kN"),
    "NUP308": ("--axial=-500 N",),
    "NJ308": ("--axial", "500 N"),
}
"""Designations, one of each kind, with the options without which they carry nothing."""

TWO_ROWS = ("NN3014", "NNCF5010", "3208", "QJ208", "1208")
"""Those whose elements stand in two rows, or have two contacts more."""

OLD = {"loaded_elements": "loaded_{}s", "highest_raceway_load": "highest_{}_load"}
"""Names that all kinds have, and those that each had for itself."""

SHARED = (
    "stiffness_along", "stiffness_across", "damping_along", "damping_across", "displacement_along",
    "displacement_across", "highest_raceway_load", "loaded_elements", "film_parameter", "hertz_pressure",
    "central_film", "minimum_film", "outside",
)  # fmt: skip
"""Variables of the dataset of every kind, beside loads of rolling elements."""

SEEN = {}
"""Dimensions, units and words of the first kind."""


@pytest.mark.parametrize("name", KINDS)
def test_one_bearing(name, capsys, tmp_path, monkeypatch):
    """The same names, units and words for all, and files that say the same as the page."""
    monkeypatch.chdir(tmp_path)
    ask = (name, "--load", "2 kN", "--speed", "1500 rpm", "--law", "hertz:1.25e-5 s", *KINDS[name])
    status, page, err = run(capsys, "bearing", *ask, "-o", "a.nc")
    assert status == 0, err
    with xr.open_dataset("a.nc") as data:
        data.load()
    check_units(data)
    element = "ball" if "ball" in data.dims else "roller"
    told = {one: (data[one].dims, data[one].attrs["units"], data[one].attrs["long_name"]) for one in SHARED}
    assert told == SEEN.setdefault("told", told)
    first = np.atleast_2d(data[f"{element}_load"].values[0, 0])[0]
    assert float(data["highest_raceway_load"][0, 0]) == first.max()
    assert int(data["loaded_elements"][0, 0]) == np.count_nonzero(first > 0.01 * first.max())
    for new, old in OLD.items():
        copy = data[old.format(element)]
        assert np.array_equal(copy, data[new])
        assert copy.attrs["comment"].startswith(f"copy of {new}: the next release has no ")
    # a turn of the inner ring passes each element of a row once; the cage carries them past a place of the outer one
    of_row = data.sizes[element] // (2 if name in TWO_ROWS else 1)
    cage, outer, inner = (float(data[f"{at}_frequency"][0, 0]) for at in ("cage", "outer_pass", "inner_pass"))
    assert outer + inner == pytest.approx(25.0 * of_row, rel=1e-12)
    assert outer == pytest.approx(cage * of_row, rel=1e-12) and 0.35 < cage / 25.0 < 0.5 + 1e-9
    for words in ("(BPFO)", f"{element}s carry more than 1 %", "damping, low-frequency limit", "Lambda", "assumed: "):
        assert words in page
    status, _, err = run(capsys, "bearing", *ask, "--bands", "numerics", "-o", "a.toml")  # for ROSS, whose x is y here
    assert status == 0, err
    (matrices,) = tomllib.loads((tmp_path / "a.toml").read_text(encoding="utf-8")).values()
    found = [np.ravel(matrices[key])[0] for key in ("kxx", "kyy", "cxx", "cyy")]
    asked = [float(data[key][0, 0]) for key in SHARED[:4]]
    assert found == pytest.approx(asked, rel=1e-9)  # of the axes of the load
    status, table, err = run(capsys, "bearing", *ask, "--speed", "3000 rpm", "-o", "a.csv", "--plot", "b.svg")
    assert status == 0, err
    heads = next(line for line in table.splitlines() if "K along" in line).split()
    assert {"load", "speed", f"{element}s", "Hertz", "Lambda"} <= set(heads)
    drawn = (tmp_path / "b.svg").read_text(encoding="utf-8")  # with its texts as comments
    assert "<!-- 2000 N" in drawn and (" N axial -->" in drawn) == (" axial" in page)
    with open("a.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    assert len(rows) == 2
    for one in (*OLD, *(old.format(element) for old in OLD.values()), "stiffness_along", "film_parameter"):
        value = float(rows[0][f"{one} [{data[one].attrs['units']}]"])
        assert value == pytest.approx(float(data[one][0, 0]), rel=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["6208", "7208B", "NU308", "NA4908", "32208", "NUP308"])
def test_heat_in_the_inlet_thins_films_of_every_kind(name, capsys, tmp_path, monkeypatch):
    """Under the same words; the film of the page is smaller by about the factor of QL, 1 to 4 here."""
    monkeypatch.chdir(tmp_path)
    ask = (name, "--load", "2 kN", "--speed", "9000 rpm", "--temperature", "60 degC", *KINDS[name], "-o", "a.nc")
    films, printed = {}, name not in ("32208", "NUP308")  # these have films by formulas beside their laws
    for physics in ("isothermal", "inlet-heat") if printed else ("inlet-heat",):
        status, page, err = run(capsys, "bearing", *ask, "--physics", physics)
        assert status in (0, 1), err
        assert bool(re.search("inlet heat[;,]", page)) == (physics == "inlet-heat")
        with xr.open_dataset("a.nc") as data:
            films[physics] = np.nanmin(data["minimum_film"].values)
    if printed:
        assert 0.55 < films["inlet-heat"] / films["isothermal"] < 0.95


KNOWN = (
    "--know", "temperature = +- 1 K; clearance = +- 0 um; viscosity = +- 0 %; pressure_viscosity = +- 0 %; "
    "geometry = +- 0 %; profile = +- 0 %; cage_angle = +- 0 deg",
)  # fmt: skip
"""What is asked of pages of which numerics, or alternatives, are looked at: a law for each end is dear."""


@pytest.mark.slow
@pytest.mark.parametrize("name", ["NU308", "6208"])
def test_stated_errors_are_in_the_bands_of_one_bearing(name, capsys, tmp_path, monkeypatch):
    """Those of the rule of heat come to those of the law: 0.5 to 1 (1 - phi) of the loss, and the same of the film
    compliance, which the damping has twice; phi is that of the printed film."""
    monkeypatch.chdir(tmp_path)
    ask = (name, "--load", "2 kN", "--speed", "3000 rpm", "--temperature", "60 degC", *KINDS.get(name, ()))
    found = {}
    for physics in ("isothermal", "inlet-heat"):
        more = ("--physics", physics, "--bands", "all", *KNOWN, "-o", f"{physics}.nc")
        page = run(capsys, "bearing", *ask, *more)[1]
        head = next(line for line in page.splitlines() if "90 % of what" in line)
        value = head.index("value") + 5  # where values end
        columns = [(head.index("numerics"), head.index("numerics") + 9), (value - 12, value)]
        rows = {
            line[4:11].strip(): line for line in page.splitlines() if re.match(r"    ([KC] (along|axial)|film)", line)
        }
        wide = [[float(rows[key][slice(*at)]) for at in columns] for key in ("K along", "C along", "film, u")]
        sizes = [size / value for size, value in wide]
        with xr.open_dataset(f"{physics}.nc") as data:
            found[physics] = (*sizes, float(np.nanmin(data["central_film"].values)))
    cold, warm = found["isothermal"], found["inlet-heat"]
    thinner = 1.0 - warm[-1] / cold[-1]
    assert thinner > 0.02 and warm[0] > cold[0] > 0.0
    assert 0.4 * thinner < warm[1] - cold[1] < 2.0 * thinner
    assert 0.0 < warm[2] - cold[2] < thinner  # the rule's own error of films is a part of its effect


@pytest.mark.slow
@pytest.mark.usefixtures("fine_laws")
@pytest.mark.parametrize("name", ["6208", "32208"])
def test_bearings_with_axial_load_take_an_oil_layer(name, capsys, tmp_path, monkeypatch):
    """A thick one is flooded, to what the cap of the films lets through; a thin one leaves less to damp."""
    monkeypatch.chdir(tmp_path)
    ask = (name, "--load", "2 kN", "--axial", "2 kN", "--speed", "3000 rpm", "-o", "a.nc")
    found, films = {}, {}
    for supply in ("flooded", "1 mm", "1 um"):
        status, page, err = run(capsys, "bearing", *ask, "--supply", supply)
        assert status == 0, err
        with xr.open_dataset("a.nc") as data:
            found[supply] = [float(data[name][0, 0]) for name in ("stiffness_along", "damping_along")]
            films[supply] = np.nanmin(data["minimum_film"].values)
        assert "in place of flooded" not in page  # it is stated
    assert found["1 mm"] == pytest.approx(found["flooded"], rel=1e-3)
    # points keep the damping of their flooded films, and balls move to other loads and angles
    assert found["1 um"] != pytest.approx(found["flooded"], rel=1e-4) and "oil layer 1 um" in page
    assert name == "6208" or found["1 um"][1] < 0.95 * found["flooded"][1]
    assert 0.3e-6 < films["1 um"] < 0.95 * films["flooded"] and films["1 mm"] == pytest.approx(
        films["flooded"], rel=1e-3
    )
    if name == "32208":  # its alternatives take the longest, and are found as those of balls
        return
    page = run(capsys, "bearing", *ask[:-2], "--bands", "all", *KNOWN)[1]
    assert [line.split(" in place")[0].strip() for line in page.splitlines() if "in place of flooded" in line] == [
        "oil bath",
        "oil air",
        "grease",
    ]
    status, _, err = run(capsys, "bearing", *ask, "--law", "hertz", "--supply", "1 um")
    assert status == 2 and "--supply: got oil layer 1 um with dry contacts; allowed: with --law table" in err


@pytest.mark.parametrize("name", KINDS)
def test_electrics_of_one_bearing(name, capsys, tmp_path, monkeypatch):
    """The same electric numbers for all, a row for each temperature; the warmer film is thinner, and has more."""
    monkeypatch.chdir(tmp_path)
    ask = (name, "--load", "2 kN", "--speed", "1500 rpm", "--law", "hertz", *KINDS[name], "--permittivity", "2.2")
    status, page, err = run(
        capsys, "bearing", *ask, "--temperature", "40 degC", "--temperature", "70 degC", "-o", "a.csv"
    )
    assert status == 0, err
    with open("a.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    assert [float(row["temperature [K]"]) for row in rows] == [313.15, 343.15]
    for row in rows:
        low, found, high = (float(row[f"capacitance{end} [F]"]) for end in ("_low", "", "_high"))
        assert 1e-11 < low < found < high < 1e-8
        assert float(row["breakdown_high [V]"]) == pytest.approx(6.0 * float(row["breakdown_low [V]"]))
    assert float(rows[1]["capacitance [F]"]) > float(rows[0]["capacitance [F]"])
    assert page.count("breakdown at ") == 2


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--permittivity", "wet"), "--permittivity value: got 'wet'"),
        (
            ("--permittivity", "{ value = 2.2, outlet = 'wet' }"),
            "outlet: got 'wet'; allowed: 'parallel'",
        ),
        (("--permittivity", "{ value = 2.2"), "--permittivity: is not TOML"),
        (("-o", "a.cir"), "a circuit; allowed: with --permittivity 2.2"),
        (("--permittivity", "2.2", "--temperature", "40 degC", "--temperature", "50 degC"), "several with -o NAME.csv"),
        (("--permittivity", "2.2", "--load", "1 kN", "-o", "a.cir"), "got 2 points; allowed: one load and one speed"),
    ],
)
def test_refused_electrics(options, words, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ask = ("bearing", "6208", "--load", "2 kN", "--speed", "1500 rpm", "--law", "hertz")
    status, _, err = run(capsys, *ask, *options)
    assert status == 2 and words in err
    assert not list(tmp_path.iterdir())
