"""Files that the programs write: which file may be replaced, and how it is done. One rule for every writer.

A file is replaced only where it is a regular file, none of those that the command reads, and one that a program of this
distribution made as the same kind of thing: a map for a map, a figure for a figure. An empty file may be filled. Every
file carries a mark of its kind, so that this can be told from the file alone. Files are written aside in the same
folder, brought to the disk and renamed: what stood there is replaced whole, or not at all. Aside is a new file with a
name that nobody can guess, so that nothing else is written to; those of writers that were killed are removed later.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import re
import secrets
import stat
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.netcdf_structure import DAMAGE, opened

MARK = "made by ehdmaps"
"""What files of text and figures carry."""

_SOUGHT = 4096
"""The mark of a text stands in its first bytes; that of a figure stands there or in its last ones."""

_WRITABLE = 0o222
"""A file without these bits is protected on purpose, from root too."""

_PART = re.compile(r"\.ehdmaps-([0-9]{1,10})-[0-9a-f]{16}\.part(?:\..*)?", re.DOTALL)
"""Names of files that are being written, with the process that does."""

_LONGEST_ENDING = 16
"""Characters: what writers look at is shorter, and a name must not become too long for the file system."""

_LEFT_SECONDS = 3600.0
"""A file that nobody wrote to for so long, by a process that is no more, was left: here or on another machine."""

RESOLUTION = 150
"""Dots an inch of figures."""

_FIGURE_KEYS = {".png": "Software", ".pdf": "Creator", ".svg": "Creator"}


@dataclass(frozen=True)
class Kind:
    """Kind of a file.

    Attributes
    ----------
    name : str
        Name in words, with its article, such as "a map of ehdmaps".
    endings : tuple of str
        Endings that a name may have, in lower case; empty for any.
    ours : callable
        Tells of an existing regular file whether a program of this distribution made it as this kind.
    """

    name: str
    endings: tuple[str, ...]
    ours: Callable[[Path], bool]


@dataclass(frozen=True)
class Output:
    """A file that a command is asked to write.

    Attributes
    ----------
    option : str
        That names it, such as "--plot"; begins the messages.
    path : str or Path or None
        Path as it was given; None if it was not.
    kind : Kind
        What it will be.
    """

    option: str
    path: str | Path | None
    kind: Kind


def output_problems(outputs: Iterable[Output], read: Iterable[str | Path] = ()) -> list[str]:
    """Tell what is wrong about the files to be written, before anything is computed, so that no result is lost by it.

    Parameters
    ----------
    outputs : iterable of Output
        All files of a command; those without a path are passed over.
    read : iterable of str or Path
        All files that the command reads. Names that are no files (of shipped jobs, say) do no harm.

    Returns
    -------
    list of str
        One sentence a problem.
    """
    problems: list[str] = []
    taken: dict[object, str] = {place: f"{path}, which is read" for path in read if (place := _place(path)) is not None}
    for output in outputs:
        if output.path is None:
            continue
        problem = _problem(output, taken)
        if problem:
            problems.append(problem)
            continue
        # A file that is not there yet is known by its name.
        taken.setdefault(_place(output.path) or os.path.realpath(output.path), f"the file of {output.option}")
    return problems


def name_problem(path: Path) -> str:
    """Tell why nothing may be written under a name, whatever is there; empty if it may.

    Parameters
    ----------
    path : Path
        A file or a folder.
    """
    if not path.name.isprintable():
        return "whose name is not printable; allowed: a name of printable characters; rename it"
    if '"' in path.name and path.suffix.lower() == ".c":
        return f"which is {path.name[:300]}; allowed: no quotation mark, which ends the header's name in C; rename it"
    place = os.path.realpath(path)
    if "\\" in place:
        return (
            f"which is {place[:300]}; allowed: no backslash in names of files and folders, as netCDF takes it for the "
            "end of a folder's name; rename it"
        )
    return ""


def check_outputs(outputs: Iterable[Output], read: Iterable[str | Path] = ()) -> None:
    """Raise what `output_problems` finds.

    Raises
    ------
    InputError
        With every problem.
    """
    problems = output_problems(outputs, read)
    if problems:
        raise InputError(problems)


@contextlib.contextmanager
def written_aside(path: str | Path, kind: Kind, advice: str = "") -> Iterator[Path]:
    """Give the place to write to; at the end of the block it becomes the file, or nothing is changed.

    Parameters
    ----------
    path : str or Path
        The file; where it is a symbolic link, the file that it leads to.
    kind : Kind
        What is written.
    advice : str
        What to do besides where it cannot be written.

    Yields
    ------
    Path
        A new, empty file in the same folder, with the same ending.

    Raises
    ------
    InputError
        If the file may not be replaced (see the module), or cannot be written.
    """
    problem = _problem(Output("", path, kind), {})
    if problem:
        raise InputError(problem)
    target = Path(os.path.realpath(path))
    _remove_left_parts(target.parent)
    try:
        aside, descriptor = new_part(target)
        os.close(descriptor)
        try:
            yield aside
            _sync(aside)
            problem = _problem(Output("", path, kind), {})
            if problem:  # it came while we computed
                raise InputError(problem)
            aside.replace(target)
        finally:
            aside.unlink(missing_ok=True)
        _sync(target.parent)
    except (OSError, RuntimeError, ValueError) as error:
        # netCDF4 reports a full disk as a RuntimeError, matplotlib some of its own as a ValueError.
        cause = getattr(error, "strerror", None) or str(error) or type(error).__name__
        raise InputError(
            f"{path}: cannot be written ({cause}); allowed: a file in a folder that may be written, with space on the "
            f"disk{'; ' if advice else ''}{advice}"
        ) from error


def new_part(target: Path) -> tuple[Path, int]:
    """Make the file that becomes another one: new, whatever stands in the folder, and under a random name.

    Parameters
    ----------
    target : Path
        What it is to become.

    Returns
    -------
    path : Path
        The new file, in the same folder and with the same ending.
    descriptor : int
        File descriptor of it, open for writing.

    Raises
    ------
    OSError
        If it cannot be made.
    """
    ending = target.suffix[:_LONGEST_ENDING]
    path = target.with_name(f".ehdmaps-{os.getpid()}-{secrets.token_hex(8)}.part{ending}")
    return path, os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666)


def write_text(path: str | Path, text: str, kind: Kind) -> None:
    """Write a text in UTF-8 that carries its mark itself.

    Parameters
    ----------
    path : str or Path
        File to write.
    text : str
        What to write.
    kind : Kind
        Kind of file, by which a later run knows that it may replace it.

    Raises
    ------
    InputError
        If it may not be replaced, or cannot be written.
    """
    with written_aside(path, kind) as aside:
        aside.write_text(text, encoding="utf-8")


def write_figure(figure: Any, path: str | Path) -> None:
    """Write a figure of matplotlib as png, pdf or svg, by the ending of its name.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    path : str or Path
        The file.

    Raises
    ------
    InputError
        If it may not be replaced, or cannot be written.
    """
    import matplotlib as mpl

    from ehdmaps.figures import without_latex

    with written_aside(path, FIGURE) as aside, mpl.rc_context({"text.usetex": False}):  # of texts that drawing makes
        without_latex(figure)
        ending = aside.suffix.lower()
        figure.savefig(aside, format=ending[1:], dpi=RESOLUTION, metadata={_FIGURE_KEYS[ending]: MARK})


def cache_folder(name: str, variable: str, environment: Mapping[str, str]) -> Path:
    """Return the folder in which something is kept that can be made again.

    Parameters
    ----------
    name : str
        Name of the folder in our part of the user's folder for caches, `${XDG_CACHE_HOME:-~/.cache}/ehdmaps`.
    variable : str
        Environment variable that names another folder.
    environment : mapping of str to str
        The environment.
    """
    if own := environment.get(variable):
        return Path(own).expanduser()
    caches = Path(environment.get("XDG_CACHE_HOME", ""))
    # a relative one is to be ignored, says the specification: it would be a folder of whoever made the current one
    return (caches if caches.is_absolute() else Path("~/.cache").expanduser()) / "ehdmaps" / name


def own_folder(folder: Path) -> Path:
    """Make a folder for what is kept, if it is not there, and refuse one in which others may have put something.

    Parameters
    ----------
    folder : Path
        The folder.

    Raises
    ------
    PermissionError
        If it, or the link to it, belongs to somebody else, or others may write there.
    OSError
        If it cannot be made.
    """
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    if others := others_may_write(folder):
        raise PermissionError(others)
    return folder


def others_may_write(path: Path) -> str:
    """Tell why what is kept there may be of somebody else; empty if it is of this user alone, or not there.

    The user is trusted, and root is; a group that has no other member is the user's own.

    Parameters
    ----------
    path : Path
        A folder, or a file.
    """
    if not hasattr(os, "getuid"):  # where there is no such user, homes are private
        return ""
    try:
        link, status = path.lstat(), path.stat()
    except OSError:
        return ""
    if not {link.st_uid, status.st_uid} <= {os.getuid(), 0}:
        return f"{path} belongs to somebody else"
    if status.st_mode & stat.S_IWOTH or (status.st_mode & stat.S_IWGRP and not _alone_in(status.st_gid)):
        return f"others may write in {path}: look at what is there, and take their right with chmod go-w"
    return ""


def _alone_in(group: int) -> bool:
    """Tell whether a group is this user's own."""
    import grp
    import pwd

    try:
        name = pwd.getpwuid(os.getuid()).pw_name
        found = grp.getgrgid(group)
    except KeyError:
        return False
    return found.gr_name == name and set(found.gr_mem) <= {name}


