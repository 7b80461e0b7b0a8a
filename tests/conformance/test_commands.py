"""Every command of `mbs` on every kind of bearing and on machines that mix them, dry and with films."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import xarray as xr

from tests.cases.commands import check_units, run
from tests.conformance.machines import MACHINES


@dataclass(frozen=True)
class Command:
    """A row: a command with its options; `slow` ones run in time, or write pages."""

    name: str
    options: tuple[str, ...] = ()
    output: str = ""
    slow: bool = False
    laws: tuple[str, ...] = ("dry", "films")


COMMANDS = (
    Command("check"),
    Command("statics", output="-o result.nc"),
    Command("modes", output="-o result.nc"),
    Command("lsa", output="-o result.nc"),
    Command("sweep", ("--workers", "1"), output="-o result.nc"),
    Command("critical", output="-o result.nc"),
    Command("hammer", ("--hits", "1", "--duration", "20 ms", "--workers", "1"), output="-o result.uff"),
    Command("report", output="-o result.html", slow=True),
    Command("runup", ("--workers", "1"), output="-o result.nc", slow=True, laws=("films",)),
    Command("run", output="-o folder", slow=True),  # with the Campbell diagram, whose runs are run-ups too
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
    if law in command.laws
]


@pytest.mark.parametrize(("machine", "law", "command"), CELLS)
def test_command(machine, law, command, capsys, tmp_path, monkeypatch):
    """A sound machine has a result: no traceback, the status 0, nothing that is no number, and the files asked for."""
    monkeypatch.chdir(tmp_path)
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
    assert found == SEEN.setdefault((law, command.name), found)
    if command.name == "statics":
        loaded = np.linalg.norm(dataset["bearing_force"], axis=1) > 1.0
        assert np.count_nonzero(loaded) >= 2
        for name in (*LOADS, *CONTACTS[: None if law == "films" else 1]):
            assert np.all(dataset[name].values[loaded] > 0.0), name


SEEN = {}
"""Names, dimensions and units of the first dataset of each law and command."""
