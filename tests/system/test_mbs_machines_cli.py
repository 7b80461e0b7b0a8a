"""The command line `mbs` as somebody meets it who builds a machine of his own, or breaks one."""

from __future__ import annotations

import math
import os
import shutil
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
import xarray as xr

import mbs
from ehdmaps.errors import InputError
from ehdmaps.maps.emap import open_map
from mbs.analyses import ramp
from mbs.bearings.bearing_element import RingElement
from mbs.linearised.averaged import steady_system
from mbs.linearised.modes import modes
from mbs.model.equilibrium import equilibrium
from mbs.scene.assembly import assemble
from mbs.scene.reader import parse_scene, read_scene
from tests.cases.commands import run

HEAD = """
schema = 1
title = "{title}"
[operation]
speed = "{speed}"
temperature = "40 degC"
[lubricant]
name = "FVA3"
"""

SHAFT = """
[[shafts]]
name = "{name}"
freedoms = ["y", "z", "theta_x", "theta_y", "theta_z"]
position = ["0 mm", "0 mm", "0 mm"]
sections = [{{ from = "0 mm", to = "300 mm", diameter = "30 mm" }}]
frames = {{ left = "0 mm", middle = "150 mm", right = "300 mm" }}
cutoff = "10 kHz"
damping_ratio = 0.05
"""

SPRING = """
[[springs]]
name = "{name}"
on = "{on}"
stiffness = {{ y = "1e7 N/m", z = "1e7 N/m", theta_x = "100 N m/rad" }}
damping = {{ y = "1e3 N s/m", z = "1e3 N s/m", theta_x = "0.1 N m s/rad" }}
"""

SEEN = """
[[loads]]
name = "shaker"
on = "{on}"
force = ["0 N", "0 N", "10 N"]
frequency = "400 Hz"
[[inputs]]
name = "E"
on = "{on}"
direction = "z"
[[sensors]]
name = "{sensor}"
on = "{on}"
direction = "z"
quantity = "acceleration"
[linear]
frequencies = ["400 Hz"]
[sweep]
from = "0 rpm"
to = "3000 rpm"
points = 3
[runup]
from = "0 rpm"
to = "3000 rpm"
duration = "0.8 s"
step = "40 us"
sample = "40 us"
[campbell]
highest = "1 kHz"
"""

SPIN = 21.0 / 23.0


def shaft_on_springs(name="shaft", sensor="S", title="shaft on springs", speed="1000 rpm"):
    springs = SPRING.format(name="one", on=f"{name}:left") + SPRING.format(name="other", on=f"{name}:right")
    seen = SEEN.format(on=f"{name}:middle", sensor=sensor)
    return HEAD.format(title=title, speed=speed) + SHAFT.format(name=name) + springs + seen


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "springs.toml").write_text(shaft_on_springs(), encoding="utf-8")
    text = read_scene("nu308_rigid").text
    (tmp_path / "own.toml").write_text(text, encoding="utf-8")
    (tmp_path / "unloaded.toml").write_text(
        text.replace('"100 N", "100 N"', '"0 N", "0 N"').replace('"0 um"', '"20 um"'), encoding="utf-8"
    )
    return tmp_path


