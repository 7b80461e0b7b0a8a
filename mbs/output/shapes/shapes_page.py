"""Mode shapes as a part of a page of HTML that moves: no network, no other file; turned by the mouse, in WebGL 2.

Places are kept in single precision, displacements as parts of the largest one in 16 bits: 2 pixels of 65 thousand.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ehdmaps.figures import COLOURS
from ehdmaps.outputs import Kind, has_mark
from ehdmaps.report.page import Markup, Moving, Section, document, joined, tag
from mbs.linearised.modes import Modes
from mbs.linearised.shapes import AXIS, EDGE, JOINT, Skeleton
from mbs.linearised.shapes import MARK as ACROSS

PAGE = Kind("a page of mode shapes of mbs", (".html", ".htm"), has_mark)

MOST_SHAPES = 60
"""Modes of a page: a housing of 3000 nodes takes 50 kB each."""

_FULL = 32767
_WIDTHS = {AXIS: 5.0, EDGE: 2.0, ACROSS: 3.0, JOINT: 4.0}
"""Of lines [pixels]."""


def is_page(name: str) -> bool:
    """Tell by its ending whether a file is to become a page.

    Parameters
    ----------
    name : str
        Name of the file.
    """
    return Path(name).suffix.lower() in PAGE.endings


def shapes_page(
    title: str, words: str, found: Modes, bones: Skeleton, shown: Sequence[int], names: Mapping[int, str]
) -> str:
    """The page of some modes.

    Parameters
    ----------
    title, words : str
        Heading, and the line below it.
    found : Modes
        All modes.
    bones : Skeleton
        Places, lines and surfaces of the system.
    shown : sequence of int
        Indices of the modes; the first `MOST_SHAPES` are taken.
    names : mapping of int to str
        Names of modes by their indices, as far as they have some.
    """
    view = moving_shapes(found, bones, shown, names)
    return document(title, words, [Section("shapes", "Mode shapes", [view])], (moving(),))


@cache
def moving() -> Moving:
    """Style and script of `moving_shapes`, for `ehdmaps.report.page.document`."""
    style, script = (
        (resources.files(__package__) / f"shapes.{ending}").read_text(encoding="utf-8") for ending in ("css", "js")
    )
    return Moving(style, script)


def moving_shapes(found: Modes, bones: Skeleton, shown: Sequence[int], names: Mapping[int, str]) -> Markup:
    """A view of some modes that moves; of a page that has `moving`, once.

    Parameters
    ----------
    found, bones, shown, names
        The same as of `shapes_page`.
    """
    skinned = set(bones.owners[bones.triangles[:, 0]].tolist())
    red, *others = COLOURS[1], COLOURS[0], *COLOURS[2:]
    colours = [red if kind == JOINT else others[int(bones.owners[begin]) % len(others)]
               for (begin, _), kind in zip(bones.lines, bones.kinds, strict=True)]  # fmt: skip
    named = [
        (name, "surface" if index in skinned else others[index % len(others)])
        for index, name in enumerate(bones.bodies)
        if np.any(bones.owners == index)
    ]
    data = {
        "points": _coded(bones.points, "<f4"),
        "triangles": _coded(bones.triangles, "<u4"),
        "lines": bones.lines.tolist(),
        "colours": colours,
        "widths": [_WIDTHS[kind] for kind in bones.kinds],
        "names": [*named, *([("bearings and gears", red)] if JOINT in bones.kinds else [])],
        "size": bones.size,
        "modes": [_mode(found, bones, mode, names.get(mode, "")) for mode in shown[:MOST_SHAPES]],
    }
    # A name must not end the block.
    text = json.dumps(data, allow_nan=False).replace("<", "\\u003c")
    ranges = [
        tag("label", words, tag("input", type="range", id=f"shapes-{name}", min="0", max=most, value=value))
        for words, name, most, value in (
            ("size", "size", "25", "8"),
            ("speed", "speed", "40", "12"),
            ("surface", "opacity", "100", "70"),
        )
    ]
    return joined(
        tag(
            "div",
            tag("label", "mode", tag("select", id="shapes-mode")),
            *ranges,
            tag("button", "pause", type="button", id="shapes-pause"),
            class_="shapes",
        ),
        tag("p", "Drag to turn, with Shift to move; the wheel zooms. Colours of surfaces: amplitude, up to the largest "
            "of the mode. Displacements are enlarged.", class_="says"),
        tag("canvas", id="shapes-view"),
        tag("div", id="shapes-names"),
        Markup(f'<script type="application/json" id="shapes-data">{text}</script>'),
    )  # fmt: skip


def _mode(found: Modes, bones: Skeleton, mode: int, name: str) -> dict[str, Any]:
    """One mode: what it is called, and both parts of the displacement of all places."""
    moved = bones.scaled(found.shapes[:, mode])
    ratio = float(found.damping_ratio[mode])
    where = f" ({name})" if name else ""
    return {
        "name": f"{mode + 1}: {found.frequency[mode]:.5g} Hz, damping ratio {ratio:.2g}{where}",
        "real": _coded(np.round(_FULL * moved.real), "<i2"),
        "imaginary": _coded(np.round(_FULL * moved.imag), "<i2"),
    }


def _coded(values: npt.ArrayLike, kind: str) -> str:
    """Numbers as text."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode("ascii")
