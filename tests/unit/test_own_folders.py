"""Folders of what is kept, and read or run again: whoever else may write there has nothing to say."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from ehdmaps import compiled
from ehdmaps.openfoam import installation
from ehdmaps.outputs import cache_folder, others_may_write, own_folder
from mbs.flexible import carry_out

SOMEBODY = 65534


def test_folders_are_the_user_s_alone(tmp_path) -> None:
    folder = own_folder(tmp_path / "a" / "b")
    assert folder.stat().st_mode & 0o777 == 0o700
    assert own_folder(folder) == folder and others_may_write(tmp_path / "none") == ""
    for mode in (0o702, 0o777):
        folder.chmod(mode)
        with pytest.raises(PermissionError, match=r"others may write in .*/b: .* chmod go-w"):
            own_folder(folder)
    folder.chmod(0o755)
    assert others_may_write(folder) == ""
    with pytest.raises(OSError, match="exists"):
        (tmp_path / "file").touch()
        own_folder(tmp_path / "file")


def test_a_group_that_others_are_in_may_not_write(tmp_path, monkeypatch) -> None:
    """Where users have groups of their own, folders are writable by them."""
    import grp
    import pwd

    tmp_path.chmod(0o775)
    who = pwd.getpwuid(os.getuid())

    def group(name, *members):
        monkeypatch.setattr(grp, "getgrgid", lambda _: grp.struct_group((name, "x", 1, list(members))))
        return others_may_write(tmp_path)

    assert group(who.pw_name) == group(who.pw_name, who.pw_name) == ""
    assert "others may write" in group("users") and "others may write" in group(who.pw_name, "somebody")


@pytest.mark.parametrize("of", ["folder", "link"])
def test_folders_and_links_of_somebody_else_are_refused(tmp_path, monkeypatch, of) -> None:
    (tmp_path / "there").mkdir(mode=0o755)
    place = tmp_path / "here"
    place.symlink_to("there")
    assert others_may_write(place) == ""
    if os.getuid() == 0:
        os.chown(tmp_path / "there" if of == "folder" else place, SOMEBODY, SOMEBODY, follow_symlinks=False)
    else:
        monkeypatch.setattr(os, "getuid", lambda: SOMEBODY)
    assert others_may_write(place) == f"{place} belongs to somebody else"


def test_a_relative_folder_for_caches_is_none() -> None:
    """Its code would be that of whoever made the current folder."""
    assert cache_folder("x", "OWN", {"XDG_CACHE_HOME": "/c"}) == Path("/c/ehdmaps/x")
    for given in ("cache", "./c", ".", ""):
        assert cache_folder("x", "OWN", {"XDG_CACHE_HOME": given}) == Path("~/.cache/ehdmaps/x").expanduser()


def test_nothing_is_read_from_where_others_may_write(tmp_path, monkeypatch) -> None:
    """Compiled code, reductions and the solver of OpenFOAM."""
    for name in ("compiled", "reduced", "openfoam"):
        (tmp_path / name).mkdir()
    monkeypatch.setenv("EHDMAPS_REDUCED", str(tmp_path / "reduced"))
    monkeypatch.setenv("EHDMAPS_OPENFOAM", str(tmp_path / "openfoam"))
    solver = tmp_path / "openfoam" / "bin" / "ehlFoam"
    solver.parent.mkdir()
    solver.touch(mode=0o755)
    read = []
    monkeypatch.setattr(carry_out, "read_reduced", read.append)
    carry_out._from_disk("key")
    assert read == [tmp_path / "reduced" / "key.npz"]
    for name in ("compiled", "reduced", "openfoam"):
        (tmp_path / name).chmod(0o777)
    carry_out._from_disk("key")
    assert len(read) == 1
    with pytest.raises(PermissionError):
        compiled._use(tmp_path / "compiled")
    assert any("ehlFoam: others may write in" in problem for problem in installation.missing())
