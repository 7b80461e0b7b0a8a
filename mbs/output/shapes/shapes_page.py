"""Mode shapes as one page of HTML that moves: no network, no other file; turned by the mouse, in WebGL 2.

Places are kept in single precision, displacements as parts of the largest one in 16 bits: 2 pixels of 65 thousand.
"""

from __future__ import annotations

import base64
import html
import json
import re
from collections.abc import Sequence
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ehdmaps.figures import COLOURS
from ehdmaps.outputs import MARK, Kind, has_mark
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


def shapes_page(title: str, words: str, found: Modes, bones: Skeleton, shown: Sequence[int]) -> str:
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
        "modes": [_mode(found, bones, mode) for mode in shown[:MOST_SHAPES]],
    }
    # A name must not end the script.
    text = json.dumps(data, allow_nan=False).replace("<", "\\u003c")
    filled = {"MARK": MARK, "TITLE": html.escape(title), "WORDS": html.escape(words), "DATA": text}
    page = (resources.files(__package__) / "shapes_page.html").read_text(encoding="utf-8")
    return re.sub("@(MARK|TITLE|WORDS|DATA)@", lambda found: filled[found[1]], page)


def _mode(found: Modes, bones: Skeleton, mode: int) -> dict[str, Any]:
    """One mode: what it is called, and both parts of the displacement of all places."""
    moved = bones.scaled(found.shapes[:, mode])
    ratio = float(found.damping_ratio[mode])
    return {
        "name": f"{mode + 1}: {found.frequency[mode]:.5g} Hz, damping ratio {ratio:.2g}",
        "real": _coded(np.round(_FULL * moved.real), "<i2"),
        "imaginary": _coded(np.round(_FULL * moved.imag), "<i2"),
    }


def _coded(values: npt.ArrayLike, kind: str) -> str:
    """Numbers as text."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode("ascii")
