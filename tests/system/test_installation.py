"""Real installations, in new folders: README's two commands in one clone, and upgrades.

What ehdmaps needs is linked from the environment of the tests, so that pip finds it and downloads setuptools alone.
"""

import os
import shutil
import site
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import ehdmaps
from tests.cases.programs import needed, quick_compiler

ROOT = Path(__file__).parents[2]

pytestmark = pytest.mark.slow

JOB = """
schema = 1
[bearing]
name = "NU308"
[lubricant]
name = "FVA3"
[grid]
load = ["20 N/mm", "80 N/mm"]
entrainment_speed = ["1 m/s", "2 m/s"]
temperature = ["40 degC", "60 degC"]
[solver]
name = "formula"
"""


def sources(folder):
    """A copy of the tracked files, as a clone has them, with the changes that were not committed."""
    if not (ROOT / ".git").exists():
        pytest.skip("needs a clone")
    listed = subprocess.run(
        [needed("git"), "-C", str(ROOT), "ls-files", "-z"], capture_output=True, text=True, check=True
    )
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
    # modules are compiled as they are imported, which is a part of them: installations of all of them take seconds
    settings = {**kept, "PIP_DISABLE_PIP_VERSION_CHECK": "1", "PIP_NO_COMPILE": "1", "LC_ALL": "C.UTF-8", **variables}
    words = [str(word) for word in command]
    found = subprocess.run(words, capture_output=True, text=True, cwd=folder, env=settings, check=False)
    assert found.returncode == 0, f"{words}: {found.stdout}\n{found.stderr}"
    return found.stdout


def replaced(path, old, new):
    """Change a text that a file has once."""
    text = path.read_text(encoding="utf-8")
    assert text.count(old) == 1
    path.write_text(text.replace(old, new), encoding="utf-8")


def test_the_two_commands_of_the_readme_in_one_clone_and_an_upgrade(tmp_path):
    """An upgrade computes with the new code: stored points of the old code are not taken over. That compiled functions
    see it, too, is held by `tests/unit/test_compiled.py`."""
    clone = sources(tmp_path / "Prüfstand 2, neu" / "clone")
    packages = environment(clone / ".venv")
    python, program = clone / ".venv" / "bin" / "python", clone / ".venv" / "bin" / "ehdmaps"
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "job.toml").write_text(JOB)
    where = "import mbs; from ehdmaps import BearingGeometry; import ehdmaps; print(ehdmaps.__file__)"

    def computed():
        run(program, "generate", "job.toml", "-o", "map.nc", "--workers", "1", folder=elsewhere)
        with ehdmaps.open_map(elsewhere / "map.nc").dataset as dataset:
            return dataset.load()

    def install(*asked):
        run(needed("bash"), ".ci/environment", *asked, folder=clone, CC=quick_compiler(tmp_path))

    install()
    found = run(python, "-c", where, folder=elsewhere)
    assert Path(found.strip()) == packages / "ehdmaps" / "__init__.py"
    before = computed()
    # what versions that kept compiled code beside the sources would have left there
    for name in ("ehdmaps", "mbs"):
        (packages / name / "physics" / "__pycache__").mkdir(parents=True, exist_ok=True)
        (packages / name / "physics" / "__pycache__" / "density-12.py311.nbi").write_bytes(b"old")
        (packages / name / "physics" / "__pycache__" / "density.cpython-311.opt-1.pyc").write_bytes(b"old")
    # to the clone itself, as the second command makes it, in a newer state
    replaced(
        clone / "ehdmaps" / "physics" / "closed_form.py",
        "return film, film * slope",
        "return 1.05 * film, film * slope",
    )
    install("--editable", ".")
    assert not (packages / "ehdmaps").exists()
    assert not (packages / "mbs").exists()
    found = run(python, "-c", where, folder=elsewhere)
    assert Path(found.strip()) == clone / "ehdmaps" / "__init__.py"
    after = computed()
    np.testing.assert_allclose(after["film_offset"] / before["film_offset"], 1.05)  # round-off
    assert after.attrs["code_hash"] != before.attrs["code_hash"]
