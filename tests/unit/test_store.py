import os
import sqlite3
import subprocess
import sys

import numpy as np
import pytest

from ehdmaps.errors import StoreError
from ehdmaps.jobs.make.store import Store, pack, store_path, unpack

ARRAYS = {
    "film_offset": np.array([1.5, np.nan, -0.0]),
    "status": np.array([0, 1, 5], np.int8),
    "reason": np.array(["", "h/R = 0.02 > 0.01", "µ"]),
}


def same(a, b):
    return a.keys() == b.keys() and all(
        a[name].dtype == b[name].dtype and a[name].tobytes() == b[name].tobytes() for name in a
    )


def test_arrays_come_back_bit_for_bit(tmp_path):
    path = tmp_path / "a.nc.store"
    with Store(path) as store:
        assert store.get("k") is None
        store.put("k", ARRAYS)
        assert same(store.get("k"), ARRAYS)
    with Store(path) as store:
        assert same(store.get("k"), ARRAYS)
        assert store.damaged == 0


PLACE = "family", (1e4, 0.0, 313.15, 0.3)


def moved(index, by):
    numbers = [*PLACE[1]]
    numbers[index] *= 1.0 + by
    return PLACE[0], tuple(numbers)


def test_a_site_is_the_same_within_1e_9_of_each_of_its_numbers(tmp_path):
    with Store(tmp_path / "a.store") as store:
        store.put("k", ARRAYS, site=PLACE)
    with Store(tmp_path / "a.store") as store:
        assert store.get("other") is None
        for index in (0, 2, 3):
            for by in (0.0, 1e-16, 9e-10, -9e-10):
                assert same(store.get("other", moved(index, by)), ARRAYS)
            for by in (1.1e-9, -1.1e-9, 1e-6):
                assert store.get("other", moved(index, by)) is None
        for numbers in ((1e4, 1e-300, 313.15, 0.3), (1e4, 0.0, 313.15), (1e4, 0.0, 0.0, 313.15, 0.3)):
            assert store.get("other", (PLACE[0], numbers)) is None
        assert store.get("other", ("another", PLACE[1])) is None


def test_a_key_comes_before_a_site_and_a_damaged_entry_is_found_by_neither(tmp_path):
    path = tmp_path / "a.store"
    with Store(path) as store:
        store.put("first", {"x": np.array([1.0])}, site=PLACE)
        store.put("second", {"x": np.array([2.0])}, site=moved(0, 1e-12))
    with Store(path) as store:
        assert store.get("second", PLACE)["x"] == 2.0
        assert store.get("third", PLACE)["x"] == 1.0
    with sqlite3.connect(path) as database:
        database.execute("UPDATE results SET checksum = '' WHERE key = 'first'")
        database.execute("UPDATE sites SET last = 0.25, numbers = zeroblob(32) WHERE key = 'second'")
    database.close()
    with Store(path) as store:
        assert store.get("third", PLACE) is None
        assert store.get("third", (PLACE[0], (0.0,) * 4)) is None


def test_a_store_without_sites_still_serves_and_fresh_forgets_them(tmp_path):
    path = tmp_path / "a.store"
    with Store(path) as store:
        store.put("k", ARRAYS)
    with sqlite3.connect(path) as database:
        database.execute("DROP TABLE sites")  # as it was made before there were some
    database.close()
    with Store(path) as store:
        assert same(store.get("k", PLACE), ARRAYS)
        assert store.get("other", PLACE) is None
        store.put("new", ARRAYS, site=PLACE)
    with Store(path) as store:
        assert same(store.get("other", PLACE), ARRAYS)
    with Store(path, fresh=True) as store:
        store.put("new", ARRAYS)
        assert store.get("other", PLACE) is None


def test_the_store_stands_beside_the_map(tmp_path):
    assert store_path(tmp_path / "nu308.nc") == tmp_path / "nu308.nc.store"


def test_put_at_once_is_on_the_disk_at_once(tmp_path):
    path = tmp_path / "a.store"
    store = Store(path)
    store.put("k", ARRAYS, at_once=True)
    assert not store._database.in_transaction
    store._database.close()


def test_fresh_forgets(tmp_path):
    path = tmp_path / "a.store"
    with Store(path) as store:
        store.put("k", ARRAYS)
    with Store(path, fresh=True) as store:
        assert store.get("k") is None


def test_what_was_put_before_an_error_is_kept(tmp_path):
    path = tmp_path / "a.store"
    with pytest.raises(ValueError, match="a bug"), Store(path) as store:
        store.put("k", ARRAYS)
        raise ValueError("a bug")
    with Store(path) as store:
        assert same(store.get("k"), ARRAYS)


@pytest.mark.parametrize("fresh", [False, True])
def test_a_second_job_is_refused(tmp_path, fresh):
    path = tmp_path / "a.store"
    with Store(path) as store:
        store.put("k", ARRAYS)
        store.commit()
        script = f"from ehdmaps.jobs.make.store import Path, Store; Store(Path({str(path)!r}), fresh={fresh})"
        other = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
        assert other.returncode == 1
        assert "StoreError" in other.stderr
        assert "is in use by another job; allowed: one job a store" in other.stderr
        assert same(store.get("k"), ARRAYS)


