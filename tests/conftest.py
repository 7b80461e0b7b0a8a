"""Settings of all tests, maps that several of them read, and the report of those that take long unmarked."""

import collections
import gc
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from unittest import mock

import pytest
from hypothesis import settings

from tests.cases.jobs import FINE, SMALL, WIDE_AXES, map_job
from tests.cases.programs import held_to_run

# CI must not fail on an example that nobody has seen before; a developer wants to see new ones
settings.register_profile("ci", derandomize=True, deadline=None)
settings.register_profile("developer", deadline=None)
settings.load_profile("ci" if os.environ.get("CI") else "developer")


@pytest.fixture(scope="session", autouse=True)
def own_reductions() -> Iterator[None]:
    """Keep reductions and tables of laws out of the user's folder, in programs that tests start too."""
    with tempfile.TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        patch.setenv("EHDMAPS_REDUCED", folder)
        patch.setenv("EHDMAPS_LAW_TABLES", "off")  # laws are made anew, whatever a test has changed of how
        yield


@pytest.fixture(scope="session")
def law_tables(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Folder for tables of laws that commands share, as those of a user do."""
    return str(tmp_path_factory.mktemp("laws"))


@pytest.fixture(scope="session", autouse=True)
def numerics_alone() -> Iterator[None]:
    """Let commands find bands of what is not known only where a test asks for them: they cost seconds."""
    with mock.patch("mbs.commands.common.USUAL_BANDS", "numerics"):
        yield


@pytest.fixture(scope="session", autouse=True)
def own_binaries() -> Iterator[None]:
    """Compile units for this system alone: for all of them it takes ten seconds of processor time each."""
    with mock.patch("ehdmaps.exports.fmu.binaries.zig", return_value=()):
        yield


def pytest_collection_finish() -> None:
    """Let the collector of garbage leave alone what stays to the end, and look less often.

    numba's compiler makes many objects, and the collector's looks at them, and at all tests, take a tenth of its time.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 20)


class Doctests:
    """Looks for doctests only in modules whose text has some.

    To import all others takes each process that runs tests 20 s.
    """

    @pytest.hookimpl(hookwrapper=True)
    def pytest_collect_file(self, file_path: Path) -> Iterator[None]:
        outcome = yield
        if file_path.suffix == ".py" and b">>> " not in file_path.read_bytes():
            outcome.force_result([one for one in outcome.get_result() if type(one) is pytest.Module])


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(Doctests())


LONG = ("slow", "openfoam")
"""Marks of the tests of the long tier, which run with ``--all``."""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--all", action="store_true", help="the long tier too: tests that are marked slow or openfoam")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out the long tier, unless all tests are asked for, or marks, or a test by its name."""
    if config.option.all or config.option.markexpr or any("::" in argument for argument in config.args):
        return
    long = [item for item in items if any(item.get_closest_marker(mark) for mark in LONG)]
    config.hook.pytest_deselected(items=long)
    items[:] = [item for item in items if not any(item.get_closest_marker(mark) for mark in LONG)]


QUICK = 2.0
"""Seconds of processor time, compiling included, that a test may take without the mark `slow`."""

SPENT: dict[tuple[str, str], float] = {}
"""Seconds of tests without the mark, by phase and name."""

FILES: collections.Counter[str] = collections.Counter()
"""Seconds of all tests, by file."""

LISTED = 30
"""Files that the report names."""


def processor_time() -> float:
    """Seconds of this process and of those that it waited for."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def spend(item: pytest.Item, phase: str) -> Iterator[None]:
    begin = processor_time()
    yield
    seconds = processor_time() - begin
    FILES[item.nodeid.partition("::")[0]] += seconds
    if item.get_closest_marker("slow") is None:
        SPENT[phase, item.nodeid] = seconds


@pytest.hookimpl(hookwrapper=True, tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> Iterator[None]:
    yield from spend(item, "setup")


@pytest.hookimpl(hookwrapper=True, tryfirst=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    yield from spend(item, "call")


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport() -> Iterator[None]:
    outcome = yield
    held_to_run(outcome.get_result())


@pytest.hookimpl(hookwrapper=True)
def pytest_make_collect_report() -> Iterator[None]:
    outcome = yield
    held_to_run(outcome.get_result())


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Hand what a worker of pytest-xdist spent to the process that reports."""
    output = getattr(session.config, "workeroutput", None)
    if output is not None:
        output["spent"] = [(*test, seconds) for test, seconds in SPENT.items()]
        output["files"] = dict(FILES)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: object) -> None:
    """Take over what a worker spent; one that died hands over nothing."""
    output = getattr(node, "workeroutput", {})
    SPENT.update({(phase, name): seconds for phase, name, seconds in output.get("spent", [])})
    FILES.update(output.get("files", {}))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Name the tests that should be quicker or be marked; a report and no failure, for machines differ."""
    over = sorted(((seconds, *test) for test, seconds in SPENT.items() if seconds > QUICK), reverse=True)
    if over:
        terminalreporter.section(f"not marked slow, and more than {QUICK:g} s of processor time")
    for seconds, phase, name in over:
        terminalreporter.write_line(f"{seconds:.1f} s {phase} {name}")
    total = sum(FILES.values())
    terminalreporter.section(f"processor time of the tests: {total:.0f} s; the files that take most of it")
    terminalreporter.write_line(", ".join(f"{name} {seconds:.0f} s" for name, seconds in FILES.most_common(LISTED)))


def made_map(folder: Path, text: str, statuses: tuple[int, ...] = (0,)) -> str:
    """Make the map of a job in a folder; status 1 is a point without a solution."""
    from ehdmaps.jobs import cli

    (folder / "job.toml").write_text(text)
    path = str(folder / "map.nc")
    assert cli.main(["generate", str(folder / "job.toml"), "-o", path, "--workers", "1"]) in statuses
    return path


@pytest.fixture(scope="session")
def formula_maps(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Files of small maps by the film formula, by the name of the bearing."""
    return {
        name: made_map(tmp_path_factory.mktemp(name), map_job(*WIDE_AXES, bearing=name), statuses=(0, 1))
        for name in ("NU308", "N1014")
    }


@pytest.fixture(scope="session")
def formula_map(formula_maps: dict[str, str]) -> str:
    """File of the small map of NU308."""
    return formula_maps["NU308"]


@pytest.fixture(scope="session")
def small_map(tmp_path_factory: pytest.TempPathFactory) -> str:
    """File of a map of NU308 by the film formula whose laws have small tables."""
    return made_map(tmp_path_factory.mktemp("small"), SMALL, statuses=(0, 1))


@pytest.fixture(scope="session")
def reynolds_map(tmp_path_factory: pytest.TempPathFactory) -> str:
    """File of a map of NU308 by the Reynolds equation, which takes some seconds of processor time."""
    return made_map(tmp_path_factory.mktemp("reynolds"), FINE)


@pytest.fixture(scope="session")
def solved_map(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The same with all films solved, and with refinement lines."""
    return made_map(tmp_path_factory.mktemp("solved"), f'{FINE}films = "solved"\n')