class TestFiles:
    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("arguments", "words"),
        [
            (("-o", "own.toml"), "-o: got own.toml, which would be written over own.toml, which is read"),
            (("-o", "./sub/../own.toml"), "which would be written over own.toml"),
            (("--plot", "own.toml"), "--plot: got own.toml; allowed: a file that ends in .png, .pdf, .svg"),
            (("-o", "a.png", "--plot", "a.png"), "-o: got a.png; allowed: a file in netCDF, which ends in .nc"),
            (("-o", "sub"), "-o: got sub, which is a folder; allowed: a file in it"),
            (("--plot", "a\0.png"), "allowed: the path of a file"),
            (("-o", "pipe"), "-o: got pipe, which is no regular file"),
        ],
    )
    def test_what_cannot_be_written_is_said_before_anything_is_computed(
        self, here, capsys, monkeypatch, arguments, words
    ):
        (here / "sub").mkdir()
        os.mkfifo(here / "pipe")
        before = (here / "own.toml").read_bytes()
        monkeypatch.setattr("mbs.analyses.runup.run_system", None)  # a call of it fails
        for command in ("statics", "modes", "lsa", "runup"):
            status, out, err = run(capsys, command, "own.toml", *arguments)
            assert (status, out) == (2, "")
            assert words in err
        assert (here / "own.toml").read_bytes() == before
        assert sorted(entry.name for entry in here.iterdir()) == [
            "own.toml",
            "pipe",
            "springs.toml",
            "sub",
            "unloaded.toml",
        ]
        assert (here / "pipe").is_fifo()

    def test_a_map_is_not_written_over(self, here, capsys):
        (here / "map.nc").write_bytes(b"hours of work")
        status, _, err = run(capsys, "statics", "own.toml", "--map", "map.nc", "-o", "map.nc")
        assert status == 2
        assert "-o: got map.nc, which would be written over map.nc" in err
        assert (here / "map.nc").read_bytes() == b"hours of work"

    @pytest.mark.slow
    def test_a_body_that_the_scene_reads_is_not_written_over(self, here, capsys):
        folder = Path(mbs.__file__).parent / "systems"
        shutil.copy(folder / "nu308_flexible.toml", here / "machine.toml")
        body = shutil.copy(folder / "nu308_housing.nc", here)
        before = Path(body).read_bytes()
        for command in ("statics", "runup"):
            status, _, err = run(capsys, command, "machine.toml", "-o", "./nu308_housing.nc")
            assert status == 2
            assert "nu308_housing.nc, which is read; choose another name" in err
        # nor, by the kind of file that it is, from a scene that does not read it
        status, _, err = run(capsys, "statics", "own.toml", "-o", "nu308_housing.nc")
        assert status == 2
        assert "nu308_housing.nc, which is there and is not a result of mbs" in err
        assert Path(body).read_bytes() == before

    def test_a_name_too_long_for_a_file(self, here, capsys):
        status, _, err = run(capsys, "statics", 5000 * "a", "-o", 5000 * "b")
        assert status == 2
        assert "cannot be read" in err

    @pytest.mark.slow
    def test_a_mark_at_the_beginning_of_the_file(self, here, capsys):
        """Some editors write one."""
        (here / "marked.toml").write_text((here / "own.toml").read_text(encoding="utf-8"), encoding="utf-8-sig")
        assert run(capsys, "statics", "marked.toml")[0] == 0


class TestWithoutLoad:
    @pytest.mark.slow
    def test_there_is_an_equilibrium(self, here, capsys, formula_map):
        """The films push from all sides: what they leave over is round-off, and was taken for a load."""
        status, _, err = run(capsys, "statics", "unloaded.toml", "--map", formula_map, "-o", "u.nc", "--plot", "u.png")
        assert (status, err) == (0, "")
        with xr.open_dataset("u.nc") as data:
            # round-off of a film's force of some newtons
            assert np.max(np.abs(data["bearing_force"])) < 1e-9
            assert np.max(np.abs(data["displacement"])) < 1e-12
            assert data.attrs["residual"] < 1.0
        assert run(capsys, "modes", "unloaded.toml", "--map", formula_map)[0] == 0
        assert run(capsys, "sweep", "unloaded.toml", "--map", formula_map, "--speed", "0 rpm", "500 rpm", "2")[0] == 0

    def test_no_film_at_rest_is_said_in_words(self, here, capsys, formula_map):
        text = (here / "own.toml").read_text(encoding="utf-8").replace('speed = "500 rpm"', 'speed = "0 rpm"')
        (here / "rest.toml").write_text(text, encoding="utf-8")
        _, out, _ = run(capsys, "modes", "rest.toml", "--map", formula_map)
        assert "bearing_left: at rest no film: the stiffness is that of dry contacts, no damping" in out
        assert "inf" not in out
        _, out, _ = run(capsys, "statics", "rest.toml", "--map", formula_map)
        assert "films follow" not in out


