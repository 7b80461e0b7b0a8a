"""Roughness as people state it, what a map keeps of it, and what is shown of films that are too thin or too thick."""

from __future__ import annotations

import json
import math
import re

import numpy as np
import pytest

from ehdmaps import BearingGeometry, EHDMap, Job, Lubricant
from ehdmaps.choices import surface_from_text
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs import cli
from ehdmaps.jobs.make.report import status_counts
from ehdmaps.jobs.reader import parse_job, read_job
from ehdmaps.jobs.show.describe import roughness_lines
from ehdmaps.jobs.show.rough_plot import plot_roughness
from ehdmaps.jobs.supply import surface_keys, surface_words
from ehdmaps.maps import schema
from ehdmaps.maps.emap import open_map
from ehdmaps.maps.reading import check_content, content_sha256
from ehdmaps.maps.records import record_json
from ehdmaps.maps.rough_layer import (
    FILM_PARAMETER,
    FILM_SHARE,
    MEAN_DISTANCE,
    OVERLAP,
    MeanPlanes,
    RoughLayer,
    least_share,
    overlapping,
    rough_variables,
)
from ehdmaps.physics.closed_form import THICKEST_FILM, FormulaSolver, too_thick, too_thin
from ehdmaps.physics.solution import Status
from ehdmaps.physics.surface import SMOOTH, Surface
from tests.cases.jobs import SMALL
from tests.cases.laws import CONTACTS, OIL, dataset_of, dry_dataset

TABLE = "[lubricant]"
ROUGH = SMALL.replace(TABLE, f'[surface]\nroughness = "0.2 um"\n{TABLE}')


@pytest.mark.parametrize("text", ["0.2 um", "2e-7 m", "200 nm"])
def test_a_roughness_is_read_as_a_length(text):
    assert surface_from_text(text).roughness == pytest.approx(2e-7, rel=1e-12)


def test_smooth_is_a_word():
    assert surface_from_text("smooth") is SMOOTH


@pytest.mark.parametrize("text", ["0.2", "0.2 N", "0 um", "2 mm", "0.5 nm", "rough", ""])
def test_what_is_no_roughness_is_refused(text):
    with pytest.raises(InputError, match=f"got {text!r}; allowed: a combined rms roughness of 0.001 um to 10 um"):
        surface_from_text(text)


@pytest.mark.parametrize("surface", [Surface(2e-7), Surface(3.3e-7, 0.03, 0.001, 5e9)])
def test_keys_read_back_as_the_surface(surface):
    keys = "\n".join(f"{key} = {json.dumps(value)}" for key, value in surface_keys(surface).items())
    assert parse_job(SMALL.replace(TABLE, f"[surface]\n{keys}\n{TABLE}"), "job", "job.toml").surface == surface


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("", r"\[surface\] roughness: missing; allowed"),
        ('roughness = "1 mm"', r"\[surface\] roughness: got '1 mm'; allowed: 0.001 um to 10 um"),
        ("roughness = 2e-7", r"\[surface\] roughness: got 2e-07 without a unit"),
        ('roughness = "0.2 um"\nasperity_product = 5', r"\[surface\] asperity_product: got 5; allowed: 0.02 to 0.5"),
        ('roughness = "0.2 um"\nhardness = "7 MPa"', r"\[surface\] hardness: got '7 MPa'; allowed: 1 GPa to 100 GPa"),
        ('rougness = "0.2 um"', r"\[surface\] rougness: unknown key \(did you mean 'roughness'"),
    ],
)
def test_slips_in_the_table_are_told(table, message):
    with pytest.raises(InputError, match=message):
        parse_job(SMALL.replace(TABLE, f"[surface]\n{table}\n{TABLE}"), "job", "job.toml")


