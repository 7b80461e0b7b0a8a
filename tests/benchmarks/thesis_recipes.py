"""Recipes of figures beside the thesis: its own oil, its second law of dry contacts, its rig at high speed."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tests.benchmarks.machine_recipes import highest_peaks, mode_rows
from tests.benchmarks.page_block import Figure, given
from tests.benchmarks.printed_tables import NUMBER, Output, one_case, sweep_cases


def oil_of_the_thesis(outputs: Sequence[Output]) -> list[Figure]:
    """Viscosities; k, c and the modes along the load of the gearbox, with that oil and with FVA 3."""
    text = outputs[0].text
    told = re.search(rf"FVA3 \({NUMBER} mPa s at 40 degC\).*Spirax MA 80W \({NUMBER} mPa s", text)
    assert told is not None
    fva, own = (one_case([text], name) for name in ("nu308", "spirax"))
    found: list[Figure] = [*given("80"), float(told[2]), *given("3"), float(told[1]), *given("30")]
    for index in (0, 1):
        found += [-case.along.changes[index] for case in (own, fva)]
    for case in (own, fva):
        found += [-mode.change for mode in case.bearing_modes()]
    found += given("500")
    for case in (own, fva):
        found += [100.0 * mode.damping_ratio for mode in case.bearing_modes()]
    return found


def last_peak_of_the_flexible(outputs: Sequence[Output]) -> list[Figure]:
    """The last peak of S1 of nu308_flexible below 4 kHz at both speeds, with that oil and with FVA 3."""
    found: list[Figure] = given("20 500 2000")
    for name in ("spirax", "nu308"):
        case = one_case([outputs[0].text], name)
        for last in (False, True):
            found += max((at, height) for height, at in highest_peaks(case.text, last) if at < 4000.0)
    return [*found, *given("3")]


def dry_laws_of_the_rigid(outputs: Sequence[Output]) -> list[Figure]:
    """The seventh mode of nu308_rigid by three dry laws."""
    return [*given("16281"), *(mode_rows(output.text)[6][0] for output in outputs)]


def rig_at_high_speed(outputs: Sequence[Output]) -> list[Figure]:
    """Highest peak of S1 of n1014_testrig at 1000 and 4200 rpm, without clearance and with it."""
    found: list[Figure] = given("1000 4200")
    for clearance, case in zip(("0", "20"), sweep_cases(outputs[0].text), strict=True):
        both = [max(highest_peaks(case.text, last)) for last in (False, True)]
        found += [*given(clearance), both[0][1], both[1][1], both[0][0], both[1][0]]
    return found


def height_of_the_rigid(outputs: Sequence[Output]) -> list[Figure]:
    """k, c and damping ratio of the shaft mode of nu308_rigid from 500 to 2000 rpm, with clearance and without."""
    found: list[Figure] = given("500 2000")
    for clearance in ("20", "0"):
        case = next(case for case in sweep_cases(outputs[0].text) if case.title == f"{clearance} um, 1 x load")
        along = next(mode for mode in case.complex.values() if mode.first > 2000.0)
        found += [*given(clearance), *case.along.changes, along.damping_ratio, along.last_ratio]
    return found
