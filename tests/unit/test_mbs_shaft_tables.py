"""Shafts as tables: sections by lengths or of a CSV file, bearings by position, weight, new scenes."""

from __future__ import annotations

import dataclasses
import math
import re

import numpy as np
import pytest

from ehdmaps.errors import InputError
from mbs import assemble, cli, modes, parse_scene, read_scene, statics
from mbs.linearised.modes import undamped_modes
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.scene.shafts.new import MACHINES, new_shaft
from mbs.scene.shafts.rows import csv_rows, csv_sections
from tests.cases.reports import without_budget
from tests.conformance.test_shipped import SHORTER

IRON = 'youngs_modulus = "190 GPa", poisson_ratio = 0.28, density = "7200 kg/m^3"'
HEAD = """
schema = 1
[operation]
speed = "3000 rpm"
temperature = "60 degC"
"""
SHORT = (
    HEAD
    + """
[[shafts]]
name = "rotor"
sections = [
    { length = "60 mm", diameter = "50 mm" },
    { length = "130.7 mm", diameter = "62 mm", bore = "20 mm" },
    { length = "100.1 mm", diameter = "55 mm", IRON },
    { length = "50 mm", diameter = "30 mm" },
    { from = "62 mm", to = "100 mm", diameter = "90 mm", bore = "62 mm" },
]
discs = [
    { name = "gear", at = "140 mm", diameter = "180 mm", width = "24 mm", bore = "62 mm" },
    { at = "333 mm", mass = "2 kg", polar_inertia = "0.01 kg m^2", transverse_inertia = "0.006 kg m^2" },
]
[[bearings]]
name = "left"
bearing = "NU210"
shaft = "rotor"
position = "30 mm"
diametral_clearance = "15 um"
[[bearings]]
name = "right"
bearing = "NU206"
shaft = "rotor"
position = "315 mm"
[[loads]]
name = "mesh"
on = "rotor:gear"
force = ["0 N", "-700 N", "1.9 kN"]
"""
).replace("IRON", IRON)
LONG = (
    HEAD
    + """
gravity = ["0 m/s^2", "-9.80665 m/s^2", "0 m/s^2"]
[[shafts]]
name = "rotor"
freedoms = ["y", "z", "theta_y", "theta_z"]
spin = 1
cutoff = "5 kHz"
sections = [
    { from = "0 mm", to = "60 mm", diameter = "50 mm" },
    { from = "60 mm", to = "190.7 mm", diameter = "62 mm", bore = "20 mm" },
    { from = "190.7 mm", to = "290.8 mm", diameter = "55 mm", IRON },
    { from = "290.8 mm", to = "340.8 mm", diameter = "30 mm" },
    { from = "62 mm", to = "100 mm", diameter = "90 mm", bore = "62 mm" },
]
discs = [
    { from = "128 mm", to = "152 mm", diameter = "180 mm", bore = "62 mm" },
    { at = "333 mm", mass = "2 kg", polar_inertia = "0.01 kg m^2", transverse_inertia = "0.006 kg m^2" },
]
frames = { gear = "140 mm", left = "30 mm", right = "315 mm" }
[[bearings]]
name = "left"
inner = "rotor:left"
outer = "ground"
geometry = { estimate = "NU210", diametral_clearance = "15 um" }
[[bearings]]
name = "right"
inner = "rotor:right"
outer = "ground"
geometry = { estimate = "NU206" }
[[loads]]
name = "mesh"
on = "rotor:gear"
force = ["0 N", "-700 N", "1.9 kN"]
"""
).replace("IRON", IRON)


STEEL, CAST = 7850e-9, 7200e-9


def _ring(length: float, diameter: float, bore: float, density: float) -> float:
    """Mass of a hollow cylinder [kg], by mm and kg/mm3."""
    return length * math.pi / 4.0 * (diameter**2 - bore**2) * density


MASSES = (
    _ring(60.0, 50.0, 0.0, STEEL)
    + _ring(130.7, 62.0, 20.0, STEEL)
    + _ring(100.1, 55.0, 0.0, CAST)
    + _ring(50.0, 30.0, 0.0, STEEL)
    + _ring(38.0, 90.0, 62.0, STEEL),
    2.0 + _ring(24.0, 180.0, 62.0, STEEL),
)
"""Sections and discs of the shaft above [kg]."""


