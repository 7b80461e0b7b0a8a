"""Processor time of tests: by folder and file, to collect them, and to compile; and which should be quicker or marked.

Wall time says little on machines that do other work. A commit that changes what tests take has the table in its text.
"""

from __future__ import annotations

import collections
import importlib
import os
import sys
from collections.abc import Iterator
from typing import Any

import pytest

QUICK = 2.0
"""Seconds of processor time, compiling included, that a test may take without the mark `slow`."""

LISTED = 30
"""Files that the report names."""

MANY = 500
"""Tests of a run that is asked how long it compiles."""


def processor_time() -> float:
    """Seconds of this process and of those that it waited for."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


class Durations:
    """Plugin of pytest that adds up what a process spends, and what its workers hand to it."""

    def __init__(self) -> None:
        self.seconds = collections.Counter[str]()
        """By file, and under "collecting" and "compiling"."""
        self.tests = collections.Counter[str]()
        """Number of tests by file."""
        self.over: dict[str, float] = {}
        """Seconds of phases of tests that took too long without the mark."""
        self._heard, self._depth, self._began = False, 0, 0.0

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        """Load numba, which tells how long it compiles, for runs of many tests."""
        if len(session.items) > MANY:
            importlib.import_module("numba.core.event")

    def _listen(self) -> None:
        """Hear of compiling from now on, if numba is loaded."""
        if not self._heard and "numba.core.event" in sys.modules:
            event: Any = sys.modules["numba.core.event"]
            listener = type("Listener", (event.Listener,), {"on_start": self._start, "on_end": self._end})
            event.register("numba:compile", listener())
            self._heard = True

    def _start(self, *_: object) -> None:
        """Begin to compile; a function that another one calls is compiled within it."""
        if self._depth == 0:
            self._began = processor_time()
        self._depth += 1

    def _end(self, *_: object) -> None:
        self._depth -= 1
        if self._depth == 0:
            self.seconds["compiling"] += processor_time() - self._began

    def _spend(self, item: pytest.Item, phase: str) -> Iterator[None]:
        self._listen()
        begin = processor_time()
        yield
        seconds = processor_time() - begin
        self.seconds[item.nodeid.partition("::")[0]] += seconds
        if seconds > QUICK and item.get_closest_marker("slow") is None:
            self.over[f"{phase} {item.nodeid}"] = seconds

    @pytest.hookimpl(hookwrapper=True, tryfirst=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> Iterator[None]:
        yield from self._spend(item, "setup")

    @pytest.hookimpl(hookwrapper=True, tryfirst=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Iterator[None]:
        self.tests[item.nodeid.partition("::")[0]] += 1
        yield from self._spend(item, "call")

    @pytest.hookimpl(hookwrapper=True, tryfirst=True)
    def pytest_make_collect_report(self) -> Iterator[None]:
        begin = processor_time()
        yield
        self.seconds["collecting"] += processor_time() - begin

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Hand what a worker of pytest-xdist spent to the process that reports."""
        output = getattr(session.config, "workeroutput", None)
        if output is not None:
            output["durations"] = dict(self.seconds), dict(self.tests), self.over

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: object) -> None:
        """Take over what a worker spent; one that died hands over nothing."""
        seconds, tests, over = getattr(node, "workeroutput", {}).get("durations", ({}, {}, {}))
        self.seconds.update(seconds)
        self.tests.update(tests)
        self.over.update(over)

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Print the table, and name tests that are too slow; a report and no failure, for machines differ."""
        say = terminalreporter.write_line
        if self.over:
            terminalreporter.section(f"not marked slow, and more than {QUICK:g} s of processor time")
        for name, seconds in sorted(self.over.items(), key=lambda one: -one[1]):
            say(f"{seconds:.1f} s {name}")
        files = {name: self.seconds[name] for name in self.tests}
        total, compiling, collecting = sum(files.values()), self.seconds["compiling"], self.seconds["collecting"]
        terminalreporter.section("processor time")
        say(f"{total:6.0f} s  {sum(self.tests.values())} tests, {compiling:.0f} s of it to compile")
        say(f"{collecting:6.0f} s  to collect them")
        folders = collections.defaultdict[str, list[str]](list)
        for name in files:
            folders["/".join(name.split("/")[:2]) if name.startswith("tests/") else "doctests"].append(name)
        for folder, names in sorted(folders.items(), key=lambda one: -sum(files[name] for name in one[1])):
            spent, count = sum(files[name] for name in names), sum(self.tests[name] for name in names)
            say(f"{spent:6.0f} s  {count:5d} tests of {folder}")
        dearest = sorted(files.items(), key=lambda one: -one[1])[:LISTED]
        say("dearest: " + ", ".join(f"{name.removeprefix('tests/')} {seconds:.0f} s" for name, seconds in dearest))
