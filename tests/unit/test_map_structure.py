"""One map for every structural law: what is stored are films; approach, stiffness and damping follow from them."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.generate import generate
from ehdmaps.jobs.reader import parse_job
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.reading import content_sha256
from ehdmaps.maps.records import DERIVED, SAME
from ehdmaps.physics.approach import STRUCTURAL_LAWS
from ehdmaps.physics.bearing import BearingGeometry, with_law
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.solution import FilmSolution, Status
from tests.cases.jobs import map_job, spaced
from tests.cases.laws import CONTACTS, LINE, dataset_of

ROUND_OFF = 1e-12
"""Relative: of powers, and of a table that is compiled twice from films that differ in their last digits."""

TEXT = map_job(spaced("1 N/mm", "100 N/mm", 7), '["0.5 m/s", "1 m/s", "2 m/s"]', '["40 degC", "60 degC"]')


class WithErrors(FormulaSolver):
    """Closed formulas that state errors of both signs, and ask for a backbone."""

    wants_backbone = True

    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        films = super().solve_line(contact, lubricant, loads, entrainment_speed, temperature)
        sign = 1.0 if entrainment_speed > 1.0 else -1.0
        errors = {"film_offset_error": -1e-3, "film_compliance_error": 0.02 * sign, "loss_compliance_error": 0.03}
        return tuple(dataclasses.replace(film, **errors) for film in films)


def job_of(law: str, text: str = TEXT) -> Job:
    return parse_job(text.replace("iso16281", law), "test", "test.toml")


@pytest.fixture(scope="module")
def paths(tmp_path_factory):
    """Maps of one bearing, each by a job with another structural law."""
    folder = tmp_path_factory.mktemp("structure")
    for law in STRUCTURAL_LAWS:
        generate(job_of(law), folder / f"{law}.nc", workers=1, solver=WithErrors())
    return {law: folder / f"{law}.nc" for law in STRUCTURAL_LAWS}


def read(emap):
    """What two laws of a map say at some points."""
    points = (np.array([2e-6, 2.2e-6, -1e-7]), np.array([0.0, 1e-4, 0.0]), np.array([1.0, 0.7, 2.0]), 320.0)
    return [emap.law(kind)(*points) for kind in ("series", "outer")]


@pytest.fixture(scope="module")
def own(paths):
    """Every map as it was made, and what its laws say."""
    return {law: (emap, read(emap)) for law, emap in ((law, open_map(path)) for law, path in paths.items())}


# each made by one is read by itself and by the next
@pytest.mark.parametrize(
    ("made_by", "read_by"),
    [
        (law, other)
        for law, following in zip(STRUCTURAL_LAWS, (*STRUCTURAL_LAWS[1:], STRUCTURAL_LAWS[0]), strict=True)
        for other in (law, following)
    ],
)
def test_one_map_is_the_map_of_every_structural_law(paths, own, made_by, read_by):
    emap, (other, answers) = open_map(paths[made_by], structural_law=read_by), own[read_by]
    assert (emap.structural_law, emap.contacts) == (read_by, other.contacts)
    for name in (*DERIVED, "film_offset", "film_compliance", "loss_compliance"):
        found, expected = emap.dataset[name], other.dataset[name]
        assert found.attrs == expected.attrs
        np.testing.assert_allclose(found.values, expected.values, rtol=ROUND_OFF, atol=0.0)
    for law, expected in zip(read(emap), answers, strict=True):
        for ours, theirs in zip(law, expected, strict=True):
            np.testing.assert_allclose(ours, theirs, rtol=ROUND_OFF)


def test_the_laws_differ_by_their_solids_only(paths):
    """The measure of the test above: two structural laws are far apart, in stiffness as in the laws."""
    iso, half = (open_map(paths[law]) for law in ("iso16281", "half_space"))
    assert np.abs(half.dataset["stiffness"] / iso.dataset["stiffness"] - 1.0).max() > 0.02
    one, two = (emap.law("series")(4e-6, 0.0, 1.0, 320.0) for emap in (iso, half))
    assert abs(two[0] / one[0] - 1.0) > 0.02
    loads = iso.dataset["load"].values
    for i, contact in enumerate(half.contacts):
        compliance = 1.0 / half.dataset["stiffness"].values[i] - contact.structural_compliance(loads)[:, None, None]
        film = iso.dataset["film_compliance"].values[i]
        # A difference of compliances: round-off of the larger one.
        np.testing.assert_allclose(compliance, film, rtol=0.0, atol=1e-15 / half.dataset["stiffness"].values.min())


def test_the_errors_of_damping_keep_the_sign_of_one_error_against_the_other(paths):
    """Errors of the loss and of k add up or cancel: 0.03 and 2 x 0.02 times the film's share of the compliance."""
    data = open_map(paths["iso16281"]).dataset
    assert set(np.unique(data["loss_compliance_error"])) == {-0.03, 0.03}
    assert np.all(data["film_compliance_error"] == 0.02)
    slow, fast = (data.isel(entrainment_speed=k) for k in (0, 2))
    for entry, sign in ((slow, -1.0), (fast, 1.0)):
        k = 0.02 * entry["film_compliance"] * entry["stiffness"]
        expected = np.abs(0.03 * sign - 2.0 * k) + 0.05 * (0.03 + 2.0 * k)
        np.testing.assert_allclose(entry["damping_error"], expected, rtol=1e-12)
        np.testing.assert_allclose(entry["stiffness_error"], k, rtol=1e-12)


