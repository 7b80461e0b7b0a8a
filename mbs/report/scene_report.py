"""The report of a scene as one document."""

from __future__ import annotations

import math
from collections.abc import Sequence

import xarray as xr

from ehdmaps.figures import typeset
from ehdmaps.jobs.show.budget_chart import budget_section
from ehdmaps.jobs.show.map_report import job, provenance, written_by
from ehdmaps.program import plain
from ehdmaps.report.page import Markup, Section, document, joined, pairs, sentences, tag
from ehdmaps.units import RPM
from mbs.analyses.sensors import excited_orders
from mbs.model.findings import warned
from mbs.report.bearings import bearings
from mbs.report.campbell import campbell, lines_of, mode_table, saved_campbell
from mbs.report.examination import Examination, highest_of
from mbs.report.located import located_bearings
from mbs.report.machine import in_short, machine, map_sections, notes, used_maps, warnings


def scene_report(
    found: Examination,
    command: str,
    maps: Sequence[str],
    saved: tuple[str, xr.Dataset] | None = None,
    remarks: Sequence[str] = (),
) -> str:
    """Return the document.

    Parameters
    ----------
    found : Examination
        What was found.
    command : str
        Command line that asks for it.
    maps : sequence of str
        Names of the files of the maps, in their order.
    saved : (str, xarray.Dataset) or None
        A result for the Campbell diagram and the name of its file, in place of the sweep.
    remarks : sequence of str
        Notes besides, such as how maps were made.
    """
    scene = found.model.scene
    used = list(used_maps(found))
    warning_lines = [*warned(found.findings), *warnings(found)]
    sections = [
        Section(
            "summary",
            "In short",
            [
                sentences(map(typeset, in_short(found))),
                *(tag("p", typeset(f"Warning: {line}"), class_="warning") for line in warning_lines),
            ],
        ),
        Section("machine", "Machine, law and oil", [machine(found)]),
    ]
    if found.model.bearings:
        sections.append(Section("bearings", "Bearings in operation", list(bearings(found))))
    if locating := list(located_bearings(found)):
        sections.append(Section("locating", "Bearings with axial load in operation", locating))
    for index, one in enumerate(used):
        sections += map_sections(one, f"map-{index}", len(used) > 1)
    if not used:
        words = f"The law is that of {found.model.law}: no map stands behind it, and there are no curves of one."
        sections.append(Section("law", "Contact law", [tag("p", words)]))
    sections += [
        Section("modes", f"Modes at {RPM.text(scene.speed)}", [_modes(found)]),
        Section("campbell-diagram", "Campbell diagram", [_campbell(found, saved)]),
        *([budget_section(found.budget)] if found.budget else []),
        Section("limits", "What limits these numbers", [_limits(warning_lines, [*notes(found), *remarks])]),
        Section("provenance", "Provenance", [_provenance(found, command, maps)]),
    ]
    lead = f"{RPM.text(scene.speed)}; law {found.model.law}."
    return document(scene.title, typeset(lead), sections)


def _modes(examination: Examination) -> Markup:
    """The modes, or why there are none."""
    if isinstance(examination.modes, str):
        return tag("p", f"There are no modes: {examination.modes}", class_="warning")
    return mode_table(examination.modes, highest_of(examination.model.scene), examination.banded)


def _campbell(examination: Examination, saved: tuple[str, xr.Dataset] | None) -> Markup:
    """The diagram, or why there is none."""
    model = examination.model
    given = model.scene.campbell.orders
    # modes of a linear system, not of a run: no order is too slow for it
    excited = {1.0: "1", **dict(excited_orders(model, math.inf))}
    orders = [(order, f"{order:g}") for order in given] if given else sorted(excited.items())
    if saved is not None:
        name, dataset = saved
        return saved_campbell(dataset, orders, highest_of(examination.model.scene), name)
    if isinstance(examination.sweep, str):
        return tag("p", f"There is no Campbell diagram: {examination.sweep}", class_="warning")
    return campbell(
        lines_of(examination.sweep.sweeps[0]), orders, highest_of(examination.model.scene), model.scene.speed
    )


def _limits(warning_lines: Sequence[str], note_lines: Sequence[str]) -> Markup:
    """Warnings and notes."""
    if not warning_lines and not note_lines:
        return tag("p", "Nothing is to be warned of.")
    return joined(
        *(tag("p", typeset(line), class_="warning") for line in warning_lines),
        sentences(map(typeset, note_lines)) if note_lines else None,
    )


def _provenance(examination: Examination, command: str, maps: Sequence[str]) -> Markup:
    """Scene, maps, program and command."""
    scene = examination.model.scene
    used = list(used_maps(examination))
    names = maps if len(maps) == len(used) else [plain(one.emap.dataset.attrs.get("job_name", "")) for one in used]
    return joined(
        pairs([("scene", scene.file.name if scene.file else scene.name)]),
        tag("details", tag("summary", "The scene, as it was"), tag("pre", scene.text)) if scene.text else None,
        *(
            joined(tag("h3", f"Map {name}"), provenance(one.emap, name), job(one.emap, f"map-{index}"))
            for index, (one, name) in enumerate(zip(used, names, strict=True))
        ),
        written_by(command),
    )