class TestWithoutBearings:
    def test_every_command(self, here, capsys):
        for command in ("statics", "modes", "lsa", "runup", "sweep", "campbell"):
            figure = ("--plot", f"{command}.png") if command in ("runup", "sweep") else ()
            status, out, err = run(capsys, command, "springs.toml", "-o", "a.nc", *figure)
            assert status == 0, err
            assert "warning" not in out.lower()
            with xr.open_dataset("a.nc") as data:
                if "bearing" in data.coords:
                    assert data["bearing"].dtype.kind in "OUS"
            if figure:
                assert matplotlib.image.imread(f"{command}.png").shape[2] == 4

    def test_a_sweep_lists_and_draws_all_modes(self, here, capsys):
        _, out, _ = run(capsys, "sweep", "springs.toml", "-o", "s.nc")
        with xr.open_dataset("s.nc") as data:
            for frequency in data["frequency"].values[0, 0, :4]:
                assert f"{frequency:.5g} to" in out

    def test_a_response_of_nothing_is_drawn(self, here, capsys):
        """At rest y does not move z; the figure has a logarithmic axis."""
        text = shaft_on_springs(speed="0 rpm").replace('direction = "z"\n[[sensors]]', 'direction = "y"\n[[sensors]]')
        (here / "across.toml").write_text(text, encoding="utf-8")
        status, out, err = run(capsys, "lsa", "across.toml", "--plot", "a.png")
        assert (status, err) == (0, "")
        assert "by E: no peak" in out

    def test_there_are_no_rollers_to_draw(self, here, capsys):
        status, _, err = run(capsys, "statics", "springs.toml", "-o", "a.nc", "--plot", "a.png")
        assert status == 2
        assert "--plot: springs has no bearing of rollers or balls to draw" in err
        assert not (here / "a.nc").exists()

    def test_level_of_a_sine(self, here, capsys):
        """Amplitude of the response times that of the load, over the root of two; the start has died out."""
        run(capsys, "lsa", "springs.toml", "-o", "l.nc")
        run(capsys, "campbell", "springs.toml", "-o", "c.nc")
        with xr.open_dataset("l.nc") as data:
            at = np.argmin(np.abs(data["frequency"].values - 400.0))
            size = float(np.hypot(data["response_real"][at], data["response_imaginary"][at]).squeeze())
        expected = 20.0 * math.log10(10.0 * size / math.sqrt(2.0) / 1e-6)
        with xr.open_dataset("c.nc") as data:
            found = data["sum_level"].values[0]
        # 0.1 dB: steps of 40 us of which 62 make a period bend it by 1 %, windows of a ramp leave some noise
        np.testing.assert_allclose(found[found.size // 4 :], expected, atol=0.1)


class TestNames:
    def test_names_are_no_formulas(self, here, capsys):
        text = shaft_on_springs(name="a$_1^$", sensor="$_{", title="5 $ and 6 $ \\\\frac")
        (here / "names.toml").write_text(text, encoding="utf-8")
        for command in ("modes", "lsa"):
            status, _, err = run(capsys, command, "names.toml", "--plot", f"{command}.png")
            assert status == 0, err

    def test_letters_that_the_font_lacks_are_said_on_stdout(self, here, capsys):
        (here / "names.toml").write_text(shaft_on_springs(name="轴"), encoding="utf-8")
        status, out, _ = run(capsys, "modes", "names.toml", "--plot", "a.png")
        assert status == 0
        assert "warning: a.png: Glyph" in out


class TestWithoutEffect:
    """What does nothing is hardly meant, and was taken in silence."""

    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("old", "new", "words"),
        [
            (
                'outer = "ring_left"',
                'outer = "shaft:left"',
                "bearing 'bearing_left': got shaft:left and shaft:left; allowed: rings on two bodies",
            ),
            (
                'on = "ring_left"\nstiffness',
                'on = "ring_left"\nagainst = "ring_left"\nstiffness',
                "spring 'mount_left': ring_left and ring_left do not move against each other",
            ),
            (
                'against = "ring_left"\nforce = ["0 N", "100 N", "100 N"]',
                'moment = ["100 N m", "0 N m", "0 N m"]',
                "load 'preload_left': no freedom moves shaft:left against ground along its direction",
            ),
            (
                "direction = [0, 1, 1]                   #",
                'direction = "x" #',
                "input 'E1': no freedom moves shaft:left against ground along its direction",
            ),
            (
                'on = "ring_left"\ndirection = [0, 1, 1]',
                'on = "ring_left"\ndirection = "theta_z"',
                "sensor 'S1': no freedom moves ring_left against ground along its direction",
            ),
        ],
    )
    def test_is_refused(self, here, capsys, old, new, words):
        text = (here / "own.toml").read_text(encoding="utf-8")
        assert old in text
        (here / "idle.toml").write_text(text.replace(old, new, 1), encoding="utf-8")
        status, _, err = run(capsys, "statics", "idle.toml")
        assert status == 2
        assert words in err
        assert "1 problem" in err


class TestCampbell:
    def arguments(self):
        return ("campbell", "springs.toml", "--law", "hertz", "--law", "formula", "--law", "constant:soft")

    @pytest.fixture(autouse=True)
    def scene(self, here):
        with (here / "springs.toml").open("a") as file:
            file.write('[laws.soft]\nstiffness = "1e7 N/m"\n')

    @pytest.mark.parametrize("at", [0, 1, 2])
    def test_what_is_done_is_kept_when_it_is_stopped(self, here, capsys, monkeypatch, at):
        calls = iter(range(9))
        whole = ramp.run_system

        def stopped(*arguments, **keywords):
            if next(calls) == at:
                raise KeyboardInterrupt
            return whole(*arguments, **keywords)

        monkeypatch.setattr(ramp, "run_system", stopped)
        # in this process, where the run is stopped; side by side it is that of `test_side_by_side`
        status, out, err = run(capsys, *self.arguments(), "-o", "c.nc", "--workers", "1")
        if at == 0:
            assert status == 130
            assert "stopped" in err
            return
        assert status == 1
        labels = ["dry Hertz", "film formula", "constant soft"]
        with xr.open_dataset("c.nc") as data:
            assert data["law"].values.tolist() == labels[:at]
        for label in labels[at:]:
            assert f"warning: {label}: stopped, no result" in out

    @pytest.mark.parametrize("duration", ["100000 s", "1 ms"])
    def test_runs_that_are_too_long_or_too_short(self, here, capsys, duration):
        path = here / "springs.toml"
        path.write_text(path.read_text().replace('"0.8 s"', f'"{duration}"'))
        status, _, err = run(capsys, *self.arguments())
        assert status == 2
        assert "[runup] duration: got" in err
        assert "allowed: 64 to 5000000" in err


def test_factors_that_are_no_numbers_are_said_to_be_so():
    text = read_scene("nu308_rigid").text.replace(
        'name = "preload_left"', 'name = "preload_left"\ntimes = ["0 s", "1 s"]\nfactors = [1.0, nan]'
    )
    with pytest.raises(
        InputError, match="preload_left factors: got a list of 2 entries; allowed: as many finite numbers"
    ):
        parse_scene(text, "a", "a")


GEAR_SHAFT = """
[[shafts]]
name = "{name}"
freedoms = ["y", "z", "theta_x", "theta_y", "theta_z"]
position = ["-120 mm", "{y!r} mm", "{z!r} mm"]
spin = {spin!r}
sections = [{{ from = "0 mm", to = "240 mm", diameter = "40 mm" }}]
discs = [{{ from = "107.5 mm", to = "132.5 mm", diameter = "94.5 mm", bore = "40 mm" }}]
frames = {{ left = "40 mm", gear = "120 mm", right = "200 mm" }}
cutoff = "6 kHz"
damping_ratio = 0.005
[[springs]]
name = "coupling_{name}"
on = "{name}:left"
stiffness = {{ theta_x = "500 N m/rad" }}
[[loads]]
name = "torque_{name}"
on = "{name}:left"
moment = ["{torque!r} N m", "0 N m", "0 N m"]
"""

GEAR_BEARING = """
[[bearings]]
name = "bearing_{name}_{at}"
inner = "{name}:{at}"
outer = "ground"
geometry = {{ name = "NU308", diametral_clearance = "30 um" }}
slices = 11
start_angle = "{angle!r} deg"
"""

GEARS = """
[[gears]]
name = "mesh"
on = "first:gear"
against = "second:gear"
teeth = [21, 23]
module = "4.5 mm"
pressure_angle = "20 deg"
face_width = "25 mm"
stiffness = "14 N/(um mm)"
damping = "2e3 N s/m"
backlash = "0 mm"
"""


def turned_gears(emap, turned=0.0, side=1.0, angle=0.0):
    """Two shafts with a gear pair, the second one at an angle [degrees] beside the first, or on the other side."""
    turn = math.radians(turned)
    places = (0.0, 0.0), (99.0 * side * math.cos(turn), 99.0 * side * math.sin(turn))
    text = HEAD.format(title="gears", speed="1500 rpm")
    for name, (y, z), spin, torque in zip(
        ("first", "second"), places, (side, -SPIN * side), (82.0 * side, 82.0 / SPIN * side), strict=True
    ):
        text += GEAR_SHAFT.format(name=name, y=y, z=z, spin=spin, torque=torque)
        for at in ("left", "right"):
            text += GEAR_BEARING.format(name=name, at=at, angle=angle)
    model = assemble(parse_scene(text + GEARS, "gears", "gears"), "map", emap, None)
    return model, equilibrium(steady_system(model.system), model.operation)


def places(model, balance):
    """Displacement (4, 6) of both ends of both shafts."""
    rows = [model.system.relative(f"{name}:{at}") for name in ("first", "second") for at in ("left", "right")]
    return np.array([row @ balance.displacement for row in rows])


@pytest.fixture(scope="module")
def emap(formula_map):
    return open_map(formula_map)


@pytest.fixture(scope="module")
def straight(emap):
    return turned_gears(emap)


class TestSymmetry:
    """Of gears on films: what is turned or mirrored as a whole does the same, turned or mirrored."""

    def test_turned_about_the_axis(self, emap, straight):
        turned = turned_gears(emap, turned=17.0, angle=17.0)
        sine, cosine = math.sin(math.radians(17.0)), math.cos(math.radians(17.0))
        rotation = np.kron(np.eye(2), [[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]])
        expected = places(*straight) @ rotation.T
        # what Newton leaves over, 1e-10 of the forces
        np.testing.assert_allclose(places(*turned), expected, atol=1e-9 * np.max(np.abs(expected)))
        np.testing.assert_allclose(modes(turned[1]).frequency, modes(straight[1]).frequency, rtol=1e-9)

    def test_cages_a_pitch_further(self, emap, straight):
        further = turned_gears(emap, angle=30.0)
        np.testing.assert_allclose(places(*further), places(*straight), atol=1e-14)

    def test_mirrored(self, emap, straight):
        """y turns round, and so do tilts about x and z; without backlash and error the other flank does the same."""
        mirrored = turned_gears(emap, side=-1.0)
        expected = places(*straight) * [1.0, -1.0, 1.0, -1.0, 1.0, -1.0]
        np.testing.assert_allclose(places(*mirrored), expected, atol=1e-9 * np.max(np.abs(expected)))
        np.testing.assert_allclose(modes(mirrored[1]).frequency, modes(straight[1]).frequency, rtol=1e-9)

    def test_bearings_of_each_shaft_carry_the_tooth_force(self, straight):
        model, balance = straight
        lever = 0.5 * 4.5e-3 * 21 * math.cos(math.radians(20.0))
        coupling = 500.0 * places(*straight)[0, 3]
        for name in ("first", "second"):
            carried = sum(
                balance.forces[i][:3]
                for i in model.system.select(RingElement)
                if model.system.elements[i].element.name.startswith(f"bearing_{name}")
            )
            assert np.hypot(carried[1], carried[2]) == pytest.approx((82.0 - coupling) / lever, rel=1e-9)
