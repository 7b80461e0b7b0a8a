"""The file of a unit: sources, binaries and texts in one archive."""

from __future__ import annotations

import hashlib
import html
import io
import re
import tempfile
import uuid
import zipfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.exports.fmu.binaries import compiled, platforms, universal
from ehdmaps.exports.fmu.description import KIND, Identity, build_description, model_description
from ehdmaps.exports.fmu.variables import Variable
from ehdmaps.outputs import MARK, Kind, written_aside
from ehdmaps.program import tell
from ehdmaps.version import version

_BEGINNING = (1980, 1, 1, 0, 0, 0)
_DESCRIPTION = "modelDescription.xml"
_SOURCES = "sources/"


@dataclass(frozen=True)
class Content:
    """Content of a unit, before anything is compiled.

    Attributes
    ----------
    words : str
        Description in a line.
    checksum : str
        Version of what it was made from.
    variables : tuple of Variable
        Variables, in the order of `variables.h`.
    start : mapping of str to float
        Values at the start of variables that do not start at zero.
    films : tuple of str
        Names of the states of films with memory.
    sources : mapping of str to str
        Texts of the sources by the names of their files: the kernel, `variables.h` and `motion.c`.
    defines : str
        Constants of `identity.h`, beside the token.
    sentences : tuple of str
        Axes, signs and limits, for people.
    beyond : str
        What happens outside of what the law was made for, for people.
    header : tuple of str
        Lines that say where the unit comes from.
    exchanges : bool
        Whether there is Model Exchange, beside Co-Simulation.
    """

    words: str
    checksum: str
    variables: tuple[Variable, ...]
    start: Mapping[str, float]
    films: tuple[str, ...]
    sources: Mapping[str, str]
    defines: str
    sentences: tuple[str, ...]
    beyond: str
    header: tuple[str, ...]
    exchanges: bool = True


def write_unit(path: Path, content: Content, fmi: str, sources_only: bool = False) -> str:
    """Write a unit, and return what was written in words.

    Parameters
    ----------
    path : Path
        File of the unit.
    content : Content
        Content of the unit.
    fmi : {"2", "3"}
        Version of the standard.
    sources_only : bool
        Whether nothing is compiled.

    Raises
    ------
    InputError
        If a compiler fails, or the file may not be written.
    """
    identity = _identity(content, path.stem, fmi)
    entries, inside = _compiled(identity, fmi, _unit_files(content, identity, fmi), sources_only)
    with written_aside(path, UNIT) as aside:
        aside.write_bytes(_zipped(entries))
    return f"{path}: written (FMI {KIND[fmi]}: {inside})"


def _identity(content: Content, stem: str, fmi: str) -> Identity:
    """Name and token of a unit; the same for the same content and program."""
    parts = [version(), fmi, repr(sorted(content.start.items())), repr(content.films), *content.sources.values()]
    name = re.sub(r"\W", "_", stem, flags=re.ASCII)
    return Identity(
        name=name if name[:1].isalpha() else f"bearing_{name}",
        token="{" + str(uuid.UUID(hashlib.sha256("\n".join(parts).encode()).hexdigest()[:32])) + "}",
        words=content.words,
        tool=f"{MARK} {version()}",
        version=content.checksum[:16],
    )


def _unit_files(content: Content, identity: Identity, fmi: str) -> dict[str, str]:
    """Return all files of a unit but its binaries."""
    own = files("ehdmaps.exports.fmu")
    texts = {name: own / name for name in (f"fmi{fmi}.c", "component.c", "component.h")}
    texts |= {entry.name: entry for entry in (own / "headers").iterdir() if entry.name.startswith(f"fmi{fmi}")}
    written = {**content.sources, **{name: entry.read_text(encoding="utf-8") for name, entry in texts.items()}}
    written["identity.h"] = (
        f'#ifndef IDENTITY_H\n#define IDENTITY_H\n\n#define FMU_TOKEN "{identity.token}"\n{content.defines}\n#endif\n'
    )
    to_compile = _to_compile(written)
    if fmi == "3":
        written["buildDescription.xml"] = build_description(identity, to_compile)
    return {
        **{f"{_SOURCES}{name}": text for name, text in written.items()},
        _DESCRIPTION: model_description(
            fmi, identity, content.variables, to_compile, content.start, content.films, exchanges=content.exchanges
        ),
        "documentation/index.html": _page(identity, content),
    }


def _to_compile(names: Iterable[str]) -> tuple[str, ...]:
    """Return the files that a compiler takes, in order."""
    return tuple(sorted(name for name in names if name.endswith(".c")))


def _compiled(
    identity: Identity, fmi: str, unit_files: Mapping[str, str], sources_only: bool
) -> tuple[dict[str, bytes], str]:
    """Return all files of a unit with its binaries, and what is inside in words."""
    entries, inside = {name: text.encode() for name, text in unit_files.items()}, ["sources"]
    if sources_only:
        return entries, ", ".join(inside)
    sources = {name.removeprefix(_SOURCES): text for name, text in unit_files.items() if name.startswith(_SOURCES)}
    try:
        with tempfile.TemporaryDirectory() as folder:
            for name, text in sources.items():
                (Path(folder) / name).write_text(text, encoding="utf-8")
            places: dict[str, list[bytes]] = {}
            for target in platforms():
                place = target.name if fmi == "2" else target.folder
                if not place or not target.compiler:
                    continue
                if "ziglang" in target.compiler:
                    tell(f"ehdmaps: compiling for {target.folder}, the first time a minute or two")
                library = compiled(target, Path(folder), _to_compile(sources), identity.name)
                places.setdefault(f"binaries/{place}/{identity.name}{target.ending}", []).append(library)
                inside.append(target.folder)
            entries |= {name: parts[0] if len(parts) == 1 else universal(parts) for name, parts in places.items()}
            if not all(target.compiler for target in platforms()):
                inside.append("none for other systems, for which the package ziglang compiles: pip install ziglang")
    except OSError as error:
        raise InputError(
            f"export fmu: cannot compile in the folder for temporary files ({error.strerror or error}); it takes some "
            "MB there: make room, set TMPDIR to another folder, or take --sources-only where a command has it"
        ) from error
    return entries, ", ".join(inside)


def _page(identity: Identity, content: Content) -> str:
    """Documentation of a unit, for people."""

    def listed(lines: tuple[str, ...]) -> str:
        return "".join(f"<li>{html.escape(line)}</li>\n" for line in lines)

    rows = "".join(
        f"<tr><td>{v.name}</td><td>{v.causality}</td><td>{v.unit}</td><td>{html.escape(v.words)}</td></tr>\n"
        for v in content.variables
    )
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{html.escape(identity.name)}</title>'
        f"</head><body>\n<h1>{html.escape(identity.name)}</h1>\n<p>{html.escape(identity.words)}</p>\n"
        f"<h2>Axes, signs, limits</h2>\n<ul>\n{listed(content.sentences)}</ul>\n"
        f"<p>{html.escape(content.beyond)}</p>\n"
        f"<h2>Variables</h2>\n<table>\n{rows}</table>\n"
        f"<h2>Where it comes from</h2>\n<ul>\n{listed(content.header)}</ul>\n"
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
