import math
import subprocess
import sys
from pathlib import Path

import pytest

from ehdmaps import units
from ehdmaps.errors import InputError
from ehdmaps.units import FILM, LOAD, MOTIONS, TEMPERATURE, Display, closest, quantity, short

ROOT = Path(__file__).parents[2]
SI = {
    **{"STIFFNESS": "N/m^2", "DAMPING": "N s/m^2", "COMPLIANCE": "m^2/N", "SPRING": "N/m", "DAMPER": "N s/m"},
    **{"LOAD": "N/m", "ROLLING_FORCE": "N/m", "MASS_FLOW": "kg/(m s)", "FILM": "m", "LENGTH": "m"},
    **{"PRESSURE": "Pa", "SPEED": "m/s", "RPM": "rad/s"},
}
ELSEWHERE = {"TEMPERATURE", "KELVIN"}


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("62 N/mm", "N/m", 62000.0),
        ("0.7 mm", "m", 0.0007),
        ("3.5mm", "m", 0.0035),
        ("40 degC", "K", 313.15),
        ("40 °C", "K", 313.15),
        ("-5 degC", "K", 268.15),
        ("104 degF", "K", 313.15),
        ("313.15 K", "K", 313.15),
        ("22.4 1/GPa", "1/Pa", 2.24e-8),
        ("84.5 mPa s", "Pa s", 0.0845),
        ("84.5 mPa*s", "Pa s", 0.0845),
        ("95 mm^2/s", "m^2/s", 9.5e-5),
        ("95 mm²/s", "m^2/s", 9.5e-5),
        ("880 kg/m**3", "kg/m^3", 880.0),
        ("880 kg/m3", "kg/m^3", 880.0),
        ("12 kg cm2", "kg m^2", 0.0012),
        ("3 m/s2", "m/s^2", 3.0),
        ("14 N/(um mm)", "N/m^2", 1.4e10),
        ("1 kHz", "Hz", 1000.0),
        ("  +1.5e-1 \t m/s ", "m/s", 0.15),
    ],
)
def test_quantity_reads_what_people_write(text, unit, value):
    # Decimal conversions are exact to the last digit written: a slip of 1e-15 would show in every file.
    assert quantity(text, unit) == value


@pytest.mark.parametrize(("unit", "text"), [(unit, text) for unit in units._COMMON for text in units._COMMON[unit]])
def test_common_units_have_the_factors_of_pint(unit, text):
    assert units._COMMON[unit][text] == units._conversion(text, unit)
    assert units._conversion(unit, unit) == (1.0, 0.0)


def test_common_units_are_read_without_pint():
    code = "import sys; from ehdmaps.units import quantity; quantity('5 kN', 'N'); quantity('2 Pa', 'Pa'); "
    subprocess.run([sys.executable, "-c", f"{code} sys.exit('pint' in sys.modules)"], check=True, cwd=ROOT)


def test_rotation_is_read_in_radians():
    # 1e-13 bounds the rounding of the factor to 15 digits.
    assert quantity("500 rpm", "rad/s") == pytest.approx(500 * 2 * math.pi / 60, rel=1e-13)


@pytest.mark.parametrize("bare", [62, 62.5, True, None, [1], {"a": 1}, "62"])
def test_a_bare_value_is_refused(bare):
    with pytest.raises(InputError, match=r'got .* without a unit; allowed: .* such as "62 N/mm"'):
        quantity(bare, "N/m")


@pytest.mark.parametrize("text", ["nan m", "inf m", "m", "", "-", "١ m", "e5 m", "0x"[:0] + "x10 m"])
def test_what_does_not_start_with_a_number_is_refused(text):
    with pytest.raises(InputError, match="does not start with a number"):
        quantity(text, "m")


