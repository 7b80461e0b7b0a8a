"""Open the map of a command, by the structural law that its option --structure names."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING

from ehdmaps.errors import InputError
from ehdmaps.jobs.surface import surface_from_text
from ehdmaps.physics.approach import STRUCTURAL_LAWS
from ehdmaps.physics.roughness import Surface
from ehdmaps.units import closest

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap


def open_given(path: str | PathLike[str], structure: str | None, roughness: str | None = None) -> EHDMap:
    """Open a map.

    Parameters
    ----------
    path : str or path
        The file.
    structure : str or None
        What was given for --structure; None for the structural law of the map's job.
    roughness : str or None
        What was given for --roughness; None for the surfaces of the map's job.

    Raises
    ------
    MapError
        If the file cannot be read, is no map, or was changed since it was made.
    InputError
        If there is no such structural law, or it does not suit the map; if the roughness is none.
    """
    known = {law: law for law in STRUCTURAL_LAWS}
    if structure is not None and structure not in known:
        raise InputError(
            f"--structure: got {structure!r:.60}{closest(structure, STRUCTURAL_LAWS)}; allowed: "
            f"{', '.join(STRUCTURAL_LAWS)}"
        )
    surface = None if roughness is None else surface_given(roughness)
    from ehdmaps.maps.emap import open_map  # commands without a map look at their options by this module, too

    emap = open_map(path)
    if surface is not None:
        emap = emap.with_surface(surface)
    try:
        return emap if structure is None else emap.with_structure(known[structure])
    except InputError as error:
        raise InputError([f"--structure: {problem}" for problem in error.problems]) from error


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
