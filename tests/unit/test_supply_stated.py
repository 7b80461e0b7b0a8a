"""The oil supply as people state it: one text, a table of a job, and what a map keeps of it."""

from __future__ import annotations

import math
import re

import pytest

from ehdmaps import BearingGeometry, EHDMap, Job, Lubricant
from ehdmaps.choices import supply_from_text
from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs import cli
from ehdmaps.jobs.reader import parse_job, read_job
from ehdmaps.jobs.supply import supply_keys, supply_words
from ehdmaps.maps import schema
from ehdmaps.maps.emap import open_map
from ehdmaps.maps.reading import check_content, content_sha256
from ehdmaps.maps.records import record_json
from ehdmaps.physics.oil_supply import FLOODED, LAYERS, OilSupply
from tests.cases.jobs import SMALL
from tests.cases.laws import dry_dataset

TABLE = "[lubricant]"
GREASE = SMALL.replace(TABLE, f'[supply]\nlubrication = "grease"\n{TABLE}')


@pytest.mark.parametrize("name", list(LAYERS))
def test_a_kind_of_lubrication_is_read_by_its_name(name):
    assert supply_from_text(name) == OilSupply(LAYERS[name], name)


@pytest.mark.parametrize("text", ["5 um", "5e-6 m", "0.005 mm"])
def test_an_oil_layer_is_read_as_a_length(text):
    assert supply_from_text(text) == OilSupply(5e-6)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("oil-air", r"got 'oil-air' \(did you mean 'oil air'\?\); allowed: flooded, oil bath, oil air, grease, or the"),
        ("greese", r"got 'greese' \(did you mean 'grease'\?\)"),
        ("5", r"got '5'; allowed: .* oil layer of 0.001 um to 1000 um, such as '5 um'"),
        ("5 N", "got '5 N'; allowed"),
        ("0 um", "got '0 um'; allowed"),
        ("2 mm", "got '2 mm'; allowed"),
        ("", "got ''; allowed"),
    ],
)
def test_what_is_no_supply_is_refused(text, message):
    with pytest.raises(InputError, match=message):
        supply_from_text(text)


@pytest.mark.parametrize("supply", [OilSupply.named(name) for name in LAYERS] + [OilSupply(3e-6), OilSupply()])
def test_keys_read_back_as_the_supply(supply):
    keys = "\n".join(f'{key} = "{value}"' for key, value in supply_keys(supply).items())
    read = parse_job(SMALL.replace(TABLE, f"[supply]\n{keys}\n{TABLE}"), "job", "job.toml").supply
    assert read.oil_layer == supply.oil_layer
    assert read.lubrication == (supply.lubrication or ("flooded" if supply.flooded else ""))


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (
            'oil_layer = "5 um"\nlubrication = "grease"',
            r"\[supply\]: got both of oil_layer and lubrication",
        ),
        ("", r"\[supply\]: got neither of oil_layer and lubrication; allowed: one of the two, such as"),
        ('lubrication = "oilair"', r"\[supply\] lubrication: got 'oilair' \(did you mean 'oil air'\?\); allowed: 'flo"),
        ("lubrication = 5", r"\[supply\] lubrication: got 5; allowed: .* in quotes"),
        ('oil_layer = "5 mm"', r"\[supply\] oil_layer: got '5 mm'; allowed: 0.001 um to 1000 um; check value and unit"),
        ("oil_layer = 5e-6", r"\[supply\] oil_layer: got 5e-06 without a unit"),
        ('lubrication = "grease"\noil_leyer = "5 um"', r"\[supply\] oil_leyer: unknown key \(did you mean 'oil_layer'"),
    ],
)
def test_slips_in_the_table_are_told(table, message):
    with pytest.raises(InputError, match=message):
        parse_job(SMALL.replace(TABLE, f"[supply]\n{table}\n{TABLE}"), "job", "job.toml")