@pytest.mark.parametrize(
    "text",
    [
        "9**9**9 m",
        "1_0 m",
        "5 m^9^9^9",
        "5 m^99999999",
        "5 __import__('os')",
        "1 -m",
        "5 m/",
        "5 m)",
        "1 m²³",
        "1 m;m",
        "5 m\x00",
    ],
)
def test_what_is_not_a_unit_never_reaches_the_unit_library(text, monkeypatch):
    monkeypatch.setattr("ehdmaps.units._conversion", lambda *_: pytest.fail("reached the unit library"))
    with pytest.raises(InputError, match="does not read as a unit"):
        quantity(text, "m")


@pytest.mark.parametrize("text", ["5 nan", "5 inf", "5 N", "5 (m", "3 e", "5 dBm", "1 kilokilom", "1 m/m", "5 %"])
def test_a_wrong_unit_is_refused(text):
    with pytest.raises(InputError, match=r'got the unit .*; allowed: a number with a unit of m, such as "0.7 mm"'):
        quantity(text, "m")


def test_long_text_is_refused_unread():
    with pytest.raises(InputError, match="1000002 characters long"):
        quantity("9" * 10**6 + " m", "m")


@pytest.mark.parametrize("text", ["1e400 m", "1e999 m", "1e308 km"])
def test_overflow_is_refused(text):
    with pytest.raises(InputError, match="too large for a number"):
        quantity(text, "m")


def test_the_coulomb_is_explained():
    with pytest.raises(InputError, match="C is the coulomb, write degC"):
        quantity("40 C", "K")


@pytest.mark.parametrize("turning", ["rpm", "RPM", "1/min", "/min", "min-1", "min^-1", "r/min", "U/min", "rev/min"])
def test_speeds_are_read_as_catalogues_and_drawings_write_them(turning):
    assert quantity(f"1500 {turning}", "rad/s") == pytest.approx(50.0 * math.pi, rel=1e-14)  # 15 digits are kept
    assert quantity("25 Hz", "rad/s") == quantity(f"1500 {turning}", "rad/s")
    with pytest.raises(InputError, match='such as "500 rpm", "25 Hz"'):
        quantity("1500 U/s", "rad/s")


@pytest.mark.parametrize(("text", "unit"), [("500 rpm", "Hz"), ("8 1/s", "rad/s")])
def test_cycles_and_angles_are_not_mixed(text, unit):
    with pytest.raises(InputError, match="are not converted into each other"):
        quantity(text, unit)


def test_display_is_for_people():
    assert LOAD.text(62000.0) == "62 N/mm"
    assert TEMPERATURE.text(313.15) == "40 degC"
    assert FILM.text(1.25e-6) == "1.25 um"


def test_short_keeps_messages_short():
    assert short("x" * 1000) == repr("x" * 50 + "...")
    assert short(10**5000) == "a number of 16610 bits"
    assert short([1, 2]) == "a list of 2 entries"
    assert short({"a": 1}) == "a table of 1 entries"


def test_closest_suggests_only_what_is_close():
    assert closest("structural_lav", ("structural_law", "name")) == " (did you mean 'structural_law'?)"
    assert closest("zzz", ("structural_law", "name")) == ""


def test_what_people_are_shown_is_the_same_quantity_in_another_unit():
    """The factor of each unit, by the reader of units, which is pint's."""
    shown = {name: value for name, value in vars(units).items() if isinstance(value, Display)}
    assert shown.keys() - ELSEWHERE == SI.keys()
    for display, unit in [*((shown[name], unit) for name, unit in SI.items()), *((v, k) for k, v in MOTIONS.items())]:
        assert quantity(f"1 {display.unit}", unit.replace("s2", "s^2")) * display.factor == pytest.approx(
            1.0, rel=1e-12
        )


def test_the_reference_page_has_the_unit_of_every_quantity():
    page = (ROOT / "docs" / "reference_ehdmaps.md").read_text(encoding="utf-8")
    table = page.partition("## Units\n")[2].partition("\n## ")[0]
    for display in [value for value in vars(units).values() if isinstance(value, Display)] + [*MOTIONS.values()]:
        if display.unit != "K":
            assert display.unit in table
