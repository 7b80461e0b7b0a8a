"""Output of a run of `ehlFoam`: the dictionary `results`, and tables of the film and its temperatures."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import SolverError
from ehdmaps.openfoam.dictionary import camel
from ehdmaps.openfoam.pyfoam import parse
from ehdmaps.physics.solution import Status

_STATUSES = {status.name.lower(): status for status in (Status.CONVERGED, Status.STAGNATED, Status.DIVERGED)}
"""Words of `ehlFoam` for how a run ended."""

_NUMBERS = (
    *("central_film", "minimum_film", "max_pressure", "film_offset", "wall_stress", "traction", "rolling_force"),
    *("load_defect", "flux_defect", "outlet_defect", "cell_continuity", "seconds"),
)
_RESPONSES = ("film_compliance", "loss_compliance", "response_residual")
"""Numbers of every film, and those at each frequency."""

_GROUPS = (
    ("film_temperature", "surface_temperature", "dissipated_heat", "compression_heat", "carried_heat", "wall_heat"),
    ("oscillation_film_compliance", "oscillation_loss_compliance"),
)
"""Numbers that are there together or not at all: of a film with heat, and of an oscillation in time."""

FILM, THIN_FILM = "film.dat", "thinFilm.dat"
"""Tables of the film as it is, and, of a run with all stresses, of the thin film from which it starts."""

TEMPERATURE = "temperature.dat"
"""Table of the temperatures of a film with heat: a line a column of cells, across it from surface to surface."""

COLUMNS = ("x", "pressure", "film", "flux", "density", "liquid_fraction")
"""Columns of the tables of the film."""


@dataclass(frozen=True)
class Results:
    """Numbers of one run; NaN in one that did not converge.

    Attributes
    ----------
    status, reason
        How the run ended.
    iterations : int
        Iterations of the coupled solve.
    central_film, minimum_film, film_offset : float
        [m].
    max_pressure : float
        [Pa].
    wall_stress : float
        Largest shear stress at a wall [Pa].
    traction, rolling_force : float
        Integrals of the shear stress along the film up to its exit: of the mean of both walls, of the sign of the
        slide-to-roll ratio, and of their difference [N/m].
    frequencies : tuple of float
        Frequencies of the responses that follow [Hz].
    film_compliance : tuple of float
        1/k - 1/k_dry at each frequency [m2/N].
    loss_compliance : tuple of float
        Loss compliance at each frequency [m2 s/N].
    response_residual : tuple of float
        What the Krylov space leaves of the equations at each frequency, relative to the response at rest.
    load_defect, flux_defect, outlet_defect, cell_continuity : float
        Relative defects of the balances: load, mass flux before and behind the rupture of the film, mass of the cells.
    film_temperature, surface_temperature : float
        Highest temperature in the film and of its surfaces [K]; NaN of an isothermal film.
    dissipated_heat, compression_heat, carried_heat, wall_heat : float
        Heat that shear and compression make, that the oil carries out, and that goes into the surfaces [W/m]; NaN of an
        isothermal film.
    seconds : float
        Time of the run as it says itself.
    oscillation_film_compliance, oscillation_loss_compliance : float or None
        Compliances from an oscillation in time, where one was asked for [m2/N], [m2 s/N].
    """

    status: Status
    reason: str = ""
    iterations: int = 0
    central_film: float = math.nan
    minimum_film: float = math.nan
    max_pressure: float = math.nan
    film_offset: float = math.nan
    wall_stress: float = math.nan
    traction: float = math.nan
    rolling_force: float = math.nan
    frequencies: tuple[float, ...] = ()
    film_compliance: tuple[float, ...] = ()
    loss_compliance: tuple[float, ...] = ()
    response_residual: tuple[float, ...] = ()
    load_defect: float = math.nan
    flux_defect: float = math.nan
    outlet_defect: float = math.nan
    cell_continuity: float = math.nan
    film_temperature: float = math.nan
    surface_temperature: float = math.nan
    dissipated_heat: float = math.nan
    compression_heat: float = math.nan
    carried_heat: float = math.nan
    wall_heat: float = math.nan
    seconds: float = math.nan
    oscillation_film_compliance: float | None = None
    oscillation_loss_compliance: float | None = None

    @property
    def complex_compliance(self) -> ComplexArray:
        """Film compliance - i omega loss compliance at each frequency, shape (k,) [m2/N]."""
        omega = 2.0 * math.pi * np.array(self.frequencies)
        return np.asarray(np.array(self.film_compliance) - 1j * omega * np.array(self.loss_compliance))


@dataclass(frozen=True)
class FilmTable:
    """A film over the columns of cells, each of shape (columns,).

    Attributes
    ----------
    x : ndarray
        Centres of the columns from the contact centre [m].
    pressure : ndarray
        [Pa].
    film : ndarray
        h [m].
    flux : ndarray
        Mass flux per width [kg/(m s)].
    density : ndarray
        [kg/m3].
    liquid_fraction : ndarray
        1 where there is oil only.
    """

    x: FloatArray
    pressure: FloatArray
    film: FloatArray
    flux: FloatArray
    density: FloatArray
    liquid_fraction: FloatArray


def read_results(case: Path) -> Results:
    """Read the dictionary `results` of a case.

    Raises
    ------
    SolverError
        If it is not there or is not what `ehlFoam` writes: where, what was got, what is allowed.
    """
    path, entries, end = ended(case)
    if end["status"] is not Status.CONVERGED:
        return Results(**end)
    frequencies = numbers(path, entries, "frequencies", None)
    groups = [name for group in _GROUPS if key_of(group[0]) in entries for name in group]
    end |= {name: number(path, entries, key_of(name)) for name in (*_NUMBERS, *groups)}
    end |= {name: numbers(path, entries, key_of(name), len(frequencies)) for name in _RESPONSES}
    return Results(**end, frequencies=frequencies)


def ended(case: Path) -> tuple[Path, Mapping[str, Any], dict[str, Any]]:
    """Read how a run ended.

    Parameters
    ----------
    case : Path
        The case folder.

    Returns
    -------
    path : Path
        The file `results`.
    entries : mapping
        Entries of that file.
    end : dict
        Status, reason and iterations, by the names of `Results`.

    Raises
    ------
    SolverError
        If it is not there or is not what `ehlFoam` writes.
    """
    path = case / "results"
    entries = parse(path)
    word = entries.get("status")
    if not isinstance(word, str) or word not in _STATUSES:
        raise SolverError(f"{path}, status: got {word!r:.60}; allowed: {', '.join(_STATUSES)}")
    reason, iterations = str(entries.get("reason", "")).strip('"'), int(number(path, entries, "iterations"))
    return path, entries, {"status": _STATUSES[word], "reason": reason, "iterations": iterations}


def key_of(name: str) -> str:
    """Word of `ehlFoam` for a number.

    Parameters
    ----------
    name : str
        Name of the number.

    Examples
    --------
    >>> key_of("max_pressure")
    'maximumPressure'
    """
    return camel(name.replace("max_", "maximum_"))


def read_film(case: Path, columns: int, name: str = FILM) -> FilmTable:
    """Read a table of the film.

    Parameters
    ----------
    case : Path
        The case folder.
    columns : int
        Columns of cells that it has.
    name : str
        FILM or THIN_FILM.

    Raises
    ------
    SolverError
        If it is not there or is not a table of finite numbers with the columns of `COLUMNS`.
    """
    return FilmTable(*read_table(case / name, columns, COLUMNS))


def read_temperatures(case: Path, columns: int, rows: int) -> FloatArray:
    """Read the temperatures of a film with heat.

    Parameters
    ----------
    case : Path
        The case folder.
    columns, rows : int
        Cells that it has along and across the film.

    Returns
    -------
    ndarray, shape (rows + 2, columns)
        Temperatures of the lower surface, of the rows and of the upper surface [K].

    Raises
    ------
    SolverError
        If it is not there or is not such a table of finite numbers.
    """
    return read_table(case / TEMPERATURE, columns, ("lower", *map(str, range(rows)), "upper"))


def read_table(path: Path, count: int, columns: tuple[str, ...]) -> FloatArray:
    """Read a table of numbers.

    Parameters
    ----------
    path : Path
        The file.
    count : int
        Number of lines.
    columns : tuple of str
        Heads of its columns.

    Returns
    -------
    ndarray, shape (columns, count)
        A row for each column.

    Raises
    ------
    SolverError
        If it is not there or is not such a table of finite numbers.
    """
    try:
        with path.open(encoding="ascii") as file:
            header = file.readline().lstrip("#").split()
            table = np.loadtxt(file, ndmin=2)
    except FileNotFoundError as error:
        raise SolverError(f"{path}: is not there") from error
    except ValueError as error:
        raise SolverError(f"{path}: is no table of numbers ({error})") from error
    if tuple(header) != columns or table.shape != (count, len(columns)) or not np.isfinite(table).all():
        raise SolverError(
            f"{path}: got an array of shape {table.shape} under {' '.join(header):.80}; "
            f"allowed: {count} lines of finite numbers under {' '.join(columns)}"
        )
    return np.ascontiguousarray(table.T)


def number(path: Path, entries: Mapping[str, Any], key: str) -> float:
    """Return a finite number of a dictionary.

    Parameters
    ----------
    path : Path
        File of the dictionary, for the message.
    entries : mapping
        The dictionary.
    key : str
        Key of the entry.

    Raises
    ------
    SolverError
        If it is none.
    """
    value = entries.get(key)
    if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
        raise SolverError(f"{path}, {key}: got {value!r:.60}; allowed: a finite number")
    return float(value)


def numbers(path: Path, entries: Mapping[str, Any], key: str, length: int | None) -> tuple[float, ...]:
    """Return a list of finite numbers of a dictionary; the parser takes three of them for a vector.

    Parameters
    ----------
    path : Path
        File of the dictionary, for the message.
    entries : mapping
        The dictionary.
    key : str
        Key of the entry.
    length : int or None
        How many; None: any.

    Raises
    ------
    SolverError
        If it is none.
    """
    value = entries.get(key)
    try:
        found = tuple(float(each) for each in value)  # type: ignore[union-attr]
    except (TypeError, ValueError):
        found = (math.nan,)
    if not all(map(math.isfinite, found)) or length not in (None, len(found)):
        what = "finite numbers" if length is None else f"{length} finite numbers"
        raise SolverError(f"{path}, {key}: got {value!s:.60}; allowed: {what} in brackets")
    return found