def scene_of(text, folder=None):
    return parse_scene(text, "own", "own.toml", folder)


def problems_of(text, folder=None) -> str:
    with pytest.raises(InputError) as found:
        scene_of(text, folder)
    return str(found.value)


def test_a_table_is_the_shaft_that_is_written_the_long_way():
    short, long = (statics(assemble(scene_of(text))) for text in (SHORT, LONG))
    for name in ("mass", "stiffness", "damping"):
        one, other = getattr(short.model.system, name), getattr(long.model.system, name)
        # Round-off of the ends of sections, which are sums of lengths.
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-11 * np.abs(other).max())
    # Round-off, and the residual of the equilibrium.
    np.testing.assert_allclose(short.balance.displacement, long.balance.displacement, rtol=1e-8, atol=1e-15)


def test_the_bearings_carry_the_weight_and_the_load():
    found = statics(assemble(scene_of(SHORT)))
    mass = sum(MASSES)
    force = sum(found.balance.forces[index] for index in range(2))
    # Residual of the equilibrium.
    np.testing.assert_allclose(force[1:3], [700.0 + 9.80665 * mass, -1900.0], rtol=1e-8)
    assert found.dataset.attrs["weight"] == "with weight (9.807 m/s2 along -y)"


def test_weight_is_on_where_a_shaft_is_a_table_and_no_gravity_is_stated():
    assert scene_of(SHORT).gravity == (0.0, -9.80665, 0.0)
    off = SHORT.replace("[[shafts]]", 'gravity = ["0 m/s^2", "0 m/s^2", "0 m/s^2"]\n[[shafts]]', 1)
    assert scene_of(off).gravity == (0.0, 0.0, 0.0)
    without = LONG.replace('gravity = ["0 m/s^2", "-9.80665 m/s^2", "0 m/s^2"]', "")
    assert scene_of(without).gravity == (0.0, 0.0, 0.0)
    assert statics(assemble(scene_of(without))).dataset.attrs["weight"].startswith("without weight")


PINNED = (
    HEAD.replace("3000 rpm", "0 rpm")
    + """
[[shafts]]
name = "rod"
sections = [{ length = "0.4 m", diameter = "10 mm" }, { length = "0.6 m", diameter = "10 mm" }]
cutoff = "1 kHz"
[[bearings]]
kind = "table"
name = "a"
shaft = "rod"
position = "0 m"
stiffness = { y = "1e10 N/m", z = "1e10 N/m" }
[[bearings]]
kind = "table"
name = "b"
shaft = "rod"
position = "1 m"
stiffness = { y = "1e10 N/m", z = "1e10 N/m" }
"""
)


def test_a_pinned_rod_has_the_frequencies_of_euler_and_bernoulli():
    found = modes(assemble(scene_of(PINNED))).dataset["frequency"].values
    modulus, density, d = 210e9, 7850.0, 0.01
    section = scene_of(PINNED).bodies[0].sections[0]
    assert (section.youngs_modulus, section.density) == (modulus, density)
    first = 0.5 * math.pi * math.sqrt(modulus * d**2 / 16.0 / density)
    # Shear and rotary inertia take (pi n d/(4 L))^2 (1 + E/(kappa G))/2: 1.2e-4 of the first, four times that next.
    np.testing.assert_allclose(found[:4], [first, first, 4.0 * first, 4.0 * first], rtol=6e-4)
    np.testing.assert_allclose(found[:2], first, rtol=1.5e-4)


def test_a_cut_off_that_nobody_states_is_one_that_modes_do_not_feel():
    overhung = PINNED.replace('cutoff = "1 kHz"\n', "").replace('"1 m"', '"0.93 m"').replace('"10 mm"', '"40 mm"')
    scene, highest = scene_of(overhung), 3000.0

    def model(**changed):
        return assemble(dataclasses.replace(scene, bodies=[dataclasses.replace(scene.bodies[0], **changed)]))

    # at rest and without damping
    beams = model(cutoff=None, largest_element=0.005, cutoff_stated=True).system
    whole = undamped_modes(equilibrium(beams, Operation())).frequency
    stated, raised = modes(model(cutoff_stated=True), highest=highest), modes(model(), highest=highest)
    assert [one.model.scene.bodies[0].cutoff for one in (stated, raised)] == [5e3, 1e4]
    seen = slice(int(np.count_nonzero(whole <= highest)))
    assert np.max(stated.modes.frequency[seen] / whole[seen] - 1.0) > 0.04
    # what is not felt, and the waves of the elements
    assert np.max(np.abs(raised.modes.frequency[seen] / whole[seen] - 1.0)) < 5e-4 + 1e-4
    assert np.max(np.abs(raised.modes.reduction.frequency / raised.modes.frequency)[seen]) < 5e-4
    assert scene_of(overhung.replace("40 mm", "5 m")).bodies[0].cutoff is None


