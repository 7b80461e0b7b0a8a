"""A bearing by its designation and an oil by its class: the names, the numbers, and every command and picture."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import ehdmaps
from ehdmaps.errors import InputError
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.defaults import bearing_source, designated_job
from ehdmaps.jobs.estimate_bands import geometry_band, oil_bands
from ehdmaps.jobs.job_text import lubricant_keys
from ehdmaps.jobs.reader import parse_job, read_job
from ehdmaps.jobs.solvers import of_map
from ehdmaps.physics.bearing import BEARINGS
from ehdmaps.physics.catalogue import _RATINGS, designated, estimate
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.designations.estimates import estimated_parts
from ehdmaps.physics.designations.oil_class import _LIMITS, _QUADRATICS, CLASSES, viscosity_100, viscosity_index
from ehdmaps.physics.designations.reader import read_designation
from ehdmaps.physics.lubricant import LUBRICANTS, Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_ratings import ball_static_rating
from ehdmaps.physics.rollers.tapered_catalogue import tapered_estimate
from ehdmaps.physics.solids import STEEL
from mbs.cli import main as mbs_main

SMALL = """
[bearing]
name = "NJ 2207 ECP"
[lubricant]
name = "ISO VG 150, VI 140"
[grid]
load = ["5 N/mm", "20 N/mm", "80 N/mm"]
entrainment_speed = ["1 m/s", "2 m/s", "4 m/s"]
temperature = ["50 degC", "60 degC"]
"""


@pytest.mark.parametrize(
    "text", ["NU210", "nu 210", "NU-210", "NU 210 ECP", "NU210-E-TVP2", "NU 210 E.TVP2/P6", " NU210 ECJ "]
)
def test_spellings_of_one_bearing(text):
    assert designated(text) == estimate("NU210")


def test_one_row_serves_four_types():
    lengths = {designated(f"{kind}210").roller_length for kind in ("NU", "NJ", "NUP", "N")}
    assert len(lengths) == 1
    assert designated("NU 308 ECP") == BEARINGS["NU308"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("NU210M", "got"),
        ("NN3910", "got 'NN3910', double row cylindrical roller bearing: not yet"),
        ("6210", "6210 is a ball bearing: its contacts are points"),
    ],
)
def test_other_designs_are_refused(text, words):
    with pytest.raises(InputError, match=f"bearing designation: {words}"):
        designated(text)


@pytest.mark.parametrize("key", _RATINGS)
def test_tabulated_ratings_suit_the_width(key):
    """Rollers by the rating and by the share of the width agree to the stated 20 %: a slip of the table would not."""
    by_rating = estimate(f"NU{key}")
    (length,) = (part for part in estimated_parts(by_rating) if part.name == "roller length")
    assert 0.5 < by_rating.roller_length / _width(key) < 0.5 * 1.4
    assert length.held == "+-20 %"
    assert [end["roller_length"] / by_rating.roller_length for end in length.ends] == pytest.approx([1.2, 0.8])
    assert "SKF's static rating" in by_rating.estimated


def _width(key):
    from ehdmaps.physics.catalogue import boundary

    return boundary(f"NU{key}").width


@pytest.mark.parametrize(
    ("typed", "name", "told"),
    [
        ("B7005-C-T-P4S", "7005C", "B: spindle bearing (B of Schaeffler, S of GMN); T: cage; P4S: class"),
        ("7014 CD/P4A", "7014C", "D: design of the maker; P4A: class of accuracy"),
        ("7014 CD/HCP4A", "7014C HC", "D: design of the maker; HC: rolling elements of silicon nitride; P4A: class of"),
        ("HCB7014-E-T-P4S", "7014AC HC", "HCB: balls of silicon nitride (Schaeffler); T: cage; P4S"),
        ("NU 308 ECP", "NU308", "ECP: reinforced, as tables here have it, and its cage"),
        ("6205-2RSH/C3", "6205 C3", "2RSH: seals or shields; C3: class of radial clearance"),
        ("HR30205J", "30205", "HR: high capacity (NSK); J: design"),
        ("NU 210 GE9", "NU210", "GE9: not understood, and left out"),
        ("6208/C3XX0241", "6208 C3", "C3: class of radial clearance; XX0241: not understood, and left out"),
        ("7914A5TYNDBLP4", "71914AC DBL", "TYN: cage; DBL: set of bearings"),
        ("7014UCG/GNP4", "7014C", "U: design of NTN; G: for mounting in pairs"),
        ("S 61914 C TA P4+", "71914C", "B: spindle bearing (B of Schaeffler, S of GMN); TA: cage; P4+: class"),
        ("NU309EMC3", "NU309 C3", "EM: reinforced, as tables here have it, and its cage; C3"),
        ("NCF 3010 CV", "NCF3010", "CV: full complement"),
        ("32210-XL", "32210", "XL: quality of the maker"),
        (
            "FAG NU208-E-XL-TVP2",
            "NU208",
            "FAG: name of the maker; E: reinforced, as tables here have it, and its cage; XL: quality",
        ),
    ],
)
def test_each_part_of_a_designation_is_told(typed, name, told):
    found = read_designation(typed)
    assert (found.text, found.words.partition("; ")[2][: len(told)]) == (name, told)
    assert read_designation(found.text).text == name  # the name is a designation


@pytest.mark.parametrize(
    ("typed", "why"),
    [
        ("32206 B", "B: steeper angle"),
        ("HCS7014-C-T-P4S", "HCS: smaller balls for high speed"),
        ("HCNU210", "rollers of silicon nitride: not yet"),
        ("6208 DB", "DB: set of bearings"),
        ("NJ2310 ECM/V", "V: full complement"),
        ("6205ETN9", "E: more or larger balls"),
        ("NU 308 W", "W: cage without E"),
        ("HSS7010-E-T-P4S-UL", "HSS: smaller balls for high speed"),
    ],
)
def test_what_changes_forces_and_is_not_served_is_refused(typed, why):
    read = {"N": designated, "H": designated, "3": tapered_estimate}.get(
        typed.removeprefix("HCS").removeprefix("HSS")[0], ball_estimate
    )
    with pytest.raises(InputError, match=f"bearing designation: got '{typed}', {why}"):
        read(typed)


def test_hybrid_balls_are_stiffer_by_their_modulus(capsys):
    """At equal load Hertz has K ~ E'^(2/3), 1.181 to that power; balls without clearance keep their angle of zero."""
    found = []
    for name in ("6205", "6205-2RSLTN9/HC5"):
        asked = ["bearing", name, "--load", "500 N", "--clearance", "0 um", "--speed", "0 rpm", "--law", "hertz"]
        assert mbs_main(asked) == 0
        said = capsys.readouterr().out
        found.append(float(next(line for line in said.splitlines() if line.startswith("  stiffness")).split()[2]))
    assert "2RSL: seals or shields; TN9: cage; HC5: rolling elements of silicon nitride" in said
    assert found[1] / found[0] == pytest.approx(1.117, abs=1e-3)  # its last digit, and five printed ones
    steel, hybrid = ball_estimate("6205"), ball_estimate("6205 HC")
    assert (hybrid.ball_diameter, hybrid.estimated) == (steel.ball_diameter, steel.estimated)
    assert ball_static_rating(hybrid) == pytest.approx(0.7 * ball_static_rating(steel))
    assert hybrid.ball_mass(STEEL) / steel.ball_mass(STEEL) == pytest.approx(0.41, abs=0.003)


