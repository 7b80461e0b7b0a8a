"""Progress on stderr: a bar on a terminal, a plain line now and then elsewhere."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable
from math import inf
from typing import Any

from ehdmaps.compiling import Compiling
from ehdmaps.program import tell

LINE_SECONDS = 10.0
"""Between two plain lines; a log of a night stays readable."""

FIRST_SECONDS = 0.05
"""What is told this soon after the first piece of work belongs to it: runs in time tell many steps at once."""

LONGEST_SHARE = 0.5 + 1e-9
"""Of the time counted that one wait may make up where a rate is stated; two equal waits are enough of them."""

_BAR = "{percentage:3.0f}%|{bar}| {n_fmt}/{total_fmt} {unit}s [{elapsed}{postfix}]"

_DURATIONS = ((120.0, 1.0, "s"), (7200.0, 60.0, "min"), (172800.0, 3600.0, "h"), (inf, 86400.0, "days"))
"""Up to which time [s] which unit [s] is shown."""


class Pace:
    """How fast it goes, and how long it will take.

    It counts from the end of the first piece of work on, and leaves out what this process compiles. There is no
    estimate as long as one wait makes up more than half of the time counted: other processes may compile, too, and what
    that takes says nothing about the rest.

    Parameters
    ----------
    total : int
        Points, steps or hits.
    clock : callable
        Gives the time [s].
    compiled : callable, optional
        Gives what has been spent on compiling so far [s]; nothing if left out.
    """

    def __init__(
        self, total: int, clock: Callable[[], float] = time.monotonic, compiled: Callable[[], float] | None = None
    ) -> None:
        self.total = total
        self.done = 0
        self._clock = clock if compiled is None else lambda: clock() - compiled()
        self._first_told: float | None = None
        self._since = self._last = 0.0, 0
        self._longest = 0.0

    def taken_over(self, count: int) -> None:
        """Count what was there."""
        self.done += count

    def solved(self, count: int) -> None:
        """Count what is done now."""
        self.done += count
        now = self._clock()
        waited = now - self._last[0]
        self._last = now, self.done
        if self._first_told is None:
            self._first_told = now
        if now <= self._first_told + FIRST_SECONDS:
            self._since = self._last
        else:
            self._longest = max(self._longest, waited)

    @property
    def rate(self) -> float | None:
        """Number a second [1/s]; None as long as nobody can know."""
        seconds, count = self._last[0] - self._since[0], self._last[1] - self._since[1]
        return count / seconds if seconds > 0.0 and self._longest <= LONGEST_SHARE * seconds else None

    @property
    def seconds_left(self) -> float | None:
        """Expected time to the end [s]; None as long as nobody can know."""
        if self.done >= self.total:
            return 0.0
        return None if self.rate is None else (self.total - self.done) / self.rate

    def text(self, unit: str) -> str:
        """Rate and time left in words; empty as long as nobody can know."""
        if self.rate is None or self.seconds_left is None:
            return ""
        return f"{self.rate:.3g} {unit}s/s, {duration(self.seconds_left)} left"


class Bar:
    """A tqdm bar with rate and time left; what was taken over does not count for the rate."""

    def __init__(self, total: int, unit: str = "point") -> None:
        self._compiling = Compiling(self._say)
        self._pace = Pace(total, compiled=lambda: self._compiling.seconds)
        self._unit = unit
        self._bar: Any = None
        self._compiling.listen()

    def begin(self) -> None:
        """Begin with nothing."""
        self.taken_over(0)

    def taken_over(self, count: int) -> None:
        """Begin at what was there."""
        from tqdm import tqdm

        self._pace.taken_over(count)
        self._bar = tqdm(
            total=self._pace.total, initial=count, file=_Stderr(), dynamic_ncols=True, bar_format=_BAR, unit=self._unit
        )

    def solved(self, count: int) -> None:
        """Advance."""
        self._pace.solved(count)
        self._bar.set_postfix_str(self._pace.text(self._unit), refresh=False)
        self._bar.update(count)
        if self._bar.n >= self._bar.total:
            self._bar.close()
            self._compiling.end()

    def _say(self, text: str) -> None:
        """Say something above the bar."""
        if self._bar is None:
            tell(text)
        else:
            self._bar.write(text, file=_Stderr())


class Lines:
    """One line at the beginning, one every `LINE_SECONDS`, one at the end."""

    def __init__(self, total: int, unit: str = "point") -> None:
        self._compiling = Compiling(tell)
        self._pace = Pace(total, compiled=lambda: self._compiling.seconds)
        self._unit = unit
        self._last = time.monotonic()
        self._compiling.listen()

    def begin(self) -> None:
        """Begin with nothing, which is not worth a line."""

    def taken_over(self, count: int) -> None:
        """Say how much was there."""
        self._pace.taken_over(count)
        tell(f"{count} of {self._pace.total} {self._unit}s taken over")

    def solved(self, count: int) -> None:
        """Count, and say so now and then."""
        self._pace.solved(count)
        now = time.monotonic()
        if self._pace.done >= self._pace.total or now - self._last >= LINE_SECONDS:
            pace = self._pace.text(self._unit)
            tell(f"{self._pace.done} of {self._pace.total} {self._unit}s{pace and ', '}{pace}")
            self._last = now
        if self._pace.done >= self._pace.total:
            self._compiling.end()


class _Stderr:
    """Stderr for a bar, which must not end a run because nobody can see it."""

    encoding = property(lambda _: sys.stderr.encoding)

    def write(self, text: str) -> None:
        """Write, if it is possible."""
        with contextlib.suppress(OSError, ValueError):
            sys.stderr.write(text)

    def flush(self) -> None:
        """Flush, if it is possible."""
        with contextlib.suppress(OSError, ValueError):
            sys.stderr.flush()

    def isatty(self) -> bool:
        """Whether it is a terminal."""
        return sys.stderr.isatty()

    def fileno(self) -> int:
        """Return its number, for its width."""
        return sys.stderr.fileno()


def progress(total: int, unit: str = "point") -> Bar | Lines:
    """Return what suits stderr.

    Parameters
    ----------
    total : int
        How many there are.
    unit : str
        What is counted, in the singular: point, step, hit.
    """
    terminal = sys.stderr is not None and sys.stderr.isatty()
    return Bar(total, unit) if terminal else Lines(total, unit)


def duration(seconds: float) -> str:
    """Return a time in the unit that a reader would choose, such as "12 min"."""
    size, unit = next((size, unit) for limit, size, unit in _DURATIONS if seconds < limit)
    value = seconds / size
    return f"{value:.0f} {unit}" if value >= 10.0 or unit == "s" else f"{value:.1f} {unit}"