def test_a_map_with_another_structural_law_is_a_map_like_any_other(paths, tmp_path):
    emap = open_map(paths["iso16281"]).with_structure("half_space", reference_depth=4e-3)
    assert emap.contacts[0].reference_depth == 4e-3
    path = tmp_path / "half.nc"
    emap.dataset.to_netcdf(path)
    emap.backbone.to_netcdf(path, mode="a", group="backbone")
    again = open_map(path)
    assert again.dataset.attrs[schema.CHECKSUM] == content_sha256(emap.dataset, emap.backbone)
    assert again.contacts == emap.contacts
    xr.testing.assert_equal(again.dataset, emap.dataset)
    back = again.with_structure("iso16281")
    np.testing.assert_allclose(
        back.dataset["stiffness"], open_map(paths["iso16281"]).dataset["stiffness"], rtol=ROUND_OFF
    )
    assert again.with_structure("half_space") is again


def test_structural_laws_that_do_not_suit_are_refused(paths):
    emap = open_map(paths["iso16281"])
    with pytest.raises(InputError, match="structural_law: got 'dowson'; allowed: iso16281, palmgren, half_space"):
        emap.with_structure("dowson")
    with pytest.raises(InputError, match="half_space law: got a contact half-width"):
        emap.with_structure("half_space", reference_depth=1e-6)
    with pytest.raises(InputError, match="structural_law: got 'dowson'"):
        open_map(paths["iso16281"], structural_law="dowson")
    bare = EHDMap(dataset_of(contacts=(LINE,), speeds=(0.5, 1.0), temperatures=(330.0,), bearing=None))
    with pytest.raises(InputError, match="roller_length: got none; the palmgren law needs it; give the length"):
        bare.with_structure("palmgren")
    assert bare.with_structure("palmgren", roller_length=15e-3).contacts[0].structural_law == "palmgren"
    with pytest.raises(InputError, match="fe_approach: got none; the fe law needs it; give the approach"):
        bare.with_structure("fe")
    assert bare.with_structure("fe", fe_approaches={"line": 3e-6}).contacts[0].fe_approach == 3e-6


def test_finite_elements_of_other_rings(paths):
    """Approaches that are given stay with the map, those that come with the package go with their law."""
    emap = open_map(paths["iso16281"])
    own = emap.with_structure("fe", fe_approaches={"inner": 3e-6, "outer": 2.8e-6})
    assert [contact.fe_approach for contact in own.with_structure("iso16281").with_structure("fe").contacts] == [
        3e-6,
        2.8e-6,
    ]
    assert emap.with_structure("fe").with_structure("iso16281").contacts == emap.contacts


@pytest.mark.parametrize("name", DERIVED)
def test_what_contradicts_the_films_is_refused(name, paths):
    dataset = open_map(paths["iso16281"]).dataset
    wrong = dataset.copy(deep=True)
    here = (1, 3, 2, 1)
    size = abs(float(dataset[name].values[here]))
    if name == "approach":  # a difference: held to the size of both parts
        size += float(dataset["film_offset"].values[here])
    wrong[name].values[here] += 3.0 * SAME * size
    values = dataset[name].size
    told = f"map: variable {name} contradicts the films: 1 of {values} values are not what"
    with pytest.raises(MapError, match=told):
        EHDMap(wrong)
    within = dataset.copy(deep=True)
    within[name] = within[name] * (1.0 + 0.1 * SAME)
    EHDMap(within)
    bare = EHDMap(dataset.drop_vars(name))
    xr.testing.assert_allclose(bare.dataset[name], dataset[name], rtol=ROUND_OFF)
    assert bare.dataset[name].attrs == dataset[name].attrs


