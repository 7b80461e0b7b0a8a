"""The film table: coordinates, ends, errors, refusals, its file and how it is made."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from pathlib import Path

import netCDF4
import numpy as np
import pytest

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs import table_make
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.table_make import AXES, make_table, solve_table_line
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import load_and_speed
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.solution import Status
from ehdmaps.table.coordinates import load_number_at, zeta_of
from ehdmaps.table.family import outside_family
from ehdmaps.table.fields import FIELDS, FILMS, LAW
from ehdmaps.table.file import content_sha256, film_table, read_tables, shipped_tables, write_tables
from ehdmaps.table.films import TableFilms
from ehdmaps.table.interpolation import Axes

CERAMIC = Material(youngs_modulus=310e9, poisson_ratio=0.26)
NUMBERS = tuple(field.name for field in FILMS)


def bare(radius: float = 5e-3, material: Material = STEEL) -> LineContact:
    """A bare contact."""
    return LineContact("line", radius, material, "half_space", reference_depth=radius)


def roelands(alpha: float = 2e-8, z: float = 0.65, viscosity: float = 0.05, law: str = "dowson-higginson") -> Lubricant:
    """An oil that is the same at every temperature."""
    return Lubricant.roelands(
        viscosity=viscosity,
        pressure_viscosity=alpha,
        roelands_z=z,
        density=880.0,
        density_law=law,  # type: ignore[arg-type]
    )


def read(contact: LineContact, oil: Lubricant, load: object, speed: object, temperature: object = 313.15) -> TableFilms:
    """All that the table says."""
    return film_table(oil).films(contact, oil, load, speed, temperature, response=True)  # type: ignore[arg-type]


@pytest.mark.parametrize("place", [(0.5, 5.0), (2.0, 12.0), (0.9, 25.0)])
def test_contacts_of_the_same_groups_have_the_same_reduced_films(place: tuple[float, float]) -> None:
    """Of other radius, material and viscosity; the solver agrees to its Newton tolerance, the table to round-off."""
    solved: list[list[float]] = []
    table: list[list[float]] = []
    for contact, viscosity in ((bare(5e-3), 0.05), (bare(80e-3, CERAMIC), 0.7)):
        oil = roelands(viscosity=viscosity)
        E, R = contact.reduced_modulus, contact.radius
        w, u = load_and_speed(*place, viscosity, 2e-8, R, E)
        film = ReynoldsSolver(thickest_film=math.inf).solve_line(contact, oil, (w,), u, 313.15)[0]
        found = read(contact, oil, w, u)
        loss_unit = half_width(w, R, E) / (u * E)
        thickness = R * math.sqrt(2.0 * viscosity * u / (E * R))
        for into, one in ((solved, film), (table, found)):
            into.append(
                [
                    float(one.film_offset) / thickness,
                    float(one.film_compliance) * E,
                    float(one.loss_compliance) / loss_unit,
                ]
            )
    assert np.allclose(solved[0], solved[1], rtol=1e-6)
    assert np.allclose(table[0], table[1], rtol=1e-9)


def test_zeta_is_inverted() -> None:
    """Round-off."""
    zeta = np.linspace(-6.0, 8.0, 29)
    oil = [np.full_like(zeta, x) for x in (23.0, 1.7e-8, 0.6)]
    assert np.allclose(zeta_of(load_number_at(zeta, *oil), *oil), zeta, rtol=0.0, atol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["roelands", "fva3", "incompressible"])
def test_fresh_films_lie_within_the_stated_errors(name: str) -> None:
    """Points drawn at random, solved on a finer grid; its own stated errors come on top. Misses: 5 % of the numbers."""
    oil = {
        "roelands": Lubricant.roelands(
            viscosity_40=100e-6, viscosity_100=11e-6, pressure_viscosity=23e-9, density=870.0
        ),
        "fva3": Lubricant.named("FVA3"),
        "incompressible": roelands(1.7e-8, 0.58, 0.03, "incompressible"),
    }[name]
    contact = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
    random = np.random.default_rng(12)
    n = 40
    w, u = np.exp(random.uniform(np.log(100.0), np.log(1e6), n)), np.exp(random.uniform(np.log(0.05), np.log(10.0), n))
    T = random.uniform(300.0, 390.0, n)
    films = read(contact, oil, w, u, T)
    solver = ReynoldsSolver(density=14.0, inlet_length=700.0)
    inside = []
    for i in range(n):
        film = solver.solve_line(contact, oil, (float(w[i]),), float(u[i]), float(T[i]))[0]
        assert film.status == films.status[i]
        for field in (*LAW, *FILMS[3:5], FILMS[7]):
            value = float(getattr(films, field.name)[i])
            fresh, own = getattr(film, field.name), abs(getattr(film, f"{field.name}_error"))
            inside.append(abs(value - fresh) <= films.errors[field.name][i] * abs(value) + own * abs(fresh))
    assert np.mean(inside) >= 0.95


def _along(axis: str, at: FloatArray) -> TableFilms:
    """Films along a line of load, speed or temperature, however thick."""
    place: dict[str, FloatArray | float] = {"load": 2e4, "entrainment_speed": 0.5, "temperature": 313.15} | {axis: at}
    w, u, T = (place[name] for name in ("load", "entrainment_speed", "temperature"))
    oil = Lubricant.named("FVA3")
    return film_table(oil).films(bare(), oil, w, u, T, response=True, thickest_film=math.inf)


def _largest_bend(axis: str, low: float, high: float, n: int) -> dict[str, float]:
    """Largest change of slope from step to step of the smooth forms of films along a line, by name."""
    at = np.linspace(low, high, n) if axis == "temperature" else np.geomspace(low, high, n)
    films = _along(axis, at)
    assert np.all(films.usable), set(films.reason)
    values = {
        name: np.log(getattr(films, name)) for name in ("film_offset", "central_film", "rolling_force", "mass_flow")
    }
    compliance = films.film_compliance * bare().reduced_modulus
    values["film_compliance"] = np.arcsinh(compliance / 0.3)
    values["loss over compliance"] = np.arcsinh(films.loss_compliance / np.median(np.abs(films.loss_compliance)))
    values["response"] = np.arcsinh(films.response[:, 2].imag * bare().reduced_modulus / 0.3)
    return {name: float(np.max(np.abs(np.diff(value, 2)))) * (n - 1) for name, value in values.items()}


@pytest.mark.parametrize(
    ("axis", "low", "high"),
    [("load", 0.05, 5e6), ("entrainment_speed", 2e-10, 4.0), ("temperature", 280.0, 470.0)],
)
def test_films_have_slopes_without_jumps_through_all_seams(axis: str, low: float, high: float) -> None:
    """Through the rigid end, the nodes and the ends of L and zeta: with a fourth of the step slopes change by a fourth.

    A kink would stay: what is allowed is a third.
    """
    coarse, fine = (_largest_bend(axis, low, high, n) for n in (10001, 40001))
    for name, bend in fine.items():
        assert bend < 0.34 * coarse[name], name


def test_extremes_have_films_with_errors_or_a_reason() -> None:
    """No NaN under a usable status, no warning; what is refused says why."""
    random = np.random.default_rng(3)
    seen: set[str] = set()
    for _ in range(60):
        alpha, z = random.uniform(0.0, 60e-9), random.uniform(0.1, 1.4)
        radius = math.exp(random.uniform(math.log(1e-4), 0.0))
        hot = random.uniform(2e-6, 40e-6)
        oil = Lubricant.roelands(
            viscosity_40=hot * random.uniform(2.0, 12.0),
            viscosity_100=hot,
            pressure_viscosity=alpha,
            roelands_z=z,
            density=880.0,
        )
        w = np.exp(random.uniform(math.log(0.01), math.log(1e8), 100))
        u = np.exp(random.uniform(math.log(1e-3), math.log(50.0), 100))
        T = random.uniform(233.15, 473.15, 100)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            films = read(bare(radius, random.choice([STEEL, CERAMIC])), oil, w, u, T)  # type: ignore[arg-type]
        good = films.usable
        for name in NUMBERS:
            assert np.all(np.isfinite(getattr(films, name)[good])), name
            assert np.all(np.isnan(getattr(films, name)[~good])), name
            assert np.all(films.errors[name][good] >= 0.0), name
        assert np.all(np.isfinite(films.response[good]))
        assert np.all(films.film_offset[good] > 0.0)
        assert np.all(films.reason[~good] != "")
        seen.update(films.reason)
    assert "" in seen
    assert any("Hertz pressure" in reason for reason in seen)


@pytest.mark.parametrize(
    ("oil", "load", "speed", "reason"),
    [
        (roelands(), 3e7, 1.0, "Hertz pressure above 10 GPa"),
        (roelands(), 1e-9, 50.0, "M outside"),
        (roelands(6e-8, 0.65, 500.0), 1e4, 50.0, "L above its range"),
        (roelands(1e-9), 1e4, 1.0, "pressure-viscosity coefficient outside its range"),
        (roelands(z=1.9), 1e4, 1.0, "bends over pressure as none of its oils"),
        (roelands(viscosity=5.0), 10.0, 20.0, "neither thin-film theory nor a parabolic gap holds"),
    ],
)
def test_what_is_not_in_the_table_says_why(oil: Lubricant, load: float, speed: float, reason: str) -> None:
    """One point for each reason."""
    films = read(bare(), oil, load, speed)
    assert int(films.status) == int(Status.OUTSIDE_VALIDITY)
    assert reason in str(films.reason)
    assert np.isnan(films.film_offset)


def test_a_cold_oil_without_a_state_says_so() -> None:
    """FVA 3 ends at -14.67 degC."""
    films = read(bare(), Lubricant.named("FVA3"), 1e4, 1.0, np.array([250.0, 313.15]))
    assert "no state at this temperature" in films.reason[0]
    assert films.usable.tolist() == [False, True]


def test_a_contact_that_stands_still_is_dry() -> None:
    """As the solver says."""
    films = read(bare(), roelands(), 1e4, 0.0)
    assert int(films.status) == int(Status.ASYMPTOTE)
    assert str(films.reason) == "no entrainment: dry contact"
    assert float(films.film_offset) == float(films.loss_compliance) == 0.0
    solved = ReynoldsSolver().solve_line(bare(), roelands(), (1e4,), 0.0, 313.15)[0]
    assert float(films.max_pressure) == pytest.approx(solved.max_pressure, rel=1e-12)


def test_points_that_none_can_be_are_refused() -> None:
    """As of any solver."""
    with pytest.raises(InputError, match="load: got -1"):
        read(bare(), roelands(), [1.0, -1.0], 1.0)


def test_an_oil_of_the_other_density_law_is_refused() -> None:
    """It has a table of its own."""
    table = film_table(roelands())
    with pytest.raises(InputError, match="this table holds dowson-higginson"):
        table.films(bare(), roelands(law="incompressible"), 1e4, 1.0, 313.15)


def test_solvers_of_other_films_are_refused_with_the_reason() -> None:
    """Heat, shear and sliding; other solvers."""
    assert outside_family(ReynoldsSolver(density=9.0)) == ""
    assert "heat in the film (physics = thermal)" in outside_family(ReynoldsSolver(physics="thermal"))
    eyring = ReynoldsSolver(shear="eyring", shear_stress=5e6, slide_to_roll=0.1)
    assert "a law of shear (shear = eyring)" in outside_family(eyring)
    assert "traction of a sliding contact (slide_to_roll = 0.1)" in outside_family(eyring)
    assert "not of formula" in outside_family(FormulaSolver())


def test_the_shipped_file_is_what_it_says_and_is_small() -> None:
    """Its checksum is tested as it is read."""
    tables = shipped_tables()
    assert tables.attributes["content_sha256"] == content_sha256(tables)
    assert set(tables.tables) == {"dowson-higginson", "incompressible"}
    for table in tables.tables.values():
        assert np.all(np.isfinite(table.values))


def test_a_changed_file_is_refused(tmp_path: Path) -> None:
    """One number, another kind, and no netCDF at all."""
    path = tmp_path / "table.nc"
    write_tables(path, shipped_tables())
    assert read_tables(path).attributes["content_sha256"] == shipped_tables().attributes["content_sha256"]
    with netCDF4.Dataset(path, "a") as file:
        file["incompressible"]["values"][0, 3, 1, 0, 0] += 1e-3
    with pytest.raises(MapError, match="was changed since it was made"):
        read_tables(path)
    with netCDF4.Dataset(path, "a") as file:
        file.setncattr("made_as", "another thing")
    with pytest.raises(MapError, match="is no film table of this version"):
        read_tables(path)
    path.write_text("no netCDF", encoding="utf-8")
    with pytest.raises(MapError, match="cannot be read as a film table"):
        read_tables(path)


def test_a_table_without_a_density_law_says_so() -> None:
    """And that such films are solved."""
    tables = shipped_tables()
    only = replace(tables, tables={"incompressible": tables.tables["incompressible"]})
    with pytest.raises(MapError, match="has no films of the density law 'dowson-higginson'"):
        only.of(roelands())


def test_solving_again_gives_the_nodes_of_the_shipped_file() -> None:
    """A line of the table, from a lower start only; Newton's tolerance, and the bits that the file keeps."""
    table = shipped_tables().tables["dowson-higginson"]
    axes = table.axes
    j, k, p = 9, 2, 1
    first, last = 14, 40
    oil = (float(np.exp(axes.log_l[j])), float(np.exp(axes.log_alpha[k])), float(axes.bend[p]))
    again = solve_table_line(axes.zeta[first:last], *oil, True)
    for f, field in enumerate(FIELDS):
        allowed = 0.3 if field.name in ("max_pressure", "wall_stress") else 2e-3
        apart = np.abs(table.values[first:last, j, k, p, f] - field.lifted(again.values[:, f]))
        assert np.max(apart) < allowed, field.name


