"""The set-up scripts say what they do, with stand-ins for what they run: nothing is installed."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.cases.programs import needed

ROOT = Path(__file__).parents[2]

PIP = """#!/bin/bash
echo "pip $*" >>"$RECORD"
[ "$1" != show ] || exit "${SHOWN:-1}"
"""
PYTHON = f"""#!/bin/bash
case $1 in
  --version) echo Python 3.12.0 ;;
  ehdmaps/kernel/building.py) echo "${{COMPILER-/usr/bin/cc}}" ;;
  -m) mkdir -p .venv/bin; cat >.venv/bin/pip <<'END'
{PIP}END
    chmod +x .venv/bin/pip ;;
esac
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "clone").mkdir()
    (tmp_path / "bin").mkdir()
    shutil.copytree(ROOT / ".ci", tmp_path / "clone" / ".ci")
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}:{os.environ['PATH']}")
    monkeypatch.setenv("RECORD", str(tmp_path / "record"))
    return tmp_path


def program(folder, name, text):
    path = folder / "bin" / name
    path.write_text(text)
    path.chmod(0o755)


def run(folder, script, *arguments):
    command = [needed("bash"), str(folder / "clone" / ".ci" / script), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_the_environment_says_what_it_makes_and_how_long_it_takes(folder, monkeypatch):
    program(folder, "python3", PYTHON)
    first = run(folder, "environment")
    assert (first.returncode, first.stdout) == (0, "")
    assert first.stderr.splitlines() == [
        ".ci/environment: making .venv with Python 3.12.0 (some seconds)",
        ".ci/environment: installing ehdmaps and what it needs with pip (about two minutes, more on a slow line; up to "
        "1 GB in .venv)",
        ".ci/environment: the C library is compiled by /usr/bin/cc",
        ".ci/environment: done: .venv/bin/ehdmaps, .venv/bin/mbs",
    ]
    monkeypatch.setenv("COMPILER", "")
    assert (
        ".ci/environment: no C compiler is found: pip fetches one for the build, the package ziglang (100 MB, some "
        in (run(folder, "environment").stderr)
    )
    monkeypatch.setenv("SHOWN", "0")
    again = run(folder, "environment", "--editable", ".[test]")
    assert again.returncode == 0
    assert again.stderr.splitlines()[0] == (
        ".ci/environment: bringing ehdmaps and what it needs up to date with pip (seconds, or minutes where something "
        "is new)"
    )
    record = (folder / "record").read_text().splitlines()
    assert [line.split()[-1] for line in record if "install" in line] == [".", ".", ".[test]"]


def test_a_failed_installation_is_none(folder):
    program(folder, "python3", PYTHON.replace('[ "$1" != show ]', "false"))
    found = run(folder, "environment")
    assert found.returncode != 0
    assert "done" not in found.stderr


def test_tools_say_what_they_install(folder):
    program(folder, "dpkg-query", "#!/bin/bash\n[ ${!#} = calculix-ccx ] || printf installed\n")
    program(folder, "apt-get", '#!/bin/bash\necho "apt-get $*" >>"$RECORD"\n')
    program(folder, "sudo", '#!/bin/bash\n"$@"\n')
    found = run(folder, "tools")
    assert (found.returncode, found.stdout) == (0, "")
    assert found.stderr == ".ci/tools: installing calculix-ccx with apt-get (minutes)\n"
    assert (folder / "record").read_text().splitlines()[-1].endswith("calculix-ccx")
