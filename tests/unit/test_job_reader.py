import hashlib
import re

import netCDF4
import pytest

from ehdmaps.errors import InputError
from ehdmaps.jobs.reader import parse_job, read_job, shipped_jobs
from ehdmaps.maps.records import record_json
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.viscosity import TaitDoolittle
from tests.cases.jobs import map_job, spaced

GOOD = map_job(spaced("0.1 N/mm", "1000 N/mm", 5), '["0.5 m/s", "1 m/s"]', '["20 degC", "40 degC"]')

BY_HAND = """[bearing]
inner_raceway_diameter = "52 mm"
outer_raceway_diameter = "80 mm"
roller_diameter = "14 mm"
roller_length = "15 mm"
rollers = 12
diametral_clearance = "30 um"
"""

OIL = """[lubricant]
viscosity_law = "roelands"
viscosity_40 = "95 mm^2/s"
viscosity_100 = "10.6 mm^2/s"
pressure_viscosity = "22.4 1/GPa"
density = "880 kg/m^3"
"""

CONTACT = """[contact]
radius = "5.515 mm"
reference_depth = "5 mm"
"""

NAMED = '[bearing]\nname = "NU308"\n'
NAMED_OIL = '[lubricant]\nname = "FVA3"\n'
LOAD = 'load = { from = "0.1 N/mm", to = "1000 N/mm", points = 5, spacing = "log" }'


def parse(text, **options):
    return parse_job(text, name="job", where="job.toml", **options)


def changed(old, new):
    assert old in GOOD
    return GOOD.replace(old, new)


def test_a_good_job_is_read_in_si():
    job = parse(GOOD)
    assert job.bearing == BearingGeometry.named("NU308")
    assert [contact.name for contact in job.contacts] == ["inner", "outer"]
    assert job.lubricant == Lubricant.named("FVA3")
    assert job.loads == pytest.approx((100.0, 1000.0, 10000.0, 100000.0, 1e6), rel=1e-14)  # round-off of exp
    assert (job.loads[0], job.loads[-1]) == (100.0, 1e6)
    assert job.entrainment_speeds == (0.5, 1.0)
    assert job.temperatures == (293.15, 313.15)
    assert (job.solver, job.fill, job.shape, job.points) == ("formula", "neighbours", (2, 5, 2, 2), 40)
    assert job.sha256 == hashlib.sha256(GOOD.encode()).hexdigest()


def test_a_bearing_and_an_oil_by_hand():
    job = parse(GOOD.replace(NAMED, BY_HAND).replace(NAMED_OIL, OIL))
    assert job.bearing is not None
    assert job.bearing.diametral_clearance == 30e-6
    assert job.contacts[0].radius == BearingGeometry.named("NU308").inner_radius
    assert job.lubricant == Lubricant.roelands(
        viscosity_40=95e-6, viscosity_100=10.6e-6, pressure_viscosity=22.4e-9, density=880.0
    )


TAIT_DOOLITTLE = """[lubricant]
viscosity_law = "tait-doolittle"
viscosity = "20 mPa s"
density = "800 kg/m^3"
doolittle_slope = 4.5
occupied_fraction = 0.66
occupied_expansion = "-7e-4 1/K"
volume_expansion = "8e-4 1/K"
bulk_modulus = "8.7 GPa"
bulk_modulus_decay = "6.3e-3 1/K"
bulk_modulus_slope = 11.0
reference_temperature = "40 degC"
"""


def test_an_oil_of_free_volume():
    law = parse(GOOD.replace(NAMED_OIL, TAIT_DOOLITTLE)).lubricant.pressure_viscosity
    assert law == TaitDoolittle(4.5, 0.66, -7e-4, 8e-4, 8.7e9, 6.3e-3, 11.0, 313.15)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("occupied_fraction = 0.66\n", "", r"occupied_fraction: missing"),
        ("0.66", "1.2", r"occupied_fraction: got 1.2; allowed: 0.05 to 0.99"),
        ('"8.7 GPa"', '"8.7 Pa"', r"bulk_modulus: got '8.7 Pa'; allowed: 0.1 GPa to 1000 GPa"),
        ("doolittle_slope", 'pressure_viscosity = "20 1/GPa"\ndoolittle_slope', r"pressure_viscosity: stands beside"),
        ('"tait-doolittle"', '"fva3"', r"bulk_modulus: stands beside .* allowed: with 'tait-doolittle' only"),
    ],
)
def test_numbers_that_are_not_of_the_law_are_refused(old, new, message):
    assert old in TAIT_DOOLITTLE
    with pytest.raises(InputError, match=message):
        parse(GOOD.replace(NAMED_OIL, TAIT_DOOLITTLE.replace(old, new)))


