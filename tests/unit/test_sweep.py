import importlib
import os
import signal
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from ehdmaps import workers as processes
from ehdmaps.errors import DiskFullError, SolverError, WorkerError
from ehdmaps.jobs.make.store import Store
from ehdmaps.jobs.make.sweep import sweep
from ehdmaps.workers import worker_pool


@dataclass(frozen=True)
class Stub:
    """A task that squares, gives up, breaks, or takes its process down."""

    number: int
    kind: str = "square"
    marker: str = ""
    slow: bool = False
    points: int = 3

    @property
    def key(self):
        return f"{self.kind} {self.number}"

    @property
    def site(self):
        return self.kind, (float(self.number),)

    def run(self):
        if self.kind == "gives up":
            raise SolverError("no film")
        if self.kind == "no room":
            raise DiskFullError("no room")
        if self.kind == "bug":
            raise ZeroDivisionError("a bug")
        if self.kind == "dies" or (self.kind == "dies once" and not Path(self.marker).exists()):
            if self.marker:
                Path(self.marker).write_text("")
            os.kill(os.getpid(), signal.SIGKILL)
        if self.kind == "interrupted":
            raise KeyboardInterrupt
        return {"value": np.array([float(self.number) ** 2]), "reason": np.array([""])}

    def failed(self, reason):
        return {"value": np.array([np.nan]), "reason": np.array([reason])}

    def is_final(self, arrays):
        return self.kind != "unlucky"

    def where(self, points):
        return f"Stub {self.number}"


@dataclass
class Heard:
    """A progress that remembers."""

    before: int = -1
    after: int = 0

    def taken_over(self, points):
        self.before = points

    def solved(self, points):
        self.after += points


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_every_task_is_run_kept_and_told(tmp_path, workers):
    tasks = [Stub(number) for number in range(20)]
    heard = Heard()
    with Store(tmp_path / "s") as store:
        result = sweep(tasks, store, workers, heard)
        assert all(store.get(task.key)["value"] == task.number**2 for task in tasks)
    assert [float(result.arrays[task.key]["value"][0]) for task in tasks] == [n**2 for n in range(20)]
    assert (result.taken_over, result.solved, heard.before, heard.after) == (0, 60, 0, 60)


def test_what_the_store_has_is_not_run_again(tmp_path):
    with Store(tmp_path / "s") as store:
        store.put("bug 7", {"value": np.array([49.0])})
        result = sweep([Stub(7, "bug"), Stub(8)], store, 1)  # the bug would be raised if it ran
    assert (result.taken_over, result.solved) == (3, 3)
    assert result.arrays["bug 7"]["value"] == 49.0


def test_a_result_that_is_not_final_is_tried_again(tmp_path):
    for _ in range(2):
        with Store(tmp_path / "s") as store:
            result = sweep([Stub(1), Stub(2, "unlucky")], store, 1)
            assert store.get("unlucky 2") is None
            assert result.arrays["unlucky 2"]["value"] == 4.0
    assert (result.taken_over, result.solved) == (3, 3)


def test_a_solver_that_gives_up_is_a_result(tmp_path):
    with Store(tmp_path / "s") as store:
        result = sweep([Stub(1), Stub(2, "gives up"), Stub(3)], store, 1)
        assert store.get("gives up 2")["reason"] == ["no film"]
    assert result.arrays["square 3"]["value"] == 9.0
    assert result.solved == 9


@dataclass(frozen=True)
class Meeting(Stub):
    """A task that says when it begins; the first one waits for the others, so long as `patience` says."""

    patience: float = 0.0

    def run(self):
        if self.number > 0:
            Path(self.marker).write_text("")
        end = time.monotonic() + self.patience
        while self.number == 0 and not Path(self.marker).exists() and time.monotonic() < end:
            time.sleep(0.01)
        return {"value": np.array([float(Path(self.marker).exists())]), "reason": np.array([""])}


@pytest.mark.slow
@pytest.mark.parametrize(("slow", "patience"), [(False, 1.0), (True, 60.0)])
def test_only_slow_tasks_run_beside_the_first_one(tmp_path, slow, patience):
    """The first one compiles for all; what takes hours does not wait for it."""
    tasks = [Meeting(number, "met", str(tmp_path / "begun"), slow, patience=patience) for number in range(4)]
    with Store(tmp_path / "s") as store:
        result = sweep(tasks, store, 2)
    assert result.arrays["met 0"]["value"] == slow
    assert result.solved == 12


@pytest.mark.slow
def test_a_dead_worker_costs_its_task_only(tmp_path):
    tasks = [Stub(number) for number in range(10)]
    tasks[4:4] = [Stub(4, "dies")]
    with Store(tmp_path / "s") as store:
        result = sweep(tasks, store, 2)
        assert store.get("dies 4") is None  # the next run tries again
    assert "worker process died" in str(result.arrays["dies 4"]["reason"][0])
    assert [float(result.arrays[f"square {n}"]["value"][0]) for n in range(10)] == [n**2 for n in range(10)]
    assert result.solved == 33


