"""What searches with wild and damaged input found, each as a test of its own."""

from __future__ import annotations

import argparse
import json
import sqlite3
import struct

import netCDF4
import numpy as np
import pytest
from scipy import sparse

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError, MapError, StoreError
from ehdmaps.jobs.commands.status import run as run_status
from ehdmaps.jobs.make.store import Store
from ehdmaps.jobs.reader import parse_job, read_job
from ehdmaps.maps.emap import open_map
from ehdmaps.netcdf_structure import structure_problem
from ehdmaps.outputs import MARK, root_attributes
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import Status
from mbs import parse_scene
from mbs.flexible.finite_elements import FiniteElementModel, NodePositions
from mbs.flexible.matrix_files import assemble_model, read_dofs, read_matrix_market
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.reduced_file import read_reduced
from mbs.laboratory.extremes.contact_points import wild_point
from tests.cases.flexible import spring
from tests.system.hostile_tables import JOB, SCENE

HEAP = b"GCOL\x01\x00\x00\x00"


@pytest.fixture
def texts(tmp_path):
    """A netCDF-4 file whose attributes stand in a global heap."""
    path = tmp_path / "a.nc"
    with netCDF4.Dataset(path, "w") as file:
        file.setncattr_string("job_toml", "schema = 1")
        file.setncattr_string("made_as", ["a", "list of texts", "of different lengths"])
    return path


@pytest.mark.parametrize(
    ("object_index", "size", "words"),
    [
        (0, 0, "an object of the heap .* is said to have 0 bytes"),  # the library would read it for ever
        (
            1,
            2**64 - 1,
            "an object of the heap .* is said to have 18446744073709551615 bytes",
        ),
        (1, 2**40, "an object of the heap .* is said to have 1099511627776 bytes"),
    ],
)
def test_an_object_of_a_heap_that_never_ends(texts, object_index, size, words) -> None:
    content = bytearray(texts.read_bytes())
    place = content.find(HEAP) + 16
    content[place : place + 2] = struct.pack("<H", object_index)
    content[place + 8 : place + 16] = struct.pack("<Q", size)
    texts.write_bytes(content)
    with pytest.raises(MapError, match=f"cannot be read .*{words}"):
        open_map(texts)
    with pytest.raises(InputError, match=f"looks like a map file but cannot be read .*{words}"):
        read_job(texts)
    with pytest.raises(InputError, match=f"is no reduced body .*{words}"[:60]):
        read_reduced(texts)
    assert root_attributes(texts) == {}


def test_a_heap_larger_than_its_file(texts) -> None:
    content = bytearray(texts.read_bytes())
    place = content.find(HEAP)
    content[place + 8 : place + 16] = struct.pack("<Q", 2**50)
    texts.write_bytes(content)
    assert f"the heap at byte {place} is said to have {2**50} bytes" in structure_problem(texts)


def test_a_text_that_is_said_to_have_a_gigabyte(texts) -> None:
    """The library takes that memory before it looks for the text."""
    good = texts.read_bytes()
    assert structure_problem(texts) == ""
    address = good.find(HEAP).to_bytes(8, "little")
    place = good.find(address) - 4
    texts.write_bytes(good[:place] + struct.pack("<I", 2**30) + good[place + 4 :])
    assert "a text of the heap at byte" in structure_problem(texts)
    with pytest.raises(MapError, match=r"cannot be read \(.*said to be longer than it is"):
        open_map(texts)


@pytest.fixture(params=["NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA"])
def classic(request, tmp_path):
    """A classic file with two dimensions, attributes of all kinds of lengths and two variables."""
    path = tmp_path / "a.nc"
    with netCDF4.Dataset(path, "w", format=request.param) as file:
        file.title, file.numbers, file.small = "seven", np.arange(3.0), np.arange(5, dtype="i2")
        file.createDimension("load", 3)
        file.createDimension("time", None)
        file.createVariable("load", "f8", ("load",))[:] = [1.0, 2.0, 3.0]
        file.createVariable("flag", "i1", ("time", "load")).units = "1"
    return path


def test_a_classic_header_that_promises_more_than_the_file_has(classic) -> None:
    """The library takes memory for as many entries as the header says: a gigabyte for a file of 17 kB."""
    good = classic.read_bytes()
    assert structure_problem(classic) == ""
    wide = good[3] == 5
    count, most = (8, 2**60) if wide else (4, 2**31 - 1)
    for tag in (b"\x00\x00\x00\x0a", b"\x00\x00\x00\x0b", b"\x00\x00\x00\x0c"):
        content = bytearray(good)
        place = content.find(tag) + 4
        content[place : place + count] = most.to_bytes(count, "big")
        classic.write_bytes(content)
        with pytest.raises(MapError, match=f"its header promises more than the {len(good)} bytes of the file"):
            open_map(classic)
    for end in (3, 4, 10, 60, 120):
        classic.write_bytes(good[:end])
        assert end < 4 or "promises more" in structure_problem(classic)


