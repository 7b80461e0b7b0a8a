"""Every command of `mbs` on every kind of bearing and on machines that mix them, dry and with films."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pytest
import xarray as xr

from mbs.output.results import RESPONSE_UNITS
from tests.cases.commands import check_units, run
from tests.cases.reports import without_budget
from tests.conformance.machines import KINDS, MACHINES, MIXED, Machine


@dataclass(frozen=True)
class Command:
    """A row: a command with its options; `slow` ones run in time, or write pages.

    Those that are dear have some machines alone, by the law with which each has it; those that are `turned` have every
    machine, by one law and the other in turn. Those that are `linear` ask for what modes have of each bearing, K, C and
    films with memory, in the same words: machines whose elements another one has are left out.
    """

    name: str
    options: tuple[str, ...] = ()
    output: str = ""
    slow: bool = False
    linear: bool = False
    only: Mapping[str, str] | None = None
    turned: int | None = None

    def has(self, machine: Machine, law: str) -> bool:
        if self.linear and machine.name in LIKE_OTHERS:
            return False
        if self.turned is not None and machine.films:
            return (MACHINES.index(machine) + self.turned) % 2 == list(LAWS).index(law)
        return self.only is None or self.only.get(machine.name) == law


# Each kind has each of these once, and each of them both laws: what is of a kind and a law is in the other rows.
ALONE = [machine.name for machine in (*KINDS, MIXED[-1])]
# runs of each kind of element, with films or without; other designations of a kind have its block, and run in
# `test_runs.py` with all kinds
FILMS = dict.fromkeys(("cylindrical", "rollers as bodies", "deep groove", "tapered", "ribbed NUP", "thrust"), "films")
DRY = dict.fromkeys([name for name in ALONE if name not in FILMS], "dry")
# needles, and rollers as bodies, have the page of cylindrical rollers
PAGES = {
    "cylindrical": "films", "deep groove": "films", "angular contact": "dry", "tapered": "films", "ribbed NUP": "dry",
    "table": "dry",
}  # fmt: skip

LIKE_OTHERS = (
    "needle", "double row cylindrical", "hybrid, thin section", "two rows, four-point", "self-aligning",
    "angular contact", "ribbed NJ",
)  # fmt: skip
"""Machines whose bearings have the elements of another one, with other dimensions."""

COMMANDS = (
    Command("check", turned=0),
    Command("statics", output="-o result.nc", turned=1),
    Command("modes", output="-o result.nc", turned=1),
    Command("lsa", output="-o result.nc", linear=True, turned=0),
    Command("sweep", ("--workers", "1"), output="-o result.nc", linear=True, turned=1),
    Command("critical", output="-o result.nc", linear=True, turned=0),
    Command(
        "hammer",
        ("--hits", "1", "--duration", "20 ms", "--workers", "1"),
        output="-o result.uff",
        linear=True,
        turned=1,
    ),
    Command("identify", ("--plan", "--free", "pull.force"), turned=0),
    Command("report", output="-o result.html", slow=True, only=PAGES),
    Command("runup", ("--workers", "1"), output="-o result.nc", slow=True, only=FILMS),
    Command("campbell", ("--workers", "1"), output="-o result.nc", slow=True, only=DRY),
    # all of these but the first and the page, with their figures; of other kinds in `test_shipped.py`
    Command("run", output="-o folder", slow=True, only={"table": "dry"}),
)

LAWS = {"dry": ("--law", "hertz:1.25e-5 s"), "films": ("--law", "table")}

CELLS = [
    pytest.param(
        machine, law, command, id=f"{machine.name}-{law}-{command.name}", marks=[pytest.mark.slow] * command.slow
    )
    for machine in MACHINES
    for law in LAWS
    if machine.films or law == "dry"
    for command in COMMANDS
    if command.has(machine, law)
]


@pytest.mark.parametrize(("machine", "law", "command"), CELLS)
def test_command(machine, law, command, capsys, tmp_path, monkeypatch):
    """A sound machine has a result: no traceback, the status 0, nothing that is no number, and the files asked for."""
    monkeypatch.chdir(tmp_path)
    without_budget(monkeypatch)  # which shipped scenes have, in `test_shipped.py`
    (tmp_path / "machine.toml").write_text(machine.text(), encoding="utf-8")
    status, out, err = run(capsys, command.name, "machine.toml", *LAWS[law], *command.options, *command.output.split())
    assert status == 0, err or out
    assert "nan" not in out.lower().split()
    for name in command.output.split():
        assert name.startswith("-") or (tmp_path / name).exists()
    if command.output.endswith(".nc"):
        with xr.open_dataset("result.nc") as dataset:
            check_dataset(dataset, machine, law, command)
            if command.name == "statics" and machine.films:
                # each bearing that turns and carries has a life: idle rollers load the outer raceway at least
                carry = np.count_nonzero(dataset["highest_raceway_load"] > 0.0)
                assert 0 < carry <= out.count(", L10r ") <= dataset.sizes["bearing"]


LOADS = ("loaded_elements", "highest_raceway_load")
CONTACTS = ("hertz_pressure", "central_film", "minimum_film", "rolling_torque", "rolling_power")
"""What `mbs statics -o` says of the contacts of each bearing."""


def check_dataset(dataset, machine, law, command):
    """Names, dimensions and units are those of the first machine with this law and command, whatever its kind; and
    pressures, films and torque are told of every bearing that carries load."""
    check_units(dataset)
    if not machine.films:  # bearings by matrices have no contacts
        return
    found = {name: (entry.dims, entry.attrs.get("units")) for name, entry in dataset.variables.items()}
    if machine.name == "rollers as bodies":  # their cages stand: there is no range over their angles
        assert not {"response_least", "response_most"} & set(found)
        found |= {name: OVER_ANGLES for name in ("response_least", "response_most") if command.name == "lsa"}
    assert found == SEEN.setdefault((law, command.name), found)
    if command.name == "statics":
        loaded = np.linalg.norm(dataset["bearing_force"], axis=1) > 1.0
        assert np.count_nonzero(loaded) >= 2
        for name in (*LOADS, *CONTACTS[: None if law == "films" else 1]):
            assert np.all(dataset[name].values[loaded] > 0.0), name


OVER_ANGLES = (("frequency", "sensor", "input"), RESPONSE_UNITS)

SEEN = {}
"""Names, dimensions and units of the first dataset of each law and command."""
