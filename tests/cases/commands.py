"""The command line `mbs` in this process, and what every file of it holds."""

from __future__ import annotations

from ehdmaps.compiling import NOTE
from mbs import cli


def run(capsys, *arguments):
    """Status, stdout and stderr; without the note on compiling, which depends on what numba finds on the disk."""
    status = cli.main(arguments)
    captured = capsys.readouterr()
    return status, captured.out, without_note(captured.err)


def without_note(err):
    """Stderr without the lines that are the note on compiling and nothing else."""
    return "".join(line for line in err.splitlines(keepends=True) if line.rstrip() != NOTE)


def check_units(dataset):
    for name, variable in dataset.data_vars.items():
        assert "long_name" in variable.attrs, name
        assert "units" in variable.attrs or variable.dtype.kind in "OUS", name
