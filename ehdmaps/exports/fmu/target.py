"""The target `fmu` of `ehdmaps export`."""

from __future__ import annotations

import argparse
import hashlib
import html
import io
import re
import tempfile
import uuid
import zipfile
from collections.abc import Iterable, Mapping
from importlib.resources import files
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.exports.c.kernel import BEYOND, kernel_files
from ehdmaps.exports.c.target import add_law_arguments, options_of
from ehdmaps.exports.fmu.binaries import compiled, platforms
from ehdmaps.exports.fmu.description import KIND, Identity, build_description, model_description
from ehdmaps.exports.fmu.variables import LAG, MEMORY, MOTION, SLOW, VARIABLES, film_names
from ehdmaps.exports.target import Target, origin
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.outputs import MARK, Kind, Output, check_outputs, written_aside
from ehdmaps.version import version

_USUAL_TEMPERATURE = 313.15
_BEGINNING = (1980, 1, 1, 0, 0, 0)
_DESCRIPTION = "modelDescription.xml"
_SOURCES = "sources/"


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
    if emap.bearing is None:
        raise InputError("export fmu: got a map of a bare contact; allowed: the map of a bearing")
    options, unit = options_of(arguments), output or path.with_suffix(".fmu")
    check_outputs([Output("-o", unit, UNIT)], [path])
    header = origin(emap, path.name, BEYOND[options.outside])
    sources = {name: text for name, text in kernel_files(emap, options, header).items() if name.endswith((".c", ".h"))}
    cold, hot = (float(emap.dataset["temperature"].values[end]) for end in (0, -1))
    clearance = emap.bearing.diametral_clearance if options.clearance is None else options.clearance
    start = {"temperature": min(max(_USUAL_TEMPERATURE, cold), hot), "clearance": clearance}
    films = film_names(emap.bearing.rollers, options.slices) if arguments.films == "memory" else ()
    identity = _identity(emap, path, arguments.fmi, sources, start, films)
    unit_files = _unit_files(identity, arguments.fmi, sources, start, films, header)
    entries, words = _compiled(identity, arguments.fmi, unit_files, arguments.sources_only)
    with written_aside(unit, UNIT) as aside:
        aside.write_bytes(_zipped(entries))
    return f"{unit}: written (FMI {KIND[arguments.fmi]}: {words})"


def _identity(
    emap: EHDMap,
    path: Path,
    fmi: str,
    sources: Mapping[str, str],
    start: Mapping[str, float],
    films: tuple[str, ...],
) -> Identity:
    """Name and token of a unit; the same for the same map, options and program."""
    text = "\n".join([version(), fmi, repr(sorted(start.items())), repr(films), *sources.values()])
    stem = re.sub(r"\W", "_", path.stem, flags=re.ASCII)
    return Identity(
        name=stem if stem[:1].isalpha() else f"bearing_{stem}",
        token="{" + str(uuid.UUID(hashlib.sha256(text.encode()).hexdigest()[:32])) + "}",
        words=str(emap.dataset.attrs.get("title", "EHD map of a bearing")),
        tool=f"{MARK} {version()}",
        version=str(emap.dataset.attrs.get(schema.CHECKSUM, ""))[:16],
    )


def _unit_files(
    identity: Identity,
    fmi: str,
    sources: Mapping[str, str],
    start: Mapping[str, float],
    films: tuple[str, ...],
    header: tuple[str, ...],
) -> dict[str, str]:
    """Return all files of a unit but its binaries."""
    own = files("ehdmaps.exports.fmu")
    texts = {name: own / name for name in ("component.c", "component.h", f"fmi{fmi}.c")}
    texts |= {entry.name: entry for entry in (own / "headers").iterdir() if entry.name.startswith(f"fmi{fmi}")}
    written = {**sources, **{name: entry.read_text(encoding="utf-8") for name, entry in texts.items()}}
    written["identity.h"] = (
        "#ifndef IDENTITY_H\n#define IDENTITY_H\n\n"
        f'#define FMU_TOKEN "{identity.token}"\n#define EHD_START_TEMPERATURE {start["temperature"]!r}\n'
        f"#define FMU_MEMORY {int(bool(films))} /* whether films have states */\n\n#endif\n"
    )
    to_compile = _to_compile(written)
    if fmi == "3":
        written["buildDescription.xml"] = build_description(identity, to_compile)
    return {
        **{f"{_SOURCES}{name}": text for name, text in written.items()},
        _DESCRIPTION: model_description(fmi, identity, to_compile, start, films),
        "documentation/index.html": _page(identity, header, MEMORY if films else SLOW),
    }


