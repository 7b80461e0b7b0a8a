"""What a run wrote: results, table and fields, and what is said where they are something else."""

import os
import subprocess
from pathlib import Path

import meshio
import numpy as np
import pytest

from ehdmaps.errors import InputError, SolverError
from ehdmaps.openfoam.fields import read_fields, write_fields
from ehdmaps.openfoam.parameters import Mesh, Parameters
from ehdmaps.openfoam.pyfoam import parse
from ehdmaps.openfoam.results import read_film, read_results
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import Status
from tests.cases import openfoam_fake

COLUMNS, ROWS = 12, 4
PARAMETERS = Parameters(
    reduced_radius=5.5e-3,
    reduced_modulus=2.3e11,
    load=1e4,
    lower_speed=1.0,
    upper_speed=1.0,
    oil=Lubricant.named("FVA3").at(313.15),
    cavitation_range=500.0,
    mesh=Mesh(film=0.2),
    columns=COLUMNS,
    rows=ROWS,
    write_fields=True,
)
HEADER = "FoamFile { version 2.0; format ascii; class dictionary; object results; }\n"


@pytest.fixture
def case(tmp_path):
    """A case in which the fake ehlFoam has run."""
    openfoam_fake.build(tmp_path / "build")
    folder = tmp_path / "case"
    (folder / "constant").mkdir(parents=True)
    (folder / "constant" / "ehlProperties").write_text(PARAMETERS.text())
    command = [tmp_path / "build" / "bin" / "ehlFoam", "-case", folder]
    subprocess.run(command, check=True, capture_output=True)
    return folder


def changed(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_the_temperature_of_a_film_with_heat(case, tmp_path):
    assert read_fields(case).T is None
    text = (case / "1" / "p").read_text()
    (case / "1" / "T").write_text(text)
    fields = read_fields(case)
    np.testing.assert_array_equal(fields.T, fields.p)
    write_fields(fields, tmp_path / "film.vtu")
    np.testing.assert_array_equal(meshio.read(tmp_path / "film.vtu").cell_data["T"][0], fields.T)


def test_results(case):
    results = read_results(case)
    assert (results.status, results.reason, results.iterations) == (Status.CONVERGED, "", 7)
    assert results.frequencies == (0.0,)
    assert len(results.film_compliance) == len(results.loss_compliance) == 1
    assert results.outlet_defect == 1e-4
    assert results.oscillation_film_compliance is None


def test_results_of_three_frequencies_and_an_oscillation(case):
    # three numbers in brackets are a vector to the parser
    text = "\n".join(
        line
        for line in (case / "results").read_text().splitlines()
        if not line.startswith(("frequencies", "filmCompliance", "lossCompliance", "responseResidual"))
    )
    text += "\nfrequencies (0 1 2);\nfilmCompliance 3(1e-13 2e-13 3e-13);\nlossCompliance (1e-18 2e-18 3e-18);\n"
    text += "responseResidual (0 1e-9 2e-9);\n"
    text += "oscillationFilmCompliance 1e-13;\noscillationLossCompliance 2e-18;\n"
    (case / "results").write_text(text)
    results = read_results(case)
    assert results.frequencies == (0.0, 1.0, 2.0)
    assert results.film_compliance == (1e-13, 2e-13, 3e-13)
    assert (results.oscillation_film_compliance, results.oscillation_loss_compliance) == (1e-13, 2e-18)


def test_results_of_a_run_that_did_not_converge_need_no_numbers(case):
    (case / "results").write_text(HEADER + 'status diverged; reason "pressure of 1e12 Pa"; iterations 3;\n')
    results = read_results(case)
    assert (results.status, results.reason, results.iterations) == (Status.DIVERGED, "pressure of 1e12 Pa", 3)
    assert np.isnan(results.central_film)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("status converged", "status happy", "status: got 'happy'; allowed: converged, stagnated, diverged"),
        ("status converged;", "", "status: got None"),
        ("iterations 7", "iterations nan", "iterations: got 'nan'; allowed: a finite number"),
        ("loadDefect 1e-10;", "", "loadDefect: got None; allowed: a finite number"),
        (
            "frequencies (0.0)",
            "frequencies (0.0 1.0)",
            r"filmCompliance: got .*; allowed: 2 finite numbers in brackets",
        ),
        ("frequencies (0.0)", "frequencies (zero)", r"frequencies: got .*; allowed: finite numbers in brackets"),
        ("frequencies (0.0)", "frequencies 0.0", r"frequencies: got 0.0; allowed: finite numbers in brackets"),
        ("status", "#include; {{", "is no OpenFOAM dictionary"),
    ],
)
def test_results_that_are_none(case, capsys, old, new, message):
    changed(case / "results", old, new)
    with pytest.raises(SolverError, match=message):
        read_results(case)
    assert capsys.readouterr().out == ""


def test_a_dictionary_that_is_not_there_or_too_long(tmp_path):
    with pytest.raises(SolverError, match="results: is not there"):
        read_results(tmp_path)
    (tmp_path / "results").write_text(HEADER + "a 1;\n" * 300_000)
    with pytest.raises(SolverError, match="longer than 1000000 bytes; allowed: a small dictionary"):
        parse(tmp_path / "results")


