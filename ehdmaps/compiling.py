"""Processor time of work, and time that numba spends on compiling, of which users are told and which no rate counts."""

from __future__ import annotations

import contextlib
import functools
import os
import time
from collections.abc import Callable
from typing import Any

from numba.core import event

_EVENTS: Any = event

NOTE = "compiling, once after an installation or an update"
"""What users are told."""

TOLD_AFTER = 1.0
"""Seconds of compiling after which they are; shorter waits are no reason to."""


class Compiling(event.Listener):
    """Listens to numba while it compiles; code that is read from disk is none of that.

    Parameters
    ----------
    say : callable
        Is called once, with `NOTE`, as soon as compiling has taken longer than `TOLD_AFTER`.
    clock : callable
        Gives the time [s].
    """

    def __init__(self, say: Callable[[str], None], clock: Callable[[], float] = time.monotonic) -> None:
        self._say: Callable[[str], None] | None = say
        self._clock = clock
        self._depth, self._begun, self._spent = 0, 0.0, 0.0

    @property
    def seconds(self) -> float:
        """Time spent so far [s]."""
        return self._spent + (self._clock() - self._begun if self._depth else 0.0)

    def on_start(self, event: Any) -> None:
        """One function is being compiled, maybe for another one that is.

        Parameters
        ----------
        event : numba.core.event.Event
            What begins.
        """
        if self._depth == 0:
            self._begun = self._clock()
        self._depth += 1
        if self._say is not None and self.seconds > TOLD_AFTER:
            self._say(NOTE)
            self._say = None

    def on_end(self, event: Any) -> None:
        """It is done.

        Parameters
        ----------
        event : numba.core.event.Event
            What ends.
        """
        self._depth -= 1
        if self._depth == 0:
            self._spent += self._clock() - self._begun

    def listen(self) -> None:
        """Listen from now on."""
        _EVENTS.register("numba:compile", self)

    def end(self) -> None:
        """Listen no more."""
        with contextlib.suppress(ValueError):  # it has ended already
            _EVENTS.unregister("numba:compile", self)


def cpu_seconds() -> float:
    """Processor time of this process and of the programs that it ran and that ended [s]."""
    times = os.times()
    return time.process_time() + times.children_user + times.children_system


def stopwatch() -> Callable[[], float]:
    """Start a watch of processor time, of `cpu_seconds` but without compiling; calling it gives the time so far [s]."""
    compiling = _listening()
    begin = cpu_seconds() - compiling.seconds

    def elapsed() -> float:
        return cpu_seconds() - compiling.seconds - begin

    return elapsed


@functools.cache
def _listening() -> Compiling:
    """One listener for all watches of a process."""
    found = Compiling(lambda _: None, time.process_time)
    found.listen()
    return found
