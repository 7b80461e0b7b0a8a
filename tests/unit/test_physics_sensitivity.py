"""How much the pressure-viscosity matters: the formula against the Reynolds solver, and what `check` says."""

import pytest

import ehdmaps
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.jobs.cli import main
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.closed_form import film_change
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.own_oil import CORRELATIONS
from ehdmaps.physics.solids import STEEL

CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]

JOB = """
schema = 1
[bearing]
name = "NU308"
[lubricant]
viscosity_law = "roelands"
viscosity_40 = "32 mm^2/s"
viscosity_100 = "5.4 mm^2/s"
density = "870 kg/m^3"
pressure_viscosity = "{alpha}"
[grid]
load = ["1 N/mm", "10 N/mm", "100 N/mm"]
entrainment_speed = ["0.5 m/s", "1 m/s", "2 m/s"]
temperature = ["40 degC"]
[solver]
name = "formula"
structural_law = "iso16281"
"""


def oil(alpha):
    return Lubricant.barus(viscosity=0.05, pressure_viscosity=alpha, density=870.0)


@pytest.mark.parametrize(("load", "speed"), [(1e4, 0.7), (1e5, 0.7), (1e5, 3.0)])
def test_the_formula_changes_as_the_reynolds_solution_does(load, speed):
    """The exponent of alpha in the formula is within 0.06 of that of full solutions (0.55 to 0.61): model error."""
    alpha, factor = 2e-8, 1.2
    films = [
        ReynoldsSolver().solve_line(CONTACT, oil(alpha * f), (load,), speed, 313.15)[0].central_film
        for f in (1.0, factor)
    ]
    measured = films[1] / films[0] - 1.0
    found = film_change(CONTACT, oil(alpha).at(313.15), load, speed, factor)
    assert 0.05 < measured < 0.2
    assert found == pytest.approx(measured, abs=0.012)


def test_check_says_how_much_alpha_matters(tmp_path, capsys):
    path = tmp_path / "job.toml"
    path.write_text(JOB.format(alpha="20 1/GPa"))
    assert main(["check", str(path)]) == 0
    (line,) = (line for line in capsys.readouterr().out.splitlines() if "pressure-viscosity that" in line)
    state = Lubricant.roelands(viscosity_40=32e-6, viscosity_100=5.4e-6, density=870.0, pressure_viscosity=2e-8).at(
        313.15
    )
    change = film_change(CONTACT, state, 1e4, 1.0, 1.2)
    assert line.strip() == (
        f"a pressure-viscosity that is 20% higher makes the film {change:.1%} thicker (film formula of Moes at "
        "10 N/mm, 1 m/s, 40 degC, the middle of the map)"
    )


def test_check_says_what_is_estimated(tmp_path, capsys):
    path = tmp_path / "job.toml"
    path.write_text(JOB.format(alpha="so-klaus"))
    assert main(["check", str(path)]) == 0
    assert "; pressure-viscosity estimated by So and Klaus (1980); against 38" in capsys.readouterr().out


def test_check_of_an_isoviscous_oil_says_nothing_of_alpha(tmp_path, capsys):
    path = tmp_path / "job.toml"
    path.write_text(JOB.format(alpha="0 1/GPa"))
    assert main(["check", str(path)]) == 0
    assert "pressure-viscosity" not in capsys.readouterr().out


def test_a_map_of_an_estimated_oil_says_so(tmp_path, capsys):
    path, made = tmp_path / "job.toml", tmp_path / "map.nc"
    path.write_text(JOB.format(alpha="gold-mineral"))
    assert main(["generate", str(path), "-o", str(made), "--workers", "1"]) == 0
    sentence = CORRELATIONS["gold-mineral"].sentence
    assert f"; {sentence}" in capsys.readouterr().out
    assert ehdmaps.open_map(made).dataset.attrs["lubricant_verified"] == 0
    assert main(["show", str(made)]) == 0
    assert "oil own oil: NOT VERIFIED\n  density -0.6 kg/m3 a K (assumed); " + sentence in capsys.readouterr().out
