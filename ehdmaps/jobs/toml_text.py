"""From the text of a TOML file to its tables: what jobs, scenes and bodies have in common."""

from __future__ import annotations

import re
import tomllib
from typing import Any

from ehdmaps.errors import InputError

DEEPEST = 64
"""Parts of a dotted key: the time to read one goes with their square, and no table of ours is deeper than five."""

_ENDS_OF_KEYS = re.compile(r"[=,\[\]{}#]")


def parse(text: str, where: str) -> dict[str, Any]:
    """Tables of a TOML text; `where` is how messages call the file.

    Raises
    ------
    InputError
        If it is not TOML.
    """
    for number, line in enumerate(text.splitlines(), start=1):
        if line.count(".") >= DEEPEST and _deepest_key(line) > DEEPEST:
            raise InputError(
                f"{where}: is not TOML of this program: line {number} has a dotted key of more than {DEEPEST} parts; "
                "allowed: tables as the reference names them"
            )
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        # ValueError covers TOMLDecodeError and numbers with too many digits.
        raise InputError(
            f"{where}: is not TOML: {error}; allowed: TOML 1.0; strings with units stand in quotes"
        ) from error


def _deepest_key(line: str) -> int:
    """Most parts, with dots between them, of what may be a key in a line."""
    dense = "".join(line.split())
    return max(sum(bool(part) for part in run.split(".")) for run in _ENDS_OF_KEYS.split(dense))
