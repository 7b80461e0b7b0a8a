"""Laws with coarse tables: what holds for every table is tried with those that are quick to make."""

from __future__ import annotations

import contextlib
import importlib
from collections.abc import Iterator
from unittest import mock

from ehdmaps.maps.compilation import Resolution
from ehdmaps.maps.emap import EHDMap

COARSE = Resolution(approach=0.1, log_speed=0.5, temperature=0.5, log_load=0.08)
"""A fine table takes four times as long."""

KEEPERS = ("ball_films", "line_films")
"""Modules of `mbs.scene.locating` that keep laws they have made, as `mbs.scene.contact_laws` and `map_set` do."""


_OWN = EHDMap._resolution


def forget() -> None:
    """Let the modules that keep laws make them anew."""
    for name in ("contact_laws", "map_set", *(f"locating.{one}" for one in KEEPERS)):
        for value in vars(importlib.import_module(f"mbs.scene.{name}")).values():
            if hasattr(value, "cache_clear"):
                value.cache_clear()


@contextlib.contextmanager
def coarse_tables() -> Iterator[None]:
    """Make tables of laws coarse for a while."""
    forget()
    with mock.patch.object(EHDMap, "_resolution", COARSE):
        yield
    forget()


@contextlib.contextmanager
def fine_tables() -> Iterator[None]:
    """Make them as users have them, for a while."""
    forget()
    with mock.patch.object(EHDMap, "_resolution", _OWN):
        yield
    forget()
