"""The target `fmu` of `ehdmaps export`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.exports.c.kernel import BEYOND, KernelOptions, kernel_files
from ehdmaps.exports.c.target import add_law_arguments, options_of
from ehdmaps.exports.c.text import template
from ehdmaps.exports.fmu.description import KIND
from ehdmaps.exports.fmu.unit import UNIT, Content, write_unit
from ehdmaps.exports.fmu.variables import DEVIATING, LAG, MEMORY, MOTION, SLOW, VARIABLES, film_names
from ehdmaps.exports.target import Target, origin
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.outputs import Output, check_outputs

_USUAL_TEMPERATURE = 313.15
_BEYOND = (
    "Outside the map calls are discarded, or held at its edge with a warning, as it was chosen when the unit was made; "
    "the log says which value was outside."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of the target.

    Parameters
    ----------
    parser : argparse.ArgumentParser
        The parser of the command.
    """
    parser.add_argument("--fmi", choices=tuple(KIND), default="2", help="version of the standard; 2 if left out")
    parser.add_argument(
        "--films",
        choices=("slow", "memory"),
        default="slow",
        help="slow: films follow at once (the default); memory: they need time, with a state for each slice",
    )
    parser.add_argument("--sources-only", action="store_true", help="compile nothing")
    add_law_arguments(parser)


def write(emap: EHDMap, path: Path, output: Path | None, arguments: argparse.Namespace) -> str:
    """Write the unit of a map.

    Parameters
    ----------
    emap : EHDMap
        The map.
    path : Path
        File of the map.
    output : Path or None
        File of the unit; beside the map if not given.
    arguments : argparse.Namespace
        Options of the target.
    """
    unit = output or path.with_suffix(".fmu")
    check_outputs([Output("-o", unit, UNIT)], [path])
    memory, sources_only = arguments.films == "memory", arguments.sources_only
    return write_map_unit(emap, path.name, unit, options_of(arguments), arguments.fmi, memory, sources_only)


def write_map_unit(
    emap: EHDMap,
    name: str,
    unit: Path,
    options: KernelOptions,
    fmi: str,
    memory: bool = False,
    sources_only: bool = False,
    deviations: Any | None = None,
) -> str:
    """Write the unit of a bearing with the law of a map, and return what was written in words.

    Parameters
    ----------
    emap : EHDMap
        The map.
    name : str
        Name of its file.
    unit : Path
        File of the unit.
    options : KernelOptions
        What is exported of the map.
    fmi : {"2", "3"}
        Version of the standard.
    memory : bool
        Whether films have states.
    sources_only : bool
        Whether nothing is compiled.
    deviations : record or None
        Deviations of the bearing from its form, see `ehdmaps.exports.c.deviations`.

    Raises
    ------
    InputError
        For the map of a bare contact; if a compiler fails, or the file may not be written.
    """
    if emap.bearing is None:
        raise InputError("export fmu: got a map of a bare contact; allowed: the map of a bearing")
    header = origin(emap, name, BEYOND[options.outside])
    texts = kernel_files(emap, options, header, deviations)
    kernel = {name: text for name, text in texts.items() if name.endswith((".c", ".h"))}
    own = {name: template("ehdmaps.exports.fmu", name) for name in ("motion.c", "variables.h")}
    cold, hot = (float(emap.dataset["temperature"].values[end]) for end in (0, -1))
    clearance = emap.bearing.diametral_clearance if options.clearance is None else options.clearance
    start = {"temperature": min(max(_USUAL_TEMPERATURE, cold), hot), "clearance": clearance}
    films = film_names(emap.bearing.rolling_elements, options.slices) if memory else ()
    content = Content(
        words=str(emap.dataset.attrs.get("title", "EHD map of a bearing")),
        checksum=str(emap.dataset.attrs.get(schema.CHECKSUM, "")),
        variables=VARIABLES,
        start=start,
        films=films,
        sources={**kernel, **own},
        defines=f"#define FMU_START {{[TEMPERATURE] = {start['temperature']!r}, [CLEARANCE] = EHD_CLEARANCE}}\n"
        f"#define FMU_MEMORY {int(bool(films))} /* whether films have states */\n",
        sentences=(*MOTION, *([DEVIATING] if deviations else []), MEMORY if films else SLOW, LAG),
        beyond=_BEYOND,
        header=header,
    )
    return write_unit(unit, content, fmi, sources_only)


TARGET = Target(
    summary="Functional Mock-up Unit by FMI 2.0 or 3.0, Model Exchange and Co-Simulation",
    writes="MAP.fmu",
    read_back_by="FMPy",
    add_arguments=add_arguments,
    write=write,
)
