"""Texts of batch files."""

from __future__ import annotations

from tests.cases.jobs import spaced

TABLES = f"""
[grid]
load = {spaced("1 N/mm", "300 N/mm", 4)}
entrainment_speed = ["0.5 m/s", "2 m/s"]
temperature = ["40 degC"]
[solver]
name = "SOLVER"
structural_law = "iso16281"
"""


def batch_text(lists: str, solver: str = "formula", more: str = "") -> str:
    """A batch file: what [batch] says, the solver, and what stands in [solver] and after it."""
    return f"schema = 1\n[batch]\n{lists}\n{TABLES.replace('SOLVER', solver)}{more}"


SMALL_LISTS = 'bearings = ["NU308", "N1014"]\noils = ["FVA3"]'
"""Two maps."""
