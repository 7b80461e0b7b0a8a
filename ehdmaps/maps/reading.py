"""A map file as datasets: whether it is a map, whether it was changed, and nothing read before its declared shape.

Attributes, axes and variables are held to the table of `schema`, and what is derived to the films that it comes from.

Only what the table of a version names is read. The shape that a file declares is checked before anything is loaded, so
that a damaged or foreign file costs neither memory nor time; values are checked when they are there. Read with netCDF4
itself: xarray would load every axis of a file and decode every variable, foreign ones too, before anybody could look at
their sizes.

A checksum of what a map holds tells values that were changed after the map was made. It is over names, dims, shapes and
values of all variables of the table of the map's version, of the grid and of the backbone, and over the attributes that
laws are made from. Not over the way they are stored: compression, chunks and the form of texts may change. Nor over
what the clock says: maps that are equal in all physics have one sum.

Laws know more than the points of a map where its films are those of the film table, or where it has refinement lines.
Who changes the points and deletes the checksum has points of his own, of which neither knows anything: laws then read
these points. `own_points` tells, see there.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ehdmaps.errors import EhdmapsError, MapError
from ehdmaps.maps import schema
from ehdmaps.maps.records import contacts_of, contradictions, lubricant_from_json, read_json
from ehdmaps.maps.schema import Variable
from ehdmaps.netcdf_structure import DAMAGE, opened
from ehdmaps.physics.designations.families import words_for_lines
from ehdmaps.physics.heat import INLET_HEAT

if TYPE_CHECKING:
    import xarray as xr

_AGAIN = "generate the map again"
_WHOLE, _REAL, _TEXT = "iu", "iuf", "OSUT"
"""Kinds of numpy types that may stand for whole numbers, for numbers and for texts."""

_MULTILINE = ("job_toml",)
"""Attributes that hold lines; the others are printed, so that they hold no control characters."""


def validate(dataset: xr.Dataset, where: str = "map", backbone: xr.Dataset | None = None) -> None:
    """Hold a dataset to the table, and what is derived to its films.

    Parameters
    ----------
    dataset : xarray.Dataset
        A map.
    where : str
        File name, for the message.
    backbone : xarray.Dataset, optional
        Group of its refinement lines.

    Raises
    ------
    MapError
        With every problem found, one a line.
    """
    check_tables(dataset, where, backbone)
    refuse(contradictions(dataset, contacts_of(dataset)), where)


def check_tables(dataset: xr.Dataset, where: str = "map", backbone: xr.Dataset | None = None) -> None:
    """Hold a dataset to the table of its version; arguments as of `validate`.

    Raises
    ------
    MapError
        With every problem found, one a line.
    """
    refuse(version_problems(dataset.attrs), where)
    version = schema.version_of(dataset)
    problems = [*attribute_problems(dataset.attrs), *_grid_problems(dataset, version)]
    if backbone is not None:
        problems += [f"group {schema.BACKBONE}: {problem}" for problem in _backbone_problems(backbone, version)]
    refuse(problems, where)


def refuse(problems: Iterable[str], where: str) -> None:
    """Raise the problems, if there are any."""
    lines = [f"{where}: {problem}" for problem in problems]
    if lines:
        raise MapError("\n".join(lines))


def version_problems(attributes: Mapping[str, Any]) -> Iterator[str]:
    """Yield why the attributes are not those of a map of this version."""
    version = attributes.get("schema_version")
    if version is None:
        yield "has no attribute schema_version; expected a map written by `ehdmaps generate`"
    elif not isinstance(version, (int, np.integer)):
        yield f"attribute schema_version is {version!r:.60}, no whole number; {_AGAIN}"
    elif not 1 <= version <= schema.SCHEMA_VERSION:
        newer = "it was made by a newer one: update ehdmaps, or " if version > schema.SCHEMA_VERSION else ""
        yield f"schema_version is {version}; this ehdmaps reads 1 to {schema.SCHEMA_VERSION}; {newer}{_AGAIN}"


def attribute_problems(attributes: Mapping[str, Any]) -> Iterator[str]:
    """Yield which attributes are missing, or of a type that they do not have in a map."""
    for name in schema.ATTRIBUTES:
        if name not in attributes:
            yield f"attribute {name} is missing; {_AGAIN}"
    for name, value in attributes.items():
        if name not in (*schema.ATTRIBUTES, *schema.NUMBERS, *schema.TEXTS) and not name.startswith("law_"):
            continue
        number = isinstance(value, (int, float, np.integer, np.floating)) and math.isfinite(value)
        if name in schema.NUMBERS or name.endswith("_within_bar"):
            if not number:
                yield f"attribute {name} is {value!r:.60}; expected a finite number; {_AGAIN}"
        elif name == "schema_version" or (number and name not in schema.ATTRIBUTES):
            continue
        elif not isinstance(value, str):
            yield f"attribute {name} is {value!r:.60}; expected a text; {_AGAIN}"
        elif name not in _MULTILINE and not all(c.isprintable() or c == "\n" for c in value):
            yield f"attribute {name} is {value!r:.60}, with control characters; expected a plain text; {_AGAIN}"


def shape_problems(entry: Variable, dims: Sequence[str], shape: Sequence[int], kind: str) -> Iterator[str]:
    """Yield what is wrong with the shape and type that a variable is declared to have.

    Parameters
    ----------
    entry : Variable
        Row of the table.
    dims, shape : sequence
        Names and lengths of its dims, without that of the characters of a text.
    kind : str
        Kind of its numpy type.
    """
    what = _what(entry)
    if tuple(dims) != entry.dims:
        yield f"{what} has dims {tuple(map(str, dims))}; expected {entry.dims}; {_AGAIN}"
    allowed = _TEXT if entry.dtype == "str" else _WHOLE if entry.dtype.startswith("int") else _REAL
    if kind not in allowed:
        yield f"{what} has values of another type (kind {kind!r}); expected {entry.dtype}; {_AGAIN}"
    if math.prod(shape) > schema.MOST_POINTS:
        yield f"{what} has {' x '.join(map(str, shape))} values; allowed: at most {schema.MOST_POINTS}; {_AGAIN}"


def _grid_problems(dataset: xr.Dataset, version: int) -> Iterator[str]:
    """Yield what is wrong with the axes and variables of a map."""
    yield from _table_problems(dataset, schema.GRID, version)
    if "contact" in dataset.coords:
        names = tuple(str(name) for name in np.atleast_1d(dataset["contact"].values))
        if names not in schema.CONTACT_NAMES:
            yield f"contact holds {', '.join(names):.60}; expected inner, outer or line"


def _backbone_problems(group: xr.Dataset, version: int) -> Iterator[str]:
    """Yield what is wrong with the group of refinement lines."""
    if not isinstance(group.attrs.get(schema.REFERENCE_CONTACT), str):
        yield f"attribute {schema.REFERENCE_CONTACT} is missing or no text; {_AGAIN}"
    yield from _table_problems(group, schema.BACKBONE, version)
    together = schema.response_rows(version)
    lacking = [entry for entry in together if entry.name not in group.variables]
    if lacking and len(lacking) < len(together):
        held = ", ".join(entry.name for entry in together if entry not in lacking)
        yield from (f"{_what(entry)} is missing; it belongs to {held}; {_AGAIN}" for entry in lacking)
    own = [entry for entry in schema.table(schema.BACKBONE, version) if entry.name.startswith(schema.OWN)]
    if any(entry.name in group.variables for entry in own):
        there = [entry for entry in own if entry.name.removeprefix(schema.OWN) in group.variables]
        lost = [entry for entry in there if entry.name not in group.variables]
        yield from (
            f"{_what(entry)} is missing; it belongs to the lines of the outer contact; {_AGAIN}" for entry in lost
        )


def _table_problems(dataset: xr.Dataset, group: str, version: int) -> Iterator[str]:
    """Yield what is wrong with a dataset, by the rows of a group."""
    for entry in schema.table(group, version):
        held = dataset.coords if entry.axis else dataset.data_vars
        if entry.name not in held:
            if entry.required_in(version):
                yield f"{_what(entry)} is missing; {_AGAIN}"
            continue
        found = held[entry.name]
        yield from shape_problems(entry, list(map(str, found.dims)), found.shape, found.dtype.kind)
        if entry.dtype == "str":
            continue
        if found.attrs.get("units") != entry.units:
            yield f"{_what(entry)} has units {found.attrs.get('units')!r:.60}; expected {entry.units!r}"
        if found.dtype.kind in _REAL:
            yield from _value_problems(entry, found.values)


def _value_problems(entry: Variable, values: npt.NDArray[Any]) -> Iterator[str]:
    """Yield what is wrong with the numbers of an axis or a flag."""
    if entry.axis:
        yield from _axis_problems(entry, np.atleast_1d(values))
    elif entry.flags:
        known = [value for value, _ in entry.flags]
        unknown = np.setdiff1d(values, known)
        if unknown.size:
            yield f"{entry.name} holds {unknown[:5].tolist()}; expected {known}"


def _axis_problems(entry: Variable, values: npt.NDArray[Any]) -> Iterator[str]:
    """Yield what is wrong with a numeric axis."""
    what = _what(entry)
    low, high = entry.limits or (-math.inf, math.inf)
    if values.size == 0 or not np.all(np.isfinite(values)):
        yield f"{what} is empty or holds values that are not finite numbers"
    elif np.any(np.diff(values) <= 0):
        yield f"{what} does not rise from value to value"
    elif values[0] < low or values[-1] > high:
        wrong = values[0] if values[0] < low else values[-1]
        yield f"{what} holds {wrong:g} {entry.units}; allowed: {low:g} to {high:g}; {_AGAIN}"


def _what(entry: Variable) -> str:
    """Name of a variable in a message."""
    return f"{'coordinate' if entry.axis else 'variable'} {entry.name}"


_ATTRIBUTES = ("contacts", "geometry", "lubricant", "structural_law", schema.REFERENCE_CONTACT)

_WHERE_STATED = (schema.OIL_SUPPLY, schema.SURFACE, schema.FILM_TABLE)
"""Attributes that only some maps have: of the others the checksum is that of a table without them."""

_TIMES = ("solve_seconds",)
"""Variables that another run of the same job finds otherwise."""


def content_sha256(dataset: xr.Dataset, backbone: xr.Dataset | None) -> str:
    """Return the checksum of a map, in hexadecimal digits.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map.
    backbone : xarray.Dataset or None
        Group of its refinement lines.
    """
    return _sum(dataset, backbone, _TIMES)


def _sum(dataset: xr.Dataset, backbone: xr.Dataset | None, without: Collection[str]) -> str:
    """The checksum over everything but some variables."""
    digest = hashlib.sha256()
    version = schema.version_of(dataset)
    for group, held in ((schema.GRID, dataset), (schema.BACKBONE, backbone)):
        if held is None:
            continue
        for name in _ATTRIBUTES:
            digest.update(_header(group, name, held.attrs.get(name)))
        for name in _WHERE_STATED:
            if name in held.attrs:
                digest.update(_header(group, name, held.attrs[name]))
        for entry in schema.table(group, version):
            if entry.name in held.variables and entry.name not in without:
                found = held[entry.name]
                digest.update(_header(group, entry.name, [*map(str, found.dims), *found.shape, entry.dtype]))
                digest.update(_content(found, entry.dtype))
    return digest.hexdigest()


def check_content(dataset: xr.Dataset, backbone: xr.Dataset | None, where: str) -> None:
    """Refuse a map that is not what its checksum says; maps without one, made before there was any, pass.

    So do those whose checksum was made over the times, too, as it once was.

    Parameters
    ----------
    dataset : xr.Dataset
        The map.
    backbone : xr.Dataset or None
        Group of its refinement lines, if it has one.
    where : str
        How messages call the map.

    Raises
    ------
    MapError
        With what to do.
    """
    stated = dataset.attrs.get(schema.CHECKSUM)
    if stated is not None and stated not in (_sum(dataset, backbone, left_out) for left_out in (_TIMES, ())):
        raise MapError(
            f"{where}: was changed since it was made: variables, contacts, geometry, oil, surface, oil supply or group "
            f"{schema.BACKBONE} do not match its attribute {schema.CHECKSUM}; generate it again; or, if the "
            "change is meant, delete that attribute, and the map counts as yours: laws then read its points"
        )


def _header(*words: object) -> bytes:
    """A line that no other content can look like."""
    return json.dumps(words, default=str).encode() + b"\n"


def _content(found: xr.DataArray, dtype: str) -> bytes:
    """Values as bytes: numbers in the type of the table, little-endian."""
    if dtype == "str":
        return _header(*(str(text) for text in found.values.ravel()))
    return np.ascontiguousarray(found.values, dtype=np.dtype(found.dtype).newbyteorder("<")).tobytes()


_SINGLE = 1e-6
"""Relative: films of the table that were saved in single precision differ by less from those that are read."""


def own_points(dataset: xr.Dataset, backbone: xr.Dataset | None) -> str:
    """Say why the points of a map are not those that its film table or its lines stand for; empty where they are.

    Points of the film table are read again. Lines have the seal of their points, see `points_seal`; those of a map that
    was made before there was any are believed, unless its checksum says otherwise.

    Parameters
    ----------
    dataset : xarray.Dataset
        A valid map.
    backbone : xarray.Dataset or None
        Group of its refinement lines.
    """
    if backbone is not None:
        seal = backbone.attrs.get(schema.SEAL)
        if seal is None:
            stated = dataset.attrs.get(schema.CHECKSUM)
            same = stated is None or stated in (_sum(dataset, backbone, left_out) for left_out in (_TIMES, ()))
        else:
            held, sealed = (read_json(text, schema.SEAL) for text in (points_seal(dataset), seal))
            same = all(held[name] == sealed[name] for name in held if name in sealed)
        return "" if same else "they are not those that its refinement lines were made for"
    if schema.FILM_TABLE not in dataset.attrs:
        return ""
    wrong = _not_of_table(dataset)
    return f"{wrong} of {dataset['status'].size} are not those of the film table" if wrong else ""


def points_seal(dataset: xr.Dataset) -> str:
    """Return checksums of what refinement lines stand for, JSON by name: oil, axes and films of the points.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map.
    """
    names = [name for name in (*schema.DIMS[1:], *_READ_BY_LAWS) if name in dataset.variables]
    contents = {"lubricant": _header(dataset.attrs["lubricant"])}
    contents |= {name: _content(dataset[name], "float64") for name in names}
    return json.dumps({name: hashlib.sha256(content).hexdigest() for name, content in contents.items()})


_READ_BY_LAWS = ("film_offset", "film_compliance", "loss_compliance", "rolling_force", "mass_flow")
"""Films of the points of which a law makes something."""


def _not_of_table(dataset: xr.Dataset) -> int:
    """Number of points, filled ones apart, whose films are not what the film table has there."""
    from ehdmaps.physics.closed_form import THICKEST_FILM  # with the film table, that other maps do not need
    from ehdmaps.table.file import film_table

    points = dataset.transpose(*schema.DIMS, ...)
    axes = (points[name].values.astype(np.float64) for name in schema.DIMS[1:])
    w, u, T = np.meshgrid(*axes, indexing="ij")
    settings = read_json(dataset.attrs["solver_settings"], "solver_settings")
    thickest, heat = float(settings.get("thickest_film", THICKEST_FILM)), settings.get("physics") == INLET_HEAT
    lubricant = lubricant_from_json(dataset.attrs["lubricant"])
    wrong = np.zeros(points["status"].shape, dtype=bool)
    try:
        table = film_table(lubricant)
        for i, contact in enumerate(contacts_of(dataset)):
            films = table.films(contact, lubricant, w, u, T, thickest_film=thickest, inlet_heat=heat)
            for name in _READ_BY_LAWS:
                if name in points:
                    known = np.where(films.usable, getattr(films, name), np.nan)
                    wrong[i] |= ~np.isclose(points[name].values[i], known, _SINGLE, 0.0, equal_nan=True)
    except EhdmapsError:  # an oil of which the table knows nothing
        return wrong.size
    return int(np.count_nonzero(wrong & ~points["filled"].values.astype(bool)))


_OF_THE_FILE = ("_FillValue", "_Encoding", "_Unsigned", "missing_value", "coordinates")
"""Attributes that say how values are stored; values themselves are read as they are."""

_SCALED = ("scale_factor", "add_offset")


def read_map(path: str | PathLike[str]) -> tuple[xr.Dataset, xr.Dataset | None]:
    """Read the grid of a map file and its backbone, None where it has none.

    Raises
    ------
    MapError
        If it cannot be read, or its attributes, dims, types or sizes are not those of a map.
    """
    name = fspath(path)
    try:
        with opened(name) as file:
            return _read(file, name)
    except DAMAGE as error:
        cause = " ".join(str(error).split()) or type(error).__name__
        words = words_for_lines(name)
        raise MapError(
            words or f"{name}: cannot be read ({cause:.300}); expected a map file written by `ehdmaps generate`"
        ) from error


def _read(file: Any, where: str) -> tuple[xr.Dataset, xr.Dataset | None]:
    """Read an open file: first all that it declares, then the values."""
    attributes = _attributes(file)
    if (made_as := attributes.get("made_as")) is not None:
        raise MapError(f"{where}: is a {made_as!s:.40}; expected a map of line contacts, written by `ehdmaps generate`")
    refuse(version_problems(attributes), where)
    version = int(attributes["schema_version"])
    grid, refined = schema.table(schema.GRID, version), schema.table(schema.BACKBONE, version)
    group = file.groups.get(schema.BACKBONE)
    problems = [*attribute_problems(attributes), *_declared_problems(file, grid)]
    if group is not None:
        problems += [f"group {schema.BACKBONE}: {problem}" for problem in _declared_problems(group, refined)]
    refuse(problems, where)
    backbone = None if group is None else _dataset(group, refined, _attributes(group))
    return _dataset(file, grid, attributes), backbone


def _attributes(holder: Any) -> dict[str, Any]:
    """Attributes of a file, group or variable."""
    return {name: holder.getncattr(name) for name in holder.ncattrs()}


def _declared_problems(group: Any, entries: Sequence[Variable]) -> Iterator[str]:
    """Yield what is wrong with the variables that a file declares; what it lacks is seen later."""
    for entry in entries:
        found = group.variables.get(entry.name)
        if found is None:
            continue
        dims, shape = found.dimensions, found.shape
        if _is_characters(found):
            if shape and np.prod(shape, dtype=float) > schema.LONGEST_TEXTS:
                yield f"variable {entry.name} has {' x '.join(map(str, shape))} characters; generate the map again"
            dims, shape = dims[:-1], shape[:-1]
        yield from shape_problems(entry, dims, shape, "U" if found.dtype is str else np.dtype(found.dtype).kind)
        if any(name in found.ncattrs() for name in _SCALED):
            yield f"variable {entry.name} is packed (attribute scale_factor or add_offset); save it as it is"


def _is_characters(variable: Any) -> bool:
    """Tell whether a variable holds single characters, the last dim being that of the text."""
    return variable.dtype is not str and np.dtype(variable.dtype) == np.dtype("S1") and bool(variable.dimensions)


def _dataset(group: Any, entries: Sequence[Variable], attributes: dict[str, Any]) -> xr.Dataset:
    """Read the variables of the table."""
    import xarray as xr

    variables = {entry.name: _variable(group.variables[entry.name], entry) for entry in entries if _has(group, entry)}
    axes = {entry.name for entry in entries if entry.axis}
    return xr.Dataset(
        {name: found for name, found in variables.items() if name not in axes},
        coords={name: found for name, found in variables.items() if name in axes},
        attrs=attributes,
    )


def _has(group: Any, entry: Variable) -> bool:
    """Tell whether a file has a variable."""
    return entry.name in group.variables


def _variable(found: Any, entry: Variable) -> xr.Variable:
    """Read one variable."""
    import xarray as xr

    found.set_auto_maskandscale(False)
    found.set_auto_chartostring(False)
    values = np.asarray(found[...])
    if _is_characters(found):
        values = _texts(values)
    elif entry.dtype == "str":
        values = values.astype(object)
    attributes = {name: value for name, value in _attributes(found).items() if name not in _OF_THE_FILE}
    return xr.Variable(entry.dims, values, attributes, entry.encoding())


def _texts(characters: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Texts of an array of characters in UTF-8, along its last axis."""
    *shape, length = characters.shape
    if length == 0:
        return np.full(shape, "", dtype=object)
    words = np.ascontiguousarray(characters).view(f"S{length}")[..., 0]
    known, places = np.unique(words, return_inverse=True)
    return np.array([word.decode() for word in known], dtype=object)[places].reshape(shape)
