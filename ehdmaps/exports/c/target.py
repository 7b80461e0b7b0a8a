"""The target `c` of `ehdmaps export`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import get_args

from ehdmaps.errors import InputError
from ehdmaps.exports.c.kernel import BEYOND, KernelOptions, ProfileName, kernel_files
from ehdmaps.exports.target import Target, check_folder, origin, write_folder
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.law import LawKind, OutsidePolicy
from ehdmaps.units import quantity


def add_law_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of everything that is built on the kernel in C.

    Parameters
    ----------
    parser : argparse.ArgumentParser
        The parser of the command.
    """
    parser.add_argument(
        "--outside",
        choices=get_args(OutsidePolicy),
        default="error",
        help="outside the map: refuse calls (the default), or go on by the edge or the asymptote, with a status",
    )
    parser.add_argument("--clearance", metavar="LENGTH", help="diametral clearance; that of the map if left out")
    parser.add_argument("--slices", type=int, default=41, help="slices of a roller; 41 if left out")
    parser.add_argument("--profile", choices=get_args(ProfileName), default="iso", help="profile of the rollers")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of the target.

    Parameters
    ----------
    parser : argparse.ArgumentParser
        The parser of the command.
    """
    add_law_arguments(parser)
    parser.add_argument("--law", choices=get_args(LawKind), help="which contact; a roller between both if left out")
    parser.add_argument("--centrifugal", action="store_true", help="with centrifugal loads: three times as large")
    parser.add_argument("--prefix", default="ehd", help="what all names begin with; two maps in one program need two")


def options_of(arguments: argparse.Namespace) -> KernelOptions:
    """Options of a kernel from the arguments of `add_arguments`, or of `add_law_arguments` alone.

    Parameters
    ----------
    arguments : argparse.Namespace
        What was given.
    """
    return KernelOptions(
        kind=getattr(arguments, "law", None),
        outside=arguments.outside,
        centrifugal=getattr(arguments, "centrifugal", False),
        clearance=None if arguments.clearance is None else quantity(arguments.clearance, "m"),
        slices=arguments.slices,
        profile=arguments.profile,
        prefix=getattr(arguments, "prefix", "ehd"),
    )


def write(emap: EHDMap, path: Path, output: Path | None, arguments: argparse.Namespace) -> str:
    """Write the sources of a map into a folder.

    Parameters
    ----------
    emap : EHDMap
        The map.
    path : Path
        File of the map.
    output : Path or None
        The folder, beside the map if not given; a file NAME.c for a small table in its place.
    arguments : argparse.Namespace
        Options of the target.
    """
    options = options_of(arguments)
    if output is not None and output.suffix == ".c":
        from ehdmaps.exports.c.small import write_small

        if options.outside != "error" or options.centrifugal:
            raise InputError(
                f"-o: {output} is a small table, which has no --centrifugal, and no --outside but error; allowed: a "
                "folder, for the whole kernel"
            )
        return write_small(emap, path, output, origin(emap, path.name), options.prefix, options.kind)
    folder = output or path.with_name(f"{options.prefix}_{path.stem}")
    check_folder(folder, [path])
    files = kernel_files(emap, options, origin(emap, path.name, BEYOND[options.outside]))
    write_folder(folder, files)
    return f"{folder}: written ({', '.join(sorted(files))})"


TARGET = Target(
    summary="law and bearing in C99, one source, one header, no library; Fortran interface; -o NAME.c: a small table",
    writes="a folder of C sources, or one file",
    read_back_by="gcc, gfortran",
    add_arguments=add_arguments,
    write=write,
)
