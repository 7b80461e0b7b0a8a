"""Executors that a caller gives: a pool of threads, one that loses tasks, one that breaks, and dask's."""

from concurrent.futures import Executor, Future, ThreadPoolExecutor

import numpy as np
import pytest

import ehdmaps
from ehdmaps.errors import InputError
from ehdmaps.jobs.make.batch import parse_batch
from ehdmaps.jobs.make.batch_generate import generate_batch
from ehdmaps.jobs.make.store import Store
from ehdmaps.jobs.make.sweep import sweep
from ehdmaps.jobs.reader import parse_job
from tests.cases.batches import SMALL_LISTS, batch_text
from tests.cases.jobs import SMALL
from tests.unit.test_sweep import Heard, Stub


class Lost(Exception):  # noqa: N818  # as others call theirs
    """What an executor that is not known here says of a task that it lost."""


class Careless(Executor):
    """Runs each task at once, but loses some of them the first times, and takes none any more after others."""

    def __init__(self, loses=(), times=1, ends_after=10**9):
        self.left = {number: times for number in loses}
        self.ends_after = ends_after
        self.submitted = 0

    def submit(self, function, /, task, **_):
        self.submitted += 1
        if self.submitted > self.ends_after:
            raise RuntimeError("cannot schedule new futures after shutdown")
        future = Future()
        if self.left.get(task.number, 0):
            self.left[task.number] -= 1
            future.set_exception(Lost("the node is gone"))
        else:
            future.set_result(function(task))
        return future


def test_a_pool_of_threads_gives_the_same(tmp_path):
    tasks = [Stub(number) for number in range(9)] + [Stub(9, "gives up")]
    heard = Heard()
    with Store(tmp_path / "s") as store, ThreadPoolExecutor(2) as pool:
        result = sweep(tasks, store, 1, heard, executor=pool)
        assert pool.submit(int, "3").result() == 3  # it is the caller's, and stays open
    assert [float(result.arrays[task.key]["value"][0]) for task in tasks[:9]] == [n**2 for n in range(9)]
    assert result.arrays["gives up 9"]["reason"] == "no film"
    assert heard.after == 30


def test_a_task_that_is_lost_once_costs_nothing(tmp_path):
    with Store(tmp_path / "s") as store:
        result = sweep([Stub(n) for n in range(4)], store, 1, executor=Careless(loses=[2]))
        assert store.get("square 2")["value"] == 4.0
    assert result.solved == 12


def test_a_task_that_is_lost_twice_fails_and_is_tried_again_next_time(tmp_path):
    with Store(tmp_path / "s") as store:
        result = sweep([Stub(n) for n in range(4)], store, 1, executor=Careless(loses=[2], times=2))
        assert "the executor lost the task twice (the node is gone)" in result.arrays["square 2"]["reason"][0]
        assert store.get("square 2") is None
        assert store.get("square 3")["value"] == 9.0


def test_an_executor_that_ends_leaves_the_rest_for_the_next_run(tmp_path):
    with Store(tmp_path / "s") as store:
        result = sweep([Stub(n) for n in range(4)], store, 1, executor=Careless(ends_after=2))
        assert "the executor takes no task any more" in result.arrays["square 3"]["reason"][0]
        assert store.get("square 1")["value"] == 1.0
        assert store.get("square 2") is None


def test_a_bug_of_a_task_is_none_of_the_executor(tmp_path):
    with (
        Store(tmp_path / "s") as store,
        ThreadPoolExecutor(1) as pool,
        pytest.raises(ZeroDivisionError, match="a bug"),
    ):
        sweep([Stub(1, "bug"), Stub(2)], store, 1, executor=pool)


def test_maps_and_batches_by_an_executor(tmp_path):
    job = parse_job(SMALL, "small", "job")
    with ThreadPoolExecutor(2) as pool:
        in_memory = ehdmaps.generate(job, executor=pool)
        made = ehdmaps.generate(job, tmp_path / "map.nc", executor=pool)
        batch = parse_batch(batch_text(SMALL_LISTS), "cat", "cat.toml")
        assert generate_batch(batch, tmp_path / "maps", workers=1, executor=pool).status == 0
    for name in ("stiffness", "damping", "minimum_film"):
        np.testing.assert_array_equal(in_memory[name].values, made[name].values)
        np.testing.assert_array_equal(made[name].values, ehdmaps.generate(job)[name].values)


def test_a_batch_from_python(tmp_path):
    (tmp_path / "cat.toml").write_text(batch_text(SMALL_LISTS))
    table = ehdmaps.generate_batch(tmp_path / "cat.toml", tmp_path / "maps", workers=1)
    assert list(table["state"].values) == ["made", "made"]
    assert table["stiffness"].attrs["units"] == "N/m2"
    assert str(table["map"].values[0]) == "NU308_FVA3"
    assert (tmp_path / "maps" / "summary.csv").exists()
    with pytest.raises(InputError, match="no batch file"):
        ehdmaps.generate_batch("nu308", tmp_path / "maps")


def test_dask_solves_a_map():
    distributed = pytest.importorskip("distributed")
    job = parse_job(SMALL, "small", "job")
    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None, protocol="inproc://"
        ) as cluster,
        distributed.Client(cluster) as client,
        client.get_executor() as executor,
    ):
        made = ehdmaps.generate(job, executor=executor)
    np.testing.assert_array_equal(made["stiffness"].values, ehdmaps.generate(job)["stiffness"].values)
