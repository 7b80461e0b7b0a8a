"""Every reader with damaged files: nothing fails."""

from __future__ import annotations

import pytest

from mbs.laboratory.extremes.check import checks_text
from tests.fuzzing.__main__ import READERS
from tests.fuzzing.search import fuzz

MUTATIONS = 40
"""Damaged files for each reader; `python -m tests.fuzzing` has 10000."""


@pytest.mark.slow
@pytest.mark.parametrize("name", READERS)
def test_damaged_files_are_read_or_refused_and_do_no_harm(name) -> None:
    found = fuzz(READERS[name](), MUTATIONS, 14)
    assert found.failed == 0, checks_text([found])
    # Neither all refused nor all read: the damage is of the kind that tells something.
    assert found.right >= 2 and found.refused > 0.3 * MUTATIONS
    assert found.tried == MUTATIONS
