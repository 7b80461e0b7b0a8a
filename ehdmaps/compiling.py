"""Processor time of work, and time that numba spends on compiling, of which users are told and which no rate counts.

numba is loaded where something listens to it, not before: most questions need none of it.
"""

from __future__ import annotations

import contextlib
import functools
import os
import sys
import time
from collections.abc import Callable
from typing import Any

NOTE = "compiling, once after an installation or an update"
"""What users are told."""

TOLD_AFTER = 1.0
"""Seconds of compiling after which they are; shorter waits are no reason to."""


class Compiling:
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
        self._ear: Any = None

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
        """Listen from now on; before numba is loaded nothing compiles, so that `ehdmaps.compiled` begins it then."""
        if "ehdmaps.compiled" in sys.modules:
            self._register()
        else:
            _WAITING.append(self)

    def _register(self) -> None:
        """Have numba tell what it compiles."""
        from numba.core import event

        events: Any = event
        told = {"on_start": self._told(self.on_start), "on_end": self._told(self.on_end)}
        self._ear = type("Ear", (events.Listener,), told)()
        events.register("numba:compile", self._ear)

    def end(self) -> None:
        """Listen no more."""
        if self in _WAITING:
            _WAITING.remove(self)
        if self._ear is None:
            return
        from numba.core import event

        events: Any = event
        with contextlib.suppress(ValueError):  # it has ended already
            events.unregister("numba:compile", self._ear)

    @staticmethod
    def _told(what: Callable[[Any], None]) -> Callable[[Any, Any], None]:
        """Method of a listener of numba that tells what happened."""
        return lambda _, event: what(event)


_WAITING: list[Compiling] = []


def begin_waiting() -> None:
    """Begin to listen for those who asked before numba was loaded."""
    while _WAITING:
        _WAITING.pop()._register()


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
