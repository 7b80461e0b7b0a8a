"""Settings of all tests, and maps that several of them read."""

import fcntl
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
from tests.durations import Durations

# CI must not fail on an example that nobody has seen before; a developer wants to see new ones
settings.register_profile("ci", derandomize=True, deadline=None)
settings.register_profile("developer", deadline=None)
settings.load_profile("ci" if os.environ.get("CI") else "developer")


SHARED = "EHDMAPS_TESTS"
"""Environment variable that names the folder of what tests share, with those of other processes and their programs."""


def share(config: pytest.Config) -> None:
    """Keep reductions, tables of laws and maps out of the user's folder, each made once for all processes."""
    if hasattr(config, "workerinput"):  # one of several processes: it has the folder from that which started it
        return
    folder, patch = tempfile.TemporaryDirectory(), pytest.MonkeyPatch()
    patch.setenv(SHARED, folder.name)
    patch.setenv("EHDMAPS_REDUCED", str(Path(folder.name) / "reduced"))
    patch.setenv("EHDMAPS_LAW_TABLES", str(Path(folder.name) / "laws"))
    patch.setenv("EHDMAPS_LAWS", "off")  # tests make laws of coarse tables and of fine ones
    config.add_cleanup(folder.cleanup)
    config.add_cleanup(patch.undo)


@pytest.fixture(scope="session", autouse=True)
def numerics_alone() -> Iterator[None]:
    """Let commands find bands of what is not known only where a test asks for them: they cost seconds."""
    with mock.patch("mbs.commands.common.USUAL_BANDS", "numerics"):
        yield


@pytest.fixture(scope="session", autouse=True)
def coarse_figures() -> Iterator[None]:
    """Draw figures with few dots: of each of them that takes half a second."""
    with mock.patch("ehdmaps.outputs.RESOLUTION", 60):
        yield


@pytest.fixture(scope="session", autouse=True)
def own_binaries() -> Iterator[None]:
    """Compile units for this system alone, and without optimisation: for all of them it takes ten seconds of processor
    time each, and with it four times as long."""
    from ehdmaps.exports.fmu import binaries

    quick = (*binaries._OPTIONS, "-O0")
    with mock.patch.multiple(binaries, zig=lambda: (), _OPTIONS=quick):
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


def alone() -> None:
    """Have commands work in one process where nobody says how many: others are forks of one that holds all tests, and
    what they load and make is lost with them, half of the processor time of many commands."""
    from ehdmaps import workers

    workers.available_cores = lambda: 1


def pytest_configure(config: pytest.Config) -> None:
    alone()
    config.pluginmanager.register(Doctests())
    config.pluginmanager.register(Durations())
    share(config)


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


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport() -> Iterator[None]:
    outcome = yield
    held_to_run(outcome.get_result())


@pytest.hookimpl(hookwrapper=True)
def pytest_make_collect_report() -> Iterator[None]:
    outcome = yield
    held_to_run(outcome.get_result())


def made_map(name: str, text: str, statuses: tuple[int, ...] = (0,)) -> str:
    """Make the map of a job, once for all processes; status 1 is a point without a solution."""
    from ehdmaps.jobs import cli

    folder = Path(os.environ[SHARED]) / name
    folder.mkdir(exist_ok=True)
    path = folder / "map.nc"
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not path.exists():
            (folder / "job.toml").write_text(text)
            assert cli.main(["generate", str(folder / "job.toml"), "-o", str(path), "--workers", "1"]) in statuses
    return str(path)


@pytest.fixture(scope="session")
def formula_maps() -> dict[str, str]:
    """Files of small maps by the film formula, by the name of the bearing."""
    return {name: made_map(name, map_job(*WIDE_AXES, bearing=name), statuses=(0, 1)) for name in ("NU308", "N1014")}


@pytest.fixture(scope="session")
def formula_map(formula_maps: dict[str, str]) -> str:
    """File of the small map of NU308."""
    return formula_maps["NU308"]


@pytest.fixture(scope="session")
def small_map() -> str:
    """File of a map of NU308 by the film formula whose laws have small tables."""
    return made_map("small", SMALL, statuses=(0, 1))


@pytest.fixture(scope="session")
def reynolds_map() -> str:
    """File of a map of NU308 by the Reynolds equation, which takes some seconds of processor time."""
    return made_map("reynolds", FINE)


@pytest.fixture(scope="session")
def solved_map() -> str:
    """The same with all films solved, and with refinement lines."""
    return made_map("solved", f'{FINE}films = "solved"\n')


@pytest.fixture
def fine_laws() -> Iterator[None]:
    """Tables of laws are as users have them, though those of the folder are coarse."""
    from tests.cases.coarse import fine_tables

    with fine_tables():
        yield
