"""Reductions that are kept: what was reduced once is not reduced again while files, plan and code are the same.

A reduction is known by its content: a hash of the bytes of all files, of what is planned, and of the code that carries
it out. It is kept in the memory of the process, and as a file in the folder of `kept_folder`. That folder may be
removed at any time. What cannot be read there is made again, and where nothing can be written nothing is kept.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections.abc import Mapping
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.inputs import check_input
from ehdmaps.outputs import Kind, cache_folder
from ehdmaps.provenance import code_hash
from mbs.flexible.carry_out import carry_out
from mbs.flexible.number_table import LONGEST_FILE
from mbs.flexible.plan import ReductionPlan
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.reduced_file import read_reduced, write_reduced

FOLDER_VARIABLE = "EHDMAPS_REDUCED"
"""Environment variable that names another folder."""

MOST_IN_MEMORY = 16
"""Bodies; each takes some megabytes at most."""

_KEPT = Kind("a reduction that mbs keeps", (".npz",), lambda path: True)
"""All that stands in our own folder is ours, whatever became of it."""

_memory: dict[str, ReducedBody] = {}


def reduced_body(plan: ReductionPlan) -> ReducedBody:
    """Return the reduced body of a plan, kept from before or reduced now.

    Raises
    ------
    InputError
        For files that do not read or do not fit together, and interfaces that are not on the body.
    AnalysisError
        If the modes or static shapes are not found.
    """
    key = plan_key(plan)
    body = _memory.get(key) or _from_disk(key)
    if body is None:
        body = carry_out(plan)
        if plan_key(plan) != key:  # a file was changed meanwhile: nobody knows what was read
            return body
        _to_disk(key, body)
    _memory[key] = body
    while len(_memory) > MOST_IN_MEMORY:
        del _memory[next(iter(_memory))]
    return body


def plan_key(plan: ReductionPlan) -> str:
    """Hash of all that a reduction depends on: content of the files, plan and code; in hexadecimal digits.

    Raises
    ------
    InputError
        If a file cannot be read.
    """
    found = hashlib.sha256(code_hash().encode())
    for name in ("stiffness", "mass", "dofs", "mesh"):
        path = getattr(plan, name)
        found.update(f"\0{name}:{file_digest(path) if path is not None else ''}".encode())
    # The ending of a mesh says its format, and its name stands in the result.
    said = (
        plan.form,
        plan.units,
        plan.cutoff,
        plan.mesh.name,
        list(plan.interfaces.items()),
        list(plan.points.items()),
    )
    found.update(repr(said).encode())
    return found.hexdigest()


def file_digest(path: Path) -> str:
    """Hash of the content of a file.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    check_input(path, LONGEST_FILE, "a file of the body", "take a coarser mesh")
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        cause = error.strerror or str(error)
        raise InputError(f"{path}: cannot be read ({cause}); allowed: a file of the body") from error


def kept_folder(environment: Mapping[str, str]) -> Path:
    """Return where reductions are kept: $EHDMAPS_REDUCED, or in the user's folder for caches."""
    return cache_folder("reduced", FOLDER_VARIABLE, environment)


def _from_disk(key: str) -> ReducedBody | None:
    """Read what was kept; None where there is nothing, or nothing that can be read."""
    try:
        return read_reduced(kept_folder(os.environ) / f"{key}.npz")
    except (InputError, RuntimeError):  # no home folder is a RuntimeError
        return None


def _to_disk(key: str, body: ReducedBody) -> None:
    """Keep a reduction, where it can be written."""
    with contextlib.suppress(InputError, OSError, RuntimeError):
        folder = kept_folder(os.environ)
        folder.mkdir(parents=True, exist_ok=True)
        write_reduced(folder / f"{key}.npz", body, _KEPT)
