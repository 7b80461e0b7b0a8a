"""Names and settings of the contact solvers: the one place where a solver or a [solver] key is added."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ehdmaps.ehl.limits import SETTING_LIMITS
from ehdmaps.errors import InputError
from ehdmaps.jobs.table import Table
from ehdmaps.physics.heat import ISOTHERMAL, PHYSICS, THERMAL
from ehdmaps.physics.rheology import SHEAR_LIMITS, SHEARS
from ehdmaps.physics.solution import ContactSolver, ContactSolverDefaults
from ehdmaps.units import Display, short

if TYPE_CHECKING:
    from ehdmaps.jobs.job import Job
    from ehdmaps.table.solver import TableSolver

SOLVED, TABLE = "solved", "table"
"""Where the films of `reynolds` come from."""

GRID_KEYS = ("density", "inlet_length", "tolerance")
"""Keys of `reynolds` that say how a film is solved: who states one has films solved."""


@dataclass(frozen=True)
class Key:
    """A key of a solver: it takes one of some words, or a number within limits.

    Attributes
    ----------
    key : str
        Name in [solver].
    meaning : str
        What it says.
    limits : (float, float)
        The least and the largest number.
    words : tuple of str
        The words it takes; empty for a number.
    whole : bool
        Whether the number is a whole one.
    unit : str
        SI unit of a number that may be stated with its unit, as a text; a bare number is in SI.
    display : Display or None
        How a message shows a number with a unit; None for a number without one.
    """

    key: str
    meaning: str
    limits: tuple[float, float] = (0.0, 0.0)
    words: tuple[str, ...] = ()
    whole: bool = False
    unit: str = ""
    display: Display | None = None

    def read(self, table: Table) -> Any:
        """Return the value in SI, or None if absent or wrong."""
        low, high = self.limits
        if self.words:
            return table.choice(self.key, self.words)
        if self.whole:
            return table.integer(self.key, int(low), int(high))
        if self.display and isinstance(table.get(self.key), str):
            return table.quantity(self.key, self.unit, low, high, self.display)
        return table.number(self.key, low, high)


_ASSUMED = "the default is an assumption"
SHEAR_OPTIONS = (
    Key("shear", "law of the shear stress, by the formulas of `ehdmaps.physics.rheology`", words=tuple(SHEARS)),
    Key(
        "shear_stress",
        f"stress tau0 of that law, or its bound without pressure; {_ASSUMED}",
        SHEAR_LIMITS["shear_stress"],
        unit="Pa",
        display=Display("MPa", 1e-6),
    ),
    Key("limiting_ratio", f"rise of the limiting stress with pressure; {_ASSUMED}", SHEAR_LIMITS["limiting_ratio"]),
    Key("carreau_exponent", f"exponent n of Carreau's law; {_ASSUMED}", SHEAR_LIMITS["carreau_exponent"]),
    Key(
        "slide_to_roll",
        "(u_upper - u_lower)/u, difference of the surface speeds over the entrainment speed",
        (-2.0, 2.0),
    ),
)
"""Keys of the solvers that know laws of shear: the same words, limits and meanings for each."""


def physics_option(*words: str) -> Key:
    """The key that says what a solver knows of heat.

    Parameters
    ----------
    *words : str
        What it may know, of `ehdmaps.physics.heat.PHYSICS`.
    """
    return Key("physics", "heat in the films, see [films with heat](reference_ehdmaps.md#films-with-heat)", words=words)


def _nothing() -> tuple[str, ...]:
    """Nothing is missing."""
    return ()


@dataclass(frozen=True)
class SolverEntry:
    """One solver: its own keys in [solver], and how it is made from them.

    Attributes
    ----------
    options : tuple
        Keys of the solver; a key that a job leaves out has the solver's own default.
    build : callable
        Makes the solver from the keys; imports it only then.
    missing : callable
        Returns what it needs and this machine does not have, one sentence each; looked up only when the solver is asked
        for.
    keeps_cases : bool
        Whether it works in case folders, which it can keep, and has fields of the film.
    """

    options: tuple[Key, ...]
    build: Callable[..., ContactSolver]
    missing: Callable[[], tuple[str, ...]] = _nothing
    keeps_cases: bool = False


def _hertz() -> ContactSolver:
    from ehdmaps.physics.closed_form import HertzSolver

    return HertzSolver()


def _formula(**options: Any) -> ContactSolver:
    from ehdmaps.physics.closed_form import FormulaSolver

    return FormulaSolver(**options)


def _reynolds(films: str = SOLVED, **options: Any) -> ContactSolver:
    from ehdmaps.ehl.solver import ReynoldsSolver

    if films == SOLVED:
        return ReynoldsSolver(**options)
    from ehdmaps.table.coordinates import GRID, outside_family
    from ehdmaps.table.solver import TableSolver

    solver = ReynoldsSolver(**{**GRID, **options})
    if reason := outside_family(solver):
        raise InputError(f"[solver] films: got {TABLE!r}; {reason}; allowed: {SOLVED!r}")
    return TableSolver(solver)


def _openfoam(start: str = "reynolds", **options: Any) -> ContactSolver:
    from ehdmaps.ehl.start import reynolds_start
    from ehdmaps.openfoam.solver import OpenFoamSolver

    return OpenFoamSolver(starter=reynolds_start if start == "reynolds" else None, **options)


def _openfoam_missing() -> tuple[str, ...]:
    from ehdmaps.openfoam.installation import missing

    return missing()


_FILM_FORMULAS = ("moes", "dowson-toyoda", "pan-hamrock")
_DAMPINGS = ("rigid", "dietl")
_FLOWS = ("thin_film", "full_stress")
_INLET = "length of the inlet over sqrt(2 h R)"
_DENSITY = "cells per e-fold of distance from inlet, exit and spike; 6.5: about 100 a contact"
_TOLERANCE = "tolerance of Newton's last step, whose convergence is quadratic"
_FLOW = "stress of thin films, or all of it with the pressure across the film"
_COLUMNS = "cells along the film; even, as half of them are the grid of the error estimate"
_START = "start of a point: its Reynolds solution, which also places the cells, or the dry contact"
_TIMEOUT = "seconds, waiting for a processor apart, after which a point, all its grids, is stopped and failed"
SOLVERS: Mapping[str, SolverEntry] = {
    "hertz": SolverEntry((), _hertz),
    "formula": SolverEntry(
        (
            Key("film_formula", "formula of the central film", words=_FILM_FORMULAS),
            Key("damping", "damping of a rigid film, or that of a contact by Dietl's regression", words=_DAMPINGS),
            Key("inlet_length_factor", "length factor of the inlet zone of Dietl's regression", (0.01, 100.0)),
        ),
        _formula,
    ),
    "reynolds": SolverEntry(
        (
            Key("density", _DENSITY, SETTING_LIMITS["density"]),
            Key("inlet_length", _INLET, SETTING_LIMITS["inlet_length"]),
            Key("tolerance", _TOLERANCE, SETTING_LIMITS["tolerance"]),
            physics_option(*PHYSICS),
            *SHEAR_OPTIONS,
            Key("films", "films are solved, or read from the film table where it serves", words=(SOLVED, TABLE)),
        ),
        _reynolds,
    ),
    "openfoam": SolverEntry(
        (
            Key("flow", _FLOW, words=_FLOWS),
            Key("columns", _COLUMNS, (40, 4000), whole=True),
            Key("rows", "cells across the film; even; 24 for pictures", (4, 64), whole=True),
            physics_option(ISOTHERMAL, THERMAL),
            *SHEAR_OPTIONS,
            Key("inlet_length", _INLET, (5.0, 1e5)),
            Key("start", _START, words=("reynolds", "hertz")),
            Key("timeout", _TIMEOUT, (1.0, 1e6)),
        ),
        _openfoam,
        missing=_openfoam_missing,
        keeps_cases=True,
    ),
}
SOLVER_NAMES = tuple(SOLVERS)

_MEMBERS = [name for of in (ContactSolver, ContactSolverDefaults) for name in vars(of) if not name.startswith("_")]
"""Members of a `ContactSolver`."""


def read_options(name: str, table: Table) -> dict[str, Any]:
    """Read the solver's own keys from [solver]; those that are absent or wrong are left out."""
    values = {option.key: option.read(table) for option in SOLVERS[name].options}
    return {key: value for key, value in values.items() if value is not None}