def test_errors_are_stated_by_estimates_alone():
    with pytest.raises(InputError, match=r"bearing 'NU308': states no errors; allowed: a bearing that `estimate` made"):
        geometry_band(
            SimpleNamespace(bearing=replace(BEARINGS["NU308"], estimated="by somebody"), tolerances={}), None, None
        )
    assert list(estimated_parts(BEARINGS["NU308"])) == []


@pytest.mark.parametrize(
    ("cold", "hot", "index"),
    [(73.30, 8.86, 92), (22.83, 5.05, 156), (68.0, 8.6, 96), (30.0, 5.23, 104), (120.0, 20.9, 200), (70.0, 11.1, 150)],
)
def test_viscosity_index_of_published_pairs(cold, hot, index):
    """The examples of the standard, and oils of textbooks. Their viscosities are rounded, which moves an index by 2."""
    assert viscosity_index(cold, hot) == pytest.approx(index, abs=2.5)


@pytest.mark.parametrize("index", [40.0, 95.0, 100.0, 130.0])
def test_the_index_comes_back(index):
    for grade in (grade for grade in CLASSES if grade >= 10):
        hot = viscosity_100(CLASSES[grade], index)
        assert viscosity_index(CLASSES[grade], hot) == pytest.approx(index, abs=0.2), grade  # pieces meet to 0.2 % of H