def test_a_rotor_of_laval_has_the_frequency_of_its_disc_on_the_shaft():
    disc = 'discs = [{ name = "disc", at = "0.5 m", diameter = "200 mm", width = "20 mm" }]\n'
    found = modes(assemble(scene_of(PINNED.replace("cutoff", disc + "cutoff", 1)))).dataset["frequency"].values
    mass, rod = (math.pi / 4.0 * d**2 * length * 7850.0 for d, length in ((0.2, 0.02), (0.01, 1.0)))
    stiffness = 48.0 * 210e9 * math.pi * 0.01**4 / 64.0
    wanted = math.sqrt(stiffness / (mass + 17.0 / 35.0 * rod)) / (2.0 * math.pi)
    # Rayleigh's shape of the rod's own inertia, and shear: below 0.1 %.
    np.testing.assert_allclose(found[:2], wanted, rtol=1e-3)


CSV = """# machined
length [mm], Outer Diameter [mm], inner_diameter [mm], youngs modulus [GPa], poisson ratio, density [g/cm^3]
60, 50

130.7, 62, 20
100.1, 55, , 190, 0.28, 7.2
50, 30,
"""


def test_sections_of_a_file_are_those_of_the_scene(tmp_path):
    (tmp_path / "shaft.csv").write_text(CSV)
    begin, end = SHORT.index("sections = ["), SHORT.index("discs = [")
    scene = scene_of(f'{SHORT[:begin]}sections = "shaft.csv"\n{SHORT[end:]}', tmp_path)
    inline = scene_of(SHORT).bodies[0]
    shaft = scene.bodies[0]
    assert shaft.sections == inline.sections[:4]
    assert shaft == dataclasses.replace(inline, sections=inline.sections[:4])
    assert scene.gravity[1] < 0.0
    assert scene.files == (tmp_path / "shaft.csv",)
    (tmp_path / "shaft.csv").write_text(CSV.replace(",", ";"))
    assert csv_sections(tmp_path / "shaft.csv") == list(inline.sections[:4])


def test_cones_layers_and_point_masses_of_a_file_are_those_of_the_scene(tmp_path):
    rows = [
        "length [mm], outer diameter [mm], inner diameter [mm], end outer diameter [mm], end inner diameter [mm], "
        "youngs modulus [GPa], poisson ratio",
        "100, 40, 10, 60, 20, ,",
        "50, 60, , , , 190, -0.1",
    ]
    (tmp_path / "rotor.csv").write_text("\n".join(rows), encoding="utf-8")
    cone, bar = csv_sections(tmp_path / "rotor.csv")
    assert (cone.diameter, cone.bore, cone.last_diameter, cone.last_bore) == (0.04, 0.01, 0.06, 0.02)
    assert (bar.diameter, bar.last_diameter, bar.tapered, bar.poisson_ratio) == (0.06, 0.06, False, -0.1)
    text = (
        HEAD
        + """
[[shafts]]
name = "rotor"
sections = [
    { length = "0.1 m", diameter = "40 mm", end_diameter = "60 mm", bore = "10 mm", end_bore = "20 mm" },
    { from = "0 mm", to = "50 mm", diameter = "80 mm", bore = "60 mm", youngs_modulus = "0 Pa" },
]
discs = [{ name = "end", at = "100 mm", mass = "2 kg" }]
[[bodies]]
name = "foot"
freedoms = ["y", "z"]
mass = "3 kg"
"""
    )
    shaft = next(body for body in parse_scene(text, "a", "a").bodies if body.name == "rotor")
    assert shaft.sections[0] == cone
    assert shaft.sections[1].youngs_modulus == 0.0
    assert (shaft.discs[0].inertia.polar, shaft.discs[0].inertia.transverse) == (0.0, 0.0)
    foot = next(body for body in parse_scene(text, "a", "a").bodies if body.name == "foot")
    assert foot.parts[0].mass == 3.0