def build(name: str, options: Mapping[str, Any]) -> ContactSolver:
    """Make a solver.

    Raises
    ------
    InputError
        If this machine does not have what it needs.
    """
    entry = SOLVERS[name]
    lacking = entry.missing()
    if lacking:
        raise InputError([f"solver {name!r}: {problem}" for problem in lacking])
    return entry.build(**options)


def of_map(job: Job) -> ContactSolver:
    """Make the solver of a job's map: where the job does not say otherwise, the film table is read where it serves.

    Parameters
    ----------
    job : Job
        The job.
    """
    options = job.solver_options
    if job.solver != "reynolds" or job.corrected_by or {"films", *GRID_KEYS} & options.keys():
        return build(job.solver, options)
    from ehdmaps.table.coordinates import outside_family

    solved = build(job.solver, options)
    return solved if outside_family(solved) else build(job.solver, {**options, "films": TABLE})


def in_place_of_table(job: Job, solver: TableSolver) -> ContactSolver:
    """Make what solves the films of a job that the film table does not serve.

    Parameters
    ----------
    job : Job
        The job.
    solver : TableSolver
        What was to read them.
    """
    made = build(job.solver, {**job.solver_options, "films": SOLVED})
    return replace(made, thickest_film=solver.thickest_film)  # type: ignore[type-var]


