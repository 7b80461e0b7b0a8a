"""Hostile and unlucky inputs of both programs: no traceback, no hang, the problem in words, and no file touched."""

from __future__ import annotations

import hashlib
import os
import shutil
import signal
import time
import unicodedata
from pathlib import Path

import pytest
from scipy import sparse

from ehdmaps.jobs import cli as ehdmaps_cli
from mbs import cli as mbs_cli
from mbs.flexible.reduced_file import write_reduced
from mbs.modal.uff import Measurement, write_uff
from tests.cases.flexible import block, ends
from tests.cases.modal import hits
from tests.system import hostile_tables as tables
from tests.system.hostile_tables import BODY, JOB, SCENE, Case

MAINS = {"ehdmaps": ehdmaps_cli.main, "mbs": mbs_cli.main}

LONGEST = 20.0
"""Seconds that an input may take; most take some milliseconds, and a loaded machine is slow."""

CHECK, STATICS, REDUCE = ("check", "job.toml"), ("statics", "scene.toml"), ("reduce", "body.toml", "-o", "out.nc")


@pytest.fixture(scope="module")
def good(tmp_path_factory) -> Path:
    """Good files, which the cases spoil: a job, its map, a scene, a body with matrices and mesh, reduced, records."""
    folder = tmp_path_factory.mktemp("good")
    (folder / "job.toml").write_text(JOB)
    (folder / "scene.toml").write_text(SCENE)
    (folder / "body.toml").write_text(BODY)
    model = block(elements=(2, 1, 1))
    for name, matrix in (("b.sti", model.stiffness), ("b.mas", model.mass)):
        half = sparse.coo_array(sparse.triu(matrix))
        rows = zip(half.row, half.col, half.data, strict=True)
        (folder / name).write_text("".join(f"{i + 1} {j + 1} {value:.17e}\n" for i, j, value in rows))
    labels = zip(model.nodes, model.directions, strict=True)
    (folder / "b.dof").write_text("".join(f"{10 * node}.{direction + 1}\n" for node, direction in labels))
    nodes = zip(model.numbers, model.positions.tolist(), strict=True)
    lines = "".join(f"{10 * n}, {x!r}, {y!r}, {z!r}\n" for n, (x, y, z) in nodes)
    (folder / "m.inp").write_text("*NODE, NSET=ALL\n" + lines)
    from mbs.flexible.reduction import reduce

    reduced = reduce(model, ends(model), cutoff=2e4)
    for name in ("body.nc", "body.npz"):
        write_reduced(folder / name, reduced)
    write_uff(folder / "good.uff", Measurement("a long title", (hits(2, samples=64),)))
    assert ehdmaps_cli.main(["generate", str(folder / "job.toml"), "-o", str(folder / "map.nc"), "--workers", "1"]) == 0
    for path in folder.glob("map.nc?*"):
        path.unlink()
    return folder


@pytest.fixture
def here(good, tmp_path, monkeypatch):
    """A folder with the good files, a pipe, a link to it, and a link to itself."""
    folder = tmp_path / "here"
    shutil.copytree(good, folder)
    os.mkfifo(folder / "pipe")
    (folder / "link_to_pipe.msh").symlink_to("pipe")
    (folder / "loop.inp").symlink_to("loop.inp")
    monkeypatch.chdir(folder)
    return folder


def snapshot(folder: Path) -> dict[str, str]:
    """What every file of a folder holds."""
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        if path.is_file()
        else os.readlink(path)
        if path.is_symlink()
        else "no file"
        for path in sorted(folder.rglob("*"))
    }


def ended(program: str, arguments: tuple[str, ...], capsys) -> tuple[int, str, str]:
    """Exit status, stdout and stderr of a command; TimeoutError where it does not end."""

    def stop(*_):
        raise TimeoutError(f"{program} {' '.join(arguments)[:200]}")

    began = time.monotonic()
    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, LONGEST)
    try:
        status = MAINS[program](list(arguments))
    except SystemExit as end:
        status = end.code
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    # Whoever catches every error would catch that as well.
    assert time.monotonic() - began < LONGEST
    captured = capsys.readouterr()
    return status, captured.out, captured.err


