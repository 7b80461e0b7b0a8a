"""Commands find the tables of laws that earlier ones have made, as those of a user do."""

from __future__ import annotations

import pytest


@pytest.fixture(autouse=True)
def kept_laws(law_tables, monkeypatch):
    monkeypatch.setenv("EHDMAPS_LAW_TABLES", law_tables)