def test_the_pieces_of_iso_2909_meet():
    """To the digits of its tables; a wrong coefficient would not."""
    for limit, left, right in zip(_LIMITS[1:], _QUADRATICS, _QUADRATICS[1:], strict=False):
        for part in (slice(3), slice(3, 6)):
            assert np.polyval(left[part], limit) == pytest.approx(np.polyval(right[part], limit), rel=2e-3)


def test_oils_by_class():
    oil = Lubricant.named("VG46")
    assert oil == Lubricant.named("iso-vg 46")
    assert oil.name == "ISO VG 46" and oil.viscosity.viscosity_40 == pytest.approx(46e-6)
    assert not oil.verified and "viscosity index 95 (assumed)" in oil.estimated and "So and Klaus" in oil.estimated
    other = Lubricant.named("ISO VG 46, VI 150")
    assert other.name == "ISO VG 46, VI 150" and other.viscosity.viscosity_100 > oil.viscosity.viscosity_100
    assert Lubricant.named("fva 3") is Lubricant.named("FVA3")
    assert lubricant_keys(other) == {"name": "ISO VG 46, VI 150"}
    own = Lubricant.barus(viscosity=0.1, pressure_viscosity=2e-8, density=880.0, name="ISO VG 46")
    assert own.oil_class is None and own.estimated == "density and viscosity constant over temperature"


@pytest.mark.parametrize("grade", [grade for grade in CLASSES if grade >= 7])
def test_every_class_from_7_on_makes_an_oil(grade):
    oil = Lubricant.named(f"ISO VG {grade}")
    assert 1e-9 < oil.at(333.15).pressure_viscosity.pressure_viscosity < 5e-8


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("ISO VG 47", r"viscosity class: got 'ISO VG 47' \(did you mean 'ISO VG 46'\?\); allowed: ISO VG 2, 3, 5"),
        ("ISO VG 46, VI 900", r"viscosity index: got 900; allowed: 0 to 400; mineral oils have about 95"),
        ("ISO VG 5", r"viscosity index: got 95 for 4.6 mm2/s at 40 degC; allowed: what gives 2 mm2/s or more"),
        ("ISO VG -46", r"lubricant name: got 'ISO VG -46'; allowed: FVA3"),
        ("ISO VG 46, VI -95", r"lubricant name: got 'ISO VG 46, VI -95'; allowed: FVA3"),
        ("Mobil", r"lubricant name: got 'Mobil'; allowed: FVA3, Spirax MA 80W, or ISO VG 2"),
    ],
)
def test_wrong_oils(text, said):
    with pytest.raises(InputError, match=said):
        Lubricant.named(text)


def test_no_index_of_a_thin_oil():
    with pytest.raises(InputError, match=r"viscosity index: got 1.5 mm2/s at 100 degC; allowed: 2 mm2/s and above"):
        viscosity_index(4.6, 1.5)


def test_a_job_needs_its_bearing_alone():
    job = parse_job('[bearing]\nname = "NU 210"\n', "job", "job.toml")
    assert job.lubricant.name == "FVA3" and job.shape == (2, 25, 12, 6)
    assert job.assumed[0] == "oil FVA3" and len(job.assumed) == 6
    shipped = read_job("nu308")
    assert (job.loads, job.entrainment_speeds, job.temperatures) == (
        shipped.loads, shipped.entrainment_speeds, shipped.temperatures
    )  # fmt: skip
    assert shipped.assumed == ()
    with pytest.raises(InputError, match=r"^job.toml: job file bearing: missing"):
        parse_job("", "job", "job.toml")


def test_assumed_temperatures_are_those_of_the_oil():
    job = read_job("NU210, ISO VG 1000")
    assert job.temperatures == pytest.approx([313.15, 333.15, 353.15, 373.15, 393.15])