def sealed(text: str) -> str:
    """Return a text with a first line of comment by which a change by hand is noticed, see `SEALED`."""
    return f"{_seal(text)}\n{text}"


def _seal(text: str) -> str:
    """Return the first line of a text that a user may go on with."""
    digest = hashlib.sha256(text.encode()).hexdigest()
    return f"# {MARK}; replaced by it only as long as nobody edited it: sha256 {digest}"


def _has_seal(path: Path) -> bool:
    """Tell whether a text is as it was written."""
    head, _, text = path.read_text(encoding="utf-8").partition("\n")
    return head == _seal(text)


def has_mark(path: Path) -> bool:
    """Tell whether a file carries the mark near its beginning or its end."""
    with path.open("rb") as file:
        head = file.read(_SOUGHT)
        file.seek(max(path.stat().st_size - _SOUGHT, 0))
        return MARK.encode() in head + file.read(_SOUGHT)


def root_attributes(path: Path) -> dict[str, Any]:
    """Return the global attributes of a netCDF file; none if it is no such file."""
    try:
        with opened(path) as file:
            return {name: file.getncattr(name) for name in file.ncattrs()}
    except DAMAGE:
        return {}


MADE_AS = "made_as"
"""Global attribute of netCDF files other than maps: what the file is."""


NETCDF = (".nc", ".nc4", ".cdf", ".h5", "")
"""Endings of files in netCDF; a name may do without one."""


