"""The search itself: damage follows from its seed, and whatever a reader does wrong is found."""

from __future__ import annotations

import gc
import os
import signal
import time
import warnings
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.errors import InputError
from tests.fuzzing import search
from tests.fuzzing.damage import BINARY_WAYS, LARGEST, TEXT_WAYS, damage
from tests.fuzzing.search import Reader, case_of, fuzz

GOOD = {"a.txt": b'load = "1.5 N/mm"\npoints = 3\n' * 5, "a.nc": bytes(range(256)) * 4}


@pytest.mark.parametrize("text", [True, False])
def test_damage_follows_from_its_seed(text: bool) -> None:
    content = GOOD["a.txt"] if text else GOOD["a.nc"]
    first, again = (
        [damage(content, text, np.random.default_rng([1, n]), content) for n in range(300)] for _ in range(2)
    )
    assert first == again
    assert sum(entry.content != content for entry in first) > 250  # some ways find nothing to damage
    assert {way for entry in first for way in entry.how.split(" + ")} == set(TEXT_WAYS if text else BINARY_WAYS)
    assert max(len(entry.content) for entry in first) <= LARGEST


def _crash(folder: Path) -> str:
    os.kill(os.getpid(), signal.SIGSEGV)
    return ""


def _wait(folder: Path) -> str:
    while True:
        time.process_time()


def _fill(folder: Path) -> str:
    gc.collect()
    pages = np.empty(12_500_000)  # twice the bar, a page at a time
    pages[::512] = 1.0
    return "" if pages[0] == 1.0 else "no"


def _ask(folder: Path) -> str:
    try:
        return "" if np.ones(10**12).all() else "no"
    except MemoryError as error:
        raise InputError("a.txt: cannot be read") from error


def _warn(folder: Path) -> str:
    warnings.warn("overflow encountered", RuntimeWarning, stacklevel=1)
    return ""


def _overwrite(folder: Path) -> str:
    (folder / "a.txt").write_bytes(b"mine")
    raise InputError("a.txt: is none")


def _leave(folder: Path) -> str:
    (folder / "left.part").touch()
    return ""


def _say_nothing(folder: Path) -> str:
    raise InputError("")


def _say_too_much(folder: Path) -> str:
    raise InputError("a" * 5000)


def _slip(folder: Path) -> str:
    raise KeyError("load")


def _right(folder: Path) -> str:
    return ""


def _wrong(folder: Path) -> str:
    return "another load than was written"


def _refuse(folder: Path) -> str:
    raise InputError(f"{folder}/a.txt: got {os.urandom(4).hex()!r}; allowed: 1.5")


def after_the_good_one(read, parent: int):
    """A reader that does wrong in the child only: the good files are read in the parent."""
    return lambda folder: "" if os.getpid() == parent else read(folder)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("read", "words"),
    [
        (_crash, "crash: SIGSEGV"),
        (_wait, "did not end within"),
        (_fill, "MB"),
        (_ask, "asked for more than"),
        (_warn, "warning: overflow encountered"),
        (_overwrite, "a.txt was changed"),
        (_leave, "the folder holds a.nc, a.txt, left.part"),
        (_say_nothing, "InputError without a word"),
        (_say_too_much, "InputError of 5000 letters in a line"),
        (_slip, "KeyError: 'load'"),
        (_wrong, "another load"),
    ],
)
def test_whatever_a_reader_does_wrong_is_found(read, words, monkeypatch) -> None:
    if read is _fill:
        # Garbage of the parent, as large: collected in the child, it would hide the growth.
        circle = [np.ones(12_500_000)]
        circle.append(circle)
        del circle
    # Memory that a machine was not asked for before comes slowly.
    monkeypatch.setattr(search, "MOST_SECONDS", 10.0 if read is _fill else 0.6)
    monkeypatch.setattr(search, "MOST_MEMORY", 50e6)
    found = fuzz(Reader("file", [GOOD], after_the_good_one(read, os.getpid())), 1, 1)
    assert (found.tried, found.failed) == (1, 1)
    assert words in found.failures[0].what
    assert found.failures[0].case.startswith("file, seed 1, number 0: a.")


def test_a_reader_that_does_right() -> None:
    found = fuzz(Reader("file", [GOOD], after_the_good_one(_right, os.getpid())), 30, 1)
    assert (found.tried, found.right, found.failed) == (30, 30, 0)
    found = fuzz(Reader("file", [GOOD], after_the_good_one(_refuse, os.getpid())), 30, 1)
    assert (found.refused, dict(found.reasons)) == (30, {"a.txt: got #; allowed: #": 30})


def test_good_files_that_a_reader_gets_wrong() -> None:
    found = fuzz(Reader("file", [GOOD], _wrong), 0, 1)
    assert found.failures[0].case == "file, the good files"


def test_only_the_named_files_are_damaged() -> None:
    reader = Reader("file", [GOOD], _right, damaged=("a.nc",))
    assert all(case_of(reader, 1, number).files["a.txt"] == GOOD["a.txt"] for number in range(20))
