"""Deviations of a bearing from its form in C: the tables of `ehdmaps/kernel/c/run/deviations.h` as constants."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.exports.c.text import array, define, number, template

if TYPE_CHECKING:
    from ehdmaps.arrays import FloatArray

_HEADER = """
/* Deviations from the form: waves, spalls and sizes, of EHD_DEVIATES rolling elements, 0 without any.
 *
 * What they add to the contacts goes into added (EHD_DEVIATES, 2, 2): approach [m] and its rate [m/s] of the inner and
 * the outer contact of each, for `added` of ehd_bearing. By angles [rad] and speeds [rad/s] of cage and rings; elements
 * roll without slip. Films with memory take what is added at the end of a step. */
void ehd_bearing_deviations(double cage_angle, double inner_angle, double outer_angle, double inner_speed,
                            double outer_speed, double *added);
"""

_SOURCE = """
void ehd_bearing_deviations(double cage_angle, double inner_angle, double outer_angle, double inner_speed,
                            double outer_speed, double *added) {
    const double cage_speed = EHD_CAGE_INNER * inner_speed + EHD_CAGE_OUTER * outer_speed, spin = DEVIATIONS.turns[3];
    const double angles[4] = {cage_angle, inner_angle, outer_angle, spin * (inner_angle - outer_angle)};
    const double speeds[4] = {cage_speed, inner_speed, outer_speed, spin * (inner_speed - outer_speed)};
    ehd_deviations_by(&DEVIATIONS, angles, speeds, added);
}
"""


def deviation_texts(data: Any | None) -> tuple[str, str]:
    """Text of the deviations of a bearing for a header, and that for a source.

    Parameters
    ----------
    data : record or None
        `ehd_deviations` of a bearing whose inner ring turns with the system and whose outer one stands; None of a
        perfect one.
    """
    head = define(
        "EHD_DEVIATES", 0 if data is None else data.elements, "rolling elements with deviations from the form"
    )
    if data is None:
        return head, ""
    tables, turns = data.given("tables").reshape(-1), ", ".join(map(number, data.turns))
    sizes = f"{data.elements}, {data.nodes}, {data.rings}, {data.owned}"
    parts = [
        template("ehdmaps.kernel", "c/run/deviations.h"),
        template("ehdmaps.kernel", "c/run/deviations.c"),
        "static const int64_t DEVIATION_TABLES[] = {" + ", ".join(map(str, tables.tolist())) + "};\n",
        *(array(f"DEVIATION_{name.upper()}", _some(data.given(name))) for name in ("places", "sizes", "table", "own")),
        f"static const ehd_deviations DEVIATIONS = {{\n    {sizes}, 0.0, {{{turns}}},\n"
        + "    DEVIATION_TABLES, DEVIATION_PLACES, DEVIATION_SIZES, DEVIATION_TABLE, DEVIATION_OWN, NULL, NULL};\n",
        _SOURCE,
    ]
    return head + _HEADER, "\n".join(parts)


def _some(values: FloatArray) -> FloatArray:
    """Numbers of an array; C has none without any."""
    return values if values.size else np.zeros(1)
