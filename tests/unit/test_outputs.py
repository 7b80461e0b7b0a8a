"""Which files may be replaced, and that what stood there is replaced whole or not at all."""

import multiprocessing
import os
import signal
import time
from pathlib import Path

import matplotlib as mpl
import netCDF4
import pytest
import xarray as xr
from matplotlib.figure import Figure

from ehdmaps import outputs
from ehdmaps.errors import InputError
from ehdmaps.figures import keep_within, write_heading
from ehdmaps.outputs import FIELDS, FIGURE, MADE_AS, MAP, SEALED, TABLE, Kind, Output, output_problems

NOTES = Kind("a note", (), outputs.has_mark)
OURS = f"# {outputs.MARK}\n"


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def problem(path, kind=NOTES, read=()):
    (found,) = output_problems([Output("-o", path, kind)], read)
    return found


def test_what_may_be_written(here):
    (here / "empty").touch()
    (here / "ours").write_text(OURS)
    (here / "link").symlink_to("ours")
    (here / "nowhere").symlink_to("new")
    for path in ("new", "empty", "ours", "link", "nowhere", here / "new", None):
        assert output_problems([Output("-o", path, NOTES)], ["ours.toml", "shipped", "a\0b"]) == []


def test_what_may_not_be_written(here):
    (here / "foreign").write_text("my notes")
    (here / "ours").write_text(OURS)
    (here / "folder").mkdir()
    os.mkfifo(here / "pipe")
    (here / "link").symlink_to("pipe")
    assert problem("foreign") == (
        "-o: got foreign, which is there and is not a note; allowed: a new file, or one to replace that was made as "
        "that; choose another name, or remove it"
    )
    assert "which is a folder" in problem("folder")
    assert "which is no regular file" in problem("pipe")
    assert "which is no regular file" in problem("link")
    assert "missing is no folder" in problem("missing/a")
    assert "ours is no folder" in problem("ours/a")
    assert "allowed: the path of a file" in problem("")
    assert "allowed: the path of a file" in problem("a\0b")
    assert "which cannot be looked at" in problem("a" * 5000)
    assert "allowed: a file that ends in .png, .pdf, .svg" in problem("ours", FIGURE)
    assert (here / "foreign").read_text() == "my notes"


def test_a_device_stays_a_device(here):
    try:
        os.mknod(here / "null", 0o600 | 0o020000, os.makedev(1, 3))
    except PermissionError:
        os.mkfifo(here / "null")  # as good: no regular file either
    assert "which is no regular file" in problem("null")
    with pytest.raises(InputError, match="null, which is no regular file"), outputs.written_aside("null", NOTES):
        raise AssertionError
    assert not (here / "null").is_file()


def test_no_file_that_is_read_is_written_whatever_it_is_called(here):
    (here / "sub").mkdir()
    (here / "ours").write_text(OURS)
    (here / "link").symlink_to("ours")
    os.link("ours", "hard")
    for path in ("ours", "./sub/../ours", "link", "hard", here / "ours"):
        assert problem(path, read=["other", "ours"]).endswith(
            "which would be written over ours, which is read; choose another name"
        )


def test_two_outputs_do_not_share_a_file(here):
    (here / "ours").write_text(OURS)
    os.link("ours", "hard")
    for first, second in (("new", "./new"), ("ours", "hard")):
        (found,) = output_problems([Output("-o", first, NOTES), Output("--plot", second, NOTES)])
        assert found.startswith(f"--plot: got {second}, which would be written over the file of -o")


def test_a_file_that_its_owner_protected(here):
    (here / "ours").write_text(OURS)
    (here / "ours").chmod(0o444)
    assert "which may not be written" in problem("ours")


def test_a_file_appears_whole_or_not_at_all(here):
    (here / "ours").write_text(OURS)
    message = r"^ours: cannot be written \(No space left"
    with pytest.raises(InputError, match=message), outputs.written_aside("ours", NOTES) as aside:
        aside.write_text(OURS + "half")
        raise OSError(28, "No space left on device")
    assert (here / "ours").read_text() == OURS
    with outputs.written_aside("ours", NOTES) as aside:
        aside.write_text(OURS + "new")
        assert (here / "ours").read_text() == OURS
    assert (here / "ours").read_text() == OURS + "new"
    assert os.listdir(here) == ["ours"]


def test_a_link_stays_a_link(here):
    (here / "folder").mkdir()
    (here / "link").symlink_to("folder/real")
    outputs.write_text("link", OURS, NOTES)
    assert (here / "link").is_symlink()
    assert (here / "folder" / "real").read_text() == OURS


