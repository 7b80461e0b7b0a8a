"""Tables of laws are coarse, but where tests ask how exact laws are, or for the numbers of old ones."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import pytest

from tests.cases.coarse import coarse_tables

FINE = (
    "emap", "export_linear", "film_memory", "kept_tables", "law", "law_errors", "law_parts", "locked_film",
    "map_structure", "map_versions", "mbs_supply", "mbs_unknown_bands", "oil_layer", "reach", "spacing", "tradeoff",
)  # fmt: skip


@pytest.fixture(autouse=True, scope="module")
def coarse(request: pytest.FixtureRequest) -> Iterator[None]:
    name = request.module.__name__.rpartition("test_")[2]
    with contextlib.nullcontext() if name in FINE else coarse_tables():
        yield