def test_a_small_table_is_made_as_the_shipped_one() -> None:
    """Few nodes, among those of the shipped table; the same numbers at them."""
    axes = Axes(AXES.zeta[::8][:6], AXES.log_l[4:8], AXES.log_alpha[1:3], AXES.bend[1:3])
    told: list[tuple[int, int]] = []
    small = make_table(axes, True, progress=lambda done, of: told.append((done, of)))
    assert told[-1] == (16, 16)
    shipped = shipped_tables().tables["dowson-higginson"].values[::8][:6, 4:8, 1:3, 1:3]
    for k, field in enumerate(FIELDS):
        # the tip of a spike, and the stress at it, hang on the start of Newton's iterations
        allowed = 0.3 if field.name in ("max_pressure", "wall_stress") else 2e-3
        assert np.max(np.abs(small.values[..., k] - shipped[..., k])) < allowed, field.name


def test_the_command_makes_a_table_that_reads(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of few nodes; a file of another kind is not replaced."""
    small = Axes(AXES.zeta[::12][:4], AXES.log_l[4:8], AXES.log_alpha[1:3], AXES.bend[1:3])
    monkeypatch.setattr(table_make, "AXES", small)
    monkeypatch.setattr(table_make, "INCOMPRESSIBLE", small)
    path = tmp_path / "table.nc"
    assert main(["table", "make", "-o", str(path)]) == 0
    assert set(read_tables(path).tables) == {"dowson-higginson", "incompressible"}
    assert main(["table", "show", str(path)]) == 0
    assert "L 5 to 14 (4)" in capsys.readouterr().out
    path.write_text("mine", encoding="utf-8")
    assert main(["table", "make", "-o", str(path)]) == 2
    assert path.read_text(encoding="utf-8") == "mine"


def test_the_command_shows_the_table(capsys: pytest.CaptureFixture[str]) -> None:
    """Nodes, provenance and checksum."""
    assert main(["table", "show"]) == 0
    shown = capsys.readouterr().out
    assert "content_sha256: " in shown
    assert "dowson-higginson: zeta -6 to " in shown
