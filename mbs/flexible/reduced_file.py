"""Reduced bodies in files: netCDF to keep and to show, npz for other programs. The same bytes for the same body.

netCDF: dimensions coordinate, with_respect_to, frame, freedom, axis; variables mass, stiffness, unit, position,
transform; provenance as attributes. Bodies with a surface for pictures have the dimensions surface_node, triangle and
corner, too, and the variables surface_position, surface_transform (3 digits), and surface_triangle. The variable
left_out, what modes above the cut-off add, is not in older files.

npz: arrays mass (n, n), stiffness (n, n), coordinates (n,), units (n,), frames (f,), positions (f, 3), transforms
(f, 6, n); optional attributes (a, 2) as texts, surface_position (p, 3), surface_transform (p, 3, n), surface_triangle
(t, 3), left_out (n, n).
"""

from __future__ import annotations

import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import variable
from ehdmaps.errors import InputError, Problems, problems_after
from ehdmaps.netcdf_structure import structure_problem
from ehdmaps.outputs import MADE_AS, Kind, root_attributes, written_aside
from mbs.flexible.plan import REDUCED_SUFFIXES, check_reduced, check_reduced_suffix
from mbs.flexible.reduced_body import MOST_COORDINATES, ReducedBody
from mbs.model.body import FREEDOMS, Frame, Skin

SCHEMA_VERSION = 1

MOST_FRAMES = 10_000

_MADE = {MADE_AS: "reduced body"}
_ARRAYS = ("mass", "stiffness", "coordinates", "units", "frames", "positions", "transforms")
_OPTIONAL = "attributes"
_REST = "left_out"
_SKIN = ("surface_position", "surface_transform", "surface_triangle")
_PACKED = {"zlib": True, "complevel": 6, "shuffle": True}
_DIGITS = {"significant_digits": 3, "quantize_mode": "GranularBitRound"}
"""Of displacements of a surface, which are for pictures: a quarter of the bytes."""
_DAMAGED = (
    OSError,
    ValueError,
    EOFError,
    KeyError,
    TypeError,
    AttributeError,
    MemoryError,
    RuntimeError,
    zipfile.BadZipFile,
    zlib.error,
)
"""What the libraries raise for files that are damaged or of another kind."""


def _ours(path: Path) -> bool:
    """Tell whether a file was written by `write_reduced`."""
    if path.suffix != ".npz":
        return root_attributes(path).get(MADE_AS) == _MADE[MADE_AS]
    try:
        return [MADE_AS, _MADE[MADE_AS]] in _npz(path).get(_OPTIONAL, np.empty(0)).tolist()
    except InputError:
        return False


REDUCED = Kind("a body that was reduced by mbs", REDUCED_SUFFIXES, _ours)


