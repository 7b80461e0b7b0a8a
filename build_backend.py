"""Build back end: that of setuptools, which asks for a C compiler from PyPI where the machine has none that works."""

from __future__ import annotations

import os
import runpy
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from setuptools import build_meta
from setuptools.build_meta import (
    build_editable,
    build_sdist,
    build_wheel,
    get_requires_for_build_sdist,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]

COMPILER = "ziglang>=0.13,<1"
"""A C compiler on PyPI."""

Settings = Mapping[str, Any] | None


def get_requires_for_build_wheel(config_settings: Settings = None) -> list[str]:
    """Return what a wheel is built with: as setuptools says, and the compiler where there is none.

    Parameters
    ----------
    config_settings : mapping, optional
        Settings of the front end.
    """
    return [*build_meta.get_requires_for_build_wheel(config_settings), *compiler()]


def get_requires_for_build_editable(config_settings: Settings = None) -> list[str]:
    """Return the same for an editable installation.

    Parameters
    ----------
    config_settings : mapping, optional
        Settings of the front end.
    """
    return [*build_meta.get_requires_for_build_editable(config_settings), *compiler()]


def compiler() -> list[str]:
    """Return the distribution that is a C compiler where the machine has none that works."""
    building = runpy.run_path(str(Path(__file__).with_name("ehdmaps") / "kernel" / "building.py"))
    try:
        building["usable_compiler"](os.environ)
    except building["NoCompilerError"]:
        return [COMPILER]
    return []
