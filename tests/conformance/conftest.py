"""Each test of a machine tells its cell of the table of kinds and claims."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.cases.coarse import coarse_tables


@pytest.fixture(autouse=True, scope="package")
def coarse() -> Iterator[None]:
    """Claims on kinds hold with every table."""
    with coarse_tables():
        yield


@pytest.fixture(autouse=True)
def cell(request, record_property):
    """The machine is the row, the other parameters, or the name of the test, the column."""
    given = dict(request.node.callspec.params) if hasattr(request.node, "callspec") else {}
    machine = given.pop("kind", given.pop("machine", None))
    if machine is not None:
        words = [getattr(value, "name", getattr(value, "__name__", value)) for value in given.values()]
        record_property("machine", machine.name)
        record_property("claim", " ".join(map(str, words)) or request.node.originalname.removeprefix("test_"))
