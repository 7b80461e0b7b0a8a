"""The C library: found, refused, rebuilt; structs that Python fills for it."""

from __future__ import annotations

import copy
import ctypes
import os
import pickle
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest

from ehdmaps.errors import KernelError
from ehdmaps.kernel import building, library, record
from tests.cases.programs import needed

ROOT = Path(__file__).parents[2]
HOME = ROOT / "ehdmaps" / "kernel"


@pytest.fixture
def home(tmp_path, monkeypatch):
    """A folder with two of the C files, which compile in no time, and no other place for a library."""
    needed("gcc", "clang")
    (tmp_path / "home" / "c").mkdir(parents=True)
    shutil.copy(building.SOURCES / "numbers.h", tmp_path / "home" / "c")
    head, numbers, rest = (building.SOURCES / building.UNIT).read_text().partition('#include "numbers.h"\n')
    unit = head + numbers + rest[rest.index("/* State of the C files") :]
    (tmp_path / "home" / "c" / building.UNIT).write_text(unit)
    monkeypatch.setenv(library.FOLDER_VARIABLE, str(tmp_path / "kept"))
    monkeypatch.setattr(library.tempfile, "gettempdir", lambda: str(tmp_path / "temporary"))
    monkeypatch.delenv("CC", raising=False)
    (tmp_path / "temporary").mkdir()
    return tmp_path / "home"


@pytest.fixture
def no_compiler(home, monkeypatch):
    """A machine without one."""
    monkeypatch.setenv("PATH", str(home / "empty"))
    monkeypatch.setattr(building.importlib.util, "find_spec", lambda name: None)


def interface(loaded):
    loaded.ehd_interface.restype = ctypes.c_char_p
    return loaded.ehd_interface().decode()


def edit(home):
    with (home / "c" / "numbers.h").open("a") as file:
        file.write("/* edited */\n")


def test_the_library_is_that_of_the_c_files():
    assert interface(library.library()) == f"ehdmaps kernel <{building.state()}>"
    assert library.function("ehd_interface", result=ctypes.c_char_p)().decode() == interface(library.library())


def test_it_is_built_where_it_is_missing_and_again_when_a_file_changed(home):
    first = interface(library.found(home))
    place = home / building.file_name()
    old = place.stat()
    assert interface(library.found(home)) == first
    assert place.stat().st_mtime_ns == old.st_mtime_ns and place.stat().st_ino == old.st_ino  # built once
    edit(home)
    assert building.state_of(place) != building.state(home / "c")
    second = library.found(home)  # from elsewhere: of this path the system gives the open one
    assert first != interface(second) == f"ehdmaps kernel <{building.state(home / 'c')}>"
    assert building.state_of(place) == building.state(home / "c") and second._name != str(place)
    assert sorted(path.name for path in home.iterdir()) == ["c", building.file_name()]


def test_line_ends_of_windows_are_the_same_state(home):
    before = building.state(home / "c")
    for path in (home / "c").rglob("*.[ch]"):
        path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert building.state(home / "c") == before


def test_a_new_file_and_another_name_are_other_states(home):
    states = {building.state(home / "c")}
    (home / "c" / "more.h").write_text("/* more */\n")
    states.add(building.state(home / "c"))
    (home / "c" / "more.h").rename(home / "c" / "less.h")
    states.add(building.state(home / "c"))
    assert len(states) == 3


@pytest.mark.usefixtures("no_compiler")
def test_a_library_of_another_state_is_refused(home, monkeypatch):
    """It is not even opened: what stands there runs nothing when it is loaded."""
    monkeypatch.setattr(library.ctypes, "CDLL", lambda path: pytest.fail(f"{path} was loaded"))
    (home / building.file_name()).write_bytes(b"ehdmaps kernel <" + b"0" * 32 + b">")
    with pytest.raises(KernelError, match=r"no library fits the C files in .*home/c, and none is built: no C compiler"):
        library.found(home)


@pytest.mark.usefixtures("no_compiler")
def test_no_compiler(home):
    words = r"sought are CC, cc, gcc, clang and the package ziglang; install a C compiler, for example with"
    with pytest.raises(KernelError, match=words):
        library.found(home)
    with pytest.raises(building.NoCompilerError):
        building.usable_compiler(os.environ)


def test_without_a_compiler_one_that_fits_is_taken(home, monkeypatch):
    building.build(home / building.file_name(), os.environ, folder=home / "c")
    monkeypatch.setenv("PATH", str(home / "empty"))
    assert interface(library.found(home))


def test_a_file_that_does_not_compile(home):
    (home / "c" / "kernel.c").write_text("int broken(void) { return nothing; }\n")
    with pytest.raises(KernelError, match=r"(?s)none is built: .*kernel\.c.*nothing"):
        library.found(home)


