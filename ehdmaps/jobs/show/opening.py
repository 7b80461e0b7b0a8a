"""Open the map of a command: a file, or a job whose map is made in memory, with films from the film table."""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING

from ehdmaps.errors import InputError
from ehdmaps.jobs.supply import surface_from_text
from ehdmaps.physics.approach import STRUCTURAL_LAWS
from ehdmaps.physics.surface import Surface
from ehdmaps.units import closest

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap


def open_given(path: str | PathLike[str], structure: str | None, roughness: str | None = None) -> EHDMap:
    """Open a map.

    Parameters
    ----------
    path : str or path
        The file of a map. Of a job, a file ending with .toml or the name of a shipped one, the map is made in memory,
        in about a second, where the film table serves it.
    structure : str or None
        What was given for --structure; None for the structural law of the map's job.
    roughness : str or None
        What was given for --roughness; None for the surfaces of the map's job.

    Raises
    ------
    MapError
        If the file cannot be read, is no map, or was changed since it was made.
    InputError
        If there is no such structural law, or it does not suit the map; if the roughness is none; if a job is wrong, or
        its films have to be solved.
    """
    known = {law: law for law in STRUCTURAL_LAWS}
    if structure is not None and structure not in known:
        raise InputError(
            f"--structure: got {structure!r:.60}{closest(structure, STRUCTURAL_LAWS)}; allowed: "
            f"{', '.join(STRUCTURAL_LAWS)}"
        )
    surface = None if roughness is None else surface_given(roughness)
    emap = _of_job(path) if _is_job(path) else _of_file(path)
    if surface is not None:
        emap = emap.with_surface(surface)
    try:
        return emap if structure is None else emap.with_structure(known[structure])
    except InputError as error:
        raise InputError([f"--structure: {problem}" for problem in error.problems]) from error


def _is_job(path: str | PathLike[str]) -> bool:
    """Tell whether a job is given in the place of a map."""
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


def surface_given(text: str) -> Surface:
    """Read what was given for --roughness.

    Parameters
    ----------
    text : str
        Combined rms roughness such as "0.2 um", or "smooth".

    Raises
    ------
    InputError
        If it is none.
    """
    try:
        return surface_from_text(text)
    except InputError as error:
        raise InputError([f"--roughness: {problem}" for problem in error.problems]) from error