def test_a_rating_of_the_catalogue_stands_beside_the_name():
    job = parse_job('[bearing]\nname = "NU210"\nbasic_static_rating = "75 kN"\n', "job", "job.toml")
    assert job.bearing == estimate("NU210", 75e3)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ((None, "FVA3", "nu308"), r"--oil: got 'FVA3' without --bearing"),
        ((None, None, None), r"JOB: missing; allowed: a job or map, or --bearing"),
        (("NU210", None, "nu308"), r"--bearing: got 'NU210' beside a job or map"),
        (("NU21O", "VG47", None), r"--bearing: bearing designation: got 'NU21O'.*\n--oil: viscosity class: got 'VG47'"),
    ],
)
def test_wrong_options(given, said):
    with pytest.raises(InputError, match=said):
        bearing_source(*given)


def test_sources():
    assert bearing_source("nu 210 ECP", "vg 46", None) == "NU210, vg 46"
    assert bearing_source(None, None, None, needed=False) is None
    assert designated_job("job.toml") is None and designated_job("nu308") is None
    assert designated_job("NU308").name == "NU308"
    assert Lubricant.named("FVA3").name in LUBRICANTS


def test_bands_follow_the_spread():
    """By film formulas a film goes with the root of alpha or a little more; k nearly with the length of the rollers."""
    job = parse_job(SMALL + '[solver]\nname = "formula"\n', "job", "job.toml")
    point = OperatingPoint(2e4, 2.0, 333.15)
    [(words, alpha)] = oil_bands(job, point, of_map(job))
    assert words == "estimated pressure-viscosity"
    assert 0.3 * 0.17 < alpha.film < 0.7 * 0.17 and alpha.stiffness < 0.02
    wide = geometry_band(job, point, of_map(job))
    close = geometry_band(
        parse_job(SMALL.replace('ECP"', 'ECP"\nbasic_static_rating = "63 kN"'), "job", ""), point, of_map(job)
    )
    assert 0.15 < wide.stiffness < 0.3 and close.stiffness < 0.7 * wide.stiffness
    known = read_job("NU308, FVA3")
    assert geometry_band(known, point, of_map(job)) is None and not list(oil_bands(known, point, of_map(job)))
    stated = parse_job(SMALL + '[solver]\nname = "formula"\n[tolerances]\npressure_viscosity = "5 %"\n', "job", "")
    [(words, small)] = oil_bands(stated, point, of_map(job))
    assert words == "pressure-viscosity, +-5 %" and small.film < 0.4 * alpha.film  # 5 of 17 %
    with pytest.raises(InputError, match="preload: unknown key"):
        parse_job(SMALL + '[tolerances]\npreload = "5 %"\n', "job", "")


TYPED = """
[bearing]
name = "NU308"
diametral_clearance = "25 um +- 5 um"
[lubricant]
viscosity_law = "roelands"
viscosity = "84.5 mPa s +- 5 %"
pressure_viscosity = "22.4 1/GPa +- 10 %"
density = "880 kg/m^3"
density_law = "dowson-higginson"
[grid]
load = ["10 N/mm", "20 N/mm", "40 N/mm", "80 N/mm"]
entrainment_speed = ["1 m/s", "2 m/s", "3 m/s", "4 m/s"]
temperature = ["40 degC +- 2 K"]
[tolerances]
viscosity = "50 %"
[solver]
name = "formula"
structural_law = "iso16281"
"""


