"""Scripts of tests/benchmarks that change texts: what they replace must stand there."""

import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import mbs
from ehdmaps.kernel import building
from tests.benchmarks import manifest, mutations

SYSTEMS = Path(mbs.__file__).parent / "systems"


@pytest.mark.parametrize("fault", mutations.FAULTS, ids=lambda fault: fault.name)
def test_faults_can_be_planted(fault, tmp_path):
    text = (mutations.ROOT / fault.file).read_text(encoding="utf-8")
    assert text.count(fault.right) == 1
    assert fault.wrong != fault.right
    wrong = text.replace(fault.right, fault.wrong)
    if fault.file.endswith(".py"):
        compile(wrong, fault.file, "exec")
        return
    sources = shutil.copytree(building.SOURCES, tmp_path / "c")
    (sources / (mutations.ROOT / fault.file).relative_to(building.SOURCES)).write_text(wrong, encoding="utf-8")
    compiler = building.usable_compiler(os.environ)
    subprocess.run([*compiler, "-std=c99", "-fsyntax-only", str(sources / building.UNIT)], check=True)


def test_there_are_twenty_faults():
    assert len({fault.name for fault in mutations.FAULTS}) == 20


@pytest.mark.parametrize("name", manifest.SCENES)
def test_scenes_of_the_manifest_can_be_written(name, tmp_path):
    shipped, changes = manifest.SCENES[name]
    manifest._write_scene(tmp_path / "scene.toml", shipped, changes)
    text = (tmp_path / "scene.toml").read_text(encoding="utf-8")
    assert all(new in text for _, new in changes)


def test_differences_name_the_variable_and_its_size():
    values = {"run: a.nc|x": np.array([1.0, 2.0])}
    other = {"run: a.nc|x": np.array([1.0, 2.002])}
    before = {"files": {"run: a.nc": {"variables": {"x": "aa float64 (2,)"}, "attributes": {}}}, "commands": {}}
    after = {"files": {"run: a.nc": {"variables": {"x": "bb float64 (2,)"}, "attributes": {}}}, "commands": {}}
    assert list(manifest.differences(before, before, values, values)) == []
    (line,) = manifest.differences(before, after, values, other)
    assert line == ("run: a.nc: x: largest relative difference 0.001, of the largest value 0.001, in 1 of 2 values")
    assert list(manifest.differences(before, {"files": {}, "commands": {}}, values, {})) == ["run: a.nc: missing"]
    said = {"files": {}, "commands": {"mbs": {"lines": ["--law"]}}}
    more = {"files": {}, "commands": {"mbs": {"lines": ["--law", "--oil"]}}}
    assert "mbs: +--oil" in list(manifest.differences(said, more, {}, {}))


def test_words_that_change_from_run_to_run_are_left_out():
    text = (
        "created 2026-01-02T03:04:05+00:00\nversion 0.1.0+g0123456789\n"
        "3 steps, 12.5 us of processor time a step, 0.1 s\nload 12.5 N"
    )
    assert manifest._steady(text) == ["created DATE", "version VERSION", "3 steps, TIME", "load 12.5 N"]