def test_a_bare_contact_with_a_linear_axis_and_another_material():
    text = changed(NAMED, CONTACT + '[material]\nyoungs_modulus = "300 GPa"\n').replace("iso16281", "half_space")
    text = text.replace('points = 5, spacing = "log"', 'points = 3, spacing = "linear"')
    job = parse(text)
    assert [contact.name for contact in job.contacts] == ["line"]
    assert job.bearing is None
    assert job.contacts[0].reference_depth == 5e-3
    assert job.contacts[0].material.youngs_modulus == 300e9
    assert job.loads == (100.0, 500050.0, 1e6)
    assert job.title == "line contact R = 5.515 mm"


def test_a_named_bearing_may_state_its_clearance():
    job = parse(changed('name = "NU308"', 'name = "NU308"\ndiametral_clearance = "20 um"'))
    assert job.bearing is not None and job.bearing.diametral_clearance == 20e-6


def test_another_solver_drops_the_options_of_the_first():
    text = changed('name = "formula"', 'name = "formula"\nfilm_formula = "pan-hamrock"')
    assert parse(text).solver_options == {"film_formula": "pan-hamrock"}
    assert parse(text, solver="formula").solver_options == {"film_formula": "pan-hamrock"}
    override = parse(text, solver="hertz")
    assert (override.solver, override.solver_options) == ("hertz", {})


@pytest.mark.parametrize("name", ["nu308", "n1014"])
def test_shipped_jobs_are_what_the_contract_asks_for(name):
    job = read_job(name)
    assert name in shipped_jobs()
    assert job.solver == "reynolds"
    assert job.shape == (2, 25, 12, 6)
    assert (job.loads[0], job.loads[-1]) == (100.0, 1e6)
    assert (job.entrainment_speeds[0], job.entrainment_speeds[-1]) == (0.05, 10.0)
    assert (job.temperatures[0], job.temperatures[-1]) == (293.15, 393.15)


def test_a_correction_has_the_physics_of_the_map():
    """Also in the shipped job, by the two keys that it names."""
    text = read_job("nu308_cfd").text
    isothermal = parse(text)
    assert isothermal.corrected_by is not None
    assert (isothermal.corrected_by.options, isothermal.backbone) == ({}, "law")
    text = text.replace("# physics", "physics").replace("# shear", "shear")
    warm = parse(f"{text}\n[correction]\nrows = 12\n")
    assert warm.corrected_by is not None
    assert warm.solver_options == {"physics": "thermal", "shear": "limiting"}
    assert warm.corrected_by.options == {**warm.solver_options, "rows": 12}
    with pytest.raises(InputError, match=r"\[correction\] physics: got 'isothermal' for films that are thermal"):
        parse(f'{text}\n[correction]\nphysics = "isothermal"\n')
    with pytest.raises(InputError, match=r"\[correction\] physics: got 'isothermal' for films that are inlet-heat"):
        parse(text.replace('"thermal"', '"inlet-heat"'))  # which openfoam does not know


def test_the_commented_alternatives_of_the_shipped_job_are_valid():
    text = read_job("nu308").text
    for key in ("inner_raceway_diameter", "outer_raceway_diameter", "roller_diameter", "roller_length", "rollers"):
        text = re.sub(rf"^# ({key} = )", r"\1", text, flags=re.M)
    text = re.sub(
        r"^# (viscosity_law|viscosity_40|viscosity_100|pressure_viscosity|density|density_law)( = )",
        r"\1\2",
        text,
        flags=re.M,
    )
    text = re.sub(r'^name = "(NU308|FVA3)".*$', "", text, flags=re.M)
    text = re.sub(r"^# (diametral_clearance = )", r"\1", text, flags=re.M)
    text = re.sub(r"^# (\[material\]|youngs_modulus = |poisson_ratio = )", r"\1", text, flags=re.M)
    job = parse(text)
    assert job.contacts[0].radius == BearingGeometry.named("NU308").inner_radius
    assert job.lubricant.name == "own oil"