def dataset_kind(name: str, made_as: str, endings: tuple[str, ...] = NETCDF) -> Kind:
    """Return the kind of a netCDF file that says by its attribute `MADE_AS` what it is.

    Parameters
    ----------
    name : str
        How messages call the kind.
    made_as : str
        Value of the attribute `MADE_AS`.
    endings : tuple of str
        Endings that a path of this kind may have.
    """
    return Kind(name, endings, lambda path: root_attributes(path).get(MADE_AS) == made_as)


FIGURE = Kind("a figure of ehdmaps", tuple(_FIGURE_KEYS), has_mark)
SEALED = Kind("a job as it was planned", (".toml",), _has_seal)
FIELDS = Kind("film fields of ehdmaps", (".vtu", ".xdmf"), has_mark)
TABLE = Kind("a table of ehdmaps", (".csv",), has_mark)
MAP = Kind("a map of ehdmaps", NETCDF, lambda path: {"schema_version", "job_toml"} <= root_attributes(path).keys())


def _problem(output: Output, taken: dict[object, str]) -> str:
    """Tell in one sentence why a file may not be written; empty if it may."""
    text, kind = str(output.path), output.kind
    shown = text if text.isprintable() and text else repr(text)
    what = f"{output.option}: got {shown:.300}" if output.option else shown[:300]
    if not text or "\0" in text:
        return f"{what}; allowed: the path of a file"
    path = Path(text)
    if problem := name_problem(path):
        return f"{what}, {problem}"
    netcdf, ending = kind.endings == NETCDF, not kind.endings or path.suffix.lower() in kind.endings
    if not ending and not netcdf:
        return f"{what}; allowed: a file that ends in {', '.join(kind.endings)}"
    try:
        other = taken.get(_place(text) or os.path.realpath(text))
        if other:
            return f"{what}, which would be written over {other}; choose another name"
        if not ending:
            return f"{what}; allowed: a file in netCDF, which ends in {', '.join(filter(None, kind.endings))}"
        if os.path.isdir(text):
            return f"{what}, which is a folder; allowed: a file in it; add its name"
        folder = Path(os.path.realpath(text)).parent
        if not folder.is_dir():
            return f"{what}, but {path.parent} is no folder; allowed: a file in a folder that exists"
        try:
            status = os.stat(text)
        except FileNotFoundError:
            return ""
        if not stat.S_ISREG(status.st_mode):
            return f"{what}, which is no regular file; allowed: a file in a folder that exists"
        if status.st_size == 0:
            return ""
        if not status.st_mode & _WRITABLE or not os.access(text, os.W_OK):
            return f"{what}, which may not be written; choose another name, or change its permissions"
        if not kind.ours(path):
            return (
                f"{what}, which is there and is not {kind.name}; allowed: a new file, or one to replace that was "
                "made as that; choose another name, or remove it"
            )
    except (OSError, ValueError) as error:
        cause = getattr(error, "strerror", None) or str(error)
        return f"{what}, which cannot be looked at ({cause}); choose another name"
    return ""


def _remove_left_parts(folder: Path) -> None:
    """Remove files of ours that are being written no more: their writers were killed."""
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            match = _PART.fullmatch(entry.name)
            if match and entry.is_file(follow_symlinks=False):
                status = entry.stat(follow_symlinks=False)
                untouched = time.time() - status.st_mtime > _LEFT_SECONDS
                if untouched and status.st_uid == os.geteuid() and not _runs(int(match[1])):
                    os.unlink(entry.path)


def _runs(process: int) -> bool:
    """Tell whether a process of this number is there."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True


def _place(path: str | Path) -> tuple[int, int] | None:
    """Return what a file is known by, whatever names lead to it; None if it is not there."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return None
    return status.st_dev, status.st_ino


def _sync(path: Path) -> None:
    """Bring a file or a folder to the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
