"""Real installations, in new folders: README's two commands in one clone, and upgrades.

What ehdmaps needs is linked from the environment of the tests, so that pip finds it and downloads setuptools alone.
"""

import json
import os
import shutil
import site
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import ehdmaps

ROOT = Path(__file__).parents[2]

pytestmark = pytest.mark.slow

POINT = ["--load", "62 N", "--length", "0.7 mm", "--speed", "1.7 m/s", "--temperature", "40 degC", "--json"]

JOB = """
schema = 1
[bearing]
name = "NU308"
[lubricant]
name = "FVA3"
[grid]
load = ["20 N/mm", "80 N/mm", "160 N/mm"]
entrainment_speed = ["1 m/s", "2 m/s", "4 m/s"]
temperature = ["40 degC", "60 degC"]
[solver]
name = "reynolds"
structural_law = "iso16281"
backbone = "none"
law_check = 0
"""


def sources(folder):
    """A copy of the tracked files, as a clone has them, with the changes that were not committed."""
    if shutil.which("git") is None or not (ROOT / ".git").exists():
        pytest.skip("needs a clone, and git")
    listed = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z"], capture_output=True, text=True, check=True)
    for name in filter(None, listed.stdout.split("\0")):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
    return folder


def environment(folder):
    """A virtual environment that has what ehdmaps needs, by links, and not ehdmaps."""
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    needed = folder / "needed"
    needed.mkdir()
    ours = ("ehdmaps", "mbs", "__editable__", "pip", "setuptools", "_distutils_hack", "distutils-precedence")
    taken = set()
    for place in map(Path, [*site.getsitepackages(), *linked()]):
        for path in place.iterdir() if place.is_dir() else ():
            if not path.name.startswith(ours) and path.suffix != ".pth" and path.name not in taken:
                taken.add(path.name)
                (needed / path.name).symlink_to(path)
    (packages,) = folder.glob("lib/python3*/site-packages")
    (packages / "needed.pth").write_text(f"{needed}\n", encoding="utf-8")
    return packages


def linked():
    """Folders that files `.pth` of the environment of the tests name."""
    for place in map(Path, site.getsitepackages()):
        for path in place.glob("*.pth"):
            yield from (line for line in path.read_text(encoding="utf-8").splitlines() if Path(line).is_absolute())


def run(*command, folder, **variables):
    """Output of a command in a folder, of a user who has set nothing but the path; HOME is not set either."""
    kept = {name: os.environ[name] for name in ("PATH", "PIP_INDEX_URL", "PIP_CONFIG_FILE") if name in os.environ}
    settings = {**kept, "PIP_DISABLE_PIP_VERSION_CHECK": "1", "LC_ALL": "C.UTF-8", **variables}
    words = [str(word) for word in command]
    found = subprocess.run(words, capture_output=True, text=True, cwd=folder, env=settings, check=False)
    assert found.returncode == 0, f"{words}: {found.stdout}\n{found.stderr}"
    return found.stdout


def solved(program, folder, solver="reynolds", **variables):
    """Central films and damping of a point [m, N s/m2]."""
    contacts = json.loads(run(program, "solve", "nu308", *POINT, "--solver", solver, folder=folder, **variables))
    return [(contact["central_film"], contact["damping"]) for contact in contacts]


@pytest.fixture
def cache(tmp_path):
    return str(tmp_path / "cache")


def test_the_two_commands_of_the_readme_in_their_order_in_one_clone(tmp_path):
    clone = sources(tmp_path / "Prüfstand 2, neu" / "clone")
    packages = environment(clone / ".venv")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    run("bash", ".ci/environment", folder=clone)
    assert (packages / "ehdmaps" / "__init__.py").is_file()
    first = solved(clone / ".venv" / "bin" / "ehdmaps", elsewhere, "formula")
    # what versions that kept compiled code beside the sources would have left there
    for name in ("ehdmaps", "mbs"):
        (packages / name / "physics" / "__pycache__").mkdir(parents=True, exist_ok=True)
        (packages / name / "physics" / "__pycache__" / "density-12.py311.nbi").write_bytes(b"old")
        (packages / name / "physics" / "__pycache__" / "density.cpython-311.opt-1.pyc").write_bytes(b"old")
    run("bash", ".ci/environment", "--editable", ".", folder=clone)
    assert not (packages / "ehdmaps").exists()
    assert not (packages / "mbs").exists()
    code = "import mbs; from ehdmaps import BearingGeometry; import ehdmaps; print(ehdmaps.__file__)"
    found = run(clone / ".venv" / "bin" / "python", "-c", code, folder=elsewhere)
    assert Path(found.strip()) == clone / "ehdmaps" / "__init__.py"
    assert solved(clone / ".venv" / "bin" / "ehdmaps", elsewhere, "formula") == first
    # and back to a copy, as the first command makes it
    run("bash", ".ci/environment", folder=clone)
    found = run(clone / ".venv" / "bin" / "python", "-c", code, folder=elsewhere)
    assert Path(found.strip()) == packages / "ehdmaps" / "__init__.py"


def test_an_upgrade_computes_with_the_new_code(tmp_path, cache):
    """A function in an unchanged file calls one that changed; stored points of the old code are not taken over."""
    tree = sources(tmp_path / "tree")
    environment(tmp_path / "venv")
    program = tmp_path / "venv" / "bin" / "ehdmaps"
    pip = [tmp_path / "venv" / "bin" / "pip", "install", "--quiet", "--no-deps"]
    run(*pip, tree, folder=tmp_path)
    (tmp_path / "job.toml").write_text(JOB)
    generate = [program, "generate", "job.toml", "-o", "map.nc", "--workers", "1"]
    run(*generate, folder=tmp_path, XDG_CACHE_HOME=cache)
    with ehdmaps.open_map(tmp_path / "map.nc").dataset as before:
        before.load()
    point = solved(program, tmp_path, XDG_CACHE_HOME=cache)
    law = tree / "ehdmaps" / "physics" / "isotherm.py"
    text = law.read_text()
    changed = text.replace("return alpha * p * f, alpha", "return 1.05 * alpha * p * f, 1.05 * alpha")
    assert changed != text
    law.write_text(changed)
    run(*pip, tree, folder=tmp_path)
    run(*generate, folder=tmp_path, XDG_CACHE_HOME=cache)
    with ehdmaps.open_map(tmp_path / "map.nc").dataset as after:
        after.load()
    # 5 % more of alpha make some 2 % more film
    assert (np.abs(after["central_film"] / before["central_film"] - 1.0) > 0.01).all()
    assert after.attrs["code_hash"] != before.attrs["code_hash"]
    for old, new in zip(point, solved(program, tmp_path, XDG_CACHE_HOME=cache), strict=True):
        assert new[0] > 1.01 * old[0]
