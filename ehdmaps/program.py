"""Code that all programs of this distribution share: from the arguments of the process to its exit status.

Everything that a program prints goes through here: results on stdout (`deliver`), problems and progress on stderr
(`tell`). Foreign text reaches a terminal without its control characters, and what the encoding of a stream lacks is
written as an escape.
"""

from __future__ import annotations

import argparse
import contextlib
import errno
import math
import os
import sys
from collections.abc import Callable, Sequence
from typing import Any, NoReturn, TextIO

from ehdmaps.errors import EhdmapsError, InputError, WorkerError
from ehdmaps.interrupts import STOPPED, Stopped, careful_interrupts

DONE, NOT_DELIVERED, NO_RESULT, BAD_INPUT = 0, 1, 1, 2

MOST = 1024
"""Largest number of processes, cores or points that a command line takes."""

_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")

_CONTROLS = {code: f"\\x{code:02x}" for code in (*range(0x20), *range(0x80, 0xA0)) if chr(code) not in "\n\t"}
# Four digits, which JSON understands as well: its own escapes leave this character as it is.
_CONTROLS[0x7F] = "\\u007f"
_DIRECTIONS = {code: f"\\u{code:04x}" for code in (*range(0x202A, 0x202F), *range(0x2066, 0x206A))}
_ESCAPES = _CONTROLS | _DIRECTIONS


_LEAST = {
    "RLIMIT_AS": (1e9, "of memory addresses", "ulimit -v"),
    "RLIMIT_DATA": (6e8, "of data", "ulimit -d"),
    "RLIMIT_STACK": (2.5e5, "of stack", "ulimit -s"),
}
"""Least limits of a process [bytes]. One that compiles the solver was seen to take 0.79 GB of addresses, 0.47 GB of
data and 0.13 MB of stack; with less, libraries crash or never end, before anything of ours can say why."""

_LACK = {errno.ENOMEM, errno.EMFILE, errno.ENFILE, errno.EAGAIN}
"""Of errors of the system: there is not enough of something."""


class Parser(argparse.ArgumentParser):
    """A parser of arguments that prints as the rest of the program does.

    Attributes
    ----------
    complete : callable or None
        Adds the arguments that depend on others; it is given all arguments before they are parsed.
    """

    complete: Callable[[Sequence[str]], None] | None = None

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse the arguments, those included that depend on others."""
        if self.complete is not None:
            self.complete([] if args is None else args)
        return super().parse_known_args(args, namespace)

    def error(self, message: str) -> NoReturn:
        """Say what is wrong about the arguments, and end."""
        tell(f"{self.format_usage()}{self.prog}: error: {message}")
        raise SystemExit(BAD_INPUT)

    def _get_value(self, action: argparse.Action, arg_string: str) -> Any:
        """Read one value of an argument; an empty text, as of a variable that is not set, is none."""
        if not arg_string and action.nargs != argparse.PARSER:  # those of a command are looked at by its own parser
            raise argparse.ArgumentError(action, "got ''; allowed: a text that is not empty, or to leave it out")
        return super()._get_value(action, arg_string)

    def _print_message(self, message: str, file: Any = None) -> None:
        """Print help, or the version."""
        status = deliver(self.prog, message.rstrip("\n"), DONE)
        if status:
            raise SystemExit(status)

    def add_version(self) -> None:
        """Add the option `--version`."""
        self.add_argument("--version", action=_Version, nargs=0, help="show the version and end")


class _Version(argparse.Action):
    """Looks the version up only where it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        """Print it, and end."""
        from ehdmaps.version import version

        parser._print_message(f"{_plain(parser.prog)} {version()}", sys.stdout)
        parser.exit()


def count(text: str) -> int:
    """Read a number of processes, cores or points of a command line.

    Parameters
    ----------
    text : str
        What was given.

    Raises
    ------
    ArgumentTypeError
        For anything but a whole number from 1 to 1024.
    """
    if not (text.isascii() and text.isdigit() and 1 <= int(text[:6]) <= MOST and len(text) <= 4):
        raise argparse.ArgumentTypeError(f"got {text[:40]!r}; allowed: a whole number from 1 to {MOST}")
    return int(text)


def run(
    parser: argparse.ArgumentParser,
    work: Callable[[argparse.Namespace], tuple[str, int]],
    argv: Sequence[str] | None = None,
    no_result: type[EhdmapsError] | tuple[type[EhdmapsError], ...] = (),
) -> int:
    """Run a program.

    Parameters
    ----------
    parser : argparse.ArgumentParser
        Parser of the program's arguments; messages begin with its name.
    work : callable
        Takes the arguments, gives the text for stdout and the exit status.
    argv : sequence of str, optional
        Arguments of the command line; those of the process if left out, which ends after this then.
    no_result : type or types of error
        That mean that valid input has no result: exit status 1 instead of 2.

    Returns
    -------
    int
        Exit status: that of the work; 1 also if its result could not be printed, or worker processes died after some
        work; 2 for input that cannot be used, and where the system gives too little to begin; 130 after Ctrl-C, 143
        after SIGTERM.
    """
    stopped = Stopped()
    try:
        with careful_interrupts(last=argv is None) as stopped:
            status = _run(parser, work, sys.argv[1:] if argv is None else argv, no_result)
    except KeyboardInterrupt:
        tell("\nstopped")
        status = STOPPED
    return stopped.status if status == STOPPED else status


def shown(text: str) -> str:
    r"""Return a text as a terminal may have it.

    Control characters other than newline and tab, and characters that turn the direction of writing around, become
    visible escapes such as ``\x1b``.
    """
    return text.translate(_ESCAPES)


