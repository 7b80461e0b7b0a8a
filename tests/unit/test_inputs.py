"""Files that a user named: pipes, devices and folders are refused unopened, whatever leads to them."""

from __future__ import annotations

import os
import re
import signal
import socket
import stat
from pathlib import Path

import pytest

from ehdmaps import inputs
from ehdmaps.errors import InputError
from ehdmaps.jobs.reader import is_map, read_job
from mbs.flexible.matrix_files import (
    check_deck,
    read_abaqus_matrix,
    read_dof_table,
    read_dofs,
    read_matrix_market,
)
from mbs.flexible.mesh_files import read_mesh_nodes
from mbs.flexible.reduced_file import read_reduced
from mbs.modal.uff import read_uff
from mbs.scene.flexible import read_body_file
from mbs.scene.reader import parse_scene, read_scene


@pytest.fixture(autouse=True)
def an_end():
    """Whoever waits for a pipe, or reads a device, is stopped."""

    def stop(*_):
        raise TimeoutError("it waits, or reads without an end")

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, 10.0)
    yield
    signal.setitimer(signal.ITIMER_REAL, 0.0)
    signal.signal(signal.SIGALRM, before)


def link_to(path: Path, sort: str) -> Path:
    """A link to a node of some sort, made beside it."""
    node = path.with_name("node")
    if sort == "pipe":
        os.mkfifo(node)
    elif sort == "folder":
        node.mkdir()
    elif sort == "socket":
        with socket.socket(socket.AF_UNIX) as made:
            made.bind(str(node))
    else:
        try:
            os.mknod(node, 0o600 | stat.S_IFCHR, os.makedev(1, 5))  # endless zeros
        except PermissionError:
            pytest.skip("devices are made by root only")
    path.symlink_to(node)
    return path


SORTS = ("pipe", "folder", "socket", "device")


@pytest.mark.parametrize("sort", SORTS)
def test_what_is_no_regular_file(tmp_path, sort):
    path = link_to(tmp_path / "a", sort)
    told = re.escape(f"{path}: cannot be read (it is a {sort}); allowed: a text")
    for read in (
        lambda: inputs.check_input(path, 10, "a text"),
        lambda: inputs.first_bytes(path, 10, "a text"),
        lambda: inputs.read_text(path, 10, "a text"),
    ):
        with pytest.raises(InputError, match=told):
            read()


READERS = {
    "job.toml": lambda path: read_job(str(path)),
    "scene.toml": lambda path: read_scene(str(path)),
    "body.toml": read_body_file,
    "mesh.inp": read_mesh_nodes,
    "mesh.msh": read_mesh_nodes,
    "deck.inp": check_deck,
    "rows.dof": read_dofs,
    "rows.txt": read_dof_table,
    "k.mtx": read_abaqus_matrix,
    "body.nc": read_reduced,
    "body.npz": read_reduced,
    "hits.uff": read_uff,
}


@pytest.mark.parametrize("sort", ["pipe", "device"])
@pytest.mark.parametrize("name", READERS)
def test_every_reader_refuses_what_has_no_end(tmp_path, name, sort):
    path = link_to(tmp_path / name, sort)
    with pytest.raises(InputError, match=rf"{name}: cannot be read \(it is a {sort}\); allowed: a"):
        READERS[name](path)


def test_a_matrix_market_file_that_has_no_end(tmp_path):
    (tmp_path / "rows.txt").write_text("1 1\n")
    with pytest.raises(InputError, match=r"k.mtx: cannot be read \(it is a pipe\)"):
        read_matrix_market(link_to(tmp_path / "k.mtx", "pipe"), tmp_path / "rows.txt")


def test_a_pipe_is_no_map(tmp_path):
    assert not is_map(str(link_to(tmp_path / "a.nc", "pipe")))


def test_texts(tmp_path):
    path = tmp_path / "a.txt"
    path.write_bytes(b"\xef\xbb\xbfa = 1\n")
    assert inputs.read_text(path, 10, "a text") == "a = 1\n"
    assert inputs.first_bytes(path, 4, "a text") == b"\xef\xbb\xbfa"
    assert inputs.check_input(path, 9, "a text") == 9
    with pytest.raises(InputError, match=r"a.txt: longer than 8 bytes \(got 9\); allowed: a text; write less$"):
        inputs.read_text(path, 8, "a text", "write less")
    path.write_bytes(b"ab\xff")
    with pytest.raises(InputError, match=r"^the text: is not UTF-8 text \(byte 2\); allowed: a text"):
        inputs.read_text(path, 8, "a text", name="the text")
    for bad, words in (("gone", "No such file"), ("a\0b", "null"), ("a" * 300, "name too long")):
        with pytest.raises(InputError, match=rf"cannot be read \(.*{words}.*\); allowed: a text"):
            inputs.read_text(tmp_path / bad if "\0" not in bad else bad, 8, "a text")


def test_a_file_that_fails_while_it_is_read(tmp_path, monkeypatch):
    class Failing:
        def __enter__(self):
            return self

        def __exit__(self, *_):
            pass

        def read(self, _):
            raise OSError(5, "Input/output error")

    (tmp_path / "a").write_text("a")
    monkeypatch.setattr("builtins.open", lambda *_: Failing())
    with pytest.raises(InputError, match=r"a: cannot be read \(Input/output error\); allowed: a text"):
        inputs.read_text(tmp_path / "a", 8, "a text")


def test_body_files_with_a_mark_and_too_long(tmp_path):
    path = tmp_path / "body.toml"
    path.write_bytes(b"\xef\xbb\xbfcolour = 1\n")
    with pytest.raises(InputError, match="colour: unknown key"):
        read_body_file(path)
    path.write_bytes(b"colour = 1\n" + b"#" * 1_000_000)
    with pytest.raises(InputError, match="longer than 1000000 bytes"):
        read_body_file(path)


class TestFilesThatWereRead:
    BODY = """
        matrices = { format = "calculix", stiffness = "b.sti", mass = "b.mas", dofs = "b.dof" }
        mesh = "m.inp"
        cutoff = "20 kHz"
        interfaces = { left = { at = ["0 mm", "0 mm", "0 mm"], plane = { axis = "x" } } }
    """

    def test_of_a_plan(self, tmp_path):
        (tmp_path / "body.toml").write_text(self.BODY)
        names = [path.name for path in read_body_file(tmp_path / "body.toml").files]
        assert sorted(names) == ["b.dof", "b.mas", "b.sti", "body.toml", "m.inp"]

    def test_of_a_scene(self, tmp_path):
        shipped = read_scene("gearbox").files
        assert [path.name for path in shipped] == ["gearbox.toml", "gearbox_housing.nc"]
        text, housing = (path.read_bytes() for path in shipped)
        (tmp_path / "own.toml").write_bytes(text)
        (tmp_path / "gearbox_housing.nc").write_bytes(housing)
        own = read_scene(str(tmp_path / "own.toml")).files
        assert own == (tmp_path / "own.toml", tmp_path / "gearbox_housing.nc")
        assert parse_scene(text.decode(), "own", "own", tmp_path).files == own[1:]
