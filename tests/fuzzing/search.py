"""A reader given damaged files: it reads what is one, refuses what is none in words, and does no harm either way.

Cases run in child processes, so that a library in C that crashes or never ends is a finding, not the end of the search.
A child may take `MOST_MEMORY` more than it had at its start; its parent looks on. Every case follows from the seed and
its number alone.
"""

from __future__ import annotations

import contextlib
import faulthandler
import gc
import json
import os
import re
import resource
import select
import shutil
import signal
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from ehdmaps.errors import EhdmapsError
from mbs.laboratory.extremes.check import Check, Verdict, checked
from tests.fuzzing.damage import Damaged, damage

MOST_SECONDS = 10.0
"""Processor time that a small file may take; most take some milliseconds."""

MOST_WAIT = 120.0
"""Wall time after which a case counts as one that never ends, though it takes no processor time."""

MOST_MEMORY = 400e6
"""Memory that a file may take [bytes]; the damaged ones are small, see `tests.fuzzing.damage.LARGEST`."""

_ADDRESSES = 2e9
"""Address space that a child may add [bytes]: what asks for more is told, instead of filling the machine."""

_BATCH = 1000
"""Cases of one child."""

LONGEST_WORDS = 3000
"""Letters of one problem: a sentence, however long what was got is."""

_BINARY = (".nc", ".npz", ".store")
"""Endings of files that are no text."""

_VARIED = re.compile(r"'[^']*'|\"[^\"]*\"|b'.*?'|\S*/\S*|[-+]?[0-9][-+0-9.e]*")


@dataclass(frozen=True)
class Reader:
    """Reader that is given damaged files.

    Attributes
    ----------
    name : str
        What is read, such as "job file".
    folders : sequence of mapping of str to bytes
        Good files, by name; in each case one file of one of the folders is damaged.
    read : callable
        Reads from a folder that holds these files, and says what is wrong about the result; nothing where it is right.
        It refuses by an error of this distribution.
    damaged : tuple of str
        Names of the files that are damaged; all if left out.
    writes : bool
        Whether a file that it reads is also written to, as a store is.
    """

    name: str
    folders: Sequence[Mapping[str, bytes]]
    read: Callable[[Path], str]
    damaged: tuple[str, ...] = ()
    writes: bool = False


@dataclass(frozen=True)
class Case:
    """A folder of files, one of them damaged.

    Attributes
    ----------
    label : str
        What was done, and what repeats it.
    files : mapping of str to bytes
        All files.
    """

    label: str
    files: Mapping[str, bytes] = field(repr=False)


def case_of(reader: Reader, seed: int, number: int) -> Case:
    """Return a case; the same one for the same arguments.

    Parameters
    ----------
    reader : Reader
        What is given damaged files.
    seed : int
        Seed of the search.
    number : int
        Number of the case.
    """
    rng = np.random.default_rng([seed, number])
    folder = reader.folders[int(rng.integers(len(reader.folders)))]
    names = [name for name in folder if not reader.damaged or name in reader.damaged]
    name = names[rng.integers(len(names))]
    others = [content for files in reader.folders for key, content in files.items() if _text(key) == _text(name)]
    damaged: Damaged = damage(folder[name], _text(name), rng, others[rng.integers(len(others))])
    label = f"{reader.name}, seed {seed}, number {number}: {name}: {damaged.how}"
    return Case(label, {**folder, name: damaged.content})


def _text(name: str) -> bool:
    """Tell whether a file is text, by its name."""
    return not name.endswith(_BINARY)


def fuzz(reader: Reader, mutations: int, seed: int) -> Check:
    """Give a reader damaged files, and count what becomes of them.

    Parameters
    ----------
    reader : Reader
        What is given them.
    mutations : int
        How many.
    seed : int
        Seed of the search.
    """
    seconds = [0.0]

    def verdicts() -> Iterator[Verdict]:
        for files in reader.folders:
            with _folder(files) as folder:
                problem = reader.read(folder) or ("" if reader.writes else _changed(files, folder))
            if problem:
                yield Verdict(f"{reader.name}, the good files", wrong=problem)
        for number, outcome in _outcomes(reader, mutations, seed):
            seconds.append(outcome["seconds"])
            label = case_of(reader, seed, number).label if outcome["failed"] else ""
            yield Verdict(label, wrong=outcome["failed"], refused=outcome["refused"])

    return checked(
        f"{reader.name}, damaged",
        f"read with a right result, or refused in words; at most {MOST_SECONDS:g} s and {MOST_MEMORY / 1e6:g} MB a "
        "file, no crash, no warning, no file changed",
        verdicts(),
        lambda: f"{max(seconds):.2g} s for one file",
    )


