"""The report of a scene as one document."""

from __future__ import annotations

from collections.abc import Sequence

import xarray as xr

from ehdmaps.figures import typeset
from ehdmaps.jobs.show.budget_chart import budget_section
from ehdmaps.jobs.show.map_report import job, provenance, written_by
from ehdmaps.program import plain
from ehdmaps.report.page import Markup, Section, document, joined, pairs, sentences, tag
from ehdmaps.units import RPM
from mbs.linearised.mode_names import mode_names
from mbs.model.findings import warned
from mbs.output.result_text import kinds
from mbs.output.shapes.shapes_page import moving, moving_shapes
from mbs.report.bearings import bearings
from mbs.report.campbell import campbell, lines_of, mode_table, named_orders, saved_campbell
from mbs.report.examination import Examination, highest_of
from mbs.report.located import located_bearings
from mbs.report.machine import in_short, machine, map_sections, notes, used_maps, warnings
from mbs.report.safety import safety
from mbs.report.sketch import sketch
from mbs.report.solid import dressed
from mbs.report.speeds import critical_table, unbalance_parts
from mbs.report.transfer import transfer


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
    names, limiting = _mode_names(found), _limits(warning_lines, [*notes(found), *remarks])
    sections = [
        Section(
            "summary",
            "In short",
            [
                sentences(map(typeset, in_short(found))),
                *(tag("p", typeset(f"Warning: {line}"), class_="warning") for line in warning_lines),
            ],
        ),
        Section("machine", "What was assumed?", [sketch(found.model), machine(found)]),
    ]
    if carried := safety(found):
        details = [carried, *bearings(found), *located_bearings(found)]
        sections.append(Section("bearings", "Where is the equilibrium, and do the bearings carry it?", details))
    sections += [
        Section("critical", "Where are critical speeds, and how far from operation?", [_critical(found)]),
        Section("unbalance", "What do unbalances do?", [_unbalance(found)]),
        Section("transfer", "What reaches the sensors, dry beside films?", _transfer(found, names)),
        Section("campbell-diagram", "Campbell diagram: which orders meet which modes?", [_campbell(found, saved)]),
        Section("modes", f"Which modes are there at {RPM.text(scene.speed)}, and where is their energy?",
                [_modes(found, names), *_moving(found, names)]),
        Section("limits", "What is not known, and what would it change?", [limiting]),
        *([budget_section(found.budget)] if found.budget else []),
    ]  # fmt: skip
    for index, one in enumerate(used):
        sections += map_sections(one, f"map-{index}", len(used) > 1)
    if not used:
        words = f"The law is that of {found.model.law}: no map stands behind it, and there are no curves of one."
        sections.append(Section("law", "Contact law", [tag("p", words)]))
    sections.append(Section("provenance", "Provenance", [_provenance(found, command, maps)]))
    lead = f"{RPM.text(scene.speed)}; law {found.model.law}."
    return document(scene.title, typeset(lead), sections, (moving(),))


def _mode_names(found: Examination) -> dict[int, str]:
    """Names of the oscillating modes."""
    if isinstance(found.modes, str):
        return {}
    return mode_names(found.modes.balance, found.modes.modes, kinds(found.modes.modes)[2])


def _none(words: str, reason: str) -> Markup:
    """A sentence that there is no answer."""
    return tag("p", f"{words}: {reason}" if reason else f"{words}.", class_="warning" if reason else None)


def _critical(found: Examination) -> Markup:
    """The critical speeds, or why there are none."""
    if isinstance(found.speeds, str):
        return _none("Speeds were not looked at", found.speeds)
    if found.speeds.critical is None:
        return tag("p", "No body spins: no speed is critical.")
    return critical_table(found.speeds.critical, found.speeds.critical_names, found.banded)


def _unbalance(found: Examination) -> Markup:
    """Response to loads that turn, or why that is not known."""
    if isinstance(found.speeds, str):
        return _none("Speeds were not looked at", found.speeds)
    if found.speeds.critical is None:
        return tag("p", "No body spins.")
    return unbalance_parts(found.speeds.critical, found.banded)


def _transfer(found: Examination, names: dict[int, str]) -> list[Markup]:
    """Transfer paths, or why there are none."""
    if isinstance(found.transfer, str):
        return [_none("There are no transfer paths", found.transfer)]
    first = found.transfer[0]
    own = mode_names(first.balance, first.modes, kinds(first.modes)[2])
    return list(transfer(found.transfer, own or names))


def _modes(examination: Examination, names: dict[int, str]) -> Markup:
    """The modes, or why there are none."""
    if isinstance(examination.modes, str):
        return tag("p", f"There are no modes: {examination.modes}", class_="warning")
    return mode_table(examination.modes, highest_of(examination.model.scene), examination.banded, names)


_LARGEST, _PER_PLACE = 1_000_000, 16
"""Bytes that shapes that move may take of a report, and those of a place and mode."""

_MOST_MOVING = 24
"""Modes that move."""


def _moving(examination: Examination, names: dict[int, str]) -> list[Markup]:
    """Shapes of the modes that move, as far as there is room for them."""
    if isinstance(examination.modes, str):
        return []
    found, bones = examination.modes.modes, dressed(examination.modes.model)
    listed = [k for k in names if found.frequency[k] <= highest_of(examination.model.scene)]
    room = _LARGEST // (_PER_PLACE * max(len(bones.points), 1))
    shown = listed[: min(room, _MOST_MOVING)]
    if not shown:
        return [tag("p", "Mode shapes that move: mbs modes --shapes modes.html")] if listed else []
    return [tag("h3", "Shapes that move"), moving_shapes(found, bones, shown, names)]


def _campbell(examination: Examination, saved: tuple[str, xr.Dataset] | None) -> Markup:
    """The diagram, or why there is none."""
    model = examination.model
    given = model.scene.campbell.orders
    orders = [(order, f"{order:g}") for order in given] if given else named_orders(model)
    if saved is not None:
        name, dataset = saved
        return saved_campbell(dataset, orders, highest_of(examination.model.scene), name)
    if isinstance(examination.speeds, str):
        return tag("p", f"There is no Campbell diagram: {examination.speeds}", class_="warning")
    lines = lines_of(examination.speeds.sweep, examination.speeds.names)
    return campbell(lines, orders, highest_of(examination.model.scene), model.scene.speed)


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