BROKEN = {
    "not TOML": ("schema = = 1", "job.toml: is not TOML: .*strings with units stand in quotes"),
    "another schema": (changed("schema = 1", "schema = 2"), "schema: got 2; allowed: 1"),
    "schema is a boolean": (changed("schema = 1", "schema = true"), "schema: got True; allowed: 1"),
    "unknown key": (
        changed("structural_law", "structural_lav"),
        r"\[solver\] structural_lav: unknown key \(did you mean 'structural_law'\?\)",
    ),
    "unknown table": (GOOD + "[gird]\n", r"job file gird: unknown key \(did you mean 'grid'\?\); allowed: schema, "),
    "key of another solver": (
        changed('name = "formula"', 'name = "formula"\ndensity = 8'),
        r"\[solver\] density: unknown key",
    ),
    "unknown solver": (
        changed('"formula"', '"formular"'),
        r"name: got 'formular' \(did you mean 'formula'\?\); allowed: 'hertz'",
    ),
    "wrong fill": (changed('"iso16281"', '"iso16281"\nfill = "all"'), "fill: got 'all'; allowed: 'neighbours', 'none'"),
    "wrong option": (
        changed('"formula"', '"formula"\nfilm_formula = 3'),
        "film_formula: got 3; allowed: 'moes', .*, in quotes",
    ),
    "solver is no table": (
        'solver = "formula"\n' + GOOD[: GOOD.index("[solver]")],
        r"\[solver\]: got 'formula'; allowed: a table",
    ),
    "bearing and contact": (changed("[lubricant]", CONTACT + "[lubricant]"), r"\[contact\]: stands beside \[bearing\]"),
    "neither": (
        changed(NAMED, ""),
        r"bearing: missing; allowed: \[bearing\] with a name or dimensions, or \[contact\]",
    ),
    "empty bearing": (
        changed('name = "NU308"\n', ""),
        r"\[bearing\] name: missing; allowed: a designation such as 'NU206'; or give inner",
    ),
    "unknown bearing": (
        changed("NU308", "NU3008"),
        r"bearing designation: got 'NU3008' \(did you mean 'NU308'\?\); allowed: N1014, NU308, and N, NU, NJ",
    ),
    "name and dimensions": (
        changed('"NU308"', '"NU308"\nrollers = 12'),
        r"\[bearing\] rollers: stands beside name; .* delete one",
    ),
    "impossible geometry": (
        GOOD.replace(NAMED, BY_HAND.replace('"14 mm"', '"70 mm"')),
        r"\[bearing\]: bearing .*, roller_diameter: got 0.07 m; allowed: < the pitch diameter",
    ),
    "too many rollers": (
        GOOD.replace(NAMED, BY_HAND.replace("12", "40")),
        "rollers: got 40, which overlap on the pitch circle",
    ),
    "part of a bearing": (
        GOOD.replace(NAMED, BY_HAND.replace('roller_length = "15 mm"\n', "")),
        r"\[bearing\] roller_length: missing; allowed: a quantity of 0.01 mm to",
    ),
    "no clearance": (
        GOOD.replace(NAMED, BY_HAND.replace('diametral_clearance = "30 um"\n', "")),
        r'diametral_clearance: missing; allowed: a length; "0 mm" if unknown',
    ),
    "rollers as text": (
        GOOD.replace(NAMED, BY_HAND.replace("12", '"12"')),
        "rollers: got '12'; allowed: a whole number .* without quotes",
    ),
    "rollers as boolean": (
        GOOD.replace(NAMED, BY_HAND.replace("12", "true")),
        "rollers: got True; allowed: a whole number",
    ),
    "negative length": (
        GOOD.replace(NAMED, BY_HAND.replace('"15 mm"', '"-15 mm"')),
        "roller_length: got '-15 mm'; allowed: 0.01 mm to",
    ),
    "contact without depth": (
        changed(NAMED, '[contact]\nradius = "5 mm"\n').replace("iso16281", "half_space"),
        r"\[contact\]: contact 'line', reference_depth: got none; the half_space law needs it",
    ),
    "contact without radius": (changed(NAMED, '[contact]\nreference_depth = "5 mm"\n'), r"\[contact\] radius: missing"),
    "wrong ratio": (
        changed("[lubricant]", "[material]\npoisson_ratio = 0.7\n[lubricant]"),
        "poisson_ratio: got 0.7; allowed: 0 to 0.499",
    ),
    "ratio as boolean": (
        changed("[lubricant]", "[material]\npoisson_ratio = true\n[lubricant]"),
        "poisson_ratio: got True; allowed: a bare",
    ),
    "ratio not a number": (
        changed("[lubricant]", "[material]\npoisson_ratio = nan\n[lubricant]"),
        "poisson_ratio: got nan; allowed: 0 to 0.499",
    ),
    "unknown oil": (
        changed('"FVA3"', '"FVA4"'),
        r"\[lubricant\]: lubricant name: got 'FVA4' \(did you mean 'FVA3'\?\)",
    ),
    "oil and data": (changed('"FVA3"', '"FVA3"\ndensity = "880 kg/m^3"'), r"density: stands beside name"),
    "oil without density": (
        GOOD.replace(NAMED_OIL, OIL.replace('density = "880 kg/m^3"\n', "")),
        "density: missing; allowed: a quantity of",
    ),
    "two viscosities": (
        GOOD.replace(NAMED_OIL, OIL + 'viscosity = "80 mPa s"\n'),
        r"\[lubricant\]: lubricant .* either viscosity, or viscosity_40 and viscosity_100",
    ),
    "z of another law": (
        GOOD.replace(NAMED_OIL, OIL.replace("roelands", "barus") + "roelands_z = 0.6\n"),
        "roelands_z: stands beside viscosity_law = 'barus'; allowed: with 'roelands' only",
    ),
    "axis as a number": (changed(LOAD, "load = 5"), r"\[grid\] load: got 5; allowed: \{ from"),
    "empty axis": (changed(LOAD, "load = []"), "load: got an empty list; allowed: at least one value"),
    "unsorted axis": (
        changed('["0.5 m/s", "1 m/s"]', '["1 m/s", "0.5 m/s"]'),
        "entrainment_speed: got 0.5 m/s after 1 m/s; allowed: rising values",
    ),
    "same value twice": (
        changed('["20 degC", "40 degC"]', '["40 degC", "313.15 K"]'),
        "temperature: got 40 degC twice; allowed: rising values, each once",
    ),
    "single point": (
        changed("points = 5", "points = 1"),
        r"\[grid\] load points: got 1; allowed: a whole number from 2",
    ),
    "points as boolean": (changed("points = 5", "points = true"), "points: got True; allowed: a whole number"),
    "points as float": (changed("points = 5", "points = 5.0"), r"points: got 5.0; allowed: a whole number"),
    "log from zero": (
        changed('["0.5 m/s", "1 m/s"]', '{ from = "0 m/s", to = "1 m/s", points = 3, spacing = "log" }'),
        "from: got 0 m/s; a log axis starts above zero",
    ),
    "axis backwards": (
        changed('from = "0.1 N/mm", to = "1000 N/mm"', 'from = "10 N/mm", to = "1 N/mm"'),
        "from: got 10 N/mm, not below to = 1 N/mm",
    ),
    "axis too fine": (
        changed('to = "1000 N/mm", points = 5', 'to = "0.10000000000001 N/mm", points = 90000'),
        "points: got 90000; the values fall together",
    ),
    "no spacing": (changed(', spacing = "log"', ""), r"\[grid\] load spacing: missing; allowed: 'log', 'linear'"),
    "NaN": (changed('"0.1 N/mm"', '"nan N/mm"'), "from: got 'nan N/mm', which does not start with a number"),
    "negative load": (changed('"0.1 N/mm"', '"-1 N/mm"'), r"from: got '-1 N/mm'; allowed: 0.001 N/mm to 10000 N/mm"),
    "absurd load": (
        changed('"1000 N/mm"', '"1e30 N/mm"'),
        r"to: got '1e30 N/mm'; allowed: 0.001 N/mm to 10000 N/mm; check value and unit",
    ),
    "wrong unit": (changed('"0.1 N/mm"', '"0.1 mm"'), "from: got the unit 'mm'; allowed: a number with a unit of N/m"),
    "no unit": (changed('"20 degC"', '"20"'), r"temperature\[0\]: got '20' without a unit"),
    "number without unit": (changed('"20 degC"', "20"), r"temperature\[0\]: got 20 without a unit"),
    "too cold for the oil": (
        changed('"20 degC"', '"-20 degC"'),
        r"\[grid\] temperature: lubricant 'FVA3', temperature: got -20",
    ),
    "too many values": (
        changed('["20 degC", "40 degC"]', "[" + '"20 degC",' * 100001 + "]"),
        "temperature: got 100001 values; allowed: at most 100000",
    ),
    "too many points": (
        changed("points = 5", "points = 100000").replace(
            '["0.5 m/s", "1 m/s"]', '{ from = "1 m/s", to = "2 m/s", points = 6, spacing = "linear" }'
        ),
        r"\[grid\]: got 2 x 100000 x 6 x 2 = 2400000 points; allowed: at most 2000000",
    ),
    "digits without end": ("schema = " + "9" * 5000, "is not TOML"),
    "brackets without end": ("schema = " + "[" * 100000, "is not TOML"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_a_broken_job_says_where_what_and_what_to_do(case):
    text, message = BROKEN[case]
    with pytest.raises(InputError, match=message) as raised:
        parse(text)
    assert all(problem.startswith("job.toml: ") for problem in raised.value.problems)


def test_all_problems_at_once():
    text = (
        changed("NU308", "NU3009")
        .replace('"FVA3"', '"FVA4"')
        .replace("points = 5", "points = 0")
        .replace('"20 degC"', '"20 N"')
        .replace("iso16281", "iso")
        .replace("schema = 1", "schema = 7\nshema = 1")
    )
    with pytest.raises(InputError) as raised:
        parse(text)
    found = "\n".join(raised.value.problems)
    for part in ("NU3009", "FVA4", "points: got 0", "'N'", "'iso'", "schema: got 7", "shema: unknown key"):
        assert part in found
    assert len(raised.value.problems) == 7


@pytest.mark.parametrize(
    ("oil", "said"),
    [
        (
            'viscosity_law = "barus"\nviscosity_40 = "46 mm^2/s"',
            ["density: missing", "viscosity: got viscosity_40; allowed: either", "pressure_viscosity: got none"],
        ),
        (
            'viscosity_law = "barus"\nviscosity_40 = "46 mmm^2/s"\nroelands_z = 0.6\ndensity_law = "x"',
            ["viscosity_40: got the unit 'mmm^2/s'", "density: missing", "density_law: got 'x'", "roelands_z: stands",
             "viscosity: got viscosity_40; allowed: either", "pressure_viscosity: got none"],
        ),
        (
            'viscosity_law = "barus"\nviscosity_40 = "46 N"\nviscosity_100 = "7 mm^2/s"\ndensity = "870 kg/m^3"\n'
            'pressure_viscosity_40 = "20 1/GPa"',
            ["viscosity_40: got the unit 'N'", "pressure_viscosity: got pressure_viscosity_40; allowed: either"],
        ),
        (
            'viscosity_law = "roelands"\nviscosity_40 = "7 mm^2/s"\nviscosity_100 = "46 mm^2/s"\nroelands_z = 0.6',
            ["density: missing", "viscosity_100"],
        ),
        ('viscosity = "80 mPa s"\nviscosity_40 = "46 mm^2/s"',
         ["viscosity_law: missing", "density: missing", "viscosity: got viscosity and viscosity_40; allowed: either"]),
        ('viscosity_law = "tait-doolittle"\npressure_viscosity = "20 1/GPa"',
         ["density: missing", *["missing"] * 8, "viscosity: got none", "whose numbers give it; delete it"]),
    ],
)  # fmt: skip
def test_all_problems_of_an_own_oil_at_once(oil, said):
    with pytest.raises(InputError) as raised:
        parse(GOOD.replace(NAMED_OIL, f"[lubricant]\n{oil}\n"))
    found = list(raised.value.problems)
    for words in said:
        at = next((place for place, problem in enumerate(found) if words in problem), None)
        assert at is not None, words
        del found[at]
    assert found == []


def test_a_bearing_that_was_wrong_already_is_not_called_missing():
    speeds = changed('entrainment_speed = ["0.5 m/s", "1 m/s"]', 'inner_ring_speed = ["100 rpm", "200 rpm"]')
    for bearing, said in (
        ('estimate = "NU206"\nbasic_static_rating = "-3 kN"', ["basic_static_rating: got '-3 kN'"]),
        ('estimate = "NU999"\nbasic_static_rating = "3 N"', ["basic_static_rating: got '3 N'", "got 'NU999'"]),
        ('name = "NU3009"', ["NU3009"]),
    ):
        with pytest.raises(InputError) as raised:
            parse(speeds.replace('name = "NU308"', bearing))
        assert len(raised.value.problems) == len(said)
        assert all(words in problem for words, problem in zip(said, raised.value.problems, strict=True))


def test_a_wrong_solver_option():
    with pytest.raises(InputError, match="--solver: got 'foo'; allowed: hertz"):
        parse(GOOD, solver="foo")


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match=r"cannot be read \(No such file or directory\); allowed: .*n1014, nu308"):
        read_job(str(tmp_path / "none.toml"))
    with pytest.raises(InputError, match=r"did you mean 'nu308'\?.*or --bearing with a designation, such as NU210"):
        read_job("nu3o8")
    with pytest.raises(InputError, match="cannot be read"):
        read_job("a\0b")


def test_a_file_that_is_no_text(tmp_path):
    path = tmp_path / "job.toml"
    path.write_bytes(b"schema = 1 \xff")
    with pytest.raises(InputError, match=r"is not UTF-8 text \(byte 11\)"):
        read_job(str(path))


def test_a_mark_at_the_beginning_of_a_file_is_left_out(tmp_path):
    path = tmp_path / "job.toml"
    path.write_bytes("\ufeff".encode() + read_job("nu308").text.encode())
    assert read_job(str(path)).text == read_job("nu308").text


def test_a_file_that_is_too_long(tmp_path):
    path = tmp_path / "job.toml"
    path.write_bytes(b"#" * 1_000_001)
    with pytest.raises(InputError, match="longer than 1000000 bytes"):
        read_job(str(path))


def netcdf(path, **attributes):
    with netCDF4.Dataset(path, "w") as file:
        file.setncatts(attributes)
    return str(path)


def test_a_map_gives_its_job_back(tmp_path):
    digest = hashlib.sha256(GOOD.encode()).hexdigest()
    path = netcdf(tmp_path / "a.nc", job_toml=GOOD, job_sha256=digest, solver="hertz", job_name="mine")
    job = read_job(path)
    assert (job.text, job.solver, job.name) == (GOOD, "hertz", "mine")
    assert read_job(path, solver="formula").solver == "formula"


def test_a_map_without_its_job(tmp_path):
    with pytest.raises(InputError, match="carries no job"):
        read_job(netcdf(tmp_path / "a.nc", title="x"))
    with pytest.raises(InputError, match="does not match its job_sha256"):
        read_job(netcdf(tmp_path / "b.nc", job_toml=GOOD, job_sha256="0"))
    broken = tmp_path / "c.nc"
    broken.write_bytes(b"\x89HDF\r\n\x1a\n" + b"x" * 100)
    with pytest.raises(InputError, match="looks like a map file but cannot be read"):
        read_job(str(broken))


def test_records_are_json_whatever_the_values():
    assert record_json({"b": (1, 2.5), "a": float("inf")}) == '{"a": "inf", "b": [1, 2.5]}'


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ('"so-claus"', r"got 'so-claus' \(did you mean 'so-klaus'\?\); allowed: a quantity such as \"22.4 1/GPa\""),
        ('"1e-12 1/Pa"', r"pressure_viscosity: got '1e-12 1/Pa'; allowed: 0.1 1/GPa to 100 1/GPa"),
        ("22.4", r"pressure_viscosity: got 22.4 without a unit"),
    ],
)
def test_a_wrong_pressure_viscosity(value, text):
    with pytest.raises(InputError, match=text):
        parse(GOOD.replace(NAMED_OIL, OIL.replace('"22.4 1/GPa"', value)))


