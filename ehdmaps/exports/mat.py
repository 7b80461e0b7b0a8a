"""Target `mat` of `ehdmaps export`: the points of a map as a MATLAB v5 file, which MATLAB and Octave `load`.

The file holds one struct `map`: the axes `load`, `entrainment_speed` and `temperature` as columns, one struct a contact
with its fields as arrays of load x speed x temperature, `units`, `meaning`, `provenance` and `header`.
"""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.exports.header import origin
from ehdmaps.exports.matlab_file import KIND, ascii_text, write_matlab
from ehdmaps.exports.target import Target
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.schema import DIMS
from ehdmaps.outputs import Output, check_outputs
from ehdmaps.program import plain

_FIELD = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,62}")
"""Names that a field of a struct may have in MATLAB; others are left out."""

_NOTES = (
    "arrays: load x entrainment_speed x temperature; MATLAB drops a last axis of one point",
    "signs: approach is positive together, forces press the bodies together; per unit length of contact",
    "between points: linear in log(load), log(speed) and temperature is much coarser than the law of ehdmaps; "
    "a speed of 0 has no logarithm",
    "beyond the axes nothing is known: interpn and interp2 give NaN there, as long as no extrapolation is asked for",
    "status: see meaning.status; where filled is 1, values are interpolated from neighbours",
)


def contents(emap: EHDMap, name: str) -> dict[str, Any]:
    """Return the struct `map` as nested dictionaries.

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
    found: dict[str, Any] = {axis: dataset[axis].values.astype(float)[:, None] for axis in DIMS[1:]}
    for contact in emap.contacts:
        points = dataset.sel(contact=contact.name)
        found[contact.name] = {field: points[field].values.astype(float) for field in fields}
    found["units"] = {field: plain(dataset[field].attrs["units"]) for field in described}
    found["meaning"] = {field: _meaning(dataset[field].attrs) for field in described}
    attributes = {str(key): value for key, value in dataset.attrs.items() if _FIELD.fullmatch(str(key))}
    found["provenance"] = {key: _value(value) for key, value in attributes.items()}
    lines = [*origin(emap, name), *_NOTES]
    found["header"] = np.array([ascii_text(line) for line in lines], dtype=object)[:, None]
    return found


def _meaning(attributes: dict[str, Any]) -> str:
    """Return the words for a quantity, with those of its codes."""
    words = plain(attributes["long_name"])
    if "flag_meanings" not in attributes:
        return words
    codes = zip(np.ravel(attributes["flag_values"]), str(attributes["flag_meanings"]).split(), strict=True)
    return f"{words}: {', '.join(f'{code} {plain(meaning)}' for code, meaning in codes)}"


def _value(value: Any) -> Any:
    """Return an attribute as a text, or as the number that it is."""
    return ascii_text(value) if isinstance(value, str) else np.asarray(value, dtype=float)


def _write(emap: EHDMap, path: Path, output: Path | None, arguments: argparse.Namespace) -> str:
    """Write the file; by default beside the map."""
    output = output or path.with_suffix(".mat")
    check_outputs([Output("-o", output, KIND)], [path])
    write_matlab(output, {"map": contents(emap, path.name)}, "export it as csv")
    return f"{output}: written"


TARGET = Target(
    summary="points of the map as a struct for MATLAB and Octave",
    writes="MAP.mat",
    read_back_by="Octave",
    add_arguments=lambda parser: None,
    write=_write,
)
