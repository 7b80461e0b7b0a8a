"""Exports that are folders: written whole or not at all, and replaced only where they were made by an export."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.outputs import has_mark


def check_folder(path: Path, read: Iterable[Path] = ()) -> None:
    """Refuse a folder that may not be written, before anything is computed.

    Parameters
    ----------
    path : Path
        The folder of `-o`. It may be there if it is empty, or holds nothing but files with our mark.
    read : iterable of Path
        Files that the command reads; none may lie in it.

    Raises
    ------
    InputError
        With the reason and what to do.
    """
    what = f"-o: got {str(path)!r:.300}"
    parent = Path(os.path.realpath(path)).parent
    if not parent.is_dir():
        raise InputError(f"{what}, but {parent} is no folder; allowed: a new folder in one that exists")
    if not path.exists() and not path.is_symlink():
        return
    if path.is_symlink() or not path.is_dir():
        raise InputError(f"{what}, which is there and is no folder; allowed: a new folder; choose another name")
    place = path.resolve()
    for name in read:
        if place == name.resolve().parent:
            raise InputError(f"{what}, which holds {name}, which is read; choose another name")
    foreign = sorted(entry.name for entry in path.iterdir() if not _ours(entry))
    if foreign:
        raise InputError(
            f"{what}, which holds {foreign[0]!r}, which no export made; allowed: a new folder, or one that holds an "
            "export and nothing else; choose another name, or remove it"
        )


def write_folder(path: Path, files: Mapping[str, str]) -> None:
    """Write a folder of texts, which carry our mark themselves; a folder that was there is replaced.

    Parameters
    ----------
    path : Path
        The folder; look at it with `check_folder` first.
    files : mapping of str to str
        Texts by the names of their files.

    Raises
    ------
    InputError
        If it may not be replaced or cannot be written.
    """
    target = Path(os.path.realpath(path))
    aside, before = (target.with_name(f".{target.name[:100]}.{os.getpid()}.{kind}") for kind in ("part", "old"))
    try:
        try:
            aside.mkdir()
            for name, text in files.items():
                (aside / name).write_text(text, encoding="utf-8")
            check_folder(path)  # something may have come while we computed
            if target.exists():
                target.rename(before)
            aside.rename(target)
        finally:
            shutil.rmtree(aside, ignore_errors=True)
            if before.exists() and not target.exists():
                before.rename(target)
            shutil.rmtree(before, ignore_errors=True)
    except OSError as error:
        raise InputError(
            f"{path}: cannot be written ({error.strerror or error}); allowed: a new folder in one that may be written, "
            "with space on the disk"
        ) from error


def _ours(entry: Path) -> bool:
    """Whether an entry of a folder is a file that an export made."""
    return entry.is_file() and not entry.is_symlink() and has_mark(entry)
