"""The table [solids] of a job: the structural law in it, and the approaches by finite elements."""

from __future__ import annotations

import pytest

from ehdmaps.errors import InputError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.reader import parse_job
from ehdmaps.jobs.solids import job_sections
from ehdmaps.maps.records import contacts_from_json, contacts_json
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL

NU308 = BearingGeometry.named("NU308")
NAMED = '[bearing]\nname = "NU308"\n'
OWN = """[bearing]
inner_raceway_diameter = "60 mm"
outer_raceway_diameter = "80 mm"
roller_diameter = "10 mm"
roller_length = "10 mm"
rollers = 14
diametral_clearance = "0 mm"
"""
BARE = '[contact]\nradius = "5 mm"\n'
STATED = 'inner_approach = "3.1 um"\nouter_approach = "2.9 um"\n'


def text(solids: str, geometry: str = NAMED, solver: str = "", load: str = '"100 N/mm"') -> str:
    return f"""schema = 1
{geometry}
[lubricant]
name = "FVA3"
[grid]
load = [{load}]
entrainment_speed = ["1 m/s"]
temperature = ["40 degC"]
[solver]
name = "formula"
{solver}
{solids}
"""


def read(*given: str, **more: str) -> Job:
    return parse_job(text(*given, **more), "job", "job.toml")


def approaches(job: Job) -> list[float | None]:
    return [contact.fe_approach for contact in job.contacts]


def test_the_law_may_stand_in_either_table():
    for law in ("iso16281", "half_space", "fe"):
        here, there = read(f'[solids]\nlaw = "{law}"\n'), read("", solver=f'structural_law = "{law}"\n')
        assert here.contacts == there.contacts == NU308.contacts(STEEL, law)


def test_approaches_of_the_job():
    job = read(f'[solids]\nlaw = "fe"\n{STATED}', OWN)
    assert approaches(job) == pytest.approx([3.1e-6, 2.9e-6], rel=1e-12)
    kept = read(f"[solids]\n{STATED}", OWN, 'structural_law = "iso16281"\n')  # for readers who choose fe
    assert approaches(kept) == approaches(job)
    bare = read('[solids]\nlaw = "fe"\napproach = "3 um"\n', BARE)
    assert approaches(bare) == pytest.approx([3e-6], rel=1e-12)
    assert approaches(read("", solver='structural_law = "iso16281"\n')) == [None, None]


def test_solids_of_the_job():
    job = read('[solids]\nlaw = "iso16281"\nroller_bore = "4 mm"\nshaft_bore = "20 mm"\n')
    sections = job_sections(job.solids, NU308, STEEL)
    assert (sections.roller_bore, sections.shaft_bore, sections.seat) == (4e-3, 20e-3, "elastic")
    assert (sections.bore, sections.outside_diameter, sections.housing_diameter) == (40e-3, 90e-3, 135e-3)


@pytest.mark.parametrize(
    ("solids", "geometry", "solver", "message"),
    [
        ('[solids]\nlaw = "fe"\n', NAMED, 'structural_law = "fe"', r"\[solids\] law: stands beside structural_law of"),
        ('[solids]\nlaw = "fee"\n', NAMED, "", r"\[solids\] law: got 'fee' \(did you mean 'fe'\?\)"),
        ('[solids]\nlaw = "fe"\n', OWN, "", r"\[solids\] law: law fe: got the bearing 'bearing 60/80 .* solids JOB"),
        ("", OWN, 'structural_law = "fe"', r"\[solver\] structural_law: law fe: got the bearing"),
        (
            '[solids]\nlaw = "fe"\nroller_bore = "4 mm"\n',
            NAMED,
            "",
            r"\[solids\] law: got 'fe' with roller_bore of \[solids\], but without inner_approach and outer_approach",
        ),
        ('[solids]\nlaw = "fe"\n', BARE, "", r"\[contact\]: .*fe_approach: got none"),
        (f'[solids]\nlaw = "fe"\n{STATED}', BARE, "", r"inner_approach: stands beside \[contact\]; allowed: approach"),
        ('[solids]\nlaw = "fe"\napproach = "3 um"', NAMED, "", r"approach: stands beside \[bearing\]; allowed: inner_"),
        (
            '[solids]\nlaw = "fe"\ninner_approach = "3 um"',
            NAMED,
            "",
            r"outer_approach: missing beside inner_approach; allowed: both, or none; run `ehdmaps solids JOB`",
        ),
        (
            '[solids]\nlaw = "fe"\nseat = "rigid"\nshaft_bore = "2 mm"\n' + STATED,
            NAMED,
            "",
            r"shaft_bore: stands beside seat = 'rigid'",
        ),
        (
            '[solids]\nlaw = "fe"\nbore = "2 mm"\napproach = "3 um"',
            BARE,
            "",
            r"\[solids\] bore: stands beside \[contact\], which has no rings",
        ),
        ('[solids]\nlaw = "fe"\ninner_approach = "3 m"', NAMED, "", r"inner_approach: got '3 m'; allowed: 0\.01 um to"),
        ('[solids]\nlaw = "fe"\nthickness = 3', NAMED, "", r"\[solids\] thickness: unknown key"),
    ],
)
def test_wrong_solids(solids, geometry, solver, message):
    with pytest.raises(InputError, match=message):
        read(solids, geometry, solver)


def test_a_job_to_run_names_the_same_key():
    with pytest.raises(InputError, match=r"\[solids\] law: got 'fe' with bore of \[solids\]"):
        parse_job(text('[solids]\nlaw = "fe"\nbore = "41 mm"\n'), "job", "job.toml", to_run=True)


def test_loads_too_wide_for_the_law():
    with pytest.raises(InputError, match=r"\[grid\] load: contact inner: fe law: got the load 1e\+06 N/m; allowed"):
        read('[solids]\nlaw = "fe"\ninner_approach = "1 um"\nouter_approach = "3 um"\n', load='"1000 N/mm"')


def test_a_job_of_values_has_the_law():
    axes = {"loads": [1e4], "entrainment_speeds": [1.0], "temperatures": [313.15], "lubricant": Lubricant.named("FVA3")}
    job = Job.build(bearing=NU308, structural_law="fe", **axes)
    assert job.contacts == NU308.contacts(STEEL, "fe")
    own = Job.build(bearing=NU308, structural_law="fe", fe_approaches={"inner": 3e-6, "outer": 2e-6}, **axes)
    assert approaches(own) == [3e-6, 2e-6]
    bare = Job.build(contact=LineContact("line", 5e-3, STEEL, "fe", fe_approach=3e-6), **axes)
    assert approaches(bare) == [3e-6]


def test_records_hold_an_approach_only_where_there_is_one():
    """So that the records, and the checksums, of maps by other laws are those of ever."""
    iso, fe = (NU308.contacts(STEEL, law) for law in ("iso16281", "fe"))
    assert "fe_approach" not in contacts_json(iso)
    assert contacts_from_json(contacts_json(iso)) == iso
    assert contacts_from_json(contacts_json(fe)) == fe