def test_derived_variables_say_so_in_the_file(paths):
    with xr.open_dataset(paths["iso16281"]) as opened:
        for entry in (entry for entry in schema.table() if entry.name in opened):
            assert (opened[entry.name].attrs.get("comment") is not None) == entry.derived
        assert "contact laws do not read it" in opened["stiffness"].attrs["comment"]
    assert {entry.name for entry in schema.table() if entry.derived} == set(DERIVED)


def test_laws_do_not_read_what_is_derived():
    dataset = dataset_of()
    point = (5e-6, 1e-4, 1.0, 330.0)
    expected = EHDMap(dataset).law("series")(*point)
    emap = EHDMap(dataset.drop_vars(list(DERIVED)))
    emap._dataset = emap.dataset.drop_vars(list(DERIVED))
    assert emap.law("series")(*point) == expected


@dataclasses.dataclass(frozen=True)
class Lost(FormulaSolver):
    """Closed formulas with points that do not converge: at one speed, and over zeta of one backbone line."""

    wants_backbone = True
    speed: float = 0.0
    loads: tuple[float, float] = (0.0, 0.0)

    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        films = super().solve_line(contact, lubricant, loads, entrainment_speed, temperature)
        here = abs(entrainment_speed / self.speed - 1.0) < 1e-9
        low, high = self.loads
        return tuple(
            FilmSolution(Status.STAGNATED, "lost") if here and low <= load <= high else film
            for load, film in zip(loads, films, strict=True)
        )


def test_a_law_looks_at_what_it_reads(tmp_path):
    """Holes of the grid do not matter to a law that is made from the backbone; without it, that speed is left out."""
    # 1 m/s is a speed of the grid and none of the backbone, whose lowest is 0.5 m/s times the ratio of the radii
    solver = Lost(speed=1.0, loads=(0.0, 1e9))
    path = tmp_path / "grid.nc"
    generate(job_of("iso16281"), path, workers=1, solver=solver)
    emap = open_map(path)
    assert int((emap.dataset["status"] == int(Status.STAGNATED)).sum()) == 28
    assert int((emap.backbone["status"] == int(Status.STAGNATED)).sum()) == 0
    whole = EHDMap(emap.dataset.copy(), emap.backbone)
    assert whole.law("series")(5e-6, 0.0, 1.0, 320.0)[0] > 0.0
    assert EHDMap(emap.dataset).reach().text.endswith("; without 1 m/s")


@pytest.mark.parametrize(("loads", "refused"), [((6e4, 1e9), True), ((0.0, 1e1), False)])
def test_the_end_of_a_backbone_line_counts_as_far_as_the_map_goes(tmp_path, loads, refused):
    """A line that lacks loads of the map is not continued over them; what it lacks beyond them is of no importance."""
    plain = tmp_path / "plain.nc"
    generate(job_of("iso16281"), plain, workers=1, solver=Lost(speed=1e3))
    group = open_map(plain).backbone
    inside = [float(u) for u in group["reference_speed"].values if 0.5 <= u <= 2.0]
    path = tmp_path / "lost.nc"
    generate(job_of("iso16281"), path, workers=1, solver=Lost(speed=inside[1], loads=loads))
    emap = open_map(path)
    if refused:
        assert int((emap.backbone["status"] == int(Status.STAGNATED)).sum()) > 2
        with pytest.raises(
            MapError, match=r"backbone of the map: has .* unsolved points beside one another within a line"
        ):
            emap.law("inner")
    else:
        emap.law("inner")


def test_contacts_of_a_bearing_have_the_lengths_of_every_law():
    for contact in CONTACTS:
        for law in STRUCTURAL_LAWS:
            assert with_law(contact, law, BearingGeometry.named("NU308")).structural_approach(1e5) > 0.0


def test_show_by_another_structural_law(paths, capsys):
    assert main(["show", str(paths["iso16281"]), "--structural-law", "half_space"]) == 0
    shown = capsys.readouterr().out
    assert main(["show", str(paths["half_space"])]) == 0
    made = capsys.readouterr().out

    def part(text):
        return text[text.index("geometry") if "geometry" in text else text.index("bearing ") : text.index("provenance")]

    assert part(shown) == part(made)
    assert "structural law       half_space" in shown
    assert main(["show", str(paths["iso16281"]), "--structural-law", "hertz"]) == 2
    assert "--structural-law: got 'hertz'; allowed: iso16281, palmgren, half_space" in capsys.readouterr().err