def test_a_compiler_that_fails_is_passed_over(home, monkeypatch):
    (home / "bin").mkdir()
    (home / "bin" / "broken").write_text("#!/bin/sh\necho no headers >&2\nexit 1\n")
    (home / "bin" / "broken").chmod(0o755)
    monkeypatch.setenv("PATH", f"{home / 'bin'}:{os.environ['PATH']}")
    monkeypatch.setenv("CC", "broken -m64")
    first, second = [command for command in building.compilers(os.environ)][:2]
    assert first == [str(home / "bin" / "broken"), "-m64"] and Path(second[0]).name in building.COMPILERS
    assert interface(library.found(home))
    monkeypatch.setenv("PATH", str(home / "bin"))
    monkeypatch.setattr(building.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(building.NoCompilerError, match="no headers"):
        building.usable_compiler(os.environ)


def test_a_damaged_library_is_built_anew(home):
    """One that carries its number but cannot be loaded, as one of another system."""
    place = home / building.file_name()
    place.write_bytes(f"ehdmaps kernel <{building.state(home / 'c')}>".encode())
    assert interface(library.found(home))
    assert list(home.parent.glob(f"kept/*/{place.name}"))


def test_in_a_folder_that_cannot_be_written_it_is_kept_elsewhere(home, monkeypatch):
    """As root every folder can be written: the refusal is played."""
    build = building.build

    def refusing(target, *arguments):
        if target.parent == home:
            raise PermissionError(13, "Permission denied")
        return build(target, *arguments)

    monkeypatch.setattr(building, "build", refusing)
    loaded = library.found(home)
    kept = home.parent / "kept"
    assert interface(loaded) == f"ehdmaps kernel <{building.state(home / 'c')}>"
    (folder,) = kept.iterdir()
    assert folder.name.startswith(building.state(home / "c"))
    assert folder.stat().st_mode & 0o077 == 0
    monkeypatch.setattr(building, "build", lambda *_: pytest.fail("it was there"))
    assert library.found(home)._name == loaded._name
    # what others may write is not run
    folder.chmod(0o777)
    monkeypatch.setattr(building, "build", refusing)
    assert Path(library.found(home)._name).parent.parent == home.parent / "temporary"


def test_nowhere_to_write(home, monkeypatch):
    def refusing(target, *_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(building, "build", refusing)
    with pytest.raises(KernelError, match=r"none is built: .*home: Permission denied"):
        library.found(home)


def test_processes_that_build_at_once(home):
    code = "import sys; from pathlib import Path; from ehdmaps.kernel import library; library.found(Path(sys.argv[1]))"
    started = [subprocess.Popen([sys.executable, "-c", code, str(home)], cwd=ROOT) for _ in range(3)]
    assert [process.wait(60) for process in started] == [0, 0, 0]
    assert sorted(path.name for path in home.iterdir()) == ["c", building.file_name()]
    assert building.state_of(home / building.file_name()) == building.state(home / "c")


def test_a_file_that_changes_while_it_is_compiled(home, monkeypatch):
    """The number is that of what was compiled."""
    ran = building._failure

    def changing(command, folder):
        if "-DEHD_NUMBER" in " ".join(command) and "/* edited */" not in (home / "c" / "numbers.h").read_text():
            edit(home)
        return ran(command, folder)

    monkeypatch.setattr(building, "_failure", changing)
    assert building.build(home / building.file_name(), os.environ, folder=home / "c") == building.state(home / "c")
    assert building.state_of(home / building.file_name()) == building.state(home / "c")


def test_kinds(home, monkeypatch):
    for kind in ("", "debug"):
        assert interface(library.found(home, kind))
    assert {path.name for path in home.iterdir()} == {"c", building.file_name(), building.file_name("debug")}
    assert building.file_name("debug").startswith("libehd-debug.")
    monkeypatch.setenv(library.KIND_VARIABLE, "fast")
    with pytest.raises(KernelError, match="EHDMAPS_KERNEL: got 'fast'; allowed: nothing, for the usual library, or d"):
        library.library.__wrapped__()


def test_the_c_files_have_no_warnings():
    """Of the standard and of what is written; not those that depend on what a compiler makes of it."""
    options = [*building.ALWAYS, *building.LINES, "-Werror", "-pedantic", "-fsyntax-only"]
    command = [*building.usable_compiler(os.environ), *options, str(building.SOURCES / building.UNIT)]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stderr


def test_ziglang_compiles_for_old_processors_and_systems(monkeypatch):
    monkeypatch.setattr(building.sys, "platform", "linux")
    monkeypatch.setattr(building.platform, "machine", lambda: "aarch64")
    assert building.zig_target() == ("-target", "aarch64-linux-gnu.2.17")
    monkeypatch.setattr(building.platform, "machine", lambda: "AMD64")
    monkeypatch.setattr(building.sys, "platform", "win32")
    assert building.zig_target() == ("-target", "x86_64-windows-gnu")
    assert building.file_name() == "libehd.dll"
    monkeypatch.setattr(building.sys, "platform", "other")
    assert building.zig_target() == ("-mcpu=baseline",)


def test_the_unit_includes_every_file_and_the_package_lists_it():
    names = {path.relative_to(building.SOURCES).as_posix() for path in building.SOURCES.rglob("*.[ch]")}
    included = re.findall(r'^#include "(.+)"$', (building.SOURCES / building.UNIT).read_text(), re.MULTILINE)
    assert len(included) == len(set(included))
    assert {*included, building.UNIT} == names
    listed = []
    for cell in re.findall(
        r"^([\w/]+\.[][ch]+(?:, \w+\.[ch])*)  +\S", (HOME / "__init__.py").read_text(), re.MULTILINE
    ):
        stem, endings, *more = re.split(r"\.|, ", cell)
        listed += [f"{stem}.{ending}" for ending in endings.strip("[]")]
        listed += [f"{stem}{part}.{ending}" for part, ending in zip(more[::2], more[1::2], strict=True)]
    assert sorted(listed) == sorted(names)


def test_building_needs_the_standard_library_alone():
    code = "import runpy, sys; runpy.run_path(sys.argv[1]); print({'ehdmaps', 'numpy', 'setuptools'} & {*sys.modules})"
    command = [sys.executable, "-I", "-c", code, str(HOME / "building.py")]
    assert subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip() == "set()"


class Table(record.Record):
    _fields_ = (("rows", ctypes.c_int64), ("values", record.numbers), ("places", record.integers))
    shapes: ClassVar = {"values": ("rows", 2)}


class Whole(record.Record):
    _fields_ = (
        ("inner", Table),
        ("other", ctypes.POINTER(Table)),
        ("weight", ctypes.c_double),
        ("three", ctypes.c_double * 3),
    )


def whole():
    inner = Table(rows=np.int64(2), values=np.arange(4.0), places=np.array([7, 8]))
    return Whole(inner=inner, other=Table(rows=1, values=np.ones((1, 2))), weight=np.float64(2.5), three=np.arange(3.0))


def same(one):
    assert one.inner.rows == 2 and one.inner.values[3] == 3.0 and one.inner.places[1] == 8
    assert one.other.contents.values[1] == 1.0 and not one.other.contents.places
    assert one.weight == 2.5 and list(one.three) == [0.0, 1.0, 2.0]


def test_records_hold_numbers_arrays_and_records():
    one = whole()
    same(one)
    assert one.address == ctypes.addressof(one)
    assert one.given("other").given("values").shape == (1, 2)
    assert not Table().values and Table(values=None).given("values") is None


@pytest.mark.parametrize("way", [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_records_are_copied_by_their_values(way):
    one = whole()
    one.inner.rows = 2  # as the original
    one.weight = 2.5
    other = way(one)
    same(other)
    assert ctypes.addressof(other) != ctypes.addressof(one)
    other.weight = 3.0
    other.inner.rows = 5
    same(one)
    shared = np.shares_memory(one.given("inner").given("values"), other.given("inner").given("values"))
    assert shared is (way is copy.copy)


@pytest.mark.parametrize(
    ("values", "error", "words"),
    [
        (
            {"values": np.ones(4, np.float32)},
            TypeError,
            "Table.values: got an array of float32; allowed: an array",
        ),
        ({"values": [1.0]}, TypeError, "Table.values: got list; allowed: an array of float64"),
        ({"places": np.ones(4)}, TypeError, "Table.places: got an array of float64; allowed: an array of int64"),
        ({"values": np.ones((4, 2))[:, 0]}, TypeError, "Table.values: got an array that is not contiguous"),
        ({"values": np.ones((2, 4)).T}, TypeError, "not contiguous; allowed: one of numpy.ascontiguousarray"),
        ({"rows": 2, "values": np.ones(3)}, ValueError, "Table.values: got 3 numbers; allowed: 4, as many as rows x 2"),
        ({"rows": 1.5}, TypeError, "float"),
        ({"columns": 2}, TypeError, "Table has no field 'columns'; it has rows, values, places"),
    ],
)
def test_what_a_record_refuses(values, error, words):
    with pytest.raises(error, match=re.escape(words)):
        Table(**values)


def test_a_struct_of_another_size_is_refused(monkeypatch):
    sizes = {"ehd_table_size": lambda: ctypes.sizeof(Table)}
    monkeypatch.setattr(library, "function", lambda name, result: sizes[name])
    assert library.checked(Table, "ehd_table") is Table
    sizes["ehd_table_size"] = lambda: 8
    with pytest.raises(KernelError, match="Table has 24 bytes, ehd_table in C has 8: the fields of one were changed"):
        library.checked(Table, "ehd_table")
