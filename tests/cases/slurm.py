"""A Slurm of one node for tests, which `.ci/slurm` makes in a temporary folder; skipped without it, but not in CI."""

from __future__ import annotations

import os
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / ".ci" / "slurm"


class Slurm:
    """A cluster that runs."""

    def __init__(self, folder: Path) -> None:
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}

    def run(self, *command: str) -> str:
        """What a command of Slurm prints."""
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=60, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout.strip()

    def submit(self, *arguments: str) -> str:
        """Submit a job; its number."""
        return self.run("sbatch", "--parsable", *arguments)

    def states(self, job: str) -> set[str]:
        """States of the tasks of a job that have not ended."""
        return set(self.run("squeue", "--noheader", "--format=%T", f"--jobs={job}", "--states=all").split())

    def wait(self, job: str, seconds: float = 120.0) -> set[str]:
        """Wait for the end of a job; the states in which its tasks ended."""
        end = time.monotonic() + seconds
        while (states := self.states(job)) & {"PENDING", "CONFIGURING", "RUNNING", "COMPLETING"}:
            assert time.monotonic() < end, states
            time.sleep(0.2)
        return states


@contextmanager
def running_slurm() -> Iterator[Slurm]:
    """Start a cluster, and end its daemons whatever happens."""
    with tempfile.TemporaryDirectory(prefix="slurm") as name:
        folder = Path(name)
        done = subprocess.run(
            ["bash", SCRIPT, "start", folder], capture_output=True, text=True, timeout=120, check=False
        )
        try:
            if done.returncode:
                if os.environ.get("CI"):
                    pytest.fail(f"{done.stderr} (in CI no test of Slurm may be skipped)", pytrace=False)
                pytest.skip(done.stderr.strip().splitlines()[0])
            yield Slurm(folder)
        finally:
            subprocess.run(["bash", SCRIPT, "stop", folder], timeout=60, check=False)
