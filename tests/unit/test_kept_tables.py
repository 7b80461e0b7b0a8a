"""Tables of laws that were made before: read again, made again where they are damaged, never taken for others."""

from __future__ import annotations

import ctypes
import dataclasses
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import ehdmaps
from ehdmaps.jobs.make import table_law
from ehdmaps.maps.kernels import kept_tables
from ehdmaps.maps.kernels.law_in_c import ABOVE_SPEED, NOT_FINITE, LawAddress
from ehdmaps.maps.law import ContactLaw
from tests.cases.laws import CONTACTS, OIL, SMALL_FIELD


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder of kept tables."""
    monkeypatch.setenv(kept_tables.VARIABLE, str(tmp_path / "laws"))
    return tmp_path / "laws"


INNER = CONTACTS[0]


def made(contact=INNER, oil=OIL):
    return ContactLaw("inner", (contact,), oil, SMALL_FIELD)


def same_bits(law, other):
    for one, two in zip(law.table.own, other.table.own, strict=True):
        assert np.asarray(one).tobytes() == np.asarray(two).tobytes()


def refuse(*arguments, **more):
    raise AssertionError("a table was made again")


def test_a_table_is_read_again(folder, monkeypatch):
    first = made()
    assert len(list(folder.glob("*.npz"))) == 1
    monkeypatch.setattr("ehdmaps.maps.law.compile_table", refuse)
    again = made()
    same_bits(again, first)
    assert again(1e-6, 1e-4, 1.0, 330.0) == first(1e-6, 1e-4, 1.0, 330.0)
    with pytest.raises(AssertionError, match="made again"):
        made(dataclasses.replace(INNER, radius=1.01 * INNER.radius))
    with pytest.raises(AssertionError, match="made again"):
        made(oil=dataclasses.replace(OIL, density_15=1.01 * OIL.density_15))
    monkeypatch.setattr(kept_tables, "_code", lambda: b"of another state of the files")
    with pytest.raises(AssertionError, match="made again"):
        made()


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 no file of numpy", None])
def test_a_damaged_table_is_made_again(folder, content):
    first = made()
    (path,) = folder.glob("*.npz")
    path.write_bytes(path.read_bytes()[:-500] if content is None else content)
    same_bits(made(), first)
    assert path.stat().st_size > 1000
    same_bits(made(), first)


def test_a_table_that_others_may_have_written_is_not_read(folder, monkeypatch):
    made()
    folder.chmod(0o777)
    monkeypatch.setattr("ehdmaps.maps.law.compile_table", refuse)
    with pytest.raises(AssertionError, match="made again"):
        made()


def test_a_folder_that_cannot_be_written_keeps_nothing(folder):
    folder.write_text("a file where the folder would be")
    same_bits(made(), made())
    assert folder.is_file()


def test_makers_at_once_keep_one_table(folder):
    """Threads, which share the number of the process: names of parts do not rest on it."""
    with ThreadPoolExecutor(4) as pool:
        laws = list(pool.map(lambda _: made(), range(4)))
    assert len(list(folder.iterdir())) == 1
    for law in (*laws[1:], made()):
        same_bits(law, laws[0])


def test_the_oldest_tables_make_room(folder, monkeypatch):
    monkeypatch.setattr(kept_tables, "MOST", 2)
    for factor in (1.0, 1.1, 1.2, 1.3):
        made(dataclasses.replace(INNER, radius=factor * INNER.radius))
    assert len(list(folder.iterdir())) == 2


def test_nothing_is_kept_where_that_is_off(folder, monkeypatch):
    monkeypatch.setenv(kept_tables.VARIABLE, "off")
    made()
    assert not folder.exists()


def test_what_cannot_be_written_down_has_no_key():
    assert kept_tables.key_of(lambda: 0) == ""
    assert kept_tables.key_of(1.0) != kept_tables.key_of(2.0)


@pytest.mark.slow
def test_a_law_that_is_asked_for_again_shares_its_table_but_not_its_counts(folder):
    ranges = {"loads": (1e3, 1e5), "entrainment_speeds": (1.0, 2.0), "temperatures": (313.15, 333.15)}
    first, second = (ehdmaps.law("NU308", "FVA3", outside="clamp", **ranges) for _ in range(2))
    assert second.table is not first.table or second is not first
    assert second.plain_table.own.coefficients is first.plain_table.own.coefficients
    first(1.0, 0.0, 1.0, 320.0)
    assert first.outside_counts["load"] == 1 and second.outside_counts["load"] == 0
    other = ehdmaps.law("NU308", "FVA3", **ranges)
    assert other.outside == "error"


@pytest.mark.parametrize("kind", ["series", "inner"])
def test_other_programs_call_a_law_by_its_address(kind):
    law = ContactLaw(kind, CONTACTS if kind == "series" else CONTACTS[:1], OIL, SMALL_FIELD, "clamp")
    at = law.address
    room, force = np.empty(at.room // 8), np.empty(3)
    call = LawAddress.PROTOTYPE(at.function)
    q = 200.0 if kind == "series" else 0.0
    for speed, load in ((1.0, 0.0), (0.1, 0.0), (-1.0, q)):
        assert call(at.data, 1e-6, 1e-4, speed, 330.0, load, room.ctypes.data, force.ctypes.data) == 0
        assert force == pytest.approx(law(1e-6, 1e-4, speed, 330.0, load), rel=1e-12)
    assert call(at.data, 1e-6, 1e-4, 4.0, 330.0, 0.0, room.ctypes.data, force.ctypes.data) == ABOVE_SPEED
    assert force == pytest.approx(law(1e-6, 1e-4, 4.0, 330.0), rel=1e-12)
    assert call(at.data, np.nan, 0.0, 1.0, 330.0, 0.0, room.ctypes.data, force.ctypes.data) & NOT_FINITE
    assert np.all(np.isnan(force))
    assert isinstance(call, ctypes._CFuncPtr)


def test_a_whole_law_is_read_again(tmp_path, monkeypatch):
    """What another process reads is the same law; counts are its own."""
    monkeypatch.setenv(table_law.VARIABLE, str(tmp_path / "whole"))
    asked = ("NU308", "FVA3", "inner", (1e3, 1e5), (0.5, 2.0), (330.0, 340.0))
    first = ehdmaps.law(*asked)
    (path,) = (tmp_path / "whole").glob("*.pickle")
    second = ehdmaps.law(*asked)
    assert second is not first and second.table is first.table  # of this process
    monkeypatch.setattr(table_law, "_laws", {})
    monkeypatch.setattr(table_law, "_made", {})
    with monkeypatch.context() as patch:
        patch.setattr(table_law, "table_map", refuse)
        read = ehdmaps.law(*asked)
        same_bits(read, first)
        assert read(2e-6, 1e-4, 1.0, 335.0) == first(2e-6, 1e-4, 1.0, 335.0)
        patch.setattr(table_law, "_laws", {})
        path.write_bytes(path.read_bytes()[:-100])
        with pytest.raises(AssertionError, match="made again"):
            ehdmaps.law(*asked)
    same_bits(ehdmaps.law(*asked), first)
    with pytest.raises(AssertionError, match="made again"):
        monkeypatch.setattr(table_law, "table_map", refuse)
        ehdmaps.law(*asked[:2], "outer", *asked[3:])
