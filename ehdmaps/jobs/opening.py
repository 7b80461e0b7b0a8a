"""Open the map of a command, by the structural law that its option --structure names."""

from __future__ import annotations

from os import PathLike

from ehdmaps.errors import InputError
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.physics.approach import STRUCTURAL_LAWS
from ehdmaps.units import closest


def open_given(path: str | PathLike[str], structure: str | None) -> EHDMap:
    """Open a map.

    Parameters
    ----------
    path : str or path
        The file.
    structure : str or None
        What was given for --structure; None for the structural law of the map's job.

    Raises
    ------
    MapError
        If the file cannot be read, is no map, or was changed since it was made.
    InputError
        If there is no such structural law, or it does not suit the map.
    """
    known = {law: law for law in STRUCTURAL_LAWS}
    if structure is not None and structure not in known:
        raise InputError(
            f"--structure: got {structure!r:.60}{closest(structure, STRUCTURAL_LAWS)}; allowed: "
            f"{', '.join(STRUCTURAL_LAWS)}"
        )
    emap = open_map(path)
    try:
        return emap if structure is None else emap.with_structure(known[structure])
    except InputError as error:
        raise InputError([f"--structure: {problem}" for problem in error.problems]) from error