def test_a_foreign_file_that_came_meanwhile_stays(here):
    message = "note, which is there and is not a note"
    with pytest.raises(InputError, match=message), outputs.written_aside("note", NOTES) as aside:
        aside.write_text(OURS)
        (here / "note").write_text("mine")
    assert (here / "note").read_text() == "mine"
    assert os.listdir(here) == ["note"]


def test_names_that_no_map_may_have(here):
    (here / "a\\b").mkdir()
    for name in ("a\rb.nc", "a\u2028b.nc", "a\nb.nc", "a\x1bb.nc"):
        assert problem(name).endswith(f"got {name!r}, whose name is not printable; allowed: a name of printable "
                                      "characters; rename it")  # fmt: skip
    for name in ("a\\b.nc", "a\\b/c.nc"):
        assert f"got {name}, which is {os.path.realpath(name)}; allowed: no backslash" in problem(name)
    for name in ("ä b.nc", "日本.nc", "%j 'q' \"$x\".nc", "#.nc"):
        assert output_problems([Output("-o", name, NOTES)]) == []


def test_no_file_of_others_is_written_to_on_the_way(here, monkeypatch):
    """A link under the name that the file has on the way stays, with what it leads to: names are new, or refused."""
    (here / "victim").write_text("mine")
    names = []
    for _ in range(2):
        with outputs.written_aside("note", NOTES) as aside:
            assert aside.parent == here and aside.read_bytes() == b"" and not aside.is_symlink()
            names.append(aside.name)
            aside.write_text(OURS)
    assert names[0] != names[1]
    monkeypatch.setattr(outputs.secrets, "token_hex", lambda count: "0" * (2 * count))
    with outputs.written_aside("note", NOTES) as aside:
        guessed = aside.name
        aside.write_text(OURS)
    (here / guessed).symlink_to("victim")
    message = r"note: cannot be written \(File exists\)"
    with pytest.raises(InputError, match=message), outputs.written_aside("note", NOTES):
        raise AssertionError
    assert (here / "victim").read_text() == "mine" and (here / guessed).is_symlink()


def test_names_on_the_way_are_no_longer_than_a_file_system_takes(here):
    for name in ("ä" * 120, "a." + "b" * 250, "日" * 80 + ".nc"):
        outputs.write_text(name, OURS, NOTES)
        assert (here / name).read_text() == OURS


def test_what_killed_writers_left_is_removed_later(here):
    dead, me = 2**22 + 1, os.getpid()  # above the largest number that Linux gives a process

    def left(name, age=7200.0):
        (here / name).write_text("half")
        os.utime(name, (time.time() - age,) * 2)
        return name

    token = "0123456789abcdef"
    gone = [left(f".ehdmaps-{dead}-{token}.part.nc"), left(f".ehdmaps-{dead}-{token}.part")]
    stay = [
        left(f".ehdmaps-{me}-{token}.part.nc"),  # its process runs
        left(f".ehdmaps-{dead}-{token[::-1]}.part.nc", age=60.0),  # may be written on another machine
        left(f".ehdmaps-{dead}-{token}.part-nc"),
        left(f"ehdmaps-{dead}-{token}.part.nc"),
        left(f".ehdmaps-{dead}-{token[:-1]}.part.nc"),
    ]
    (here / "victim").write_text("mine")
    (here / f".ehdmaps-{dead}-{token}.part.csv").symlink_to("victim")
    outputs.write_text("note", OURS, NOTES)
    assert not [name for name in gone if (here / name).exists()]
    assert all((here / name).read_text() == "half" for name in stay)
    assert (here / f".ehdmaps-{dead}-{token}.part.csv").is_symlink() and (here / "victim").read_text() == "mine"


def _killed(path: str) -> None:
    with outputs.written_aside(path, NOTES) as aside:
        aside.write_text("half")
        os.kill(os.getpid(), signal.SIGKILL)


def test_a_killed_writer_leaves_what_the_next_one_knows(here):
    writer = multiprocessing.get_context("fork").Process(target=_killed, args=("note",))
    writer.start()
    writer.join()
    (part,) = os.listdir(here)
    outputs.write_text("note", OURS, NOTES)
    assert sorted(os.listdir(here)) == [part, "note"]
    os.utime(part, (0, 0))
    outputs.write_text("note", OURS, NOTES)
    assert os.listdir(here) == ["note"]


def _write_often(path: str, letter: str) -> None:
    for _ in range(20):
        outputs.write_text(path, OURS + letter * 100_000, NOTES)


