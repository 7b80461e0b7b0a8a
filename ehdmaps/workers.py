"""What all worker processes share: who ends them, how many there are, who says that they compile."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from multiprocessing.connection import wait as wait_for_process
from typing import Any

from ehdmaps.program import tell


def available_cores() -> int:
    """Return the cores that this process may use, which may be fewer than the machine has."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def start_worker(told: Any = None) -> None:
    """Leave Ctrl-C to the parent, and end with it even when it is killed.

    Parameters
    ----------
    told : multiprocessing.Value, optional
        Whether some worker has said that it compiles: the first one does, once for all.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    if told is not None:
        from ehdmaps.compiling import Compiling  # with numba, which the parent's command line does without

        Compiling(lambda note: _say_once(note, told)).listen()


def _say_once(note: str, told: Any) -> None:
    """Say something that no other worker has said."""
    with told.get_lock():
        first, told.value = not told.value, True
    if first:
        tell(note)


def _end_with_parent() -> None:
    """Wait for the parent's end; without this, the workers of a killed job would wait for tasks for ever."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        wait_for_process([parent.sentinel])
        os._exit(1)
