"""What both programs do alike: arguments, streams that take nothing, foreign characters, versions, Ctrl-C."""

import argparse
import errno
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import examples.housings.__main__ as housings
import mbs.cli
from ehdmaps import errors, program
from ehdmaps.errors import AnalysisError
from ehdmaps.jobs import cli
from tests.cases.commands import without_note
from tests.cases.interruptible import start
from tests.cases.jobs import DRY
from tests.cases.programs import needed

ROOT = str(Path(errors.__file__).parents[1])
DATA = Path(__file__).parents[1] / "data"
PROGRAMS = {"ehdmaps": "ehdmaps.jobs.cli", "mbs": "mbs", "examples.housings": "examples.housings"}
NOWHERE = {"ehdmaps": ["status", "none.nc"], "mbs": ["modes", "none.toml"], "examples.housings": ["none"]}


LACK = "the system has too little ({}); look after memory and limits (ulimit -a), or take fewer processes"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", ROOT)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "job.toml").write_text(DRY)
    return tmp_path


@pytest.fixture
def made(folder):
    """A map that `ehdmaps status` has something to say about: of the commands with a result the quickest."""
    for name in ("job.nc", "größe.nc"):
        shutil.copy(DATA / "schema4.nc", folder / name)


def done(name, *arguments, **options):
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | options
    command = [sys.executable, "-m", PROGRAMS[name], *arguments]
    return subprocess.run(command, check=False, **options)


def full():
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full here")
    return open("/dev/full", "wb")


# --- streams


@pytest.mark.parametrize(
    ("name", "option"), [("ehdmaps", "--help"), ("mbs", "--version"), ("examples.housings", "--help")]
)
def test_help_that_finds_no_room_is_told(folder, name, option):
    with full() as stream:
        found = done(name, option, stdout=stream)
    said = f"{'python -m ' if '.' in name else ''}{name}: the result could not be printed on stdout"
    assert (found.returncode, found.stderr.decode()) == (1, f"{said} ({os.strerror(errno.ENOSPC)})\n")


def test_a_result_that_finds_no_room_is_told(made):
    with full() as stream:
        found = done("ehdmaps", "status", "job.nc", stdout=stream)
    assert found.returncode == 1
    assert found.stderr.decode() == (
        f"ehdmaps status: the result could not be printed on stdout ({os.strerror(errno.ENOSPC)})\n"
    )


def shell(command):
    return subprocess.run([needed("bash"), "-c", f"{sys.executable} -m {command}"], capture_output=True, check=False)


def test_a_closed_stdout_is_told(made):
    found = shell("ehdmaps.jobs.cli status job.nc >&-")
    assert (found.returncode, found.stderr.decode()) == (
        1,
        "ehdmaps status: the result could not be printed on stdout (it is closed)\n",
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "stderr"),
    [("ehdmaps", "2>/dev/full")],
)
def test_problems_that_nobody_can_read_keep_their_exit_status(folder, name, stderr):
    if stderr.endswith("full"):
        full().close()
    assert shell(f"{PROGRAMS[name]} {' '.join(NOWHERE[name])} {stderr}").returncode == 2


@pytest.mark.slow
@pytest.mark.parametrize("streams", [">&- 2>&- <&-"])
def test_a_map_is_made_whole_where_nobody_listens(folder, streams):
    if "full" in streams:
        full().close()
    status = shell(f"ehdmaps.jobs.cli generate job.toml --workers 1 {streams}").returncode
    assert status == (1 if ">&- 2" in streams else 0)
    assert cli.main(["compare", "job.nc", "job.nc"]) == 0


# --- arguments and characters


@pytest.mark.parametrize("name", PROGRAMS)
def test_arguments_that_are_no_text_are_refused_at_once(folder, name):
    found = done(name, "--plot", b"a\xe9\x1b[31m.png", "none")
    assert (found.returncode, found.stdout) == (2, b"")
    assert found.stderr.decode("ascii") == (
        f"{name}: 1 problem\n  argument 2: got 'a\\udce9\\x1b[31m.png', which is not text in utf-8; allowed: text in "
        "UTF-8; rename the file or folder\n"
    )


def test_a_locale_without_utf_8_is_named(folder, monkeypatch):
    for name, value in (("PYTHONUTF8", "0"), ("PYTHONCOERCECLOCALE", "0"), ("LC_ALL", "C")):
        monkeypatch.setenv(name, value)
    found = done("ehdmaps", "check", "größe.toml".encode())
    assert found.returncode == 2
    assert b"which is not text in ascii; allowed: text in UTF-8; rename the file or folder, or choose a locale" in (
        found.stderr
    )