def hold(program: str, case: Case, here: Path, capsys) -> None:
    """Run a case, and see that it ended as it should."""
    for name, content in case.files.items():
        (here / name).write_bytes(content)
    before = snapshot(here)
    status, out, err = ended(program, case.arguments, capsys)
    assert status == case.status, (out[-500:], err[-2000:])
    assert "Traceback" not in err
    if status == 0 and "-o" in case.arguments:
        (here / case.arguments[case.arguments.index("-o") + 1]).unlink()
    assert snapshot(here) == before
    if status == 2:
        assert out == ""
        for words in case.said:
            assert any(word in err for word in words.split("|")), err[:2000]
        # A sentence a problem, however long what was got is.
        assert max(map(len, err.splitlines())) < 2000 + max(map(len, case.arguments), default=0)


def named(cases: list[Case]) -> dict[str, Case]:
    """Cases by name; each name once."""
    table = {case.name: case for case in cases}
    assert len(table) == len(cases)
    return table


LEGAL_IN_JOBS: set[str] = set()

OPTIONAL_IN_JOBS = {
    f"job.toml without {key}"
    for key in (
        *("schema", "bearing.diametral_clearance", "grid.entrainment_speed", "grid.temperature"),
        *("solver.name", "solver.structural_law", "solver.fill", "solver.backbone", "solver.law_check"),
    )
}

EHDMAPS = named(
    [
        *tables.texts("job.toml", CHECK),
        *tables.junk(JOB, "job.toml", CHECK, 2, LEGAL_IN_JOBS),
        *tables.left_out(JOB, "job.toml", CHECK, OPTIONAL_IN_JOBS),
        *tables.replaced("job.toml", JOB, CHECK, tables.GRIDS),
        *tables.options(tables.EHDMAPS_OPTIONS),
    ]
)

LEGAL_IN_SCENES = {"scene.toml, sensors.0.name: negative"}

MBS = named(
    [
        *tables.texts("scene.toml", STATICS, tables.READ_BY_ALL),
        *tables.junk(SCENE, "scene.toml", STATICS, 1, LEGAL_IN_SCENES, skip="assumed"),
        *tables.replaced("scene.toml", SCENE, STATICS, tables.SCENES),
        *tables.texts("body.toml", REDUCE, tables.READ_BY_ALL),
        *tables.junk(BODY, "body.toml", REDUCE, 1, set()),
        *tables.replaced("body.toml", BODY, REDUCE, tables.BODIES),
        *tables.options(tables.MBS_OPTIONS),
    ]
)


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    """Kernels of the solver, which its first use compiles for some tens of seconds: that is no hang."""
    job = tmp_path_factory.mktemp("compiled") / "job.toml"
    job.write_text(JOB.replace('name = "hertz"', 'name = "reynolds"'))
    assert ehdmaps_cli.main(["check", str(job)]) == 0


@pytest.mark.usefixtures("compiled")
@pytest.mark.parametrize("name", EHDMAPS)
def test_ehdmaps(name, here, capsys):
    hold("ehdmaps", EHDMAPS[name], here, capsys)


@pytest.mark.slow
@pytest.mark.parametrize("name", MBS)
def test_mbs(name, here, capsys):
    hold("mbs", MBS[name], here, capsys)


@pytest.mark.slow
@pytest.mark.parametrize("name", tables.CONTROL)
def test_control_characters_do_not_reach_the_terminal(name, here, capsys):
    program, line, content = tables.CONTROL[name]
    arguments = tuple(line.split())
    if isinstance(content, bytes):
        (here / arguments[1]).write_bytes(content)
    else:
        content(here / arguments[1])
    _, out, err = ended(program, arguments, capsys)
    raw = {letter for letter in out + err if unicodedata.category(letter) in ("Cc", "Cf") and letter not in "\n\t"}
    assert not raw
    assert out + err
    # A name does not begin a line of its own.
    assert not any(line.startswith("ehdmaps check: all is well") for line in err.splitlines())


def test_there_are_enough_of_them():
    assert len(EHDMAPS) + len(MBS) + len(tables.CONTROL) > 350
