"""Run the conformance test, and print the table of kinds and claims."""

from __future__ import annotations

import sys

import pytest

from tests.conformance.table import Table

if __name__ == "__main__":
    table = Table()
    status = pytest.main(["-q", "--all", "tests/conformance", *sys.argv[1:]], plugins=[table])
    print("\n".join(table.lines()))
    sys.exit(int(status))
