"""A dask cluster of processes on this machine: a scheduler, workers, and what befalls them."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

SCHEDULER, WORKER = r"Scheduler at: +(tcp://\S+)", r"Registered to: +(\S+)"
"""What each says once it is there."""


class Cluster:
    """Processes of dask; all are ended with the block of `cluster`."""

    def __init__(self) -> None:
        self.processes: list[subprocess.Popen[str]] = []
        self.scheduler, self.address = self._started("dask_scheduler", "--host", "127.0.0.1", "--port", "0")
        self.workers = [self.worker() for _ in range(2)]

    def _started(self, name: str, *arguments: str) -> tuple[subprocess.Popen[str], str]:
        """A process that is there, and its address."""
        command = [sys.executable, "-m", f"distributed.cli.{name}", *arguments, "--no-dashboard"]
        process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        self.processes.append(process)
        assert process.stderr is not None
        for line in process.stderr:
            if found := re.search(SCHEDULER if name == "dask_scheduler" else WORKER, line):
                return process, found[1]
        raise AssertionError(f"{name} ended: {process.wait()}")

    def worker(self) -> subprocess.Popen[str]:
        """One more worker, of one thread, without a nanny that would start it again."""
        return self._started("dask_worker", self.address, "--nthreads", "1", "--no-nanny")[0]

    def restart_scheduler(self) -> None:
        """Kill the scheduler, and start it and its workers anew at the same address."""
        for process in (self.scheduler, *self.workers):
            kill(process)
        host, port = self.address.removeprefix("tcp://").split(":")
        self.scheduler, _ = self._started("dask_scheduler", "--host", host, "--port", port)
        self.workers = [self.worker() for _ in range(2)]


def kill(process: subprocess.Popen[str]) -> None:
    """End a process by SIGKILL, and wait for its end."""
    with suppress(ProcessLookupError):
        process.send_signal(signal.SIGKILL)
    process.wait()


@contextmanager
def cluster() -> Iterator[Cluster]:
    """A scheduler and two workers."""
    made = Cluster()
    try:
        yield made
    finally:
        for process in made.processes:
            kill(process)
            assert process.stderr is not None
            process.stderr.close()