@pytest.mark.parametrize(
    ("content", "texts"),
    [
        (b"", ["has no lines"]),
        (b"length,diameter [mm]\n60,50\n", ["column 'length': has no unit; allowed: in brackets"]),
        (b"length [mm],diameter [mm],diameter [m]\n60,50\n", ["'diameter [m]' twice"]),
        (b"length [mm],width [mm]\n60,50\n", ["got the column 'width [mm]'", "has no column of the diameter"]),
        (b"length [mm],diameter [mm]\n60,50,40\n", ["line 2: got 3 cells; allowed: up to 2"]),
        (b'length [mm],diameter [mm]\n"60,50\n', ["is not CSV"]),
        (b'length [mm],diameter [mm]\n"60\n",50\n', ["a cell goes over several lines"]),
        (b"length [mm],diameter [mm]\n" + 401 * b"1,50\n", ["got 401 rows; allowed: 1 to 400"]),
        (b"\x89PNG\r\n\x1a\n\x00\xff", ["is not UTF-8 text"]),
        (b"length [mm],diameter [mm]\n" + b"1" * 1_000_001, ["longer than 1000000 bytes"]),
    ],
)
def test_a_file_that_is_no_table_of_sections_is_refused(content, texts, tmp_path):
    path = tmp_path / "bad.csv"
    path.write_bytes(content)
    with pytest.raises(InputError) as found:
        csv_rows(path)
    for text in texts:
        assert text in str(found.value)
    # The same by a scene, and by a new one.
    assert texts[0] in problems_of(SHORT.replace("sections = [", 'sections = "bad.csv"\nnone = [', 1), tmp_path)
    with pytest.raises(InputError, match=r"bad\.csv"):
        new_shaft(tmp_path / "new.toml", path)


