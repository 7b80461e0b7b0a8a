"""Universal files (UFF): hammer hits and frequency responses, by the library pyuff.

Datasets 58 (time records, function type 1; frequency responses, 4; coherences, 6), 151 (header) and 164 (units).
Values are divided by the factors of dataset 164, by the dimension of what was measured; without it they are taken for
SI. Labels of axes are not read: values in g stay in g, which changes no frequency and no damping.

The decay of an exponential window that responses have been through stands in ID line 4 of those written here.

Hits: a record of the force (data type 13) belongs to the place in its response fields, a record of a response to the
place in its reference fields, and the version number counts the hits; where it does not, their order in the file
does. The step of evenly spaced values has six digits in such a file.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ehdmaps.extras import needs
from ehdmaps.outputs import Kind, has_mark
from mbs.modal.records import Hits, Measured, Responses

UFF = Kind("a universal file of mbs", (".uff", ".unv", ".uf", ".58"), has_mark)

TIME, RESPONSE, COHERENCE = 1, 4, 6
"""Function types of datasets 58 that are read and written."""

KINDS: dict[int, Measured] = {8: "displacement", 9: "force", 11: "velocity", 12: "acceleration", 13: "force"}
"""What was measured, by its type in a file."""

CODES: dict[Measured, int] = {"displacement": 8, "velocity": 11, "acceleration": 12, "force": 13, "unknown": 0}
"""Types that are written."""

WINDOW = "exponential window, decay {} 1/s"
"""ID line 4 of responses that have been through such a window."""

Dataset = dict[str, Any]
"""A dataset as pyuff has it."""


@dataclass(frozen=True, eq=False)
class Measurement:
    """What a universal file holds.

    Attributes
    ----------
    title : str
        Title of the measurement.
    hits : tuple of Hits
        An entry a place hit; none if the file has no time records.
    responses : Responses or None
        If the file has any.
    notes : tuple of str
        What was assumed.
    """

    title: str
    hits: tuple[Hits, ...] = ()
    responses: Responses | None = None
    notes: tuple[str, ...] = ()


def load_pyuff() -> Any:
    """Return pyuff.

    Raises
    ------
    DependencyError
        If it is not installed.
    """
    with needs("modal", "pyuff", "universal files"):
        import pyuff
    return pyuff
