"""`ehdmaps export --to mat`: what Octave reads is what the map holds."""

from __future__ import annotations

import os
import shutil
import subprocess

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

import ehdmaps
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.generate import generate
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.closed_form import FormulaSolver
from tests.cases.jobs import SMALL

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


def _octave(folder):
    program = shutil.which("octave-cli")
    if program is None:
        if os.environ.get("CI"):
            pytest.fail("octave-cli is not on the PATH (in CI no test of Octave may be skipped)", pytrace=False)
        pytest.skip("octave-cli is not on the PATH: apt-get install octave")
    (folder / "script.m").write_text(SCRIPT)
    done = subprocess.run(
        [program, "--no-gui", "script.m"], cwd=folder, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


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


def test_a_matlab_file_is_replaced_only_where_we_made_it(path, tmp_path, capsys):
    ours, foreign = tmp_path / "map.mat", tmp_path / "foreign.mat"
    for _ in range(2):
        assert main(["export", str(path), "--to", "mat", "-o", str(ours)]) == 0
    foreign.write_bytes(b"MATLAB 5.0 MAT-file of somebody")
    assert main(["export", str(path), "--to", "mat", "-o", str(foreign)]) == 2
    assert "is not a MATLAB file of ehdmaps" in capsys.readouterr().err
    assert foreign.read_bytes() == b"MATLAB 5.0 MAT-file of somebody"
