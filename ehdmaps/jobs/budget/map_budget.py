"""Error budget of a map at few random points, for its report: films of the film table, rules, some fresh solves."""

from __future__ import annotations

from typing import get_args

from ehdmaps.errors import EhdmapsError
from ehdmaps.jobs.budget.entries import quick, sources
from ehdmaps.jobs.budget.measured import JUDGED, SHOWN, drawn, measured, sample_words
from ehdmaps.jobs.reader import parse_job
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.law import ContactLaw, LawKind
from ehdmaps.physics.oil_supply import FLOODED
from ehdmaps.physics.surface import SMOOTH
from ehdmaps.program import plain
from ehdmaps.trade.record import Trade

POINTS, SEED = 12, 1
"""Size of the sample, and its seed."""


def map_budget(emap: EHDMap) -> Trade | str:
    """Measure sources of error at some points of a map; or say why that cannot be.

    Parameters
    ----------
    emap : EHDMap
        The map.
    """
    try:
        name = plain(emap.dataset.attrs.get("job_name", "map"))
        job = parse_job(str(emap.dataset.attrs["job_toml"]), name, "job of the map", emap.dataset.attrs.get("solver"))
        questions, entries = drawn(job, POINTS, SEED), quick(job, _laws(emap))
        found = measured(entries, questions)
    except EhdmapsError as error:
        return str(error)
    sample = f"{sample_words(job, len(questions), SEED)}; ehdmaps tradeoff takes more points, and finer solutions."
    return Trade(
        level="contact",
        title=f"Error budget of {job.title}",
        cost="s a point",
        reference="what is known cheaply",
        judged=JUDGED,
        choices=found.choices,
        frame=(f"Against what is known cheaply. {sample}",),
        sources=sources(entries),
        shown=SHOWN,
    )


def _laws(emap: EHDMap) -> dict[str, ContactLaw]:
    """Flooded, smooth laws of the contacts of a map; none where none can be made."""
    try:
        return {
            kind: emap.law(kind, outside="asymptote", supply=FLOODED, surface=SMOOTH)
            for kind in get_args(LawKind)
            if kind in {contact.name for contact in emap.contacts}
        }
    except EhdmapsError:
        return {}
