"""The command line `mbs` in this process, and what every file of it holds."""

from __future__ import annotations

from mbs import cli


def run(capsys, *arguments):
    status = cli.main(arguments)
    captured = capsys.readouterr()
    return status, captured.out, captured.err


def check_units(dataset):
    for name, variable in dataset.data_vars.items():
        assert "long_name" in variable.attrs, name
        assert "units" in variable.attrs or variable.dtype.kind in "OUS", name
