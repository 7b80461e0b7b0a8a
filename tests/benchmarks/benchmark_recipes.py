"""Recipes of figures that benchmarks of run-ups and sweeps print."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tests.benchmarks.page_block import Figure, Given, Time, given, significant
from tests.benchmarks.printed_tables import NUMBER, Output


def gearbox_runs(outputs: Sequence[Output]) -> list[Figure]:
    """Rows of `bench_gearbox --whole` as the page has them."""
    laws = re.split(r"(?m)^(?=law \w+: \d+ coordinates)", outputs[0].text)[1:]
    rows = [
        (laws[0], "shipped: 10 us, 21", "10 21"),
        (laws[0], "  10 us", "10 41"),
        (laws[0], "  20 us", "20 41"),
        (laws[1], "shipped: 10 us, 21", "10 21"),
        (laws[1], "start moved by 10 nm", "10"),
    ]
    found: list[Figure] = given("1 2.5 5 1 5")
    for law, label, settings in rows:
        line = re.search(rf"(?m)^{re.escape(label)} (.*)$", law)
        assert line is not None
        step, processor, _, _, *values = (float(value) for value in re.findall(NUMBER, line[1]))
        # signal to three frequencies; levels to 1 kHz, to 2.5 kHz (not shown), to 5 kHz, of the sum, each twice
        signal = [significant(value, 2) for value in values[:3]]
        levels = [significant(value, 2) for value in (*values[3:5], *values[7:9], *values[9:11])]
        found += [*given(settings), Time(processor), Time(step), *signal, *levels]
    return found


def periods(outputs: Sequence[Output]) -> list[Figure]:
    """By how much periods at 5 kHz are too long [%]; error of the blended tables, as a part of the signal."""
    text = outputs[0].text
    rows = {
        float(step): float(shift)
        for step, shift in re.findall(rf"(?m)^ +{NUMBER} +0\.9 +\S+ +{NUMBER}%$", text.partition("period of a mode")[2])
    }
    blending = re.search(rf"largest difference of S1 {NUMBER} of", text)
    assert blending is not None
    return [*given("5"), rows[10.0], *given("10"), rows[20.0], *given("20"), significant(float(blending[1]), 1)]


def cutoffs(outputs: Sequence[Output]) -> list[Figure]:
    """The table of cut-offs of the housing."""
    text = outputs[0].text.partition("cut-off of the housing beside")[2]
    found: list[Figure] = given("2.5 5 5")
    for cutoff in ("5", "6", "8"):
        line = re.search(rf"(?m)^housing {cutoff} kHz: (\d+) +(.*)$", text)
        shift = re.search(rf"(?m)^  housing {cutoff} kHz: (.*)$", text)
        assert line is not None
        assert shift is not None
        step, *values = (float(value) for value in re.findall(NUMBER, line[2]))
        # after step: processor, clock, Newton, three signals, and pairs to 1 kHz, 2.5 kHz, 5 kHz
        found += [Given(cutoff), float(line[1]), Time(step), values[10], significant(values[11], 2)]
        shifts = [float(value) for value in re.findall(NUMBER, shift[1])]
        found += shifts if "missing" in shift[1] else shifts[-2:-1] if cutoff == "6" else shifts[-2:]
    return found


def speed_sweep(outputs: Sequence[Output]) -> list[Figure]:
    """Cost and errors of a sweep; what slices and cage angles change."""
    film, dry = outputs[0].text.split("\nlaw ")[1:]
    seconds = re.search(rf"inputs: {NUMBER} s", film)
    assert seconds is not None
    response = max(float(each) for each in re.findall(rf"responses within {NUMBER} ", outputs[0].text))

    def slices(text: str) -> dict[int, list[float]]:
        rows = re.findall(rf"(?m)^ +(\d+): +{NUMBER}% +{NUMBER}% +{NUMBER}%$", text)
        return {int(count): [float(value) for value in values] for count, *values in rows}

    def angles(text: str) -> tuple[float, float]:
        found = re.search(rf"f {NUMBER}% at most, {NUMBER}% in the median", text)
        assert found is not None
        return float(found[1]), float(found[2])

    own, other = slices(film)[21], [slices(dry)[count] for count in (21, 41)]
    k, f = (sorted(row[column] for row in other) for column in (0, 2))
    (film_most, film_median), (dry_most, dry_median) = angles(film), angles(dry)
    return [
        *[*given("40 1000"), Time(float(seconds[1])), significant(response, 1), *given("21 161")],
        *[*own, *k, *f],
        *[film_most, dry_most, film_median, dry_median],
    ]