@pytest.mark.parametrize("name", ["ehdmaps", "mbs"])
def test_foreign_characters_reach_a_terminal_as_escapes(folder, capsys, name):
    main = {"ehdmaps": cli.main, "mbs": mbs.cli.main}[name]
    foreign = "\x1b]0;title\x07\x9b31m\u202egnp\u2066\x7f"
    assert main([NOWHERE[name][0], f"{foreign}.toml"]) == 2
    found = capsys.readouterr().err
    assert "\\x1b]0;title\\x07\\x9b31m\\u202egnp\\u2066\\u007f.toml" in found
    with pytest.raises(SystemExit) as end:
        main([foreign])
    assert end.value.code == 2
    assert not set(foreign) - set("]0;title31mgnp") & set(found + capsys.readouterr().err)


def test_a_stream_that_lacks_a_character_gets_an_escape(folder, monkeypatch):
    monkeypatch.setenv("PYTHONIOENCODING", "ascii")
    found = done("ehdmaps", NOWHERE["ehdmaps"][0], "größe.nc")
    assert found.returncode == 2
    assert b"gr\\xf6\\xdfe.nc" in found.stderr


def test_a_result_in_an_encoding_that_lacks_a_character(made, monkeypatch):
    monkeypatch.setenv("PYTHONIOENCODING", "ascii")
    found = done("ehdmaps", "status", "größe.nc")
    assert (found.returncode, found.stderr) == (0, b"")
    assert found.stdout.startswith(b"gr\\xf6\\xdfe.nc: finished")


def test_newline_and_tab_stay():
    assert program.shown("a\tb\nc\r\x00") == "a\tb\nc\\x0d\\x00"


# --- libraries


@pytest.mark.slow
def test_the_backend_of_a_notebook_is_no_matter_of_the_programs(folder, monkeypatch):
    assert cli.main(["generate", "job.toml", "--workers", "1"]) == 0
    monkeypatch.setenv("MPLBACKEND", "module://no.such.backend")
    found = done("ehdmaps", "plot", "job.nc")
    assert (found.returncode, without_note(found.stderr.decode())) == (0, "")
    assert (folder / "job.png").stat().st_size > 0
    # Before it reads anything the other program puts its own backend there, too.
    assert mbs.cli.main(NOWHERE["mbs"]) == 2
    assert os.environ["MPLBACKEND"] == "agg"


# --- versions and exit status


@pytest.mark.parametrize("name", PROGRAMS)
def test_programs_know_their_version(name, capsys):
    main = {"ehdmaps": cli.main, "mbs": mbs.cli.main, "examples.housings": housings.main}[name]
    with pytest.raises(SystemExit) as end:
        main(["--version"])
    out = capsys.readouterr().out
    assert end.value.code == 0
    assert out.startswith(f"{name} ") and out.split()[1][0].isdigit()


@pytest.mark.parametrize(
    ("error", "status", "said"),
    [
        (errors.InputError(["a", "b"]), 2, "p work: 2 problems\n  a\n  b\n"),
        (errors.StoreError("a"), 2, "p work: 1 problem\n  a\n"),
        (AnalysisError("no\nbalance"), 1, "p work: 2 problems\n  no\n  balance\n"),
        (KeyboardInterrupt(), 130, "\nstopped\n"),
        (errors.WorkerError("they die"), 2, "p work: 1 problem\n  they die\n"),
        (errors.WorkerError("they die", kept=3), 1, "p work: 1 problem\n  they die\n"),
        (MemoryError(), 2, f"p work: 1 problem\n  {LACK.format('out of memory')}\n"),
        (OSError(errno.EMFILE, "no files left"), 2, f"p work: 1 problem\n  {LACK.format('no files left')}\n"),
    ],
)
def test_errors_end_in_words_and_a_status(capsys, error, status, said):
    def work(arguments):
        raise error

    parser = program.Parser(prog="p")
    parser.add_argument("command")
    assert program.run(parser, work, ["work"], no_result=AnalysisError) == status
    assert capsys.readouterr() == ("", said)


def commands(parser):
    (action,) = (action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    return action.choices


@pytest.mark.parametrize("name", ["ehdmaps", "mbs"])
def test_an_empty_name_is_not_taken_for_none(capsys, name):
    main, made = {"ehdmaps": (cli.main, cli.parser()), "mbs": (mbs.cli.main, mbs.cli.parser())}[name]
    tried = 0
    for command, parser in commands(made).items():
        given = {option for action in parser._actions if action.metavar is not None for option in action.option_strings}
        for option in sorted(given & {"-o", "--output", "--plot", "--maps", "--map"}):
            for words in ([option, ""], [f"{option}="] if option.startswith("--") else []):
                if words:
                    with pytest.raises(SystemExit) as end:
                        main([command, *words])
                    assert end.value.code == 2
                    assert f"{option}" in (err := capsys.readouterr().err.splitlines()[-1])
                    assert err.endswith("got ''; allowed: a text that is not empty, or to leave it out")
                    tried += 1
    assert tried > 20
    with pytest.raises(SystemExit):
        main([""])
    assert "argument COMMAND: invalid choice: ''" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["ehdmaps", "mbs"])