def test_several_processes_may_write_one_file(here):
    context = multiprocessing.get_context("fork")
    writers = [context.Process(target=_write_often, args=("note", letter)) for letter in "abcd"]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join()
        assert writer.exitcode == 0
    text = (here / "note").read_text().removeprefix(OURS)
    assert len(text) == 100_000 and len(set(text)) == 1
    assert os.listdir(here) == ["note"]


@pytest.mark.parametrize("ending", ["png", "pdf", "svg", "PNG"])
def test_figures_are_known_again(here, ending):
    figure = Figure()
    figure.subplots().plot([1, 2])
    for _ in range(2):  # the second replaces the first
        outputs.write_figure(figure, f"a.{ending}")
    # as a figure of somebody else's script
    figure.savefig(here / f"b.{ending}", dpi=50)
    assert "is not a figure of ehdmaps" in problem(f"b.{ending}", FIGURE)


def test_a_matplotlibrc_that_asks_for_latex_stops_no_figure(here):
    """LaTeX is not there, or takes "a_b %" for its own; drawing makes texts too, such as ticks."""
    with mpl.rc_context({"text.usetex": True}):
        figure = Figure()
        axes = figure.subplots()
        axes.plot([1, 2], label="a_b %")
        axes.legend()
        write_heading(figure, "N/µm & 5 %", 9)
        keep_within(figure, figure.text(0.1, 0.5, "a_b"))
        outputs.write_figure(figure, "a.png")
    assert (here / "a.png").stat().st_size > 1000


@pytest.mark.parametrize("name", ["res.csv", "res.txt", "res.json", "res.png", "res.2"])
def test_what_is_netcdf_is_not_written_under_another_ending(here, name):
    for kind in (MAP, outputs.dataset_kind("a result", "result")):
        assert problem(name, kind) == f"-o: got {name}; allowed: a file in netCDF, which ends in .nc, .nc4, .cdf, .h5"
        assert output_problems([Output("-o", "res.nc", kind), Output("-o", "res", kind)]) == []


def test_c_has_no_quotation_marks_in_names(here):
    from mbs.exports.one_bearing.source import SOURCE

    assert "allowed: no quotation mark, which ends the header's name in C" in problem('a"b.c', SOURCE)


def test_a_figure_that_fails_leaves_the_old_one(here, monkeypatch):
    figure = Figure()
    outputs.write_figure(figure, "a.png")
    good = (here / "a.png").read_bytes()

    def full(file, **_):
        Path(file).write_bytes(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(figure, "savefig", full)
    with pytest.raises(InputError, match=r"a\.png: cannot be written \(No space left"):
        outputs.write_figure(figure, "a.png")
    assert (here / "a.png").read_bytes() == good
    assert os.listdir(here) == ["a.png"]


def test_datasets_are_known_by_what_they_were_made_as(here):
    result = outputs.dataset_kind("a result", "result")
    xr.Dataset(attrs={MADE_AS: "result"}).to_netcdf("result.nc")
    xr.Dataset(attrs={"title": "somebody's"}).to_netcdf("foreign.nc")
    xr.Dataset(attrs={"schema_version": 1, "job_toml": "schema = 1"}).to_netcdf("map.nc")
    (here / "text.nc").write_text("no netCDF")
    netCDF4.Dataset("plain.nc", "w").close()
    names = ("result.nc", "foreign.nc", "map.nc", "text.nc", "plain.nc")
    assert [name for name in names if result.ours(Path(name))] == ["result.nc"]
    assert [name for name in names if MAP.ours(Path(name))] == ["map.nc"]


def test_a_job_that_was_edited_is_not_replaced(here):
    outputs.write_text("job.toml", outputs.sealed("schema = 1\n"), SEALED)
    outputs.write_text("job.toml", outputs.sealed("schema = 1 # again\n"), SEALED)
    with (here / "job.toml").open("a") as file:
        file.write("# mine\n")
    assert "is not a job as it was planned" in problem("job.toml", SEALED)
    (here / "own.toml").write_text("schema = 1\n")
    assert "is not a job as it was planned" in problem("own.toml", SEALED)
    (here / "binary.toml").write_bytes(b"\xff\xfe")
    assert "binary.toml" in problem("binary.toml", SEALED)


def test_texts_with_a_mark(here):
    for kind, name in ((TABLE, "a.csv"), (FIELDS, "a.vtu")):
        outputs.write_text(name, OURS, kind)
        assert output_problems([Output("-o", name, kind)]) == []
        (here / name).write_text("1, 2, 3")
        assert kind.name in problem(name, kind)


def test_problems_are_raised_together():
    with pytest.raises(InputError) as raised:
        outputs.check_outputs([Output("-o", "", NOTES), Output("--plot", "a.xyz", FIGURE)])
    assert len(raised.value.problems) == 2
