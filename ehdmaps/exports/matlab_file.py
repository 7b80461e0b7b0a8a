"""Files of MATLAB version 5: texts that MATLAB and Octave both read, our mark in the header, one writer."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.outputs import MARK, Kind, has_mark, written_aside
from ehdmaps.program import plain
from ehdmaps.version import version

KIND = Kind("a MATLAB file of ehdmaps", (".mat",), has_mark)

_TEXT = 116
"""Bytes of text at the beginning of a MATLAB v5 file (MAT-File Format, MathWorks, "Level 5 MAT-File Header")."""


def ascii_text(text: str) -> str:
    """Return a text without control characters and with escapes beyond ASCII, of which Octave loses some.

    Parameters
    ----------
    text : str
        Any text, such as a name in a scene.
    """
    return plain(text).encode("ascii", "backslashreplace").decode("ascii")


def write_matlab(path: Path, variables: Mapping[str, Any], advice: str) -> None:
    """Write variables as a file of MATLAB version 5 that carries our mark.

    Parameters
    ----------
    path : Path
        The file; look at it with `check_outputs` and `KIND` first.
    variables : mapping of str to object
        What `scipy.io.savemat` takes: dictionaries are structs, arrays of object are cells.
    advice : str
        What to do where they cannot be written.

    Raises
    ------
    InputError
        If they cannot be written, or something else stands there.
    """
    from scipy.io import savemat

    buffer = io.BytesIO()
    try:
        savemat(buffer, dict(variables), long_field_names=True, do_compression=True, oned_as="column")
    except (ValueError, UnicodeError) as error:
        raise InputError(f"{path}: cannot be written as a MATLAB file ({error}); {advice}") from error
    title = f"MATLAB 5.0 MAT-file, {MARK} {version()}".encode("ascii", "replace")
    with written_aside(path, KIND) as aside:
        aside.write_bytes(title.ljust(_TEXT)[:_TEXT] + buffer.getvalue()[_TEXT:])