def test_a_job_states_no_surface_unless_it_does():
    assert parse_job(SMALL, "job", "job.toml").surface is None
    assert parse_job(ROUGH, "job", "job.toml").surface == Surface(2e-7)
    axes = {"loads": [1e4, 1e5], "entrainment_speeds": [1.0, 2.0], "temperatures": [313.15]}
    given = {"bearing": BearingGeometry.named("NU308"), "lubricant": Lubricant.named("FVA3"), **axes}
    assert "[surface]" not in Job.build(**given).text
    assert Job.build(**given, surface=Surface(3e-7, hardness=5e9)).surface == Surface(3e-7, hardness=5e9)


def test_the_comments_of_the_shipped_job_are_valid():
    text = re.sub(r"^# (\[surface\]|roughness = )", r"\1", read_job("nu308").text, flags=re.M)
    assert parse_job(text, "job", "job.toml").surface == Surface(2e-7)


@pytest.mark.slow
def test_a_map_keeps_the_surface_of_its_job_and_smooth_points(tmp_path, capsys):
    maps = {}
    for name, text in (("plain", SMALL), ("rough", ROUGH)):
        job, path = tmp_path / f"{name}.toml", tmp_path / f"{name}.nc"
        job.write_text(text)
        assert cli.main(["check", str(job)]) == 0
        assert cli.main(["generate", str(job), "-o", str(path), "--workers", "1"]) == 0
        capsys.readouterr()
        assert cli.main(["show", str(path)]) == 0
        maps[name] = open_map(path), capsys.readouterr().out
    (plain, plain_text), (rough, rough_text) = maps["plain"], maps["rough"]
    assert plain.surface is SMOOTH and schema.SURFACE not in plain.dataset.attrs
    assert rough.surface == Surface(2e-7)
    assert rough.dataset.drop_vars("solve_seconds").equals(plain.dataset.drop_vars("solve_seconds"))
    assert "smooth (none stated)" in plain_text and "Lambda" not in plain_text
    assert surface_words(Surface(2e-7)) in rough_text
    assert re.search("Lambda, minimum film over roughness: [0-9]+ % of the points below 1, [0-9]+ %", rough_text)
    assert re.search("share of the film in the load: [0-9]+ % below 0.5", rough_text)
    # an option gives the same, and takes it away again
    assert cli.main(["show", str(tmp_path / "plain.nc"), "--roughness", "0.2 um"]) == 0
    given = capsys.readouterr().out
    assert [line for line in given.splitlines() if "Lambda" in line] == [
        line for line in rough_text.splitlines() if "Lambda" in line
    ]
    assert rough.with_surface(SMOOTH).surface is SMOOTH
    assert rough.with_surface(Surface(2e-7)) is rough
    with pytest.raises(MapError, match="geometry, oil, surface, oil supply or group"):
        check_content(rough.dataset.assign_attrs({schema.SURFACE: record_json(Surface(3e-7))}), None, "rough.nc")
    other = rough.dataset.assign(solve_seconds=plain.dataset["solve_seconds"])
    del other.attrs[schema.SURFACE]
    assert content_sha256(other, None) == plain.dataset.attrs[schema.CHECKSUM]
    # a page of its own, and a table with two more columns
    assert cli.main(["plot", str(tmp_path / "plain.nc"), "--roughness", "0.2 um"]) == 0
    assert (tmp_path / "plain_roughness.png").stat().st_size > 20_000
    assert cli.main(["export", str(tmp_path / "rough.nc"), "--contact", "inner", "--points", "3"]) == 0
    rows = (tmp_path / "rough.csv").read_text().splitlines()
    assert "roughness 0.2 um; central and minimum film and Lambda of smooth surfaces" in rows[0]
    assert rows[1].endswith("minimum_film [m],film_parameter [1],film_share [1]")
    assert all(0.0 <= float(row.split(",")[-1]) <= 1.0 for row in rows[2:])


@pytest.mark.parametrize(
    "text", ["rough", "null", "[]", "{}", '{"roughness": "2e-7"}', '{"roughness": 1.0}', '{"a": 1}']
)
def test_a_surface_that_does_not_read_is_a_broken_map(text):
    emap = EHDMap(dry_dataset().assign_attrs({schema.SURFACE: text}))
    with pytest.raises(MapError, match="map, attribute surface: does not read"):
        _ = emap.surface