def test_a_pressure_viscosity_may_be_estimated_or_zero():
    given = {"viscosity_40": 95e-6, "viscosity_100": 10.6e-6, "density": 880.0}
    for value, alpha in (("so-klaus", "so-klaus"), ("0 1/GPa", 0.0)):
        job = parse(GOOD.replace(NAMED_OIL, OIL.replace("22.4 1/GPa", value)))
        assert job.lubricant == Lubricant.roelands(pressure_viscosity=alpha, **given)


def test_the_law_of_fva3_needs_a_pressure_viscosity():
    text = OIL.replace("roelands", "fva3").replace('pressure_viscosity = "22.4 1/GPa"\n', "")
    with pytest.raises(InputError, match="viscosity_law fva3 needs it; give it in 1/Pa, or the name of a correlation"):
        parse(GOOD.replace(NAMED_OIL, text))


def test_an_estimate_that_does_not_hold_at_a_temperature_of_the_job_is_refused():
    thin = OIL.replace("95 mm", "2.5 mm").replace("10.6 mm", "1.1 mm").replace("22.4 1/GPa", "so-klaus")
    with pytest.raises(InputError, match=r"\[grid\] temperature: .*so-klaus: got 0.9\d* mm2/s"):
        parse(GOOD.replace(NAMED_OIL, thin).replace('"40 degC"]', '"120 degC"]'))
