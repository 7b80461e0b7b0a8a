"""Reductions that are kept: the same content is reduced once, whatever changes is reduced again."""

from __future__ import annotations

import dataclasses
import os
from pathlib import Path

import numpy as np
import pytest
from scipy import io, sparse

from ehdmaps.errors import InputError
from mbs.flexible import carry_out as kept
from mbs.flexible.carry_out import carry_out
from mbs.flexible.plan import PlaneSurface, PlannedInterface, ReductionPlan
from mbs.scene.assembly import build_body
from mbs.scene.specs import FlexibleSpec
from tests.cases.flexible import block


@pytest.fixture
def plan(tmp_path):
    """Matrices of a block in files."""
    model = block(elements=(2, 1, 1))
    for name, matrix in (("k", model.stiffness), ("m", model.mass)):
        io.mmwrite(tmp_path / f"{name}.mtx", sparse.coo_array(matrix), symmetry="general", precision=17)
    rows = zip(model.nodes.tolist(), model.directions.tolist(), strict=True)
    (tmp_path / "dofs.txt").write_text("".join(f"{node} {direction + 1}\n" for node, direction in rows))
    nodes = zip(model.numbers.tolist(), model.positions.tolist(), strict=True)
    (tmp_path / "m.inp").write_text("*NODE\n" + "".join(f"{n},{x!r},{y!r},{z!r}\n" for n, (x, y, z) in nodes))
    interfaces = {
        name: PlannedInterface((x, 0.025, 0.02), PlaneSurface((1.0, 0.0, 0.0)))
        for name, x in (("left", 0.0), ("right", 0.2))
    }
    files = (tmp_path / name for name in ("k.mtx", "m.mtx", "m.inp", "dofs.txt"))
    return ReductionPlan("matrix-market", *files, "SI", 2e4, interfaces)


@pytest.fixture
def counted(monkeypatch, tmp_path):
    """A folder and a memory of its own, and a list that grows by one with each reduction."""
    calls = []

    def counting(plan):
        calls.append(plan)
        return carry_out(plan)

    monkeypatch.setenv(kept.FOLDER_VARIABLE, str(tmp_path / "kept"))
    monkeypatch.setattr(kept, "_memory", {})
    monkeypatch.setattr(kept, "carry_out", counting)
    return calls


def another_process(monkeypatch):
    """Forget what this process has in its memory."""
    monkeypatch.setattr(kept, "_memory", {})


def same(first, second):
    return all(np.array_equal(getattr(first, name), getattr(second, name)) for name in ("mass", "stiffness")) and (
        first.coordinates == second.coordinates
    )


def test_the_same_content_is_reduced_once(plan, counted, monkeypatch):
    first = kept.reduced_body(plan)
    assert kept.reduced_body(plan) is first
    another_process(monkeypatch)
    again = kept.reduced_body(plan)
    assert len(counted) == 1
    # to the last digit: what was kept is what was computed
    assert same(again, first)
    assert dict(again.attributes) == dict(first.attributes)
    for name, frame in first.frames.items():
        assert np.array_equal(again.frames[name].transform, frame.transform)


def test_where_the_files_are_does_not_matter(plan, counted, tmp_path):
    kept.reduced_body(plan)
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    moved = {}
    for name in ("stiffness", "mass", "mesh", "dofs"):
        path = getattr(plan, name)
        moved[name] = elsewhere / path.name
        moved[name].write_bytes(path.read_bytes())
    kept.reduced_body(dataclasses.replace(plan, **moved))
    assert len(counted) == 1


@pytest.mark.parametrize(
    "changed",
    [
        lambda plan: dataclasses.replace(plan, cutoff=1e4),
        lambda plan: dataclasses.replace(plan, units="mm-t-s"),
        lambda plan: dataclasses.replace(plan, interfaces=dict(reversed(plan.interfaces.items()))),
        lambda plan: dataclasses.replace(plan, points={"corner": 1}),
    ],
    ids=["cutoff", "units", "order of interfaces", "points"],
)
def test_another_plan_is_another_key(plan, changed):
    assert kept.plan_key(changed(plan)) != kept.plan_key(plan)


