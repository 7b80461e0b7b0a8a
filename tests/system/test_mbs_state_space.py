"""`mbs lsa --state-space`: the transfer function that Octave finds from A, B, C and D is that of `mbs lsa`."""

from __future__ import annotations

import subprocess

import numpy as np
import pytest
from scipy.io import loadmat

import ehdmaps
from mbs.analyses.lsa import LsaSettings, lsa_of
from mbs.cli import main
from mbs.output.state_space_file import write_spaces
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene
from tests.cases.programs import needed

SCRIPT = """
s = load('space.mat'); f = load('f.txt');
for j = 1:numel(s.space)
  p = s.space(j);
  printf('%s|%s|%s|%s|%s\\n', p.case, strjoin(p.states, ','), strjoin(p.state_units, ','), ...
         p.output_units{1}, p.input_units{1});
  printf('%s\\n', strjoin(p.inputs, ','));
  E = eye(rows(p.A));
  for k = 1:numel(f)
    h = p.C * ((2i * pi * f(k) * E - p.A) \\ p.B) + p.D;
    printf('%.17g ', real(h.'), imag(h.')); printf('\\n');
  end
end
"""


@pytest.fixture
def octave():
    program = needed("octave-cli")

    def run(folder):
        (folder / "script.m").write_text(SCRIPT)
        done = subprocess.run(
            [program, "--no-gui", "script.m"], cwd=folder, capture_output=True, text=True, timeout=120, check=False
        )
        assert done.returncode == 0, done.stderr
        return done.stdout.splitlines()

    return run


def test_octave_finds_the_responses_of_lsa(octave, tmp_path, formula_maps):
    asked = tuple(np.geomspace(5.0, 9e3, 12))
    emap = ehdmaps.open_map(formula_maps["NU308"])
    models = [assemble(read_scene("nu308_rigid"), "map", emap, films=films) for films in ("slow", "memory")]
    results = lsa_of(models, LsaSettings(asked))
    write_spaces(tmp_path / "space.mat", list(zip(("slow: é", "memory"), results, strict=True)))
    np.savetxt(tmp_path / "f.txt", asked, fmt="%.17g")
    lines = iter(octave(tmp_path))
    # Apart from the lightly damped peak at 42 Hz, slow: rounding; memory: few states in place of all slices, 1e-8.
    for result, case, tolerance in zip(results, ("slow: \\xe9", "memory"), (1e-9, 1e-8), strict=True):
        label, states, units, output_unit, input_unit = next(lines).split("|")
        assert label == case
        assert states.split(",") == [str(name) for name in result.dataset["state"].values]
        assert len(states.split(",")) == len(units.split(",")) == result.space.A.shape[0]
        assert ("film_1" in states.split(",")) == (case == "memory")
        assert units.split(",")[0] == "m"
        assert (output_unit, input_unit) == ("m/s2", "N")
        assert next(lines) == "E1"
        found = np.array([np.array(next(lines).split(), dtype=float) for _ in asked])
        expected = result.responses[np.isin(result.frequencies, asked)]
        found = (found[:, : found.shape[1] // 2] + 1j * found[:, found.shape[1] // 2 :]).reshape(expected.shape)
        assert np.all(np.abs(found - expected) <= tolerance * np.abs(expected))


def test_the_command_writes_the_file(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["lsa", "n1014_rigid", "--law", "constant:hertz", "--state-space", "space.mat"]) == 0
    assert "space.mat: written" in capsys.readouterr().out
    space = loadmat("space.mat", simplify_cells=True)["space"]
    assert space["A"].shape == (len(space["states"]),) * 2
    assert any(line.startswith("linearised at ") and "rpm" in line for line in space["header"])


def test_foreign_files_are_not_replaced_and_options_must_differ(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "foreign.mat").write_bytes(b"MATLAB 5.0 MAT-file of somebody")
    assert main(["lsa", "nu308_rigid", "--law", "hertz", "--state-space", "foreign.mat"]) == 2
    assert "is not a MATLAB file of ehdmaps" in capsys.readouterr().err
    assert main(["lsa", "nu308_rigid", "--law", "hertz", "--state-space", "space.txt"]) == 2
    assert "ends in .mat" in capsys.readouterr().err