def _to_compile(names: Iterable[str]) -> tuple[str, ...]:
    """Return the files that a compiler takes, in order."""
    return tuple(sorted(name for name in names if name.endswith(".c")))


def _compiled(
    identity: Identity, fmi: str, unit_files: Mapping[str, str], sources_only: bool
) -> tuple[dict[str, bytes], str]:
    """Return all files of a unit with its binaries, and what is inside in words."""
    entries, inside = {name: text.encode() for name, text in unit_files.items()}, ["sources"]
    sources = {name.removeprefix(_SOURCES): text for name, text in unit_files.items() if name.startswith(_SOURCES)}
    with tempfile.TemporaryDirectory() as folder:
        for name, text in sources.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        for target in () if sources_only else platforms():
            if not target.compiler:
                inside.append(f"no {target.name}, for which no compiler is found")
                continue
            place = target.name if fmi == "2" else target.folder
            library = compiled(target, Path(folder), _to_compile(sources), identity.name)
            entries[f"binaries/{place}/{identity.name}{target.ending}"] = library
            inside.append(target.name)
    return entries, ", ".join(inside)


def _page(identity: Identity, header: tuple[str, ...], films: str) -> str:
    """Documentation of a unit, for people."""

    def listed(lines: tuple[str, ...]) -> str:
        return "".join(f"<li>{html.escape(line)}</li>\n" for line in lines)

    rows = "".join(
        f"<tr><td>{v.name}</td><td>{v.causality}</td><td>{v.unit}</td><td>{html.escape(v.words)}</td></tr>\n"
        for v in VARIABLES
    )
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{html.escape(identity.name)}</title>'
        f"</head><body>\n<h1>{html.escape(identity.name)}</h1>\n<p>{html.escape(identity.words)}</p>\n"
        f"<h2>Axes, signs, limits</h2>\n<ul>\n{listed((*MOTION, films, LAG))}</ul>\n"
        "<p>Outside the map calls are discarded, or held at its edge with a warning, as it was chosen when the unit "
        "was made; the log says which value was outside.</p>\n"
        f"<h2>Variables</h2>\n<table>\n{rows}</table>\n<h2>Where it comes from</h2>\n<ul>\n{listed(header)}</ul>\n"
        "<p>The headers of FMI in sources/ are under the 2-clause BSD licence that they carry.</p>\n</body></html>\n"
    )


def _zipped(entries: Mapping[str, bytes]) -> bytes:
    """Return an archive of files, the same for the same files."""
    room = io.BytesIO()
    with zipfile.ZipFile(room, "w") as archive:
        for name in sorted(entries, key=lambda name: (name != _DESCRIPTION, name)):
            entry = zipfile.ZipInfo(name, _BEGINNING)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, entries[name])
    return room.getvalue()


def _ours(path: Path) -> bool:
    """Tell whether a file is a unit that an export made."""
    try:
        with zipfile.ZipFile(path) as archive:
            return f'generationTool="{MARK}'.encode() in archive.read(_DESCRIPTION)
    except (zipfile.BadZipFile, KeyError):
        return False


UNIT = Kind("a unit of ehdmaps", (".fmu",), _ours)

TARGET = Target(
    summary="Functional Mock-up Unit by FMI 2.0 or 3.0, Model Exchange and Co-Simulation",
    writes="MAP.fmu",
    read_back_by="FMPy",
    add_arguments=add_arguments,
    write=write,
)