def test_a_changed_file_is_reduced_again(plan, counted):
    soft = kept.reduced_body(plan)
    io.mmwrite(plan.stiffness, 2.0 * io.mmread(plan.stiffness), symmetry="general", precision=17)
    stiff = kept.reduced_body(plan)
    assert len(counted) == 2
    # rounding of two reductions
    np.testing.assert_allclose(stiff.stiffness[:12, :12], 2.0 * soft.stiffness[:12, :12], rtol=1e-6, atol=1.0)


def test_other_code_reduces_again(plan, counted, monkeypatch):
    kept.reduced_body(plan)
    monkeypatch.setattr(kept, "code_hash", lambda: "another version")
    kept.reduced_body(plan)
    assert len(counted) == 2


@pytest.mark.parametrize("content", [b"", b"damaged", None], ids=["empty", "damaged", "cut off"])
def test_a_damaged_file_is_made_again(plan, counted, monkeypatch, content):
    first = kept.reduced_body(plan)
    (path,) = kept.kept_folder(os.environ).iterdir()
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2] if content is None else content)
    for count in (2, 2):  # read once more: it was written again
        another_process(monkeypatch)
        assert same(kept.reduced_body(plan), first)
        assert len(counted) == count


@pytest.mark.parametrize("block_it", ["file", "home"])
def test_where_nothing_can_be_written_it_is_computed(plan, counted, monkeypatch, tmp_path, block_it):
    if block_it == "file":
        (tmp_path / "taken").write_text("")
        monkeypatch.setenv(kept.FOLDER_VARIABLE, str(tmp_path / "taken"))
    else:
        monkeypatch.setattr(kept, "kept_folder", no_home)
    for count in (1, 2):
        another_process(monkeypatch)
        assert kept.reduced_body(plan).size > 12
        assert len(counted) == count


def no_home(environment):
    raise RuntimeError("Could not determine home directory.")


def test_where_reductions_are_kept():
    assert kept.kept_folder({"XDG_CACHE_HOME": "/c"}) == Path("/c/ehdmaps/reduced")
    assert kept.kept_folder({}) == Path("~/.cache/ehdmaps/reduced").expanduser()
    assert kept.kept_folder({"EHDMAPS_REDUCED": "/own", "XDG_CACHE_HOME": "/c"}) == Path("/own")


def test_a_body_of_a_scene_is_built_once(plan, counted):
    spec = FlexibleSpec("housing", plan, damping_ratio=0.01)
    first = build_body(spec)
    assert build_body(dataclasses.replace(spec)) is first
    assert build_body(dataclasses.replace(spec, damping_ratio=0.02)) is not first
    assert len(counted) == 1
    with pytest.raises(ValueError, match="read-only"):
        first.mass[0, 0] = 0.0
    (plan.mesh.parent / "b.nc").write_bytes(b"no body")
    with pytest.raises(InputError, match=r"flexible body 'housing': .*b\.nc: is no reduced body"):
        build_body(dataclasses.replace(spec, source=plan.mesh.parent / "b.nc"))
    # one that was reduced already
    own = build_body(dataclasses.replace(spec, source=carry_out(plan)))
    assert np.array_equal(own.stiffness, first.stiffness)


def test_a_file_that_cannot_be_read_is_named(plan):
    plan.mass.unlink()
    with pytest.raises(InputError, match=r"m\.mtx: cannot be read"):
        kept.plan_key(plan)
    assert any("m.mtx: cannot be read" in problem for problem in plan.file_problems())
    with pytest.raises(InputError, match=r"needs a file of its degrees of freedom"):
        carry_out(dataclasses.replace(plan, dofs=None))


def test_damping_makes_no_reduction(plan, counted):
    """The damping of a body is no part of its reduction; that of a doubled ratio is twice as large, to round-off."""
    once, twice = (build_body(FlexibleSpec("block", plan, damping_ratio=ratio)) for ratio in (0.01, 0.02))
    assert len(counted) == 1
    np.testing.assert_allclose(twice.damping, 2.0 * once.damping, rtol=1e-12, atol=1e-12 * once.damping.max())
