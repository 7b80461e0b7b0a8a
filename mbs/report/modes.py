"""The table of modes of a report."""

from __future__ import annotations

import math

from ehdmaps.report.chart import number, shown
from ehdmaps.report.page import Markup, joined, table, tag
from mbs.analyses.modes import ModesResult
from mbs.output.model_text import band_lines, clean, film_law_line, film_lines, free_words
from mbs.output.result_text import kinds, share_words
from mbs.scene.fields import HERTZ

MOST = 60
"""Modes that are listed."""


def mode_table(found: ModesResult, highest: float) -> Markup:
    """Return the oscillating modes up to a frequency.

    Parameters
    ----------
    found : ModesResult
        The modes.
    highest : float
        Highest frequency that is listed [Hz].
    """
    all_modes = found.modes
    free, creeping, swinging = kinds(all_modes)
    listed = swinging[all_modes.frequency[swinging] <= highest][:MOST]
    bands, law = all_modes.bands, all_modes.film_law
    rows = [
        (
            f"{k + 1}",
            number(float(all_modes.frequency[k]), 5),
            *([number(float(bands.frequency[k]), 2)] if bands is not None else []),
            *([_part(float(law.frequency[k]))] if law is not None else []),
            number(clean(float(all_modes.damping_ratio[k])), 3),
            *([number(float(bands.damping_ratio[k]), 2)] if bands is not None else []),
            *([_part(float(law.damping_ratio[k]))] if law is not None else []),
            share_words(all_modes, int(k)),
        )
        for k in listed
    ]
    error = (*(("±",) if bands is not None else ()), *(("film law",) if law is not None else ()))
    heads = ("mode", "frequency, Hz", *error, "damping ratio", *error, "strain energy")
    remarks = [
        f"{swinging.size - listed.size} more modes up to "
        f"{shown(HERTZ, float(all_modes.frequency[swinging].max(initial=0.0)))} are not listed."
        if swinging.size > listed.size
        else "",
        f"{creeping.size} motions creep back without oscillating." if creeping.size else "",
        f"{free_words(int(free.size))}." if free.size else "",
        f"{len(all_modes.lost)} modes could not be brought to the films of their own frequency and are not listed."
        if all_modes.lost
        else "",
        *(line.strip() + "." for line in (*band_lines(found.model), *film_law_line(found.model, law is not None))),
        *film_lines(found.errors, all_modes.frequency[listed]),
    ]
    return joined(
        table(heads, rows, "Complex modes; the frequency is |eigenvalue|/(2π)", (0, len(heads) - 1))
        if listed.size
        else tag("p", f"No mode oscillates below {shown(HERTZ, highest)}."),
        *(tag("p", remark, class_="says") for remark in remarks if remark),
    )


def _part(value: float) -> str:
    """What the film law leaves out; a dash where that is not known."""
    return number(value, 2) if math.isfinite(value) else "-"
