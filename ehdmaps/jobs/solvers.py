"""Names and settings of the contact solvers: the one place where a solver or a [solver] key is added."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.jobs.table import Table
from ehdmaps.physics.solution import ContactSolver


@dataclass(frozen=True)
class Number:
    """A key that takes a bare number within [low, high]."""

    key: str
    low: float
    high: float
    meaning: str

    def read(self, table: Table) -> Any:
        """Return the value, or None if absent or wrong."""
        return table.number(self.key, self.low, self.high)


@dataclass(frozen=True)
class Word:
    """A key that takes one of some words."""

    key: str
    allowed: tuple[str, ...]
    meaning: str

    def read(self, table: Table) -> Any:
        """Return the word, or None if absent or wrong."""
        return table.choice(self.key, self.allowed)


@dataclass(frozen=True)
class SolverEntry:
    """One solver: its own keys in [solver], and how it is made from them.

    Attributes
    ----------
    options : tuple
        Its keys; a key that a job leaves out has the solver's own default.
    build : callable
        Makes the solver from the keys; imports it only then.
    missing : str
        Why this version does not have it; empty if it has.
    """

    options: tuple[Number | Word, ...]
    build: Callable[..., ContactSolver]
    missing: str = ""


def _hertz() -> ContactSolver:
    from ehdmaps.physics.closed_form import HertzSolver

    return HertzSolver()


def _formula(**options: Any) -> ContactSolver:
    from ehdmaps.physics.closed_form import FormulaSolver

    return FormulaSolver(**options)


def _reynolds(**options: Any) -> ContactSolver:
    from ehdmaps.ehl.solver import ReynoldsSolver

    return ReynoldsSolver(**options)


def _openfoam() -> ContactSolver:
    raise InputError(SOLVERS["openfoam"].missing)


SOLVERS: Mapping[str, SolverEntry] = {
    "hertz": SolverEntry((), _hertz),
    "formula": SolverEntry(
        (Word("film_formula", ("moes", "dowson-toyoda", "pan-hamrock"), "central-film formula"),), _formula
    ),
    "reynolds": SolverEntry(
        (
            Number("density", 3.0, 60.0, "grid cells per e-fold of distance from inlet, exit and spike"),
            Number("inlet_length", 20.0, 1e5, "length of the inlet over sqrt(2 h R)"),
            Number("tolerance", 1e-12, 1e-3, "Newton tolerance on the last step"),
        ),
        _reynolds,
    ),
    "openfoam": SolverEntry(
        (),
        _openfoam,
        missing="'openfoam' is not in this version of ehdmaps; use 'reynolds', 'formula' or 'hertz'",
    ),
}
SOLVER_NAMES = tuple(SOLVERS)


def read_options(name: str, table: Table) -> dict[str, Any]:
    """Read the solver's own keys from [solver]; those that are absent or wrong are left out."""
    values = {option.key: option.read(table) for option in SOLVERS[name].options}
    return {key: value for key, value in values.items() if value is not None}


def build(name: str, options: Mapping[str, Any]) -> ContactSolver:
    """Make a solver.

    Raises
    ------
    InputError
        If this version does not have it.
    """
    entry = SOLVERS[name]
    if entry.missing:
        raise InputError(f"solver: got {entry.missing}")
    return entry.build(**options)
