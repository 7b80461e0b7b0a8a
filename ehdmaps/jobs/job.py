"""What a job file asks for, as a frozen value in SI."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant

MOST_POINTS = 2_000_000
"""Points of one map: a week of the default solver, and 300 MB. More is a slip in the job file."""

MOST_CHECKS = 100_000
"""Random points for the check of the contact laws."""


@dataclass(frozen=True)
class Job:
    """One map to be made.

    Attributes
    ----------
    name : str
        Name for titles and for the default output file ("nu308").
    text : str
        Exact text of the job file.
    bearing : BearingGeometry or None
        None for a bare [contact].
    contacts : tuple of LineContact
        In the order of the contact axis.
    lubricant : Lubricant
        The oil.
    loads : tuple of float
        Loads per unit length [N/m], rising.
    entrainment_speeds : tuple of float
        [m/s], rising.
    temperatures : tuple of float
        [K], rising.
    solver : str
        Name of the solver.
    solver_options : mapping
        The solver's own keys, those that the file gives.
    fill : str
        "neighbours" or "none".
    backbone : str
        "law": solve the lines that a contact law needs, where the solver is made for it; "none": leave them out.
    law_check : int
        Random points at which the contact laws are compared with fresh solves.
    """

    name: str
    text: str
    bearing: BearingGeometry | None
    contacts: tuple[LineContact, ...]
    lubricant: Lubricant
    loads: tuple[float, ...]
    entrainment_speeds: tuple[float, ...]
    temperatures: tuple[float, ...]
    solver: str
    solver_options: Mapping[str, Any]
    fill: str = "neighbours"
    backbone: str = "law"
    law_check: int = 0

    @property
    def sha256(self) -> str:
        """Hash of the job file's text."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    @property
    def points(self) -> int:
        """Number of points of the map."""
        return math.prod(self.shape)

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Lengths of the axes contact, load, entrainment speed, temperature."""
        return (len(self.contacts), len(self.loads), len(self.entrainment_speeds), len(self.temperatures))

    @property
    def title(self) -> str:
        """What the contacts belong to, in words."""
        if self.bearing is None:
            return f"line contact R = {self.contacts[0].radius * 1e3:.4g} mm"
        return self.bearing.title


def record_json(record: object) -> str:
    """Write a record of plain values or a dataclass as JSON, the same text for the same values.

    Infinity, which JSON does not know, becomes the word "inf".
    """
    if dataclasses.is_dataclass(record) and not isinstance(record, type):
        record = dataclasses.asdict(record)
    return json.dumps(_plain(record), sort_keys=True, allow_nan=False, ensure_ascii=False)


def _plain(value: object) -> object:
    """Return a value with every float finite or a word."""
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value