@pytest.mark.slow
def test_a_law_has_the_surface_of_its_map_or_the_one_that_is_asked_for():
    emap = EHDMap(dataset_of().assign_attrs({schema.SURFACE: record_json(Surface(3e-7))}))
    assert emap.law("inner").surface == Surface(3e-7)
    assert emap.law("inner", surface=SMOOTH).surface is SMOOTH
    # asperities touch before the mean planes do
    assert emap.law("inner", surface=SMOOTH).at(0.0, 320.0)(-1e-7, 0.0)[0] == 0.0
    assert emap.law("inner").at(0.0, 320.0)(-1e-7, 0.0)[0] > 0.0


def test_a_dry_map_has_rough_dry_contacts():
    """Without any film asperities carry everything, at any speed."""
    emap = EHDMap(dry_dataset())
    rough = emap.law("inner", surface=Surface(3e-7))
    delta = np.linspace(-2e-7, 5e-6, 7)
    at_rest, moving = (rough.at(speed, 320.0)(delta, 0.0) for speed in (0.0, 1.0))
    np.testing.assert_allclose(moving[0], at_rest[0], rtol=5e-4)  # error of the table at 0.1 N/mm
    assert at_rest[0][0] > 0.0 and np.all(np.diff(at_rest[0]) > 0.0)


def test_share_of_the_film_at_the_points_of_a_map():
    emap = EHDMap(dataset_of())
    found = rough_variables(emap.dataset, emap.contacts, emap.lubricant, Surface(3e-7))
    share, parameter = found[FILM_SHARE].values, found[FILM_PARAMETER].values
    assert np.all((share > 0.0) & (share <= 1.0))
    assert np.all(share[parameter > 6.0] > 0.999)  # Gaussian heights: nothing is left of them at six sigma
    assert share[parameter < 1.0].min() < 0.7


def test_no_film_that_is_too_thin_is_plainly_converged():
    assert too_thin(9e-10) == too_thin(9e-10, 2e-7) == "film below 1 nm: no continuum"
    assert too_thin(1e-7, 2e-7) == "film below the roughness"
    assert too_thin(1e-7) == too_thin(3e-7, 2e-7) == too_thin(0.0) == too_thin(math.nan) == ""
    dataset = dataset_of()
    films = dataset["minimum_film"].values
    films.flat[:5], films.flat[5:9] = 5e-10, 1e-8
    films.flat[9:] = 1e-6
    counts = {words: int(here.sum()) for words, here in status_counts(dataset, 2e-7).items()}
    plain = films.size - 9
    assert counts == {
        "converged": plain,
        "converged, film below the roughness": 4,
        "converged, film below 1 nm: no continuum": 5,
    }
    assert "converged, film below the roughness" not in status_counts(dataset)


