"""Recipes of figures of contacts and maps: what `ehdmaps` prints, and how far its slow films hold."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence

from ehdmaps.units import DAMPER, SPRING
from tests.benchmarks.page_block import Figure, given, significant
from tests.benchmarks.printed_tables import NUMBER, Output


def contact_over_speed(outputs: Sequence[Output]) -> list[Figure]:
    """Changes of k and c of the inner and outer contact from the first to the last point [%]."""
    first, last = (json.loads(output.text) for output in outputs)
    return [
        *given("520 500 2500"),
        *(
            100.0 * (there[name] / here[name] - 1.0)
            for name in ("stiffness", "damping")
            for here, there in zip(first, last, strict=True)
        ),
    ]


def solvers(outputs: Sequence[Output]) -> list[Figure]:
    """Stiffness [N/um] and damping [N s/mm] of a slice, inner and outer contact, of `ehdmaps solve --json`."""
    found: list[Figure] = []
    for output in outputs:
        length = re.search(r'--length "([\d.]+) mm"', output.command)
        assert length is not None
        contacts = json.loads(output.text)
        values = [
            [display.value(1e-3 * float(length[1]) * contact[name]) for contact in contacts]
            for name, display in (("stiffness", SPRING), ("damping", DAMPER))
        ]
        dry = not any(values[1])
        found += [*values[0], *([0.0] if dry else values[1])]
    return found


def frequency_limit(outputs: Sequence[Output]) -> list[Figure]:
    """Share of the damping that is left at omega b/u of 0.5 and 1 [%]."""
    rows = {}
    for line in outputs[0].text.splitlines():
        found = re.match(rf" +{NUMBER} +{NUMBER} +{NUMBER} to {NUMBER} ", line)
        if found is not None:
            ratio, *shares = map(float, found.groups())
            rows[ratio] = [100.0 * share for share in shares]
    half, whole = rows[0.5], rows[1.0]
    return [half[0], whole[0], *half[1:], *whole[1:]]


def share_of_damping(outputs: Sequence[Output]) -> list[Figure]:
    """As the glossary says it: with the places between."""
    half, whole, *bounds = frequency_limit(outputs)
    return [half, *given("0.5"), whole, *given("1 5 95"), *bounds]


def show_of_a_map(outputs: Sequence[Output]) -> list[Figure]:
    """Medians of the estimated errors [%], and shares of the laws within their bars: the smaller of both, whole [%]."""
    text = outputs[0].text

    def median(name: str) -> float:
        found = re.search(rf"(?m)^  {name} +{NUMBER} +{NUMBER} +{NUMBER}$", text)
        assert found is not None
        return 100.0 * float(found[1])

    def share(prefix: str) -> float:
        return min(
            float(each)
            for each in re.findall(rf"(?m)^  {prefix}(?:film compliance|damping) within bar +{NUMBER}%", text)
        )

    return [
        *(significant(median(name), 1) for name in ("film offset", "film compliance", "damping")),
        *given("1 5"),
        float(int(share(""))),
        float(int(share("valley "))),
    ]
