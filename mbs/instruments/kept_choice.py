"""Numerical settings that were chosen for a scene, kept to be used again.

A choice is kept under all that it follows from: content of the scene and of its files, law, maps by their checksums,
what is looked at, the tolerance, and the code. It stands in the user's folder for caches, which may be removed at any
time. What cannot be read there is chosen again, and where nothing can be written nothing is kept.
"""

from __future__ import annotations

import contextlib
import dataclasses
import enum
import hashlib
import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.outputs import cache_folder, others_may_write, own_folder
from ehdmaps.provenance import code_hash
from mbs.analyses.case import Progress
from mbs.analyses.step_error import StepCheck
from mbs.flexible.carry_out import file_digest
from mbs.instruments.tolerance import Found, Numerics, Tolerated, within
from mbs.scene.choices import Subject
from mbs.settings import CampbellSettings

FOLDER_VARIABLE = "EHDMAPS_CHOICES"
"""Environment variable that names the folder in which choices are kept."""

_DEEPEST = 20


def kept_within(
    subject: Subject,
    tolerance: float,
    run: Callable[[Subject], tuple[Found, StepCheck | None]],
    settings: CampbellSettings | None = None,
    progress: Progress | None = None,
) -> tuple[Tolerated, Found]:
    """Choose step and slices as `within` does, or take what was chosen before for the same question; and make the run.

    Parameters
    ----------
    subject, tolerance, run, settings, progress
        The same as for `mbs.instruments.tolerance.within`.

    Raises
    ------
    InputError, AnalysisError
        As `within` does.
    """
    settings = settings or subject.scene.campbell
    place = _place(subject, tolerance, settings)
    if place is not None and (found := _read(place, subject)) is not None:
        return found, run(found.subject)[0]
    made, result = within(subject, tolerance, run, settings, progress)
    if place is not None:
        _write(place, made)
    return made, result


def choice_key(subject: Subject, tolerance: float, settings: CampbellSettings) -> str:
    """Digest of all that a choice follows from.

    Parameters
    ----------
    subject : Subject
        Scene and law.
    tolerance : float
        Tolerance [dB].
    settings : CampbellSettings
        What is looked at.

    Raises
    ------
    TypeError
        If something has no content that could be told.
    """
    found = hashlib.sha256(f"{code_hash()}\0{tolerance!r}".encode())
    for path in sorted(subject.scene.files):
        found.update(f"\0{file_digest(Path(path))}".encode())
    # How it is called, and where it lies, changes nothing.
    scene = dataclasses.replace(subject.scene, name="", title="", text="", file=None)
    for part in (scene, subject.law, subject.clearance, settings):
        _tell(part, found.update, 0)
    return found.hexdigest()


def _place(subject: Subject, tolerance: float, settings: CampbellSettings) -> Path | None:
    """File of a choice; None where it has none."""
    try:
        key = choice_key(subject, tolerance, settings)
        return cache_folder("choices", FOLDER_VARIABLE, os.environ) / f"{key}.json"
    except (InputError, TypeError, RuntimeError):  # no home folder is a RuntimeError
        return None


def _read(place: Path, subject: Subject) -> Tolerated | None:
    """A choice that was kept; None where there is none that can be read and applied."""
    if others_may_write(place.parent):
        return None
    try:
        found = json.loads(place.read_text(encoding="utf-8"))
        numerics = Numerics(*(found[key] for key in ("step", "slices", "cutoff")))
        lines = (*found["lines"], f"  chosen before, and kept for this scene, law and tolerance: {place}")
        return Tolerated(
            numerics.applied(subject), numerics, lines, bool(found["met"]), float(found["confirmed"]), seconds=0.0
        )
    except (OSError, ValueError, KeyError, TypeError):  # an InputError is a ValueError
        return None


def _write(place: Path, made: Tolerated) -> None:
    """Keep a choice, where it can be written."""
    kept = {**dataclasses.asdict(made.numerics), "met": made.met, "confirmed": made.confirmed, "lines": made.lines}
    with contextlib.suppress(OSError):
        own_folder(place.parent)
        beside = place.with_suffix(f".{os.getpid()}")
        beside.write_text(json.dumps(kept, indent=1), encoding="utf-8")
        beside.replace(place)


def _tell(value: Any, update: Callable[[bytes], None], depth: int) -> None:
    """Tell the content of a value to a digest."""
    if depth > _DEEPEST:
        raise TypeError("kept choice: got values within each other that have no end")
    update(f"\0{type(value).__qualname__}:".encode())
    if value is None or isinstance(value, (bool, int, float, complex, str, enum.Enum, Path, np.generic)):
        update(repr(value).encode())
    elif isinstance(value, np.ndarray):
        update(f"{value.shape}{value.dtype}".encode() + np.ascontiguousarray(value).tobytes())
    elif isinstance(value, EHDMap):
        if schema.CHECKSUM not in value.dataset.attrs:
            raise TypeError("kept choice: got a map without a checksum")
        _tell(value.dataset.attrs[schema.CHECKSUM], update, depth + 1)
    elif isinstance(value, Mapping):
        for key in sorted(value, key=repr):
            _tell(key, update, depth + 1)
            _tell(value[key], update, depth + 1)
    elif isinstance(value, (tuple, list)):
        for entry in value:
            _tell(entry, update, depth + 1)
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        # Not all that it has by now: properties that were asked for are kept beside the fields.
        _tell({entry.name: getattr(value, entry.name) for entry in dataclasses.fields(value)}, update, depth + 1)
    elif hasattr(value, "__dict__") and not callable(value):
        _tell(vars(value), update, depth + 1)
    else:
        raise TypeError(f"kept choice: got {type(value).__name__}, whose content cannot be told")
