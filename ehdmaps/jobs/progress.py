"""Progress on stderr: a bar on a terminal, a plain line now and then elsewhere."""

from __future__ import annotations

import sys
import time
from typing import Any

LINE_SECONDS = 10.0
"""Between two plain lines; a log of a night stays readable."""


class Bar:
    """A tqdm bar with rate and time left; points taken over do not count for the rate."""

    def __init__(self, total: int) -> None:
        self._total = total
        self._bar: Any = None

    def begin(self) -> None:
        """Begin with nothing."""
        self.taken_over(0)

    def taken_over(self, points: int) -> None:
        """Begin at the points that were there."""
        from tqdm import tqdm

        self._bar = tqdm(total=self._total, initial=points, unit="point", file=sys.stderr, dynamic_ncols=True)

    def solved(self, points: int) -> None:
        """Advance."""
        self._bar.update(points)
        if self._bar.n >= self._total:
            self._bar.close()


class Lines:
    """One line at the beginning, one every `LINE_SECONDS`, one at the end."""

    def __init__(self, total: int) -> None:
        self._total = total
        self._done = 0
        self._taken = 0
        self._begin = self._last = time.monotonic()

    def begin(self) -> None:
        """Begin with nothing, which is not worth a line."""

    def taken_over(self, points: int) -> None:
        """Say how many points were there."""
        self._done = self._taken = points
        self._say(f"{points} of {self._total} points taken over")

    def solved(self, points: int) -> None:
        """Count, and say so now and then."""
        self._done += points
        now = time.monotonic()
        if self._done >= self._total or now - self._last >= LINE_SECONDS:
            rate = (self._done - self._taken) / max(now - self._begin, 1e-9)
            left = (self._total - self._done) / rate
            self._say(f"{self._done} of {self._total} points, {rate:.3g} points/s, {left:.0f} s left")
            self._last = now

    @staticmethod
    def _say(text: str) -> None:
        sys.stderr.write(text + "\n")
        sys.stderr.flush()


def progress(total: int) -> Bar | Lines:
    """Return what suits stderr."""
    return Bar(total) if sys.stderr.isatty() else Lines(total)
