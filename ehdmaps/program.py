"""Code that all programs of this distribution share: from the arguments of the process to its exit status.

A `Program` is the parser of a program: commands in groups, and options that many commands take in the same words. These
are declared once, explained once, by `PROGRAM --help`, and stand anywhere on the command line.

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
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NoReturn, TextIO

from ehdmaps.errors import EhdmapsError, InputError, WorkerError
from ehdmaps.interrupts import STOPPED, Stopped, careful_interrupts

DONE, NOT_DELIVERED, NO_RESULT, BAD_INPUT = 0, 1, 1, 2

MOST = 1024
"""Largest number of processes, cores or points that a command line takes."""

MOST_TOLD = 20
"""Problems that are listed; who has mended these sees the others."""

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


class Program(Parser):
    """The parser of a program: commands in groups, and options that several commands share.

    Parameters
    ----------
    prog : str
        Name of the program.
    description, epilog : str
        What --help says before and after the commands.
    renamed : mapping of str to str
        Options that were called otherwise, and what to write now.

    Attributes
    ----------
    shared : Parser
        Takes the options that are shared; `add_command` says which of them a command has.
    """

    def __init__(self, prog: str, description: str, epilog: str, renamed: Mapping[str, str]) -> None:
        super().__init__(prog=prog, description=description, epilog=epilog, add_help=False)
        self.add_argument("-h", "--help", action="help", help="show this help message and end")
        self.add_version()
        self.shared = Parser(prog=prog, add_help=False, allow_abbrev=False)
        self.shared.error = self.error  # type: ignore[method-assign]
        self._commands = self.add_subparsers(dest="command", required=True, metavar="COMMAND", parser_class=Parser)
        self._groups: dict[str, list[tuple[str, str]]] = {}
        self._takes: dict[str, frozenset[str]] = {}
        self._renamed = renamed

    def add_command(
        self, group: str, name: str, words: str, shared: Iterable[str] = (), more: str = "", epilog: str = ""
    ) -> Parser:
        """Add a command.

        Parameters
        ----------
        group : str
            Heading in --help under which it stands.
        name, words : str
            Name, and what it does.
        shared : iterable of str
            Keys of the shared options that it takes.
        more : str
            What its own help says of these.
        epilog : str
            What its own help says at the end.
        """
        takes = frozenset(shared)
        options = ", ".join(option for key, option in self._shared_options().items() if key in takes)
        also = f"Also, as `{self.prog} --help` explains: {options}{more}" if takes else ""
        command = self._commands.add_parser(
            name, description=words, epilog=". ".join(text for text in (also, epilog) if text) or None
        )
        self._groups.setdefault(group, []).append((name, words))
        self._takes[name] = takes
        return command

    def _shared_options(self) -> dict[str, str]:
        """The options that are shared, by their keys."""
        return {action.dest: action.option_strings[-1] for action in self.shared._actions}

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse the arguments; of the shared options a command gets those that it takes."""
        given, rest = self.shared.parse_known_args(sys.argv[1:] if args is None else args)
        arguments, unknown = super().parse_known_args(rest, namespace)
        takes = self._takes[arguments.command]
        for key, option in self._shared_options().items():
            if key in takes:
                setattr(arguments, key, getattr(given, key))
            elif getattr(given, key) != self.shared.get_default(key):
                others = ", ".join(name for name, taken in self._takes.items() if key in taken)
                self.error(f"{self.prog} {arguments.command} has no {option}; allowed: with {others}")
        return arguments, unknown

    def parse_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse the arguments, all of which have to be known."""
        arguments, unknown = self.parse_known_args(args, namespace)
        if unknown:
            options = (text.split("=")[0] for text in unknown)
            advice = [f"; {option} is {self._renamed[option]} now" for option in options if option in self._renamed]
            self.error(f"unrecognized arguments: {' '.join(unknown)}{''.join(advice)}")
        return arguments

    def format_usage(self) -> str:
        """The first line of help and errors."""
        return f"usage: {self.prog} [-h] [--version] COMMAND ...\n"

    def format_help(self) -> str:
        """Commands by groups, then the options that are shared."""
        formatter = self._get_formatter()
        formatter.add_text(self.description)
        wide = max((len(name) for names in self._groups.values() for name, _ in names), default=0)
        for group, names in self._groups.items():
            formatter.start_section(group)
            formatter.add_arguments([_line(name.ljust(wide), words) for name, words in names])
            formatter.end_section()
        for shared in self.shared._action_groups:
            formatter.start_section(shared.title)
            formatter.add_text(shared.description)
            formatter.add_arguments(shared._group_actions)
            formatter.end_section()
        formatter.add_text(self.epilog)
        return f"{self.format_usage()}\n{formatter.format_help()}"


def _line(name: str, words: str) -> argparse.Action:
    """A line of help on a command."""
    return argparse.Action([], name.strip(), metavar=name, help=words.replace("%", "%%"))


class _Version(argparse.Action):
    """Looks the version up only where it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        """Print it, and end."""
        from ehdmaps.version import version

        parser._print_message(f"{_plain(parser.prog)} {version()}", sys.stdout)
        parser.exit()


def count(text: str, least: int = 1, most: int = MOST) -> int:
    """Read a number of processes, cores or points of a command line.

    Parameters
    ----------
    text : str
        What was given.
    least, most : int
        Smallest and largest number that is allowed.

    Raises
    ------
    ArgumentTypeError
        For anything but a whole number in this range.
    """
    plain = text.isascii() and text.isdigit() and len(text) <= len(str(most))
    if not (plain and least <= int(text) <= most):
        raise argparse.ArgumentTypeError(f"got {text[:40]!r}; allowed: a whole number from {least} to {most}")
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
    """List problems on stderr, the first of many."""
    head = f"{name}: {len(problems)} problem{'s' if len(problems) > 1 else ''}"
    more = [f"  ... and {len(problems) - MOST_TOLD} more"] * (len(problems) > MOST_TOLD)
    tell("\n".join([head, *(f"  {problem}" for problem in problems[:MOST_TOLD]), *more]))


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
