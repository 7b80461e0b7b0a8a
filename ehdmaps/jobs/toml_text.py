"""From the text of a TOML file to its tables: what jobs, scenes and bodies have in common."""

from __future__ import annotations

import tomllib
from typing import Any

from ehdmaps.errors import InputError


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