def test_the_job_of_a_map_whose_attribute_names_are_no_text(tmp_path) -> None:
    path = tmp_path / "a.nc"
    with netCDF4.Dataset(path, "w", format="NETCDF3_CLASSIC") as file:
        file.setncattr("damaged_name", "a")
    path.write_bytes(path.read_bytes().replace(b"damaged_name", b"\xff\xfemaged_name"))
    with pytest.raises(InputError, match=r"a\.nc: looks like a map file but cannot be read .*utf-8"):
        read_job(path)
    assert root_attributes(path) == {}


def test_a_store_with_a_damaged_entry_keeps_the_others(tmp_path) -> None:
    """A checksum that is no text, and a content that is a text: both count as not solved."""
    path = tmp_path / "a.store"
    with Store(path) as store:
        for key in ("first", "second", "third", "fourth"):
            store.put(key, {"film": np.arange(3.0)})
    with sqlite3.connect(path) as database:
        database.execute("UPDATE results SET checksum = CAST(x'ff00fe' AS TEXT) WHERE key = 'first'")
        database.execute("UPDATE results SET content = 'words' WHERE key = 'second'")
    database.close()
    with Store(path) as store:
        assert [store.get(key) is None for key in ("first", "second", "third", "fourth")] == [True, True, False, False]
        assert store.damaged == 2


def test_an_entry_under_another_key_counts_as_damaged(tmp_path) -> None:
    """A flipped bit may turn a key into another; its entry is not that of the other."""
    path = tmp_path / "a.store"
    with Store(path) as store:
        store.put("key 2", {"film": np.arange(3.0)})
    with sqlite3.connect(path) as database:
        database.execute("UPDATE results SET key = 'key 1'")
    database.close()
    with Store(path) as store:
        assert store.get("key 1") is None
        assert store.damaged == 1


def test_a_film_without_a_linear_response_is_refused() -> None:
    """Its matrix has a pivot of zero; the first seen was 882000 times as thick as the radius of its contact."""
    wild = wild_point(read_job("nu308"), 5, 13977)
    contact, load, speed, temperature = wild.point
    (film,) = ReynoldsSolver().solve_line(contact, wild.oil, (load,), speed, temperature)
    assert not film.status.usable
    assert film.reason


def test_a_store_whose_schema_is_no_text(tmp_path) -> None:
    path = tmp_path / "a.store"
    with Store(path) as store:
        store.put("first", {"film": np.arange(3.0)})
    content = path.read_bytes()
    assert b"sqlite_autoindex_results_1" in content
    path.write_bytes(content.replace(b"sqlite_autoindex_results_1", b"sqlite_auto\x8bndex_results_1"))
    before = path.read_bytes()
    with pytest.raises(StoreError, match=r"is not a readable store \(malformed database schema"):
        Store(path)
    assert path.read_bytes() == before


def test_a_status_with_counts_of_any_size(tmp_path) -> None:
    status = {"mark": MARK, "job": "a", "process": 1, "host": "b", "workers": 1, "total": 10**400, "done": 1}
    status |= {"begun": "2026-01-01T10:00:00+00:00", "written": "2026-01-01T11:00:00+00:00", "rate": 0.3}
    (tmp_path / "map.nc.store.status").write_text(json.dumps(status))
    with pytest.raises(InputError, match="is not the status of a map that is being made"):
        run_status(argparse.Namespace(map=str(tmp_path / "map.nc"), output=None))


def test_zero_bytes_in_a_matrix_market_file(tmp_path) -> None:
    """A library reads on behind the text, and crashes."""
    (tmp_path / "dofs.txt").write_text("1 1\n1 2\n")
    path = tmp_path / "k.mtx"
    path.write_bytes(b"%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 2.5\0\0E-1\n2 2 2.5E-1\n")
    with pytest.raises(InputError, match=r"k.mtx, line 3: got .*; allowed: 3 numbers a line"):
        read_matrix_market(path, tmp_path / "dofs.txt")
    path.write_bytes(b"%%MatrixMarket matrix coordinate re" + b"(" * 4000 + b" symmetric\n2 2 1\n1 1 1\n")
    with pytest.raises(InputError, match="is no Matrix Market file") as error:
        read_matrix_market(path, tmp_path / "dofs.txt")
    assert len(str(error.value)) < 500


