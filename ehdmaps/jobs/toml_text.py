"""From the bytes of a TOML file to its tables: what jobs, scenes and bodies have in common."""

from __future__ import annotations

import tomllib
from typing import Any

from ehdmaps.errors import InputError


def decode(content: bytes, source: str, allowed: str) -> str:
    """Text of a file; a mark at its beginning, which some editors write, is left out.

    Parameters
    ----------
    content : bytes
        What is in the file.
    source : str
        How messages call the file.
    allowed : str
        What the file should have been.

    Raises
    ------
    InputError
        If it is not UTF-8.
    """
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{source}: is not UTF-8 text (byte {error.start}); allowed: {allowed}") from error


def parse(text: str, where: str) -> dict[str, Any]:
    """Tables of a TOML text; `where` is how messages call the file.

    Raises
    ------
    InputError
        If it is not TOML.
    """
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        # ValueError covers TOMLDecodeError and numbers with too many digits.
        raise InputError(
            f"{where}: is not TOML: {error}; allowed: TOML 1.0; strings with units stand in quotes"
        ) from error