def big(path):
    with Store(path) as store:
        for index in range(200):
            store.put(f"k{index}", {"x": np.random.default_rng(index).normal(size=500)})
    return path.read_bytes()


@pytest.mark.parametrize("damage", ["truncated", "overwritten"])
def test_a_corrupt_store_is_told_and_fresh_goes_on(tmp_path, damage):
    path = tmp_path / "a.store"
    content = big(path)
    broken = {
        "truncated": content[: len(content) // 2],
        "overwritten": content[:4096] + b"\xff" * (len(content) - 4096),
    }[damage]
    path.write_bytes(broken)
    with pytest.raises(StoreError, match=r"a\.store: is not a readable store .*start again with --fresh"):
        Store(path)
    assert path.read_bytes() == broken  # whoever wants to rescue it still can
    with Store(path, fresh=True) as store:
        assert store.get("k0") is None
        store.put("k", ARRAYS)
    with Store(path) as store:
        assert same(store.get("k"), ARRAYS)


def test_a_database_of_another_program_is_refused(tmp_path):
    path = tmp_path / "a.store"
    with sqlite3.connect(path) as database:
        database.execute("CREATE TABLE music (title TEXT)")
    database.close()
    for fresh in (False, True):
        with pytest.raises(StoreError, match=r"no store of ehdmaps .*left as it is; .* move it away"):
            Store(path, fresh)
    with sqlite3.connect(path) as database:
        assert database.execute("SELECT count(*) FROM music").fetchone() == (0,)
    database.close()


@pytest.mark.parametrize("fresh", [False, True])
def test_what_is_no_store_is_left_as_it_is(tmp_path, fresh):
    (tmp_path / "a.store").write_bytes(b"not a database" * 1000)
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(StoreError, match=r"a\.store: is no store of ehdmaps .*left as it is"):
        Store(tmp_path / "a.store", fresh)
    with pytest.raises(StoreError, match=r"pipe: is no store of ehdmaps \(it is no regular file\)"):
        Store(tmp_path / "pipe", fresh)
    assert (tmp_path / "a.store").read_bytes() == b"not a database" * 1000
    assert (tmp_path / "pipe").is_fifo()


def test_a_damaged_entry_counts_as_not_solved(tmp_path):
    path = tmp_path / "a.store"
    with Store(path) as store:
        store.put("good", ARRAYS)
        store.put("bad", ARRAYS)
    database = sqlite3.connect(path)
    database.execute("UPDATE results SET content = ? WHERE key = 'bad'", (pack(ARRAYS)[:-40],))
    database.commit()
    database.close()
    with Store(path) as store:
        assert store.get("bad") is None
        assert same(store.get("good"), ARRAYS)
        assert store.damaged == 1


@pytest.mark.parametrize("place", ["missing/a.store", "file/a.store"])
def test_a_folder_that_cannot_be_written(tmp_path, place):
    (tmp_path / "file").write_text("")
    with pytest.raises(StoreError, match=r"cannot be written .*allowed: a folder that exists and may be written"):
        Store(tmp_path / place)


@pytest.mark.parametrize("fresh", [False, True])
def test_a_folder_in_the_store_s_place(tmp_path, fresh):
    with pytest.raises(StoreError, match="cannot be written"):
        Store(tmp_path, fresh)


def test_a_full_disk(tmp_path):
    path = tmp_path / "a.store"
    store = Store(path)
    store.put("k", ARRAYS)
    store.commit()
    (pages,) = store._database.execute("PRAGMA page_count").fetchone()
    store._database.execute(f"PRAGMA max_page_count = {pages}")  # SQLite's own SQLITE_FULL, as a full disk gives
    with pytest.raises(StoreError, match="the disk is full; free space and run the same command again"), store:
        for index in range(100):
            store.put(f"k{index}", {"x": np.zeros(1000)}, at_once=True)
    with Store(path) as store:
        assert same(store.get("k"), ARRAYS)


def test_a_store_that_became_read_only(tmp_path):
    store = Store(tmp_path / "a.store")
    store._database.execute("PRAGMA query_only = 1")
    with pytest.raises(StoreError, match=r"cannot be written .*readonly"), store:
        store.put("k", ARRAYS)


class Broken:
    """A connection whose every use fails."""

    def __init__(self, connection):
        self.connection = connection

    def execute(self, *_):
        raise sqlite3.OperationalError("disk I/O error")

    def commit(self):
        raise sqlite3.OperationalError("disk I/O error")

    def close(self):
        self.connection.close()


def test_a_disk_that_fails_later(tmp_path):
    store = Store(tmp_path / "a.store")
    store._database = Broken(store._database)
    for use in (lambda: store.get("k"), lambda: store.put("k", ARRAYS), store.commit):
        with pytest.raises(StoreError, match="disk I/O error"):
            use()
    store._database.close()


def test_bytes_that_are_no_arrays():
    with pytest.raises(StoreError, match=r"an entry cannot be read .*--fresh"):
        unpack(b"PK nonsense")
    with pytest.raises(StoreError, match="an entry cannot be read"):
        unpack(pack(ARRAYS)[:-30])
