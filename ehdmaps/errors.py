"""Everything that ehdmaps raises on purpose, so that a caller can tell bad input from a failed solve.

Messages say where, what was got (with unit), what is allowed, and what to do.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager


class EhdmapsError(Exception):
    """Base of all errors raised on purpose by ehdmaps and mbs."""


class InputError(EhdmapsError):
    """Input that cannot be used; carries every problem found, each once, not only the first.

    Parameters
    ----------
    problems : sequence of str, or str
        One sentence a problem: where - what was got - what is allowed - what to do.
    """

    def __init__(self, problems: Sequence[str] | str) -> None:
        self.problems = (problems,) if isinstance(problems, str) else tuple(dict.fromkeys(problems))
        super().__init__("\n".join(self.problems))


class Problems(list[str]):
    """Problems of input that are noted one after another, and raised together; as a context, those of what fails in it.

    Examples
    --------
    >>> problems = Problems()
    >>> with problems:
    ...     raise InputError("speed: got -1 rpm; allowed: 0 rpm and more")
    >>> problems.check()
    Traceback (most recent call last):
    ...
    ehdmaps.errors.InputError: speed: got -1 rpm; allowed: 0 rpm and more
    """

    def __enter__(self) -> Problems:
        return self

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> bool:
        if isinstance(error, InputError):
            self += error.problems
        return isinstance(error, InputError)

    @contextmanager
    def after(self, before: str) -> Iterator[None]:
        """Note the problems of what fails in this context, each after a start.

        Parameters
        ----------
        before : str
            The start, such as "--oil: ".
        """
        with self, problems_after(before):
            yield

    def check(self) -> None:
        """Raise an `InputError` with all of them, where there are any."""
        if self:
            raise InputError(self)


@contextmanager
def problems_after(before: str, behind: str = "") -> Iterator[None]:
    """Tell in the problems of what fails in this context where they are.

    Parameters
    ----------
    before, behind : str
        What each begins and ends with, such as "shaft 'input', ".
    """
    try:
        yield
    except InputError as error:
        raise InputError([f"{before}{problem}{behind}" for problem in error.problems]) from error


class DependencyError(InputError):
    """A package that an extra of the distribution installs is not there; the message names the extra."""


class KernelError(EhdmapsError):
    """The C library of the equations cannot be loaded or built; the message says what to install."""


class SolverError(EhdmapsError):
    """A contact solver gave up in a way it could not express as a status; the sweep records it as `failed`."""


class AnalysisError(EhdmapsError):
    """An analysis finds no result from input that is valid; the message says what to try."""


class StoreError(EhdmapsError):
    """The store of solved points cannot be read, written or shared."""


class DiskFullError(EhdmapsError):
    """A disk has no room for the files of a run, which is then not one that failed; what was solved is kept."""


class WorkerError(EhdmapsError):
    """Processes that do the work cannot be started, or die before they do any; what was solved is kept.

    Parameters
    ----------
    message : str
        What happened, and what to do.
    kept : int
        Points that were solved before.
    """

    def __init__(self, message: str, kept: int = 0) -> None:
        self.kept = kept
        super().__init__(message)


class MapError(EhdmapsError):
    """A map file is broken, of another schema, or unfit for what is asked of it."""


class OutsideMapError(EhdmapsError):
    """A contact law was called outside the range of its map and its policy is `error`."""


def short(value: object) -> str:
    """Quote a value of any kind and size for a message."""
    if isinstance(value, int) and not isinstance(value, bool) and abs(value) >= 10**20:
        return f"a number of {value.bit_length()} bits"
    if isinstance(value, (dict, list, tuple)):
        kind = "a table" if isinstance(value, dict) else "a list"
        return f"{kind} of {len(value)} entries"
    if isinstance(value, str) and len(value) > 60:
        value = value[:50] + "..."
    return repr(value)


def closest(word: str, allowed: tuple[str, ...]) -> str:
    """Say ' (did you mean ...?)' where one of the allowed words is close, else nothing."""
    matches = difflib.get_close_matches(word[:100], allowed, n=1, cutoff=0.6)
    return f" (did you mean {matches[0]!r}?)" if matches else ""


LONGEST_LABEL = 60
"""Characters; a title has no room for more."""


def label_problem(label: str | None) -> list[str]:
    """Problems of a label, in words; nothing where it is None."""
    if label is None:
        return []
    rule = f"allowed: 1 to {LONGEST_LABEL} printable characters on one line"
    if not isinstance(label, str):
        return [f"got {label!r:.40}; {rule}, in quotes"]
    if not (label.strip() and len(label) <= LONGEST_LABEL and label.isprintable()):
        return [f"got {label[:40]!r}{'...' if len(label) > 40 else ''} ({len(label)} characters); {rule}"]
    return []