def test_values_of_a_job_with_their_tolerances(tmp_path, capsys):
    """What stands behind a value is nearer than the table; the film is that of an oil so much thinner or thicker."""
    job, point = parse_job(TYPED, "job", ""), OperatingPoint(2e4, 2.0, 313.15)
    assert {name: one.text for name, one in job.tolerances.items()} == {
        "clearance": "+-5 um",
        "viscosity": "+-5 %",
        "pressure_viscosity": "+-10 %",
        "temperature": "+-2 K",
    }
    bands = dict(oil_bands(job, point, of_map(job)))
    other = parse_job(TYPED.replace("84.5 mPa s +- 5 %", "80.275 mPa s"), "job", "")  # so much thinner
    films = [
        min(ehdmaps.solve(c, each.lubricant, point, solver="formula").central_film for c in each.contacts)
        for each in (job, other)
    ]
    assert bands["viscosity, +-5 %"].film == pytest.approx(1.0 - films[1] / films[0], rel=1e-6)
    assert bands["temperature, +-2 K"].film == 0.0  # of an oil that is the same at all temperatures
    with pytest.raises(InputError) as caught:
        parse_job(TYPED.replace("+- 5 %", "+- 5 um").replace("+- 2 K", "+- 90 K"), "job", "")
    assert "[lubricant] viscosity: got '5 um'; allowed: " in str(caught.value)
    assert "[grid] temperature: got '90 K'; allowed: " in str(caught.value)
    path = tmp_path / "job.toml"
    path.write_text(TYPED)
    assert main(["generate", str(path), "-o", str(tmp_path / "map.nc")]) == 0
    assert (
        "not in the map: viscosity +-5 %, pressure-viscosity +-10 %, temperature +-2 K; its" in capsys.readouterr().out
    )
    ask = ["bearing", str(path), "--load", "5 kN", "--speed", "1500 rpm", "--bands", "all"]
    assert mbs_main([*ask, "--know", "temperature = 40 degC +- 1 K"]) == 0
    said = capsys.readouterr().out
    assert "held open: clearance 25 um +-5 um (as stated)" in said
    assert "temperature +-1 K (as stated), viscosity +-5 % (as stated), pressure-viscosity +-10 % (as stated)" in said
    path.write_text(TYPED[: TYPED.index("[lubricant]")])  # the bearing alone
    assert mbs_main([*ask, "--clearance", "20 um"]) == 0
    assert "held open: clearance 20 um +-5 um (stated bare" in capsys.readouterr().out


def run(command, words):
    """Run a command; its exit status says that it was done."""
    status = command(words.split("|"))
    assert status == 0, words


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("designation")


def test_the_first_commands_of_a_user(folder, monkeypatch, capsys):
    monkeypatch.chdir(folder)
    (folder / "job.toml").write_text(SMALL)
    run(main, "generate|job.toml|--workers|1")
    text = capsys.readouterr().out
    assert text.count("inner geometry estimated") == text.count("viscosity of ISO VG 150 by its class") == 1
    assert "assumed: solver reynolds, structural law iso16281" in text
    attributes = ehdmaps.open_map("job.nc").dataset.attrs
    assert attributes["job_assumed"] == "solver reynolds, structural law iso16281"
    assert json.loads(attributes["lubricant"])["name"] == "ISO VG 150, VI 140"
    assert ehdmaps.open_map("job.nc").lubricant == Lubricant.named("ISO VG 150, VI 140")
    run(main, "check|job.toml")
    text = capsys.readouterr().out
    assert text.count("inner geometry estimated") == 1 and text.count("the estimated inner geometry may change") == 1
    run(main, "solve|--bearing|NJ 2207|--oil|VG 150|--load|50 N/mm|--speed|2 m/s|--temperature|60 degC")
    run(mbs_main, "bearing|NJ 2207 ECP|--oil|ISO VG 150|--load|2 kN|--speed|1500 rpm|--law|table")
    assert "NJ2207" in capsys.readouterr().out


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        "show|job.nc",
        "compare|job.nc|job.nc",
        "check|--bearing|NJ2207|--oil|ISO VG 150, VI 140",
        "export|--bearing|NJ2207|--oil|VG150|-o|own.csv",
    ],
)
def test_every_command_of_ehdmaps(words, folder, monkeypatch):
    monkeypatch.chdir(folder)
    (folder / "job.toml").write_text(SMALL)
    if not (folder / "job.nc").exists():
        run(main, "generate|job.toml|--workers|1")
    run(main, words)


@pytest.mark.slow
@pytest.mark.parametrize("words", ["statics|scene.toml|--law|table", "plan|scene.toml|-o|plan.toml"])
def test_scenes_have_designations(words, folder, monkeypatch):
    from importlib import resources

    monkeypatch.chdir(folder)
    text = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text()
    text = text.replace('{ name = "NU308", diametral_clearance = "0 um" }', '"NU 2210 ECP"').replace(
        'name = "FVA3" ', 'name = "ISO VG 68"'
    )
    (folder / "scene.toml").write_text(text.replace("slices = 41", "slices = 5"))
    run(mbs_main, words)
