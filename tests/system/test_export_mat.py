"""`ehdmaps export --to mat`: what Octave reads is what the map holds, and between its points the law."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator
from scipy.io import loadmat, savemat

import ehdmaps
from ehdmaps.exports.resampled import READING
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.make.generate import generate
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.closed_form import FormulaSolver
from tests.cases.jobs import DRY, LINE, SMALL, map_job
from tests.cases.programs import needed
from tests.conftest import made_map

HOSTILE = "x'); system('touch hit'); % é ☃"

SCRIPT = """
s = load('a''b%.mat'); m = s.map;
n = [numel(m.load), numel(m.entrainment_speed), numel(m.temperature)];
l = log(m.load); u = log(m.entrainment_speed); t = m.temperature;
lq = [l(1:end-1) + 0.3 * diff(l); l(2)]; uq = [repmat(u(1) + 0.6 * (u(2) - u(1)), numel(lq) - 1, 1); u(2)];
for name = {'inner', 'outer'}
  for field = {'approach', 'stiffness', 'damping', 'central_film'}
    v = m.(name{1}).(field{1});
    printf('%.17g ', v); printf('\\n');
    tq = repmat(t(1), numel(lq), 1);
    printf('%.17g ', interpn(l, u, t, v, lq, uq, tq)); printf('\\n');
    printf('%.17g ', interp2(u, l, v(:, :, 1), uq, lq)); printf('\\n');
  end
end
printf('%d %d %d\\n', n);
printf('%d\\n', isnan(interpn(l, u, t, v, l(1) - 1, u(1), t(1))));
printf('%s\\n', m.units.stiffness, m.provenance.content_sha256, m.header{1}, m.provenance.job_name);
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("mat") / "a'b%.nc"
    generate(parse_job(SMALL, HOSTILE, "map.toml"), path, workers=1, solver=FormulaSolver())
    return path