def plain(text: object) -> str:
    """Return a foreign text as part of a line: what is not printable, line breaks too, is a question mark.

    `shown` looks after whole outputs, whose line breaks stay; figures, tables and exports do not pass it.
    """
    return "".join(character if character.isprintable() else "?" for character in str(text))


def deliver(name: str, text: str, status: int) -> int:
    """Print a result on stdout.

    A reader that closes the pipe early has had enough, which is no error of ours.

    Parameters
    ----------
    name : str
        Name of the program, for the message.
    text : str
        Text without its last newline; nothing is printed where it is empty.
    status : int
        Exit status of the work.

    Returns
    -------
    int
        The same status; 1 in place of 0 if the result could not be printed, which is told on stderr.
    """
    if not text:
        return status
    try:
        if sys.stdout is None:
            raise OSError("it is closed")
        _write(sys.stdout, text)
    except BrokenPipeError:
        _leave(sys.stdout)
    except (OSError, ValueError) as error:
        _leave(sys.stdout)
        tell(f"{name}: the result could not be printed on stdout ({getattr(error, 'strerror', None) or error})")
        return status or NOT_DELIVERED
    return status


def tell(text: str) -> None:
    """Write a line or more to stderr; where that is impossible, the work goes on all the same."""
    if sys.stderr is None:
        return
    try:
        _write(sys.stderr, text)
    except (OSError, ValueError):
        _leave(sys.stderr)


def complain(name: str, problems: Sequence[str]) -> None:
    """List problems on stderr."""
    head = f"{name}: {len(problems)} problem{'s' if len(problems) > 1 else ''}"
    tell("\n".join([head, *(f"  {problem}" for problem in problems)]))


def lack(error: BaseException) -> str:
    """Say in one sentence what the system has too little of; empty for errors of other kinds.

    Parameters
    ----------
    error : BaseException
        What was raised.
    """
    if not (isinstance(error, MemoryError) or (isinstance(error, OSError) and error.errno in _LACK)):
        return ""
    cause = getattr(error, "strerror", None) or "out of memory"
    return f"the system has too little ({cause}); look after memory and limits (ulimit -a), or take fewer processes"


def _tight_limits() -> list[str]:
    """Tell which limits of this process leave libraries too little."""
    try:
        import resource
    except ImportError:  # a system that has none
        return []
    problems = []
    for name, (least, what, command) in _LEAST.items():
        soft, _ = resource.getrlimit(getattr(resource, name))
        if soft != resource.RLIM_INFINITY and soft < least:
            problems.append(
                f"limit {what}: got {soft / 1e6:.4g} MB; allowed: {least / 1e6:g} MB or more; raise it: {command} "
                f"{math.ceil(least / 1024)}"
            )
    return problems


def _plain(program: str) -> str:
    """Name of a program that may be a module to be run."""
    return program.removeprefix("python -m ")


def _run(
    parser: argparse.ArgumentParser,
    work: Callable[[argparse.Namespace], tuple[str, int]],
    argv: Sequence[str],
    no_result: type[EhdmapsError] | tuple[type[EhdmapsError], ...],
) -> int:
    """Run a program that may be interrupted."""
    _occupy_standard_files()
    name = _plain(parser.prog)
    problems = _foreign_arguments(argv)
    if problems:
        complain(name, problems)
        return BAD_INPUT
    arguments = parser.parse_args(argv)
    name = f"{name} {getattr(arguments, 'command', '')}".rstrip()
    if problems := _tight_limits():
        complain(name, problems)
        return BAD_INPUT
    _prepare_libraries()
    try:
        text, status = work(arguments)
    except EhdmapsError as error:
        complain(name, error.problems if isinstance(error, InputError) else str(error).splitlines())
        kept = isinstance(error, WorkerError) and error.kept > 0
        return NO_RESULT if kept or isinstance(error, no_result) else BAD_INPUT
    except (MemoryError, OSError) as error:
        if not (problem := lack(error)):
            raise
        complain(name, [problem])
        return BAD_INPUT
    return deliver(name, text, int(status))


def _occupy_standard_files() -> None:
    """Open what the caller has closed of stdin, stdout and stderr.

    A file that is written must not get their place, where libraries in C print.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)


def _foreign_arguments(argv: Sequence[str]) -> list[str]:
    """Tell which arguments are no text: names of files in another encoding than that of the system."""
    encoding = sys.getfilesystemencoding()
    advice = "rename the file or folder" + ("" if encoding == "utf-8" else ", or choose a locale with UTF-8")
    return [
        f"argument {place}: got {text!r:.300}, which is not text in {encoding}; allowed: text in UTF-8; {advice}"
        for place, text in enumerate(argv, 1)
        if any(0xD800 <= ord(character) <= 0xDFFF for character in text)
    ]


def _prepare_libraries() -> None:
    """Set, before they are loaded, what numpy and matplotlib take from the environment."""
    # The matrices are small, and more threads than processes only get in each other's way.
    for name in _THREADS:
        os.environ.setdefault(name, "1")
    # Figures are only written to files. A notebook names a backend that need not be installed here; matplotlib refuses
    # to be loaded then.
    os.environ["MPLBACKEND"] = "agg"


def _write(stream: TextIO, text: str) -> None:
    """Write a text and a newline at once."""
    encoding = stream.encoding or "utf-8"
    stream.write(f"{shown(text)}\n".encode(encoding, "backslashreplace").decode(encoding))
    stream.flush()


def _leave(stream: TextIO | None) -> None:
    """Give a stream that takes nothing another place to write to: the interpreter flushes it again at its end."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())  # type: ignore[union-attr]
