"""Refinement lines of films with heat: each contact has its own, and laws are made from them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

import ehdmaps
from ehdmaps.errors import MapError
from ehdmaps.jobs.make.generate import generate_in_memory, write_map
from ehdmaps.jobs.reader import parse_job
from ehdmaps.jobs.show.describe import describe
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.grid_field import has_own_lines, lines_by_contact
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.heat import inlet_heat
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import FilmSolution

JOB = """schema = 1
[bearing]
name = "NU308"
[lubricant]
name = "FVA3"
[grid]
load = { from = "5 N/mm", to = "200 N/mm", points = 4, spacing = "log" }
entrainment_speed = { from = "4 m/s", to = "10 m/s", points = 3, spacing = "log" }
temperature = ["80 degC", "90 degC"]
[solver]
name = "formula"
structural_law = "iso16281"
"""


@dataclass(frozen=True)
class Warm(FormulaSolver):
    """Closed formulas times the factor of heat in the inlet, with lines for a law."""

    physics: str = "inlet-heat"

    @property
    def wants_backbone(self) -> bool:
        return True

    def settings(self) -> dict[str, float | int | str]:
        return {**super().settings(), **({} if self.physics == "isothermal" else {"physics": self.physics})}

    def solve_line(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[FilmSolution, ...]:
        step = 1e-4
        moved = tuple(load * factor for load in loads for factor in (1.0 - step, 1.0, 1.0 + step))
        films = super().solve_line(contact, lubricant, moved, entrainment_speed, temperature)
        points = (OperatingPoint(load, entrainment_speed, temperature) for load in moved)
        offsets = [
            film.film_offset * inlet_heat(contact, lubricant, point).factor
            for film, point in zip(films, points, strict=True)
        ]
        flow = entrainment_speed * lubricant.at(temperature).density
        return tuple(
            replace(
                films[3 * i + 1],
                film_offset=offsets[3 * i + 1],
                film_compliance=(offsets[3 * i] - offsets[3 * i + 2]) / (2.0 * step * load),
                rolling_force=1.0,
                mass_flow=offsets[3 * i + 1] * flow,
            )
            for i, load in enumerate(loads)
        )


@pytest.fixture(scope="module")
def generated():
    return generate_in_memory(parse_job(JOB, "warm", "warm.toml"), workers=1, solver=Warm())


@pytest.fixture(scope="module")
def warm(generated):
    return EHDMap(generated.dataset, generated.backbone)


def test_each_contact_has_lines_of_its_own_on_common_axes(warm):
    assert has_own_lines(warm.backbone)
    inner, outer = lines_by_contact(warm.backbone, warm.contacts)
    assert (inner[1].radius, outer[1].radius) == tuple(contact.radius for contact in warm.contacts)
    assert [contact.name for _, _, (contact,) in (inner, outer)] == ["inner", "outer"]
    speeds = warm.backbone["reference_speed"].values
    np.testing.assert_allclose(speeds[[0, -1]], [4.0, 10.0], rtol=1e-12)  # the map's own, not those of another radius
    assert "of each contact its own" in describe(warm, "warm.nc")


@pytest.mark.parametrize("contact", ["inner", "outer"])
def test_films_between_the_lines_are_those_of_the_contact(warm, contact):
    """The interpolation: 1e-3 of the film. Shared lines would miss the outer film by what the loadings differ by."""
    solids = next(one for one in warm.contacts if one.name == contact)
    rng = np.random.default_rng(1)
    for field in (warm.film_field(), warm.film_field((contact,))):
        for _ in range(4):
            load, speed, kelvin = rng.uniform(5e3, 2e5), rng.uniform(4.0, 10.0), rng.uniform(353.15, 363.15)
            offset, *_ = field.films(contact, np.array([[[load]]]), np.array([speed]), np.array([kelvin]))
            (film,) = Warm().solve_line(solids, warm.lubricant, (load,), speed, kelvin)
            assert offset.item() == pytest.approx(film.film_offset, rel=1e-3)
            flow = warm.rolling_film.mass_flow(contact, load, speed, kelvin)
            assert float(flow) == pytest.approx(film.mass_flow, rel=1e-3)


def test_shared_lines_would_be_wrong(warm):
    shared = generate_in_memory(parse_job(JOB, "cold", "c.toml"), workers=1, solver=Warm(physics="isothermal"))
    field = EHDMap(shared.dataset, shared.backbone).film_field()
    assert not has_own_lines(shared.backbone)
    at = np.array([[[1e5]]]), np.array([9.0]), np.array([353.15])
    wrong, right = field.films("outer", *at)[0].item(), warm.film_field().films("outer", *at)[0].item()
    assert abs(wrong / right - 1.0) > 0.01


def test_a_law_of_both_contacts_stands_on_both(warm):
    load, speed, kelvin = 1e5, 7.0, 358.15
    films = [Warm().solve_line(c, warm.lubricant, (load,), speed, kelvin)[0].film_offset for c in warm.contacts]
    approach = sum(float(c.structural_approach(load)) for c in warm.contacts) - sum(films)
    w, *_ = warm.law("series")(approach, 0.0, speed, kelvin)
    # 1e-3 of the films, a tenth of the approach, to the power 10/9
    assert w == pytest.approx(load, rel=5e-4)


def test_it_is_written_read_and_sealed(warm, generated, tmp_path):
    path = tmp_path / "warm.nc"
    write_map(generated.dataset, path, {schema.BACKBONE: generated.backbone})
    again = open_map(path)
    assert has_own_lines(again.backbone)
    np.testing.assert_array_equal(again.backbone["outer_status"].values, warm.backbone["outer_status"].values)
    broken = warm.backbone.drop_vars("outer_mass_flow")
    with pytest.raises(MapError, match="outer_mass_flow is missing; it belongs to the lines of the outer contact"):
        EHDMap(warm.dataset, broken)
    holes = warm.backbone.copy(deep=True)
    holes["outer_film_offset"].values[10:14] = np.nan
    with pytest.raises(MapError, match="solved points without a number"):
        EHDMap(warm.dataset, holes).law("outer")
    assert EHDMap(warm.dataset, holes).law("inner").contacts[0].name == "inner"


def test_a_bare_contact_needs_no_more_lines_than_before():
    bare = JOB.replace('[bearing]\nname = "NU308"', '[contact]\nradius = "5 mm"\nroller_length = "15 mm"')
    made = generate_in_memory(parse_job(bare, "bare", "bare.toml"), workers=1, solver=Warm())
    assert made.backbone is not None and not has_own_lines(made.backbone)


def test_a_correction_with_heat_is_refused_for_a_bearing():
    by = JOB.replace('"formula"', '"formula"\ncorrected_by = "reynolds"') + '[correction]\nphysics = "inlet-heat"\n'
    with pytest.raises(ehdmaps.errors.InputError, match="'inlet-heat' for films that are isothermal; contacts of a"):
        parse_job(by, "by", "by.toml")