def _octave(folder, script=SCRIPT):
    program = needed("octave-cli")
    (folder / "script.m").write_text(script)
    done = subprocess.run(
        [program, "--no-gui", "script.m"], cwd=folder, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


@pytest.mark.slow
def test_octave_reads_and_interpolates_the_points_of_the_map(path, capsys):
    assert main(["export", str(path), "--to", "mat"]) == 0
    assert "written" in capsys.readouterr().out
    lines = iter(_octave(path.parent))
    dataset = ehdmaps.open_map(path).dataset
    axes = [dataset[axis].values for axis in ("load", "entrainment_speed", "temperature")]
    loads, speeds = np.log(axes[0]), np.log(axes[1])
    asked = np.append(loads[:-1] + 0.3 * np.diff(loads), loads[1])
    moving = np.append(np.full(loads.size - 1, speeds[0] + 0.6 * (speeds[1] - speeds[0])), speeds[1])
    places = np.column_stack([asked, moving, np.full(asked.size, axes[2][0])])
    for contact in ("inner", "outer"):
        for field in ("approach", "stiffness", "damping", "central_film"):
            values = dataset[field].sel(contact=contact).values
            # 17 digits are all of a double: nothing may be lost
            np.testing.assert_array_equal(np.array(next(lines).split(), dtype=float), values.ravel(order="F"))
            expected = RegularGridInterpolator((loads, speeds, axes[2]), values)(places)
            # 1e-12: rounding of the same multilinear rule in two programs
            for _ in ("interpn", "interp2"):
                np.testing.assert_allclose(np.array(next(lines).split(), dtype=float), expected, rtol=1e-12)
    assert next(lines).split() == [str(axis.size) for axis in axes]
    assert next(lines) == "1", "beyond the axes Octave must not extrapolate"
    assert next(lines) == "N m-2"
    assert next(lines) == dataset.attrs["content_sha256"]
    assert next(lines).startswith("made by ehdmaps")
    assert dataset.attrs["job_name"] == HOSTILE
    assert next(lines) == HOSTILE.replace("é", "\\xe9").replace("☃", "\\u2603")
    assert not (path.parent / "hit").exists()


READ_LAW = """
load('law.mat'); load('places.mat');
for line = map.law.reading', eval(line{1}); end
printf('%.17g ', [w; k; c]); printf('\\n');
printf('%.17g ', [map.law.error.load; map.law.error.stiffness; map.law.error.damping]); printf('\\n');
"""


def _read_by_octave(folder, approach, speed, temperature):
    """Load, stiffness and damping, and the errors that the file states: median, 95 %, largest of each."""
    places = {"approach": approach, "speed": speed, "temperature": temperature}
    savemat(folder / "places.mat", {name: np.asarray(values)[:, None] for name, values in places.items()})
    values, stated = _octave(folder, READ_LAW)
    # A missing value of Octave, NA, is NaN.
    numbers = np.array(values.replace("NA", "nan").split(), dtype=float)
    return numbers.reshape(3, -1), np.array(stated.split(), dtype=float).reshape(3, 3)


def _beside(found, law, approach, speed, temperature):
    """Relative differences from the law, shape (3, n)."""
    wanted = np.array(law(approach, 0.0, speed, temperature))
    return np.abs(found / wanted - 1.0)


@pytest.mark.usefixtures("fine_laws")
def test_octave_reads_the_law(path, tmp_path, capsys):
    """Between the nodes the law is met within what the file states, and outside the map there is no number.

    Stated is the largest difference of 2000 places; these are others, of which some may pass it, but by no means far.
    """
    assert main(["export", str(path), "--to", "mat", "-o", str(tmp_path / "law.mat"), "--resample", "80"]) == 0
    law, random = ehdmaps.open_map(path).law("series"), np.random.default_rng(7)
    (slow, fast), (cold, hot), (low, high) = law.speed_range, law.temperature_range, law.load_range
    speed, temperature = np.exp(random.uniform(np.log(slow), np.log(fast), 400)), random.uniform(cold, hot, 400)
    points = [law.at(*place) for place in zip(speed, temperature, strict=True)]
    loads = np.exp(random.uniform(np.log(low), np.log(high), 400))
    approach = np.array([point.approach(load) for point, load in zip(points, loads, strict=True)])
    below = np.array([point.approach(0.3 * low) for point in points[:5]])
    parting = np.array([-1.0])
    inside = (
        np.concatenate([approach, below, parting]),
        np.concatenate([speed, speed[:5], speed[:1]]),
        np.concatenate([temperature, temperature[:5], temperature[:1]]),
    )
    above = approach[0] + 1e-4
    outside = np.array(
        [
            [above, speed[0], temperature[0]],
            [0.0, 1.001 * fast, cold],
            [0.0, 0.999 * slow, cold],
            [0.0, 0.0, cold],
            [0.0, slow, hot + 0.1],
            [np.nan, slow, cold],
            [0.0, np.nan, cold],
        ]
    ).T
    found, stated = _read_by_octave(tmp_path, *np.hstack([inside, outside]))
    assert np.isnan(found[:, 406:]).all()
    differences = _beside(found[:, :400], law, approach, speed, temperature)
    for values, (median, most, largest) in zip(differences, stated, strict=True):
        assert np.median(values) < 1.3 * median
        assert np.mean(values > most) < 0.1
        assert np.max(values) < 2.0 * largest
    assert np.all(stated[:, 2] < 0.01), "and the grid is fine"
    np.testing.assert_allclose(found[0, 400:405], 0.3 * low, atol=2.0 * stated[0, 2] * low)
    assert np.all(found[:, 405] < 1e-200), "bodies apart"
    said = f"{100.0 * stated[0, 2]:.2g} % of the load, {100.0 * stated[1, 2]:.2g} % of the stiffness"
    assert said in capsys.readouterr().out


def test_octave_reads_the_law_of_a_line(tmp_path):
    """A bare contact at one speed and temperature, and dry contacts: axes of one value, and no damping."""
    for text, kind in ((LINE, "line"), (DRY, "series")):
        path = made_map(f"mat of {kind}", text)
        assert main(["export", path, "--to", "mat", "-o", str(tmp_path / "law.mat")]) == 0
        law = ehdmaps.open_map(path).law(kind)
        speed, temperature = law.speed_range[1], law.temperature_range[0]
        loads = np.geomspace(2.0 * law.load_range[0], 0.9 * law.load_range[1], 7)
        # the last place is below the highest load, whatever the rounding
        along = np.linspace(-1e-5, 0.999 * law.at(speed, temperature).point.held_approach, 20001)
        approach = np.interp(loads, law(along, 0.0, speed, temperature)[0], along)
        found, stated = _read_by_octave(tmp_path, approach, np.full(7, speed), np.full(7, temperature))
        wanted = np.array(law(approach, 0.0, speed, temperature))
        for values, expected, largest in zip(found, wanted, stated[:, 2], strict=True):
            np.testing.assert_allclose(values, expected, rtol=2.0 * largest, atol=1e-200)
        assert (kind == "series") == (not wanted[2].any())


def test_points_alone(path, tmp_path, capsys):
    """No law where none is wanted, or none can be made; what cannot be asked for is refused."""
    assert main(["export", str(path), "--to", "mat", "-o", str(tmp_path / "a.mat"), "--resample", "0"]) == 0
    assert "law" not in loadmat(tmp_path / "a.mat")["map"].dtype.names
    for grid, why in (
        (('["1 N/mm"]', '["1 m/s"]', '["40 degC"]'), "load"),
        (('["1 N/mm", "9 N/mm"]', '["0 m/s"]', '["40 degC"]'), "standstill"),
    ):
        poor = made_map(f"mat without {why}", map_job(*grid, solver="hertz"))
        capsys.readouterr()
        assert main(["export", poor, "--to", "mat", "-o", str(tmp_path / "b.mat")]) == 0
        said = capsys.readouterr().out
        assert "warning: without a resampled law: " in said
        assert why in said
    assert main(["export", str(path), "--to", "mat", "-o", str(tmp_path / "c.mat"), "--resample", "19"]) == 2
    assert "--resample: got 19; allowed: 0, or 20 to 400" in capsys.readouterr().err


def test_the_page_shows_how_it_is_read():
    """The lines of the page are those of the file."""
    page = (Path(__file__).parents[2] / "docs" / "exports.md").read_text(encoding="utf-8")
    assert "\n".join(READING) in page


def test_a_matlab_file_is_replaced_only_where_we_made_it(path, tmp_path, capsys):
    ours, foreign = tmp_path / "map.mat", tmp_path / "foreign.mat"
    for _ in range(2):
        assert main(["export", str(path), "--to", "mat", "-o", str(ours), "--resample", "0"]) == 0
    foreign.write_bytes(b"MATLAB 5.0 MAT-file of somebody")
    assert main(["export", str(path), "--to", "mat", "-o", str(foreign)]) == 2
    assert "is not a MATLAB file of ehdmaps" in capsys.readouterr().err
    assert foreign.read_bytes() == b"MATLAB 5.0 MAT-file of somebody"
