"""Commands run with coarse tables of laws."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.cases.coarse import coarse_tables


@pytest.fixture(autouse=True, scope="package")
def coarse() -> Iterator[None]:
    """What commands print, write and refuse does not depend on nodes of tables."""
    with coarse_tables():
        yield