def test_solve_says_what_a_film_is_too_thin_for(tmp_path, capsys):
    point = ["--load", "50 N/mm", "--speed", "1 mm/s", "--temperature", "100 degC", "--solver", "formula"]
    assert cli.main(["solve", "nu308", *point]) == 0
    assert "converged, film below 1 nm: no continuum" in capsys.readouterr().out
    job = tmp_path / "rough.toml"
    job.write_text(ROUGH)
    faster = [*point[:2], "--speed", "0.1 m/s", *point[4:]]
    assert cli.main(["solve", str(job), *faster]) == 0
    text = capsys.readouterr().out
    assert "converged, film below the roughness" in text and "film's share of load" in text
    assert cli.main(["solve", str(job), *faster, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)[0]
    assert (record["status"], record["film_note"]) == ("converged", "film below the roughness")
    assert record["film_parameter"] == pytest.approx(record["minimum_film"] / 2e-7)
    assert 0.0 < record["film_share"] < 1.0
    softest, stiffest = (record[f"damping_{end}_asperities"] for end in ("soft", "stiff"))
    assert 0.0 < stiffest < softest < record["damping"]  # the softer, the more is left to the film
    assert cli.main(["solve", str(job), "--load", "20 N/mm", "--speed", "0 m/s", *point[4:]]) == 0
    assert f"with the softest usual asperities {MeanPlanes.MERGED.value}" in capsys.readouterr().out


@pytest.mark.parametrize("solver", [FormulaSolver(), ReynoldsSolver()])
def test_a_film_of_millimetres_is_refused(solver):
    """Just below the limit it is an asymptote, above it there is no number."""
    loads = tuple(np.geomspace(20.0, 400.0, 25))
    films = solver.solve_line(CONTACTS[0], OIL, loads, 10.0, 293.15)
    refused = [film for film in films if film.status is Status.OUTSIDE_VALIDITY]
    assert refused and all(math.isnan(film.film_offset) for film in refused)
    assert all(
        re.match("film h/R = 0.[3-9]+.* above 0.3: neither thin-film theory nor", film.reason) for film in refused
    )
    kept = [film for film in films if film.status is Status.ASYMPTOTE]
    assert 0.2 < max(film.film_offset for film in kept) / CONTACTS[0].radius <= THICKEST_FILM


def test_limit_of_thick_films_is_told():
    assert too_thick(2e-3, 5.5e-3).startswith("film h/R = 0.364 above 0.3:")
    assert too_thick(1e-3, 5.5e-3) == too_thick(math.nan, 5.5e-3) == ""


def test_load_sharing_says_where_it_is_out_of_its_range(tmp_path, capsys):
    """Where the mean planes overlap: below one share at a load, whatever speed and temperature."""
    emap = EHDMap(dataset_of()).with_surface(Surface(1e-6))
    found = rough_variables(emap.dataset, emap.contacts, emap.lubricant, emap.surface)
    share, distance = (found[name].values for name in (FILM_SHARE, MEAN_DISTANCE))
    beyond = overlapping(share, distance)
    assert beyond.any() and not beyond.all()
    for contact, shares, overlaps in zip(emap.contacts, share, beyond, strict=True):
        limits = least_share(RoughLayer(emap.surface, contact, emap.lubricant, 1.0), emap.dataset["load"].values)
        np.testing.assert_array_equal(overlaps, (shares > 0.0) & (shares < limits[:, None, None]))
    assert not overlapping(np.array([0.0]), np.array([-1.0])).any()  # the rough dry contact shares nothing
    said = "\n".join(roughness_lines(emap))
    assert f"at {100.0 * beyond.mean():.0f} % of the points, Lambda up to" in said and OVERLAP in said
    assert "      softest usual asperities (product 0.03, slope 0.0001): k " in said
    assert MeanPlanes.MERGED.value not in said
    assert MeanPlanes.MERGED.value in "\n".join(roughness_lines(emap.with_surface(Surface(1e-5))))
    assert OVERLAP not in "\n".join(roughness_lines(emap.with_surface(Surface(1e-9))))
    job = tmp_path / "rough.toml"
    job.write_text(ROUGH)
    for load, wanted in (("200 N/mm", True), ("0.5 N/mm", False)):
        point = ["--load", load, "--speed", "0.1 m/s", "--temperature", "100 degC", "--solver", "formula"]
        assert cli.main(["solve", str(job), *point]) == 0
        assert (OVERLAP in capsys.readouterr().out) == wanted
    assert cli.main(["solve", str(job), *point, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)[0]["mean_distance"] > 0.0


@pytest.mark.slow
def test_the_page_of_roughness_shades_what_is_out_of_range(tmp_path):
    emap = EHDMap(dataset_of()).with_surface(Surface(1e-6))
    plot_roughness(emap, tmp_path / "rough.svg")
    drawn = (tmp_path / "rough.svg").read_text()
    assert "mean planes overlap: out of the range of load sharing" in drawn