def write_reduced(path: Path, reduced: ReducedBody, kind: Kind = REDUCED) -> None:
    """Write a reduced body, by the rule of all files that are written.

    Parameters
    ----------
    path : Path
        .nc or .npz.
    reduced : ReducedBody
        What is written.
    kind : Kind
        What may be replaced by it.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    check_reduced_suffix(path)
    with written_aside(path, kind) as aside:
        if path.suffix == ".npz":
            with aside.open("wb") as file:
                np.savez(file, allow_pickle=False, **_arrays(reduced))
        else:
            encoding: dict[str, dict[str, Any]] = {}
            if reduced.skin is not None:
                encoding = {name: dict(_PACKED) for name in _SKIN}
                encoding["surface_transform"] |= _DIGITS
            _dataset(reduced).to_netcdf(aside, engine="netcdf4", mode="w", encoding=encoding)


def read_reduced(path: Path) -> ReducedBody:
    """Read a reduced body.

    Parameters
    ----------
    path : Path
        .nc or .npz, written by `write_reduced` or laid out as it does.

    Raises
    ------
    InputError
        If it is none.
    """
    check_reduced(path)
    given = _npz(path) if path.suffix == ".npz" else _netcdf(path)
    with problems_after(f"{path}: "):
        return _body(given)


def _arrays(reduced: ReducedBody) -> dict[str, Any]:
    """A body as arrays."""
    frames = reduced.frames.values()
    return {
        "mass": reduced.mass,
        "stiffness": reduced.stiffness,
        "coordinates": np.array(reduced.coordinates),
        "units": np.array(reduced.units),
        "frames": np.array(list(reduced.frames), dtype=np.str_),
        "positions": np.array([frame.position for frame in frames]).reshape(-1, 3),
        "transforms": np.array([frame.transform for frame in frames]).reshape(-1, 6, reduced.size),
        _OPTIONAL: np.array(sorted({**reduced.attributes, **_MADE}.items()), dtype=np.str_).reshape(-1, 2),
        **({} if reduced.skin is None else _skin_arrays(reduced.skin)),
        **({} if reduced.left_out is None else {_REST: reduced.left_out}),
    }


def _skin_arrays(skin: Skin) -> dict[str, Any]:
    """A surface as arrays, for pictures: in single precision."""
    values = (skin.positions.astype(np.float32), skin.transforms.astype(np.float32), skin.triangles.astype(np.int32))
    return dict(zip(_SKIN, values, strict=True))


def _dataset(reduced: ReducedBody) -> xr.Dataset:
    """A body as a labelled dataset."""
    arrays = _arrays(reduced)
    per = "by the units of the coordinates"
    variables: dict[str, Any] = {
        "mass": variable(("coordinate", "with_respect_to"), arrays["mass"], f"kg for m, {per}", "mass matrix"),
        "stiffness": variable(
            ("coordinate", "with_respect_to"), arrays["stiffness"], f"N/m for m, {per}", "stiffness matrix"
        ),
        "unit": variable("coordinate", arrays["units"], "", "unit of the coordinate"),
        "position": variable(
            ("frame", "axis"), arrays["positions"], "m", "place from the origin of the finite-element body"
        ),
        "transform": variable(
            ("frame", "freedom", "coordinate"),
            arrays["transforms"],
            f"m or rad, {per}",
            "displacement of the place by the coordinates",
        ),
    }
    if reduced.skin is not None:
        place, motion, corners = (arrays[name] for name in _SKIN)
        variables |= {
            _SKIN[0]: variable(
                ("surface_node", "axis"), place, "m", "places of the surface from the origin of the finite-element body"
            ),
            _SKIN[1]: variable(
                ("surface_node", "axis", "coordinate"),
                motion,
                f"m, {per}",
                "displacement of the surface by the coordinates",
            ),
            _SKIN[2]: variable(("triangle", "corner"), corners, "", "triangles of the surface, by their nodes"),
        }
    if reduced.left_out is not None:
        words = {
            "units": f"kg s2 for m, {per}",
            "long_name": "what modes above the cut-off add by the fourth power of s",
        }
        variables[_REST] = (("coordinate", "with_respect_to"), reduced.left_out, words)
    coordinates = {
        "coordinate": variable("coordinate", arrays["coordinates"], "", "coordinates of the reduced body"),
        "with_respect_to": variable("with_respect_to", arrays["coordinates"], "", "coordinates of the reduced body"),
        "frame": variable("frame", arrays["frames"], "", "places on the body"),
        "freedom": variable("freedom", list(FREEDOMS), "", "freedoms of a place"),
        "axis": variable("axis", ["x", "y", "z"], "", "axes"),
    }
    return xr.Dataset(
        variables, coords=coordinates, attrs={"schema_version": SCHEMA_VERSION, **reduced.attributes, **_MADE}
    )


def _npz(path: Path) -> dict[str, Any]:
    """Arrays of an npz file."""
    try:
        # Nothing is unpickled: a file from elsewhere must not run code.
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            missing = [name for name in _ARRAYS if name not in file.files]
            if missing:
                raise InputError(
                    f"{path}: got the arrays {', '.join(file.files)!r:.100}; missing: {', '.join(missing)}; allowed: "
                    "those that write_reduced writes"
                )
            return {name: file[name] for name in (*_ARRAYS, _OPTIONAL, *_SKIN, _REST) if name in file.files}
    except _DAMAGED as error:
        raise _unreadable(path, error) from error


def _netcdf(path: Path) -> dict[str, Any]:
    """Arrays of a netCDF file."""
    try:
        damage = structure_problem(path)
        if damage:
            raise OSError(damage)
        with xr.open_dataset(path, engine="netcdf4", decode_times=False) as file:
            dataset = file.load()
    except _DAMAGED as error:
        raise _unreadable(path, error) from error
    version = dataset.attrs.get("schema_version")
    if version != SCHEMA_VERSION:
        raise InputError(f"{path}: got the schema_version {version!r:.40}; allowed: {SCHEMA_VERSION}")
    dims = {
        "mass": ("coordinate", "with_respect_to"),
        "stiffness": ("coordinate", "with_respect_to"),
        "unit": ("coordinate",),
        "position": ("frame", "axis"),
        "transform": ("frame", "freedom", "coordinate"),
        "coordinate": ("coordinate",),
        "frame": ("frame",),
    }
    wrong = [name for name, expected in dims.items() if name not in dataset or dataset[name].dims != expected]
    if wrong:
        raise InputError(
            f"{path}: the variables {', '.join(wrong)} are missing or have other dimensions; allowed: a file written "
            "by mbs reduce"
        )
    plural = {"unit": "units", "position": "positions", "transform": "transforms"}
    plural |= {"coordinate": "coordinates", "frame": "frames"}
    given = {plural.get(name, name): dataset[name].values for name in dims}
    given |= {name: dataset[name].values for name in (*_SKIN, _REST) if name in dataset}
    kept = {key: str(value) for key, value in dataset.attrs.items() if key != "schema_version"}
    return {**given, _OPTIONAL: np.array(sorted(kept.items()), dtype=np.str_).reshape(-1, 2)}


def _body(given: Mapping[str, Any]) -> ReducedBody:
    """A body of arrays that may be of any shape and kind."""
    names = {key: np.asarray(given[key]) for key in ("coordinates", "units", "frames")}
    held = ("mass", "stiffness", "positions", "transforms", *((_REST,) if _REST in given else ()))
    numbers = {key: np.asarray(given[key]) for key in held}
    problems = Problems(
        f"{key}: got {value.ndim} dimensions of {value.dtype}; allowed: a list of at most {MOST_FRAMES} texts"
        for key, value in names.items()
        if value.ndim != 1 or value.size > MOST_FRAMES or not all(isinstance(word, str) for word in value.tolist())
    )
    problems += [
        f"{key}: got {value.dtype}; allowed: real numbers"
        for key, value in numbers.items()
        if value.dtype.kind not in "fiu"
    ]
    if not problems:
        frames, size = names["frames"].size, names["coordinates"].size
        expected = {"positions": (frames, 3), "transforms": (frames, 6, size)}
        problems += [
            f"{key}: got shape {numbers[key].shape}; allowed: {shape}, for {frames} frames and {size} coordinates"
            for key, shape in expected.items()
            if numbers[key].shape != shape
        ]
        if len(set(names["frames"].tolist())) < frames:
            problems.append("frames: a name is there twice; allowed: each once")
        if size > MOST_COORDINATES:
            problems.append(f"coordinates: got {size}; allowed: at most {MOST_COORDINATES}")
    skin = {name: np.asarray(given[name]) for name in _SKIN if name in given}
    problems += [
        f"{name}: got {value.ndim} dimensions of {value.dtype}; allowed: {wanted} dimensions of numbers"
        for (name, value), wanted in zip(skin.items(), (2, 3, 2), strict=False)
        if value.ndim != wanted or value.dtype.kind not in ("iu" if name == _SKIN[2] else "fiu")
    ]
    if skin and len(skin) < len(_SKIN):
        problems.append(f"surface: got {', '.join(skin)}; allowed: {', '.join(_SKIN)}, or none of them")
    texts = np.asarray(given.get(_OPTIONAL, np.zeros((0, 2), dtype=np.str_)))
    if texts.ndim != 2 or texts.shape[1] != 2 or texts.dtype.kind not in "U":
        problems.append(f"attributes: got shape {texts.shape} of {texts.dtype}; allowed: pairs of texts")
    problems.check()
    places = zip(numbers["positions"].astype(np.float64), numbers["transforms"].astype(np.float64), strict=True)
    return ReducedBody(
        mass=numbers["mass"].astype(np.float64),
        stiffness=numbers["stiffness"].astype(np.float64),
        coordinates=tuple(names["coordinates"].tolist()),
        units=tuple(names["units"].tolist()),
        frames={name: Frame(*place) for name, place in zip(names["frames"].tolist(), places, strict=True)},
        attributes={key: text for key, text in texts.tolist() if key not in _MADE},
        skin=_skin(skin) if skin else None,
        left_out=numbers[_REST].astype(np.float64) if _REST in numbers else None,
    )


def _skin(arrays: Mapping[str, Any]) -> Skin:
    """A surface of its arrays."""
    place, motion, corners = (arrays[name] for name in _SKIN)
    return Skin(place.astype(np.float64), motion.astype(np.float64), corners.astype(np.int64))


def _unreadable(path: Path, error: BaseException) -> InputError:
    """The message about a file that is not a reduced body."""
    words = " ".join(str(error).split())
    return InputError(f"{path}: is no reduced body ({words:.100}); allowed: a file written by mbs reduce")