def test_parsing_leaves_nothing_behind_and_runs_nothing(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / "PlyParser_FoamFileParser_parsetab.py").write_text("open('executed', 'w')\n")
    (tmp_path / "d").write_text(HEADER + 'a #calc "1 + 1";\n')
    with pytest.raises(SolverError):
        parse(tmp_path / "d")
    assert sorted(os.listdir(tmp_path)) == ["PlyParser_FoamFileParser_parsetab.py", "d"]


def test_film_table(case):
    film = read_film(case, COLUMNS)
    assert film.x.shape == film.liquid_fraction.shape == (COLUMNS,)
    assert (np.diff(film.x) > 0).all()
    assert film.density[0] == 880.0


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("# x pressure", "# p x", r"got an array of shape \(12, 6\) under p x film"),
        ("880.0", "nan", "allowed: 12 lines of finite numbers under x pressure film"),
        ("880.0", "dense", "is no table of numbers"),
        ("880.0", "", "is no table of numbers|got an array of shape"),
    ],
)
def test_a_film_table_that_is_none(case, old, new, message):
    changed(case / "film.dat", old, new)
    with pytest.raises(SolverError, match=message):
        read_film(case, COLUMNS)


def test_a_film_table_that_is_cut_short_or_missing(case):
    with pytest.raises(SolverError, match="allowed: 24 lines"):
        read_film(case, 24)
    (case / "film.dat").unlink()
    with pytest.raises(SolverError, match=r"film\.dat: is not there"):
        read_film(case, COLUMNS)


def test_fields(case):
    fields = read_fields(case)
    assert fields.points.shape == ((COLUMNS + 1) * (ROWS + 1), 3)
    assert (fields.points[:, 2] == 0.0).all()
    assert fields.corners.shape == (COLUMNS * ROWS, 4)
    assert fields.U.shape == (COLUMNS * ROWS, 3)
    assert (fields.rho == 880.0).all()
    assert (fields.liquid_fraction == 1.0).all()
    # every value belongs to its cell: the fake's viscosity and pressure grow along the film, its velocity across
    centre = fields.points[fields.corners].mean(axis=1)
    along = (centre[:, 0] - fields.points[:, 0].min()) / np.ptp(fields.points[:, 0])
    np.testing.assert_allclose(fields.p, 1e8 * along, rtol=1e-12)
    np.testing.assert_allclose(fields.mu, 0.1 + along, rtol=1e-12)
    np.testing.assert_allclose(fields.U[:, 0], 0.5 + centre[:, 1] / fields.points[:, 1].max(), rtol=1e-12)


def test_a_velocity_profile(case):
    fields = read_fields(case)
    height, velocity = fields.profile(fields.U[:, 0], 0.0, ROWS)
    np.testing.assert_allclose(height, [0.125, 0.375, 0.625, 0.875])
    np.testing.assert_allclose(velocity, 0.5 + height)


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        ("1/p", "format ascii", "format binary", "allowed: a file of OpenFOAM with format ascii"),
        ("1/p", "internalField", "outsideField", "got no internalField"),
        ("1/p", "48\n(", "47\n(", "got 47 values; allowed: 48, one a cell"),
        ("1/mu", "\n)\n", "\nnan\n)\n", ""),
        ("1/U", "(", "", "the run was cut short|got no internalField"),
        ("1/rho", "uniform 880", "uniform nan", "got something else than 1 finite numbers"),
        ("constant/polyMesh/owner", "(", "", "got no list; allowed: an ascii list"),
        ("constant/polyMesh/boundary", "empty", "wall", "allowed: one cell thick"),
        ("constant/polyMesh/faces", "4(", "3(", "allowed: one cell thick"),
    ],
)
def test_fields_that_are_none(case, name, old, new, message):
    changed(case / name, old, new)
    if not message:  # more numbers than needed do not matter
        assert np.isfinite(read_fields(case).mu).all()
        return
    with pytest.raises(SolverError, match=message):
        read_fields(case)


def test_fields_with_a_cell_without_an_empty_face(case):
    owner = case / "constant" / "polyMesh" / "owner"
    changed(owner, "\n46\n47\n", "\n47\n47\n")
    with pytest.raises(SolverError, match="got 47 cells with an empty face; allowed: 48"):
        read_fields(case)


def test_fields_that_are_cut_short_or_missing(case):
    path = case / "1" / "U"
    path.write_text(path.read_text()[:-300])
    with pytest.raises(SolverError, match="got something else than 144 finite numbers; the run was cut short"):
        read_fields(case)
    path.unlink()
    with pytest.raises(SolverError, match=r"U: cannot be read \(No such file"):
        read_fields(case)


@pytest.mark.parametrize("ending", [".vtu", ".xdmf"])
def test_fields_are_written_for_other_programs(case, tmp_path, ending):
    fields = read_fields(case)
    write_fields(fields, tmp_path / f"film{ending}")
    mesh = meshio.read(tmp_path / f"film{ending}")
    np.testing.assert_allclose(mesh.points, fields.points)
    assert (mesh.cells_dict["quad"] == fields.corners).all()
    assert set(mesh.cell_data) == {"p", "U", "mu", "rho", "liquid_fraction"}
    np.testing.assert_allclose(mesh.cell_data["U"][0], fields.U)
    assert len(list(tmp_path.glob("film*"))) == 1


def test_fields_that_cannot_be_written(case, tmp_path):
    with pytest.raises(InputError, match=r"none is no folder; allowed: a file in a folder that exists"):
        write_fields(read_fields(case), tmp_path / "none" / "film.vtu")