def complete(solver: ContactSolver) -> ContactSolver:
    """Return the same solver, written by a user, once it has all that a solver has.

    Raises
    ------
    InputError
        For something that solves nothing, and for each member that is missing.
    """
    if isinstance(solver, type) or not callable(getattr(solver, "solve_line", None)):
        raise InputError(
            f"solver: got {short(solver)}, which is no solver; allowed: {', '.join(SOLVER_NAMES)}, or a solver such as "
            "an instance of a class that inherits from ehdmaps.physics.solution.ContactSolverDefaults"
        )
    # looked up without a call: a version may take a program to find out; what the Protocol writes down is no answer
    stubs = {name: vars(ContactSolver).get(name, _MEMBERS) for name in _MEMBERS}
    lacking = [name for name in _MEMBERS if inspect.getattr_static(solver, name, stubs[name]) is stubs[name]]
    if lacking:
        kind = type(solver).__name__
        raise InputError(
            [
                f"solver {kind}, {name}: missing; a solver has {', '.join(_MEMBERS)}; inherit from "
                "ehdmaps.physics.solution.ContactSolverDefaults, which has all but name, solve_line and settings"
                for name in lacking
            ]
        )
    return solver


PHYSICAL = ("physics", *(option.key for option in SHEAR_OPTIONS))
"""Keys that say what a film is, and not how it is solved."""


def takes(name: str, key: str, word: str) -> bool:
    """Tell whether a solver takes a word for one of its keys.

    Parameters
    ----------
    name : str
        Name of the solver.
    key : str
        One of its keys, which takes words.
    word : str
        The word.
    """
    return any(word in option.words for option in SOLVERS[name].options if option.key == key)


def carried(options: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Keys of a job's solver that another one takes over in its place: what the film is, where it knows of that.

    Parameters
    ----------
    options : mapping
        Keys of the job's solver.
    name : str
        Name of the solver that takes its place.
    """
    known = {option.key for option in SOLVERS[name].options}
    return {key: value for key, value in options.items() if key in PHYSICAL and key in known}


def reference(job: Job, solver: ContactSolver) -> ContactSolver | None:
    """A fast solver of films of the same physics as those of a map; None where there is none, or no errors are stated.

    Parameters
    ----------
    job : Job
        The job.
    solver : ContactSolver
        What solves its map.
    """
    if solver.name != job.solver or job.solver in ("hertz", "formula"):
        return None  # somebody's own, of which nothing is known; or closed forms, which know no errors
    if not SOLVERS[job.solver].keeps_cases:
        return solver
    return build("reynolds", carried(job.solver_options, "reynolds"))


def solver_words(options: Mapping[str, Any]) -> str:
    """Words on a solver's own keys behind its name: physics, law of shear, sliding; nothing of the defaults.

    Parameters
    ----------
    options : mapping
        Keys of the solver.
    """
    words = [str(options[key]) for key in ("physics", "shear") if key in options]
    own = [word for word in words if word not in (ISOTHERMAL, "newtonian")]
    slip = options.get("slide_to_roll", 0.0)
    return "".join(f", {word}" for word in (*own, *([f"slide to roll {slip:g}"] if slip else [])))


def stated(name: str, texts: Mapping[str, str], problems: list[str]) -> dict[str, Any]:
    """Read keys of a solver from a command line.

    Parameters
    ----------
    name : str
        Name of the solver.
    texts : mapping
        What was typed, by the key of [solver]; the options of the command line are called as these, with hyphens.
    problems : list of str
        Problems, appended to.

    Returns
    -------
    dict
        Values by key; what is wrong is left out.
    """
    known = {option.key: option for option in SOLVERS[name].options}
    values: dict[str, Any] = {}
    for key, text in texts.items():
        where, option = f"--{key.replace('_', '-')}", known.get(key)
        if option is None:
            having = [other for other, entry in SOLVERS.items() if key in [option.key for option in entry.options]]
            instead = f"with --solver {' or '.join(having)}" if having else "no solver takes it yet"
            problems.append(f"{where}: the solver {name!r} knows none; allowed: {instead}")
            continue
        own_problems: list[str] = []
        value = option.read(Table({key: _typed(text)}, where, own_problems))
        problems += [problem.replace(f"{where} {key}:", f"{where}:", 1) for problem in own_problems]
        if value is not None:
            values[key] = value
    return values


def _typed(text: str) -> str | float:
    """A bare number where the text is one."""
    try:
        return float(text)
    except ValueError:
        return text


def case_options(name: str, keep_cases: str | None) -> dict[str, Any]:
    """Options of a solver that is to keep its cases in a folder; none where it is not.

    Raises
    ------
    InputError
        If the solver has no cases, or the folder is none.
    """
    if keep_cases is None:
        return {}
    if not SOLVERS[name].keeps_cases:
        raise InputError(f"--keep-cases: the solver {name!r} works without cases; allowed: with the solver openfoam")
    folder = Path(keep_cases)
    if folder.exists() and not folder.is_dir():
        raise InputError(f"--keep-cases: got {folder}, a file; allowed: a folder, which is made if it is not there")
    return {"keep_cases": folder.absolute()}