def test_numbers_of_a_body_that_products_overflow() -> None:
    parts = spring()
    parts["positions"] = np.array([[0.0, 0.0, 0.0], [1e308, 0.0, 0.0]])
    with pytest.raises(InputError, match="got values that are no finite numbers, or too large ones, at node 2"):
        FiniteElementModel(**parts)
    for factor in (1e290, 1e300):
        parts = spring()
        parts["stiffness"] = parts["stiffness"] * factor
        with pytest.raises(InputError, match=r"stiffness: got an entry of 1e\+\d+; allowed: up to 1e\+100"):
            FiniteElementModel(**parts)


def test_a_direction_of_any_length_in_a_dof_file(tmp_path) -> None:
    (tmp_path / "a.dof").write_text("12." + "1" * 9000 + "\n")
    with pytest.raises(InputError, match=r'a\.dof, line 1: .* allowed: "node.direction"'):
        read_dofs(tmp_path / "a.dof")


def test_units_that_overflow() -> None:
    from mbs.flexible.matrix_files import Labelled

    huge = Labelled(sparse.csc_array(1e307 * np.eye(1)), np.array([1]), np.array([0]))
    nodes = NodePositions(np.array([1]), np.zeros((1, 3)))
    with pytest.raises(InputError, match="got entries that are no finite numbers"):
        assemble_model(huge, huge, nodes, "mm-t-s")


def test_a_reduced_body_whose_scaled_matrix_overflows() -> None:
    for mass, stiffness, words in (
        (1e270, 1.0, "mass: got an entry of 1e\\+270; allowed: up to 1e\\+100"),
        (1.0, 1e300, "stiffness: got an entry of 1e\\+300"),
        (1e-300, 1.0, "mass: got 1e-300 on the diagonal at a"),
    ):
        with pytest.raises(InputError, match=words):
            ReducedBody(np.array([[mass]]), np.array([[stiffness]]), ("a",), ("m",), {})


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("direction = [0, 1, 1]", f"direction = [0, 1, {'9' * 400}]", "direction: got a list of 3 entries"),
        ("direction = [0, 1, 1]", "direction = [0, 1, inf]", "direction: got a list of 3 entries"),
        ('assumed = ["position"]', f'times = ["0 s"]\nfactors = [{"9" * 400}]', "factors|times"),
    ],
)
def test_whole_numbers_of_any_length_in_a_scene(old, new, words) -> None:
    assert old in SCENE
    with pytest.raises(InputError, match=words):
        parse_scene(SCENE.replace(old, new), "scene", "scene.toml")


def test_a_direction_of_large_numbers_is_one() -> None:
    large = parse_scene(SCENE.replace("direction = [0, 1, 1]", "direction = [0, 1e308, 1e308]"), "scene", "a.toml")
    usual = parse_scene(SCENE, "scene", "a.toml")
    for one, other in zip(large.inputs, usual.inputs, strict=True):
        assert np.allclose(one.direction, other.direction, rtol=1e-15)


def test_names_of_any_length_make_no_long_message() -> None:
    from mbs import assemble

    name = "le" + "1," * 50_000
    for text in (
        SCENE.replace("left = ", f'"{name}" = '),
        SCENE.replace('on = "shaft:left"', f'on = "shaft:{name}"'),
        SCENE.replace('on = "ring_left"', f'on = "{name}"'),
    ):
        assert text != SCENE
        with pytest.raises(InputError) as error:
            assemble(parse_scene(text, "scene", "scene.toml"))
        assert max(map(len, error.value.problems)) < 1000
    with pytest.raises(InputError) as error:
        parse_job(JOB.replace("[grid]", f'[grid]\n"{name}" = 1'), "job", "job.toml")
    assert max(map(len, error.value.problems)) < 1000


@pytest.mark.parametrize(
    ("load", "speed", "inside"),
    [
        (2e5, 2.0, True),  # M = 9.6
        (1e3, 2.0, False),  # M = 0.05: rigid, where the film grows as 1/M and the power laws hardly at all
        (2e5, 1e-6, False),  # M = 1.4e4
    ],
)
def test_a_power_law_of_loaded_contacts_says_where_it_does_not_hold(load, speed, inside) -> None:
    contact, oil = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0], Lubricant.named("FVA3")
    for formula in ("dowson-toyoda", "pan-hamrock"):
        (film,) = FormulaSolver(formula).solve_line(contact, oil, (load,), speed, 313.15)
        assert film.status is Status.CONVERGED
        assert (film.reason == "") == inside
        assert inside or f"outside the range of {formula}" in film.reason
    (film,) = FormulaSolver("moes").solve_line(contact, oil, (load,), speed, 313.15)
    assert film.reason == ""
