"""The target `simpack`: a folder of the kernel in C and a user force over it.

Simpack does not read it back: the interface is that of a public user routine, and the tests call it through a stand-in
for the program.
"""

from __future__ import annotations

import argparse
from importlib.resources import files
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.exports.c.kernel import BEYOND, kernel_files
from ehdmaps.exports.c.target import add_law_arguments, options_of
from ehdmaps.exports.target import BEARING_AXES, Target, check_folder, origin, write_folder
from ehdmaps.maps.emap import EHDMap

_SOURCES = ("simpack.f90", "bearing_slot.h", "bearing_slot.c", "film_history.h", "film_history.c")
_BUILD = (
    "Simpack: simpack.f90 says its parameters, axes and units.",
    "Compile simpack.f90 with the module simpack of your installation, ehd.c, bearing_slot.c and film_history.c into "
    "user routines.",
)


def write(emap: EHDMap, path: Path, output: Path | None, arguments: argparse.Namespace) -> str:
    """Write the folder; returns what was written in words.

    Parameters
    ----------
    emap : EHDMap
        A map of a bearing.
    path : Path
        File of the map.
    output : Path or None
        The folder; by default one beside the map.
    arguments : argparse.Namespace
        Arguments of `add_law_arguments`.

    Raises
    ------
    InputError
        For a map of a bare contact, and for a folder that is something else.
    """
    if emap.bearing is None:
        raise InputError("export simpack: the map is of a bare contact line; allowed: a map of a bearing")
    options = options_of(arguments)
    folder = output or path.with_name(f"simpack_{path.stem}")
    check_folder(folder, [path])
    header = origin(emap, path.name, BEYOND[options.outside])
    written = dict(kernel_files(emap, options, header))
    for name in _SOURCES:
        begin, end = ("! ", "") if name.endswith(".f90") else ("/* ", " */")
        text = (files("ehdmaps.exports.simpack") / name).read_text(encoding="utf-8")
        written[name] = f"{begin}{header[0]}{end}\n{text}"
    written["README.txt"] = "\n".join([*header, "", *BEARING_AXES, "", *_BUILD]) + "\n"
    write_folder(folder, written)
    return f"{folder}: written ({', '.join(sorted(written))})"


TARGET = Target(
    summary="user routine of Simpack over the kernel in C",
    writes="a folder of sources",
    read_back_by="",
    add_arguments=add_law_arguments,
    write=write,
)
