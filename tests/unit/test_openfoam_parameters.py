"""The parameter file: what it says, and that nothing else can get into it."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.openfoam.parameters import STEP, Heat, Mesh, Oscillation, Parameters, Start, Temperatures, isotherms
from ehdmaps.openfoam.pyfoam import parse
from ehdmaps.physics.heat import HeatData
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.rheology import ShearLaw, shear_law

TEMPLATE = Path(__file__).parents[2] / "openfoam_cases" / "lineContact"
OIL = Lubricant.named("FVA3").at(313.15)
GOOD = Parameters(
    reduced_radius=5.5e-3,
    reduced_modulus=2.3e11,
    load=1e4,
    lower_speed=0.5,
    upper_speed=1.5,
    oil=OIL,
    cavitation_range=500.0,
    mesh=Mesh(film=0.2, spike_position=0.8, spike_width=0.05),
    columns=400,
    rows=6,
    start=Start(np.array([-1e-4, 0.0, 1e-4]), np.array([0.0, 5e8, 0.0]), 1e-7),
)


def entries(parameters, tmp_path):
    path = tmp_path / "ehlProperties"
    path.write_text(parameters.text())
    return parse(path)


def test_the_file_says_what_the_parameters_say(tmp_path):
    found = entries(GOOD, tmp_path)
    assert (found["reducedRadius"], found["load"], found["upperSpeed"]) == (5.5e-3, 1e4, 1.5)
    assert (found["flow"], found["columns"], found["rows"]) == ("thinFilm", 400, 6)
    assert found["viscosity"]["type"] == "FVA3"
    assert found["viscosity"]["viscosity"] == OIL.viscosity
    assert found["viscosity"]["pressureScale"] == OIL.pressure_viscosity.pressure_scale
    assert dict(found["density"]) == {"type": "DowsonHigginson", "density": OIL.density}
    assert dict(found["shear"]) == {"type": "Newtonian"}
    assert dict(found["mesh"]) == {
        "film": 0.2,
        "inletLength": 20.0,
        "outletLength": 3.0,
        "spikePosition": 0.8,
        "spikeWidth": 0.05,
    }
    assert list(found["start"]["x"]) == [-1e-4, 0.0, 1e-4]
    assert found["start"]["centralFilm"] == 1e-7
    assert list(found["response"]["frequencies"]) == [0.0]
    assert "oscillation" not in found
    assert found["writeFields"] is False or found["writeFields"] == "false"


def test_what_is_not_asked_for_is_left_out(tmp_path):
    found = entries(replace(GOOD, start=None, frequencies=()), tmp_path)
    assert "start" not in found
    assert list(found["response"]["frequencies"]) == []


def test_heat_has_the_oil_over_temperature(tmp_path):
    oil = isotherms(Lubricant.named("FVA3"), 333.15)
    found = entries(replace(GOOD, heat=Heat(333.15, HeatData(oil_conductivity=0.15), oil)), tmp_path)["heat"]
    assert (found["temperature"], found["oilConductivity"], found["solidConductivity"]) == (333.15, 0.15, 46.0)
    lists = found["isotherms"]
    place = round((333.15 - lists["first"]) / STEP)
    assert (lists["viscosity"]["type"], lists["density"]["type"], lists["step"]) == ("FVA3", "DowsonHigginson", STEP)
    assert lists["viscosity"]["viscosity"][place] == Lubricant.named("FVA3").at(333.15).viscosity
    assert {len(lists[law][key]) for law, key in (("viscosity", "pressureScale"), ("density", "density"))} == {
        len(oil.states)
    }
    assert "heat" not in entries(GOOD, tmp_path)


def test_isotherms_end_where_the_laws_do():
    oil = isotherms(Lubricant.named("FVA3"), 273.15)
    assert 273.15 - 14.67 < oil.first < 273.15 - 14.67 + STEP
    numbers = {"viscosity": 1e-4, "pressure_viscosity": 1e-8, "density": 100.0, "density_slope": -10.0}
    with pytest.raises(
        InputError, match=r"got 296.15 K, about which its laws hold over .* K; allowed with heat: at least"
    ):
        isotherms(Lubricant.barus(**numbers), 296.15)


def test_an_oscillation(tmp_path):
    found = entries(replace(GOOD, oscillation=Oscillation(1000.0, 1e-3, 80, 4)), tmp_path)
    assert dict(found["oscillation"]) == {"frequency": 1000.0, "amplitude": 1e-3, "stepsPerCycle": 80, "cycles": 4}


@pytest.mark.parametrize(
    ("oil", "words"),
    [
        (Lubricant.barus(viscosity=0.1, pressure_viscosity=2e-8, density=880.0), "type +Barus;"),
        (Lubricant.roelands(viscosity=0.1, roelands_z=0.6, density=880.0), r"type +Roelands;(.*\n)*? +exponent +0.6;"),
        (
            Lubricant.barus(viscosity=0.1, pressure_viscosity=2e-8, density=880.0, density_law="incompressible"),
            r"density\n{\n +type +incompressible;\n +density +880.0; ",
        ),
    ],
)
def test_the_laws_of_the_oil(oil, words):
    assert re.search(words, replace(GOOD, oil=oil.at(313.15)).text())


@pytest.mark.parametrize(
    ("law", "numbers"),
    [
        (shear_law("eyring", 5e6), {"type": "Eyring", "stress": 5e6}),
        (shear_law("carreau", 5e6, None, 0.4), {"type": "Carreau", "stress": 5e6, "exponent": 0.4}),
        (shear_law("limiting", 3e6, 0.07), {"type": "limiting", "stress": 3e6, "ratio": 0.07}),
    ],
)
def test_a_shear_law_has_its_numbers(tmp_path, law, numbers):
    assert dict(entries(replace(GOOD, shear=law), tmp_path)["shear"]) == numbers


HOSTILE = [
    '1; #calc "system(\\"touch /tmp/owned\\")"; x 1',
    '#codeStream { code #{ system("id"); #}; }',
    '#include "/etc/passwd"',
    "$load",
    "1e4;",
    "",
    math.nan,
    math.inf,
    -math.inf,
    None,
    True,
    [1.0],
    np.float64("nan"),
]


@pytest.mark.parametrize("value", HOSTILE, ids=repr)
def test_only_finite_numbers_get_in(value):
    for key in ("load", "reduced_radius", "upper_speed", "cavitation_range", "tolerance"):
        with pytest.raises(InputError, match=r"ehlProperties, \w+: got .*; allowed: a finite number"):
            replace(GOOD, **{key: value}).text()


@pytest.mark.parametrize("value", [value for value in HOSTILE if value is not True], ids=repr)
def test_only_finite_numbers_get_into_nested_entries(value):
    oil = replace(OIL, viscosity=value)
    for parameters in (replace(GOOD, oil=oil), replace(GOOD, mesh=Mesh(film=value))):
        with pytest.raises(InputError, match="allowed: a finite number"):
            parameters.text()


@pytest.mark.parametrize("value", [HOSTILE[0], 1.5, 0, -1, True, None, math.nan], ids=repr)
def test_only_whole_numbers_count(value):
    with pytest.raises(InputError, match=r"columns: got .*; allowed: a whole number >= 1"):
        replace(GOOD, columns=value).text()


@pytest.mark.parametrize("value", ["yes", 1, None, HOSTILE[0]], ids=repr)
def test_only_booleans_switch(value):
    with pytest.raises(InputError, match=r"writeFields: got .*; allowed: true or false"):
        replace(GOOD, write_fields=value).text()


@pytest.mark.parametrize("value", ["thinFilm; #calc", "thinFilm", None, ["thin_film"], 3], ids=repr)
def test_only_known_words_get_in(value):
    with pytest.raises(InputError, match=r"flow: got .*; allowed: thin_film, full_stress"):
        replace(GOOD, flow=value).text()


@pytest.mark.parametrize("value", ["Eyring; #calc", None, ["Eyring"], 4], ids=repr)
def test_only_known_laws_of_shear_get_in(value):
    with pytest.raises(InputError, match=r"shear: got .*; allowed: 0, 1, 2, 3"):
        replace(GOOD, shear=ShearLaw(value)).text()


@pytest.mark.parametrize(
    "value",
    [
        np.array([0.0, math.nan]),
        np.array([math.inf]),
        np.array(["0", "1; #calc"]),
        np.array([[0.0, 1.0]]),
        pytest.param(np.array([object()]), id="an object"),  # whose text has its address
        "#calc",
    ],
    ids=repr,
)
def test_only_lists_of_finite_numbers_get_in(value):
    with pytest.raises(InputError, match=r"x: got .*; allowed: a list of finite numbers"):
        replace(GOOD, start=Start(value, np.zeros(1), 1e-7)).text()


def test_the_file_has_no_character_that_could_do_more():
    text = replace(GOOD, oscillation=Oscillation(1000.0)).text()
    assert re.fullmatch(r"[A-Za-z0-9_ {}();.+\n-]*", re.sub(r"// [][A-Za-z0-9 /(),.:'^+-]*\n", "\n", text))


def test_the_file_reads_as_the_case_by_hand():
    """One entry a line, of 130 letters at most, with the units of the case that runs by hand."""
    heat = Heat(333.15, HeatData(), isotherms(Lubricant.named("FVA3"), 333.15))
    warmth = Temperatures(np.array([0.0, 0.5, 1.0]), np.full((3, 400), 1e3 / 3.0))
    start = Start(np.linspace(-1e-4, 1e-4, 400), np.full(400, 1e8 / 3.0), 1e-7, warmth)
    many = replace(GOOD, heat=heat, start=start)
    text = many.text()
    assert max(map(len, text.split("\n"))) <= 130
    assert not re.search(r";.*;|\{.*\S|\S.*\{", text)

    def units(of):
        """Unit behind each entry, the first of a name."""
        found = re.findall(r"^[ /]*(\w+) .*// [^\[\n]*(\[.*?\])(?:$|,)", of, re.MULTILINE)
        return {key: unit for key, unit in reversed(found)}

    by_hand = units((TEMPLATE / "constant" / "ehlProperties").read_text())
    written = units(text)
    shared = by_hand.keys() & written.keys()
    assert len(shared) >= 15
    assert {key: written[key] for key in shared} == {key: by_hand[key] for key in shared}