@pytest.mark.parametrize("mark", [";", "\t"])
def test_decimal_commas(mark, tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(f"length [mm]{mark}diameter [mm]\n18,5{mark}30,25\n")
    assert csv_rows(path)[0][1] == {"length": "18.5 mm", "diameter": "30.25 mm"}


@pytest.mark.parametrize(
    ("rows", "text"),
    [
        ("-60,50", "line 2 length: got '-60 mm'; allowed: 0.001 mm"),
        ("60,0", "line 2 diameter: got '0 mm'"),
        ("nan,50", "line 2 length: got 'nan mm', which does not start with a number"),
        ("60", "line 2 diameter: missing"),
        ("6\x000,50", "line 2 length: got '6\\x000 mm'"),
        ("1e999,50", "line 2 length: got '1e999 mm'"),
        ("", "got no rows; allowed: 1 to 400"),
    ],
)
def test_a_row_that_is_no_section_is_refused(rows, text, tmp_path):
    path = tmp_path / "bad.csv"
    path.write_text(f"length [mm],diameter [mm]\n{rows}\n")
    with pytest.raises(InputError) as found:
        csv_sections(path)
    assert text in str(found.value)


@pytest.mark.parametrize(
    ("old", "new", "texts"),
    [
        ('length = "60 mm"', 'length = "-60 mm"', ["sections[0] length: got '-60 mm'"]),
        ('length = "60 mm"', 'length = "60 mm", to = "3 mm"', ["sections[0] to: stands beside length"]),
        ('length = "60 mm"', "length = nan", ["sections[0] length: got nan"]),
        ('"90 mm", bore = "62 mm"', '"90 mm"', ["sections[1] and sections[4]: both fill x = 62 to 100 mm"]),
        ('position = "30 mm"', 'position = "400 mm"', ["frames left: got x = 400 mm; allowed: 0 to 340.8 mm"]),
        ('position = "30 mm"', 'position = "nan mm"', ["[[bearings]] left position: got 'nan mm'"]),
        ('position = "30 mm"', "", ["[[bearings]] left position: missing"]),
        ('shaft = "rotor"', "", ["[[bearings]] left shaft: missing"]),
        ('shaft = "rotor"', "shaft = 3", ["[[bearings]] left shaft: got 3; allowed: the name of a shaft"]),
        ('shaft = "rotor"', 'shaft = "rotor"\ninner = "rotor:gear"', ["left inner: stands beside shaft and position"]),
        ('bearing = "NU210"', 'bearing = "NU999"', ["[[bearings]] left bearing: ", "got 'NU999'"]),
        ('bearing = "NU210"', "bearing = 210", ["[[bearings]] left bearing: got 210; allowed: a designation"]),
        ('bearing = "NU210"', "", ["[[bearings]] left bearing: missing; allowed: a designation"]),
        ('bearing = "NU210"', 'bearing = "NU210"\ngeometry = {}', ["left geometry: stands beside bearing"]),
        ('name = "gear", at', 'name = "left", at', ["discs: got the name 'left', which a bearing on the shaft has"]),
        ("{ at", '{ name = "gear", at', ["discs[1] name: got 'gear' twice"]),
        ('width = "24 mm", ', "", ["discs[0] width: missing"]),
        ('at = "140 mm"', 'at = "341 mm"', ["discs[0]: got x = 341 mm; allowed: 0 to 340.8 mm"]),
        ('name = "rotor"', 'name = "rotor"\nframes = { left = "1 mm" }', ["frames left: is the name of a disc or of"]),
    ],
)
def test_every_slip_is_said(old, new, texts):
    found = problems_of(SHORT.replace(old, new, 1))
    for text in texts:
        assert text in found


def test_a_shaft_that_is_not_there_is_missed_when_the_scene_is_put_together():
    scene = scene_of(SHORT.replace('shaft = "rotor"', 'shaft = "rotar"', 1))
    with pytest.raises(InputError, match=r"bearing 'left': got the body 'rotar' \(did you mean 'rotor'\?\)"):
        assemble(scene)


def test_a_new_scene_is_read_and_stands(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert cli.main(["new", "shaft"]) == 0
    found = statics(assemble(read_scene("shaft.toml"), law="hertz"))
    assert not found.free
    assert found.model.scene.gravity[1] < 0.0
    content = (tmp_path / "shaft.toml").read_bytes()
    capsys.readouterr()
    assert cli.main(["new", "shaft"]) == 2
    assert "-o: got shaft.toml, which is there" in capsys.readouterr().err
    assert (tmp_path / "shaft.toml").read_bytes() == content


def test_a_new_scene_of_a_file_of_sections(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sub").mkdir()
    (tmp_path / "one.csv").write_text("length [m],diameter [m]\n0.5,0.06\n")
    assert cli.main(["new", "shaft", "--csv", "one.csv", "-o", "sub/own.toml"]) == 0
    scene = read_scene("sub/own.toml")
    assert {entry.geometry.name for entry in scene.bearings} == {"NU212"}
    np.testing.assert_allclose([scene.bodies[0].frames[name] for name in ("left", "right")], [0.05, 0.45])
    assert cli.main(["new", "shaft", "--csv", "sub/own.toml", "-o", "sub/own.toml"]) == 2
    said = capsys.readouterr().err
    assert "--csv: sub/own.toml" in said and "-o: got sub/own.toml" in said


@pytest.mark.parametrize(
    "content",
    [
        "length [mm],outer diameter [mm],inner diameter [mm]\n60,50,10\n40,60,0\n",
        "L (mm),D (mm),d (mm)\n60,50,10\n40,60,0\n",
        "d_mm;D_mm;length_mm\n10;50,0;60\n0;60;40\n",
        "x / mm,D / mm,d / mm\n0,50,10\n60,60,0\n100,,\n",
        "from [m],to [cm],diameter [mm],bore [mm]\n0,6,50,10\n0.06,10,60,\n",
    ],
)
def test_titles_of_columns_as_drawings_have_them(content, tmp_path):
    (tmp_path / "a.csv").write_text(content)
    first, second = csv_sections(tmp_path / "a.csv")
    held = [(part.begin, part.end, part.diameter, part.bore) for part in (first, second)]
    np.testing.assert_allclose(held, [(0.0, 0.06, 0.05, 0.01), (0.06, 0.1, 0.06, 0.0)], rtol=1e-12)


@pytest.mark.parametrize(
    ("content", "text"),
    [
        ("x [mm],D [mm]\n0,50\n", "got 1 rows with x; allowed: at least two"),
        ("x [mm],D [mm]\n0,50\n,40\n9,\n", "line 3: has no x; allowed: one in each row"),
        ("x [mm],length [mm],D [mm]\n0,1,50\n", "got x beside length, from or to"),
        ("d [mm],diameter [mm],length [mm]\n1,2,3\n", "got the column 'diameter [mm]' twice"),
    ],
)
def test_places_that_leave_a_section_open_are_refused(content, text, tmp_path):
    (tmp_path / "a.csv").write_text(content)
    with pytest.raises(InputError, match=re.escape(text)):
        csv_sections(tmp_path / "a.csv")


@pytest.mark.parametrize("what", sorted(MACHINES))
def test_a_new_machine_is_the_shipped_one_and_names_its_own_file(what, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert cli.main(["new", what]) == 0
    text = (tmp_path / f"{what}.toml").read_text()
    assert f"mbs statics {what}.toml " in text
    assert read_scene(f"{what}.toml").bearings == read_scene(MACHINES[what]).bearings
    assert cli.main(["new", what, "--csv", f"{what}.toml", "-o", "other.toml"]) == 2
    assert "--csv: got it beside" in capsys.readouterr().err


def test_a_name_that_no_text_holds_is_refused(tmp_path):
    with pytest.raises(InputError, match="printable characters; rename the file"):
        new_shaft(tmp_path / "a\nb.toml")


def test_a_check_tells_what_will_be_solved(tmp_path, capsys):
    path = tmp_path / "own.toml"
    path.write_text(SHORT)
    assert cli.main(["check", str(path), "--law", "hertz"]) == 0
    said = capsys.readouterr().out
    assert "with weight (9.807 m/s2 along -y)" in said
    assert f"shaft rotor: 340.8 mm, {MASSES[0]:.4g} kg and discs of {MASSES[1]:.4g} kg, modes up to 5000 Hz" in said
    assert "14 coordinates in all" in said
    assert "bearing right: NU206 (estimated), 13 rollers, clearance 22.5 um, rotor:right at 315 mm in ground" in said
    assert "mbs statics, modes, report: one speed" in said
    assert "mbs sweep: not yet: no speeds" in said and "mbs hammer: not yet: [[inputs]] missing" in said
    path.write_text(SHORT.replace('"30 mm"', '"9 m"', 1).replace('"NU206"', '"NU1"'))
    assert cli.main(["check", str(path)]) == 2
    assert "mbs check: " in (said := capsys.readouterr().err) and "NU1" in said


@pytest.mark.slow
def test_every_analysis_runs_on_a_new_scene(tmp_path, monkeypatch, capsys):
    """With fewer points and a short run-up; error budgets have other tests."""
    without_budget(monkeypatch)
    monkeypatch.chdir(tmp_path)
    assert cli.main(["new", "shaft"]) == 0
    for pattern, short in SHORTER:
        text = re.sub(pattern, short, (tmp_path / "shaft.toml").read_text("utf-8"))
        (tmp_path / "shaft.toml").write_text(text, "utf-8")
    assert cli.main(["run", "shaft.toml", "--law", "hertz"]) in (0, 1)
    said = capsys.readouterr()
    assert "no result" not in said.out and "error" not in said.err


def test_materials_by_name():
    """Those of the table, and a density that is stated beside."""
    parts = (
        ('material = "aluminium"', 2700.0),
        ('material = "cast iron", density = "7300 kg/m^3"', 7300.0),
        ("", 7850.0),
    )
    for words, density in parts:
        text = SHORT.replace('width = "24 mm", bore', f'width = "24 mm", {words}{", " if words else ""}bore')
        text = text.replace('length = "50 mm", diameter', f'length = "50 mm", {words}{", " if words else ""}diameter')
        (shaft,) = parse_scene(text, "a", "a").bodies
        volume = math.pi / 4.0 * (0.18**2 - 0.062**2) * 0.024
        assert shaft.discs[0].inertia.mass == pytest.approx(density * volume, rel=1e-12)  # round-off
        assert shaft.sections[3].density == density
        assert shaft.sections[3].youngs_modulus == {2700.0: 70e9, 7300.0: 110e9}.get(density, 210e9)
    with pytest.raises(InputError, match=r"material: got 'wood'; allowed: .*aluminium"):
        parse_scene(SHORT.replace('width = "24 mm"', 'width = "24 mm", material = "wood"'), "a", "a")
