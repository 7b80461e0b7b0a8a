"""Files of MATLAB version 5: texts that MATLAB and Octave both read, our mark in the header, one writer.

The file holds one struct `map`: the axes `load`, `entrainment_speed` and `temperature` as columns, one struct a contact
with its fields as arrays of load x speed x temperature, `law` with the contact law resampled for linear interpolation
(see `ehdmaps.exports.resampled`), `units`, `meaning`, `provenance` and `header`.
"""

from __future__ import annotations

import argparse
import io
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.errors import InputError, MapError
from ehdmaps.exports.resampled import QUANTITIES, Grid, Resampled, differences, resampled, struct
from ehdmaps.exports.target import Target, origin
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.schema import DIMS
from ehdmaps.outputs import MARK, Kind, Output, check_outputs, has_mark, written_aside
from ehdmaps.program import plain
from ehdmaps.version import version

KIND = Kind("a MATLAB file of ehdmaps", (".mat",), has_mark)

_TEXT = 116
"""Bytes of text at the beginning of a MATLAB v5 file (MAT-File Format, MathWorks, "Level 5 MAT-File Header")."""


def ascii_text(text: str) -> str:
    """Return a text without control characters and with escapes beyond ASCII, of which Octave loses some.

    Parameters
    ----------
    text : str
        Any text, such as a name in a scene.
    """
    return plain(text).encode("ascii", "backslashreplace").decode("ascii")


def write_matlab(path: Path, variables: Mapping[str, Any], advice: str) -> None:
    """Write variables as a file of MATLAB version 5 that carries our mark.

    Parameters
    ----------
    path : Path
        The file; look at it with `check_outputs` and `KIND` first.
    variables : mapping of str to object
        What `scipy.io.savemat` takes: dictionaries are structs, arrays of object are cells.
    advice : str
        What to do where they cannot be written.

    Raises
    ------
    InputError
        If they cannot be written, or something else stands there.
    """
    from scipy.io import savemat

    buffer = io.BytesIO()
    try:
        savemat(buffer, dict(variables), long_field_names=True, do_compression=True, oned_as="column")
    except (ValueError, UnicodeError) as error:
        raise InputError(f"{path}: cannot be written as a MATLAB file ({error}); {advice}") from error
    title = f"MATLAB 5.0 MAT-file, {MARK} {version()}".encode("ascii", "replace")
    with written_aside(path, KIND) as aside:
        aside.write_bytes(title.ljust(_TEXT)[:_TEXT] + buffer.getvalue()[_TEXT:])


_FIELD = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,62}")
"""Names that a field of a struct may have in MATLAB; others are left out."""

_NOTES = (
    "arrays: load x entrainment_speed x temperature; MATLAB drops a last axis of one point",
    "signs: approach is positive together, forces press the bodies together; per unit length of contact",
    "between points: linear in log(load), log(speed) and temperature is much coarser than the law of ehdmaps, which "
    "law holds for linear interpolation, where it is there: see law.reading; a speed of 0 has no logarithm",
    "beyond the axes nothing is known: interpn and interp2 give NaN there, as long as no extrapolation is asked for",
    "status: see meaning.status; where filled is 1, values are interpolated from neighbours",
)


FEWEST, NODES, MOST = 20, 160, 400
"""Nodes of the resampled law along the approach: the fewest, those if none are asked for (4 MB), the most (62 MB)."""


def contents(emap: EHDMap, name: str) -> dict[str, Any]:
    """Return the struct `map` without `law` as nested dictionaries.

    Parameters
    ----------
    emap : EHDMap
        The map.
    name : str
        Name of its file, for the header.

    Returns
    -------
    dict
        Axes, contacts, units, meaning, provenance and header; SI units.
    """
    dataset = emap.dataset
    fields = [
        str(field) for field, array in dataset.data_vars.items() if array.dims == DIMS and array.dtype.kind in "fiu"
    ]
    described = [*DIMS[1:], *fields]
    content: dict[str, Any] = {axis: dataset[axis].values.astype(float)[:, None] for axis in DIMS[1:]}
    for contact in emap.contacts:
        points = dataset.sel(contact=contact.name)
        content[contact.name] = {field: points[field].values.astype(float) for field in fields}
    content["units"] = {field: plain(dataset[field].attrs["units"]) for field in described}
    content["meaning"] = {field: _meaning(dataset[field].attrs) for field in described}
    attributes = {str(key): value for key, value in dataset.attrs.items() if _FIELD.fullmatch(str(key))}
    content["provenance"] = {
        key: ascii_text(value) if isinstance(value, str) else np.asarray(value, dtype=float)
        for key, value in attributes.items()
    }
    lines = [*origin(emap, name), *_NOTES]
    content["header"] = np.array([ascii_text(line) for line in lines], dtype=object)[:, None]
    return content


def _meaning(attributes: dict[str, Any]) -> str:
    """Return the words for a quantity, with those of its codes."""
    words = plain(attributes["long_name"])
    if "flag_meanings" not in attributes:
        return words
    codes = zip(np.ravel(attributes["flag_values"]), str(attributes["flag_meanings"]).split(), strict=True)
    return f"{words}: {', '.join(f'{code} {plain(meaning)}' for code, meaning in codes)}"


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add how fine the law is resampled."""
    parser.add_argument(
        "--resample",
        metavar="N",
        type=int,
        default=NODES,
        help=f"nodes of the resampled law along the approach, {FEWEST} to {MOST}, with N/5 speeds and temperatures; 0: "
        f"points alone; default: {NODES}",
    )


def _write(emap: EHDMap, path: Path, output: Path | None, arguments: argparse.Namespace) -> str:
    """Write the file; by default beside the map."""
    output = output or path.with_suffix(".mat")
    count: int = arguments.resample
    if count and not FEWEST <= count <= MOST:
        raise InputError(f"--resample: got {count}; allowed: 0, or {FEWEST} to {MOST}")
    check_outputs([Output("-o", output, KIND)], [path])
    content, words = contents(emap, path.name), ""
    if count:
        law, words = _law(emap, count)
        content |= law
    write_matlab(output, {"map": content}, "export it as csv")
    return f"{output}: written{words}"


def _law(emap: EHDMap, count: int) -> tuple[dict[str, Any], str]:
    """Return the field `law` with what is said of it; nothing where the map makes none, and why."""
    try:
        law = emap.law("series" if emap.bearing is not None else "line")
        if not law.speed_range[1] > 0.0:
            raise MapError("a map of standstill alone")
    except MapError as error:
        return {}, f"\nwarning: without a resampled law: {error}"
    table = resampled(law, Grid.of(count), Resampled)
    apart = differences(table, law)
    return {"law": struct(table, apart)}, _law_words(table, [float(apart[name][-1]) for name in QUANTITIES])


def _law_words(table: Resampled, largest: list[float]) -> str:
    """Return how large the resampled law is, and how exact."""
    size = " x ".join(map(str, table.shape))
    parts = ", ".join(f"{100.0 * part:.2g} % of the {name}" for part, name in zip(largest, QUANTITIES, strict=True))
    return (
        f"\nlaw: {table.kind}, {size} over approach, speed, temperature; by linear interpolation at 2000 places within "
        f"{parts}"
    )


TARGET = Target(
    summary="points of the map, and its law for linear interpolation, as a struct for MATLAB and Octave",
    writes="MAP.mat",
    read_back_by="Octave",
    add_arguments=_add_arguments,
    write=_write,
)