@pytest.mark.parametrize(
    ("limit", "bytes_", "said"),
    [
        (
            "RLIMIT_AS",
            409_600_000,
            "limit of memory addresses: got 409.6 MB; allowed: 1000 MB or more; raise it: ulimit -v",
        ),
        ("RLIMIT_DATA", 300_000_000, "limit of data: got 300 MB; allowed: 600 MB or more; raise it: ulimit -d"),
        ("RLIMIT_STACK", 131_072, "limit of stack: got 0.1311 MB; allowed: 0.25 MB or more; raise it: ulimit -s"),
    ],
)
def test_limits_with_which_libraries_crash_are_refused(folder, capsys, monkeypatch, name, limit, bytes_, said):
    given = resource.getrlimit
    tight = (bytes_, resource.RLIM_INFINITY)
    monkeypatch.setattr(
        resource, "getrlimit", lambda which: tight if which == getattr(resource, limit) else given(which)
    )
    main = {"ehdmaps": cli.main, "mbs": mbs.cli.main}[name]
    assert main(["stability"]) == 2
    out, err = capsys.readouterr()
    assert out == "" and len(err.splitlines()) == 2
    assert said in err


def limited(folder, limits, *arguments):
    """A command as a process with limits of the system: what is returned, and how long it took."""

    def tighten():
        for limit, value in limits.items():
            resource.setrlimit(getattr(resource, limit), (value, value))

    begin = time.monotonic()
    found = done("ehdmaps", *arguments, preexec_fn=tighten, timeout=60)
    return found.returncode, found.stderr.decode(), time.monotonic() - begin


def test_too_few_addresses_are_told_within_seconds(folder):
    status, err, seconds = limited(folder, {"RLIMIT_AS": 400_000 * 1024}, "generate", "job.toml", "--workers", "2")
    assert (status, len(err.splitlines())) == (2, 2)
    assert "limit of memory addresses: got 409.6 MB" in err and seconds < 30.0


@pytest.mark.slow  # a process that loads all libraries
def test_too_few_files_are_told(folder):
    """Which of both sentences it is hangs on what else is open then."""
    status, err, _ = limited(folder, {"RLIMIT_NOFILE": 12}, "generate", "job.toml", "--workers", "2")
    assert status == 2
    last = err.splitlines()[-1]
    assert "the system has too little (Too many open files)" in last or "worker processes cannot be started" in last
    assert "Traceback" not in err


@pytest.mark.slow  # processes that load all libraries
def test_a_script_that_starts_itself_again_is_told_so(folder):
    script = "import ehdmaps\nehdmaps.generate('job.toml', 'job.nc', workers=2)\n"
    (folder / "script.py").write_text(script)
    found = subprocess.run([sys.executable, "script.py"], capture_output=True, text=True, timeout=120, check=False)
    *trace, last = found.stderr.splitlines()
    assert found.returncode == 1 and len(trace) < 40
    assert last.startswith("ehdmaps.errors.WorkerError: worker processes: each runs ")
    assert "script.py again before it works, which fails (" in last
    assert "job.nc.store: is in use by another job" in last
    assert last.endswith('under `if __name__ == "__main__":`; put that around it, or take one worker')


# --- Ctrl-C


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "seed", "number", "status"),
    [
        pytest.param(["ehdmaps", "tradeoff", "nu308", "--points", "1000"], 1, signal.SIGINT, 130, id="ehdmaps"),
        pytest.param(["mbs", "campbell", "gearbox", "--law", "hertz"], 2, signal.SIGTERM, 143, id="mbs"),
    ],
)
def test_ctrl_c_ends_a_program_in_peace(folder, command, seed, number, status):
    name, *arguments = command
    ready = (
        f"import runpy; print(flush=True); runpy.run_module({PROGRAMS[name]!r}, run_name='__main__', alter_sys=True)"
    )
    job = start([sys.executable, "-c", ready, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    job.stdout.readline()
    time.sleep(0.3 + random.Random(seed).uniform(0.0, 1.5))
    job.send_signal(number)
    out, err = job.communicate(timeout=60)
    assert (job.returncode, out) == (status, "")
    assert err.endswith("\nstopped\n") and "Traceback" not in err


@pytest.mark.slow
def test_a_program_in_the_background_ignores_ctrl_c(folder):
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        job = subprocess.Popen([sys.executable, "-m", "ehdmaps.jobs.cli", "check", "job.toml"], stdout=subprocess.PIPE)
    finally:
        signal.signal(signal.SIGINT, before)
    # From its first moment to its last one, whenever the program looks after its signals.
    while job.poll() is None:
        job.send_signal(signal.SIGINT)
        time.sleep(0.05)
    out, _ = job.communicate()
    assert job.returncode == 0
    assert b"job.toml: no problems" in out
