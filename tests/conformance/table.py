"""The table of kinds and claims, from what a run of pytest reports."""

from __future__ import annotations

import string

MARKS = {"passed": "+", "failed": "X", "skipped": "."}


class Table:
    """Plugin of pytest: outcomes of the tests that tell their machine and claim."""

    def __init__(self):
        self.cells: dict[tuple[str, str], str] = {}

    def pytest_runtest_logreport(self, report):
        told = dict(report.user_properties)
        if "machine" in told and (report.when == "call" or report.outcome != "passed"):
            self.cells[told["claim"], told["machine"]] = MARKS[report.outcome]

    def lines(self):
        """Lines of the table: a row a claim, a column a machine."""
        machines = dict(zip(dict.fromkeys(machine for _, machine in self.cells), string.ascii_uppercase, strict=False))
        claims = list(dict.fromkeys(claim for claim, _ in self.cells))
        width = max(map(len, claims), default=0)
        yield from (f"{letter}  {machine}" for machine, letter in machines.items())
        yield "+ the claim holds, X it does not, . it is not made of that machine"
        yield " " * width + "".join(f"  {letter}" for letter in machines.values())
        for claim in claims:
            yield f"{claim:{width}}" + "".join(f"  {self.cells.get((claim, machine), ' ')}" for machine in machines)
