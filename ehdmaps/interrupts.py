"""Ctrl-C, and the end that a system asks for (SIGTERM), in programs that run compiled code.

Both end a program in the same way. Python raises KeyboardInterrupt in whatever Python code runs next. Where that is
code which numba calls while it passes values to a film solver and back, nobody expects an exception: the process dies
of a segmentation fault, or of an error of the interpreter. Libraries in C that are just being imported take it for an
error of theirs. In such places the exception waits for the next line of this distribution's own code, as a debugger
would for a breakpoint.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from types import FrameType
from typing import Any, NoReturn

STOPPED = 130
"""Exit status after Ctrl-C, as shells have it."""

_USUAL = {signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL}
"""Signals that stop a program, and who handles them as long as nobody else does."""


@dataclass
class Stopped:
    """By which signal a program was stopped.

    Attributes
    ----------
    number : int
        The signal; that of Ctrl-C as long as there is none.
    """

    number: int = signal.SIGINT

    @property
    def status(self) -> int:
        """Exit status, as shells have it."""
        return 128 + self.number


_OURS = ("ehdmaps", "mbs")
_DELICATE = ("numba", "llvmlite", "importlib", "weakref")
_GENERATED = "<string>"
"""File of code that the standard library makes: numba calls constructors of named tuples."""


@contextlib.contextmanager
def careful_interrupts(last: bool = False) -> Iterator[Stopped]:
    """Raise KeyboardInterrupt on Ctrl-C where that does no harm; a second Ctrl-C that finds it waiting ends at once.

    So it is on SIGTERM. A process that was started with one of them ignored, as a job in the background is with
    Ctrl-C, goes on ignoring it.

    Parameters
    ----------
    last : bool
        Whether the process ends after the block: Ctrl-C ends it at once then.

    Yields
    ------
    Stopped
        Tells afterwards by which signal.
    """
    heard, process = Stopped(), os.getpid()
    main = threading.current_thread() is threading.main_thread()
    ours = {number: usual for number, usual in _USUAL.items() if main and signal.getsignal(number) == usual}
    if not ours:
        yield heard
        return
    waiting = False

    def stop(frame: FrameType, event: str, argument: Any) -> NoReturn:
        nonlocal waiting
        waiting = False
        sys.settrace(None)
        raise KeyboardInterrupt

    def interrupted(number: int, frame: FrameType | None) -> None:
        nonlocal waiting
        if os.getpid() != process:  # forked, and not yet with handlers of its own
            os._exit(128 + number)
        if waiting:
            end_at_once(number, frame)
        heard.number = number
        later = _where_to_stop(frame)
        if later is None:
            raise KeyboardInterrupt
        waiting = True
        later.f_trace = stop
        sys.settrace(lambda *_: None)  # switches tracing on; frames that are entered now are of no interest

    for number in ours:
        signal.signal(number, interrupted)
    try:
        yield heard
    finally:
        for number, before in ours.items():
            signal.signal(number, end_at_once if last else before)


def end_at_once(number: int, frame: FrameType | None) -> NoReturn:
    """End the process without its usual end: a handler for when that has begun already, or does not come."""
    with contextlib.suppress(OSError):
        os.write(2, b"\nstopped\n")
    os._exit(128 + number)


@contextlib.contextmanager
def deaf_children(*more: int) -> Iterator[None]:
    """Let processes that are started in the block not hear Ctrl-C, which is the parent's business.

    They block the signal from their first moment on: a process of Python that is just starting would answer it with a
    traceback.

    Parameters
    ----------
    *more : int
        Further signals that wait until the process takes them, as `ehdmaps.workers.start_worker` does with SIGTERM: a
        forked process forgets one that comes before it is itself.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT, *more])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _where_to_stop(frame: FrameType | None) -> FrameType | None:
    """Return the frame whose next line may raise; None if the present place may."""
    delicate = False
    while frame is not None:
        package = str(frame.f_globals.get("__name__", "")).partition(".")[0]
        if package in _OURS:
            break
        delicate = delicate or package in _DELICATE or frame.f_code.co_filename == _GENERATED
        frame = frame.f_back
    return frame if delicate else None