def test_a_job_states_no_supply_unless_it_does():
    assert parse_job(SMALL, "job", "job.toml").supply is None
    assert parse_job(GREASE, "job", "job.toml").supply == OilSupply.named("grease")
    axes = {"loads": [1e4, 1e5], "entrainment_speeds": [1.0, 2.0], "temperatures": [313.15]}
    given = {"bearing": BearingGeometry.named("NU308"), "lubricant": Lubricant.named("FVA3"), **axes}
    assert "[supply]" not in Job.build(**given).text
    assert Job.build(**given, supply=OilSupply(5e-6)).supply == OilSupply(5e-6)


def test_the_comments_of_the_shipped_job_are_valid():
    text = re.sub(r"^# (\[supply\])", r"\1", read_job("nu308").text, flags=re.M)
    for key, supply in (("oil_layer", OilSupply(5e-6)), ("lubrication", OilSupply.named("oil air"))):
        stated = re.sub(rf"^# ({key} = )", r"\1", text, flags=re.M)
        assert parse_job(stated, "job", "job.toml").supply == supply


def test_a_map_keeps_the_supply_of_its_job_and_flooded_points(tmp_path, capsys):
    """The supply is a property of the laws: the points, and their checksum of a map that states none, are the same."""
    maps = {}
    for name, text in (("plain", SMALL), ("grease", GREASE)):
        job, path = tmp_path / f"{name}.toml", tmp_path / f"{name}.nc"
        job.write_text(text)
        assert cli.main(["check", str(job)]) == 0
        assert cli.main(["generate", str(job), "-o", str(path), "--workers", "1"]) == 0
        assert cli.main(["show", str(path)]) == 0
        maps[name] = open_map(path), capsys.readouterr().out
    (plain, plain_text), (grease, grease_text) = maps["plain"], maps["grease"]
    assert plain.supply is FLOODED and schema.OIL_SUPPLY not in plain.dataset.attrs
    assert grease.supply == OilSupply.named("grease")
    assert grease.dataset.drop_vars("solve_seconds").equals(plain.dataset.drop_vars("solve_seconds"))
    assert plain_text.count("flooded (none stated)") == 2  # in `check` and in `show`
    assert grease_text.count(supply_words(OilSupply.named("grease"))) == 2
    assert "grease (oil layer 0.7 um): contact laws cap the films by it" in grease_text
    # `solve_seconds` is a measured time: it is set to that of the other map to see what else the checksum holds.
    other = grease.dataset.assign(solve_seconds=plain.dataset["solve_seconds"])
    assert content_sha256(other, None) != plain.dataset.attrs[schema.CHECKSUM]
    del other.attrs[schema.OIL_SUPPLY]
    assert content_sha256(other, None) == plain.dataset.attrs[schema.CHECKSUM]
    with pytest.raises(MapError, match="oil supply or group"):
        check_content(grease.dataset.assign_attrs({schema.OIL_SUPPLY: record_json(FLOODED)}), None, "grease.nc")
    # What a map says of itself reads as a job again.
    assert read_job(str(tmp_path / "grease.nc")).supply == grease.supply


@pytest.mark.parametrize(
    "text",
    [
        "grease",
        "null",
        "[]",
        "{}",
        '{"oil_layer": 1e-6}',
        '{"oil_layer": true, "lubrication": ""}',
        '{"oil_layer": "thick", "lubrication": ""}',
        '{"oil_layer": 5.0, "lubrication": ""}',
        '{"oil_layer": 1e-6, "lubrication": "slime"}',
        '{"oil_layer": 1e-6, "lubrication": 3}',
    ],
)
def test_a_supply_that_does_not_read_is_a_broken_map(text):
    emap = EHDMap(dry_dataset().assign_attrs({schema.OIL_SUPPLY: text}))
    with pytest.raises(MapError, match="map, attribute oil_supply: does not read"):
        _ = emap.supply


def test_supplies_of_a_map_may_be_unlimited():
    emap = EHDMap(dry_dataset().assign_attrs({schema.OIL_SUPPLY: record_json(FLOODED)}))
    assert emap.supply == FLOODED and math.isinf(emap.supply.oil_layer)