def _outcomes(reader: Reader, mutations: int, seed: int) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield number and outcome of each case, from one child after the other."""
    number = 0
    while number < mutations:
        end = min(mutations, number + _BATCH)
        for last, outcome in _batch(reader, seed, number, end):
            yield last, outcome
            number = last + 1


def _batch(reader: Reader, seed: int, begin: int, end: int) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield the outcomes of a child; it stops after a case that ends it."""
    source, sink = os.pipe()
    with warnings.catch_warnings():
        # That libraries may have threads: they are idle, and the child leaves without their help.
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child == 0:
        os.close(source)
        _work(reader, seed, begin, end, sink)
    os.close(sink)
    number, rest, ended = begin, b"", ""
    try:
        while number < end and not ended:
            if not select.select([source], [], [], MOST_WAIT)[0]:
                ended = f"did not end within {MOST_WAIT:g} s"
                os.kill(child, signal.SIGKILL)
                break
            chunk = os.read(source, 65536)
            if not chunk:
                break
            *lines, rest = (rest + chunk).split(b"\n")
            for line in lines:
                yield number, json.loads(line)
                number += 1
    finally:
        os.close(source)
        if number < end and not ended:
            # The child is gone already, or nobody wants its results any more.
            with contextlib.suppress(ProcessLookupError):
                os.kill(child, signal.SIGTERM)
        _, status = os.waitpid(child, 0)
    if number < end:
        died = -os.waitstatus_to_exitcode(status)
        if died == signal.SIGXCPU:
            ended = f"did not end within {2.0 * MOST_SECONDS:g} s of processor time"
        words = ended or (f"crash: {signal.Signals(died).name}" if died > 0 else f"the process left with {-died}")
        yield number, {"failed": words, "refused": "", "seconds": 0.0}


def _work(reader: Reader, seed: int, begin: int, end: int, sink: int) -> NoReturn:
    """Run cases in a child, tell of each, and leave."""
    status = 1
    try:
        faulthandler.disable()
        # Garbage of the parent stays: what this process gave back would hide as much growth.
        gc.freeze()
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        # What a library prints about a broken file is no finding, and no use to anybody.
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for stream in (1, 2):
            os.dup2(nowhere, stream)
        _limit_addresses()
        for number in range(begin, end):
            case = case_of(reader, seed, number)
            _limit_seconds()
            with _folder(case.files) as folder:
                outcome = _judged(reader, case, folder)
            os.write(sink, json.dumps(outcome).encode() + b"\n")
        status = 0
    finally:
        os._exit(status)


def _limit_seconds() -> None:
    """Have the system end this process where the next case never ends."""
    _, most = resource.getrlimit(resource.RLIMIT_CPU)
    resource.setrlimit(resource.RLIMIT_CPU, (int(time.process_time() + 2.0 * MOST_SECONDS) + 1, most))


def _limit_addresses() -> None:
    """Refuse this process an absurd amount of memory."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[0])
    except (OSError, ValueError):
        return  # a system without it: the memory in use is looked at afterwards
    limit = int(pages * resource.getpagesize() + _ADDRESSES)
    _, most = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (limit if most == resource.RLIM_INFINITY else min(limit, most), most))


def as_written(name: str, write: Callable[[Path], None], files: Mapping[str, bytes] | None = None) -> bytes:
    """Content of a file that is written into a folder.

    Parameters
    ----------
    name : str
        Name of the file.
    write : callable
        Writes to its path.
    files : mapping of str to bytes, optional
        Other files of the folder.
    """
    with _folder(files or {}) as folder:
        write(folder / name)
        return (folder / name).read_bytes()


@contextlib.contextmanager
def _folder(files: Mapping[str, bytes]) -> Iterator[Path]:
    """A folder with these files, for a while."""
    folder = Path(tempfile.mkdtemp(prefix="ehdmaps-fuzz-"))
    try:
        for name, content in files.items():
            (folder / name).write_bytes(content)
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _judged(reader: Reader, case: Case, folder: Path) -> dict[str, Any]:
    """Outcome of a case: what failed, why it was refused, and the time."""
    before, began = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    failed = refused = ""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            failed = reader.read(folder)
        except EhdmapsError as error:
            refused = _reason(str(error), folder) or "no words"
            failed = _wording(error)
        except Exception as error:
            failed = f"{type(error).__name__}: {error!s:.300}"
    seconds = time.process_time() - began
    grown = 1024.0 * (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
    if not failed and caught:
        failed = f"warning: {caught[0].message!s:.300}"
    if not failed and seconds > MOST_SECONDS:
        failed = f"took {seconds:.3g} s"
    if not failed and grown > MOST_MEMORY:
        failed = f"took {grown / 1e6:.4g} MB"
    if not failed and (refused or not reader.writes):
        failed = _changed(case.files, folder)
    return {"failed": failed, "refused": refused, "seconds": seconds}


def _wording(error: EhdmapsError) -> str:
    """Problems with the words of a refusal."""
    problems = str(error).splitlines()
    if not any(problem.strip() for problem in problems):
        return f"{type(error).__name__} without a word"
    longest = max(map(len, problems))
    if longest > LONGEST_WORDS:
        return f"{type(error).__name__} of {longest} letters in a line: {max(problems, key=len)[:120]}"
    cause: BaseException | None = error
    while cause is not None:
        if isinstance(cause, MemoryError):
            return f"asked for more than {_ADDRESSES / 1e9:g} GB: {problems[0][:200]}"
        cause = cause.__cause__ or cause.__context__
    return ""


def _reason(text: str, folder: Path) -> str:
    """Reason for which something was refused, in words that are alike for alike cases."""
    first = next((line for line in text.splitlines() if line.strip()), "")
    words = " ".join(_VARIED.sub("#", first.replace(f"{folder}/", "")[:400]).split())
    return words.encode("ascii", "replace").decode()[:70]


def _changed(files: Mapping[str, bytes], folder: Path) -> str:
    """Tell what has become of the files of a folder; nothing where they are as they were."""
    names = sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))
    if names != sorted(files):
        return f"the folder holds {', '.join(names)} after it"
    changed = [name for name, content in files.items() if (folder / name).read_bytes() != content]
    return f"{', '.join(changed)} was changed" if changed else ""
