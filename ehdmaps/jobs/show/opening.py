"""Open the map of a command: a file, or a job whose map is made in memory, with films from the film table."""

from __future__ import annotations

import argparse
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING

from ehdmaps.choices import MAP_CHOICES, texts_of
from ehdmaps.errors import Problems

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap


def open_given(path: str | PathLike[str], arguments: argparse.Namespace | None = None) -> EHDMap:
    """Open a map with what is chosen of it.

    Parameters
    ----------
    path : str or path
        The file of a map. Of a job, a file ending with .toml or the name of a shipped one, the map is made in memory,
        in about a second, where the film table serves it.
    arguments : argparse.Namespace, optional
        Arguments of the command, with some of `ehdmaps.choices.MAP_CHOICES`; what is not there is that of the map.

    Raises
    ------
    MapError
        If the file cannot be read, is no map, or was changed since it was made.
    InputError
        If a choice is none, or does not suit the map; if a job is wrong, or its films have to be solved.
    """
    problems = Problems()
    chosen = [] if arguments is None else [
        (choice, value) for choice in MAP_CHOICES for value in choice.values(texts_of(arguments, choice), problems)
    ]  # fmt: skip
    problems.check()
    emap = _of_job(path) if _is_job(path) else _of_file(path)
    for choice, value in chosen:
        with problems.after(f"--{choice.name}: "):
            emap = choice.change(emap, value)
    problems.check()
    return emap


def choice_words(arguments: argparse.Namespace) -> list[str]:
    """Choices of a map, as words of a command line.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.
    """
    return [
        word for choice in MAP_CHOICES for text in texts_of(arguments, choice) for word in (f"--{choice.name}", text)
    ]


def _is_job(path: str | PathLike[str]) -> bool:
    """Tell whether a job is given in the place of a map."""
    from ehdmaps.jobs.defaults import designated_job

    if designated_job(fspath(path)) is not None:
        return True
    if Path(path).suffix:
        return Path(path).suffix == ".toml"
    from ehdmaps.jobs.reader import shipped_jobs

    return fspath(path) in shipped_jobs()


def _of_file(path: str | PathLike[str]) -> EHDMap:
    """The map of a file."""
    from ehdmaps.maps.emap import open_map  # commands without a map look at their options by this module, too

    return open_map(path)


def _of_job(path: str | PathLike[str]) -> EHDMap:
    """The map of a job."""
    from ehdmaps.jobs.make.table_law import job_map
    from ehdmaps.jobs.reader import read_job

    return job_map(read_job(path), fspath(path))