@pytest.mark.slow
def test_a_worker_that_was_killed_by_chance_costs_nothing(tmp_path):
    once = Stub(5, "dies once", marker=str(tmp_path / "marker"))
    with Store(tmp_path / "s") as store:
        result = sweep([Stub(1), once, Stub(2)], store, 2)
        assert store.get(once.key)["value"] == 25.0
    assert result.arrays[once.key]["value"] == 25.0


@dataclass(frozen=True)
class Missing(Stub):
    """A task that needs what a worker does not have: a library, as its process would find on import."""

    def __reduce__(self):
        return importlib.import_module, ("no_such_library",)


@pytest.mark.slow
def test_processes_that_die_before_they_do_anything_are_the_end(tmp_path, capfd):
    tasks = [Missing(number) for number in range(1000)]
    with Store(tmp_path / "s") as store:
        store.put("square 7", {"value": np.array([49.0])})
        with pytest.raises(WorkerError) as raised:
            sweep(tasks, store, 2)
    assert str(raised.value) == (
        "worker processes die before they do anything (ModuleNotFoundError: No module named 'no_such_library'); look "
        "after memory, limits (ulimit -a) and the libraries of this Python, or take one worker; what was solved is "
        "kept: the same command goes on"
    )
    assert raised.value.kept == 3
    assert capfd.readouterr() == ("", "")


@pytest.mark.slow
def test_processes_that_all_die_in_their_first_task_are_the_end(tmp_path):
    heard = Heard()
    with Store(tmp_path / "s") as store, pytest.raises(WorkerError, match=r"in their first task \(signal SIGKILL\)"):
        sweep([Stub(number, "dies") for number in range(1000)], store, 2, heard)
    assert heard.after <= 6  # two tasks were given up, by two processes each


@pytest.mark.parametrize("workers", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_a_full_disk_is_the_end_and_what_was_out_counts_as_not_tried(tmp_path, workers):
    tasks = [*(Stub(number) for number in range(5)), Stub(5, "no room"), *(Stub(number) for number in range(6, 500))]
    heard = Heard()
    with Store(tmp_path / "s") as store:
        with pytest.raises(DiskFullError, match="no room"):
            sweep(tasks, store, workers, heard)
        kept = [task.number for task in tasks if store.get(task.key) is not None]
        assert 5 not in kept and 0 in kept and len(kept) == heard.after / 3 < 500
        assert workers > 1 or kept == list(range(5))


@dataclass(frozen=True)
class Greedy(Stub):
    """A task for which there is too little of something."""

    error: type[BaseException] = MemoryError
    number_of_error: int = 0

    def run(self):
        raise self.error(*([self.number_of_error, "too little"] if self.number_of_error else []))


@pytest.mark.parametrize(("error", "number"), [(MemoryError, 0), (OSError, 24)])
def test_too_little_of_something_ends_the_sweep_in_words(tmp_path, error, number):
    with (
        Store(tmp_path / "s") as store,
        pytest.raises(WorkerError, match=r"the system has too little .* what was solved is kept") as raised,
    ):
        sweep([Stub(1), Stub(2), Greedy(3, "greedy", error=error, number_of_error=number)], store, 1)
    assert raised.value.kept == 6
    with Store(tmp_path / "s") as store, pytest.raises(OSError, match="too little"):
        sweep([Greedy(3, "greedy", error=OSError, number_of_error=2)], store, 1)  # a bug: no such file


def test_processes_that_cannot_be_started(tmp_path, monkeypatch):
    def full(*_, **__):
        raise OSError(24, "Too many open files")

    message = r"worker processes cannot be started \(Too many open files\); look after memory, limits"
    for place in ((processes, "ProcessPoolExecutor"), (processes.ProcessPoolExecutor, "submit")):
        with monkeypatch.context() as patched:
            patched.setattr(*place, full)
            with Store(tmp_path / "s") as store, pytest.raises(WorkerError, match=message):
                sweep([Stub(1), Stub(2)], store, 2)


def _speak(text):
    os.write(2, text.encode())


def test_workers_are_heard_from_their_first_task_on(capfd):
    with worker_pool(1) as pool:
        for text in ("one\n", "two\n"):
            pool.submit(_speak, text).result()
    assert capfd.readouterr().err == "one\ntwo\n"


@pytest.mark.parametrize(("kind", "error"), [("bug", ZeroDivisionError), ("interrupted", KeyboardInterrupt)])
def test_what_is_solved_before_a_bug_or_ctrl_c_is_kept(tmp_path, kind, error):
    with pytest.raises(error), Store(tmp_path / "s") as store:
        sweep([Stub(1), Stub(2), Stub(3, kind)], store, 1)
    with Store(tmp_path / "s") as store:
        assert store.get("square 2")["value"] == 4.0


def test_a_bug_in_a_worker_is_not_taken_for_a_failed_point(tmp_path):
    with Store(tmp_path / "s") as store, pytest.raises(ZeroDivisionError, match="a bug"):
        sweep([Stub(1), Stub(3, "bug")], store, 2)


@pytest.mark.slow
def test_the_environment_is_left_as_it_was(tmp_path, monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    monkeypatch.delenv("MKL_NUM_THREADS", raising=False)
    with Store(tmp_path / "s") as store:
        sweep([Stub(1), Stub(2)], store, 2)
    assert os.environ["OMP_NUM_THREADS"] == "7"
    assert "MKL_NUM_THREADS" not in os.environ
