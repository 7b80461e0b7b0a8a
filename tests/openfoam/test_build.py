"""openfoam_cases/build, on machines that are made up: no network, no compiler, no OpenFOAM."""

import hashlib
import os
import re
import shutil
import subprocess
import time
from pathlib import Path

import pytest

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.jobs.cli import main
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from tests.openfoam import conftest

BUILD = Path(__file__).parents[2] / "openfoam_cases" / "build"

TOOLS = [
    "bash",
    "cat",
    "chmod",
    "cmp",
    "cp",
    "cut",
    "dirname",
    "env",
    "find",
    "flock",
    "grep",
    "id",
    "ls",
    "mkdir",
    "mv",
    "rm",
    "sed",
    "sha256sum",
    "sleep",
    "sort",
    "tail",
    "touch",
    "tr",
    "uname",
    "xargs",
]

# As wmake behaves: compiles in the folder it is called in, by paths relative to it, and counts how often it was called.
WMAKE = """
echo "$PWD" >> "$CALLS"
echo "compiling, EIGEN_INC=$EIGEN_INC"
grep -q broken ehlFoam.C && { echo "ehlFoam.C:1: error: broken"; exit 2; }
grep -q slow ehlFoam.C && sleep 1
grep -q killed ehlFoam.C && { mkdir -p Make/objects; touch Make/objects/half.o; kill -9 $$; }
{ echo "#!/bin/sh"; cat ehlFoam.C; } > "$FOAM_USER_APPBIN/ehlFoam"
chmod +x "$FOAM_USER_APPBIN/ehlFoam"
"""


class Machine:
    """A machine with the plain tools, and what a test puts on it; its home has a space in its path."""

    def __init__(self, folder):
        self.programs = folder / "programs"
        self.source = folder / "ehlFoam"
        self.home = folder / "a home"
        self.cache = self.home / ".cache" / "ehdmaps" / "openfoam"
        self.executable = self.cache / "bin" / "ehlFoam"
        self.calls = folder / "calls"
        for made in (self.programs, self.home, self.source / "Make"):
            made.mkdir(parents=True)
        for tool in TOOLS:
            (self.programs / tool).symlink_to(shutil.which(tool))
        (self.source / "Make" / "files").write_text("ehlFoam.C\n")
        (self.source / "Make" / "options").write_text("EXE_INC =\n")
        (self.source / "ehlFoam.C").write_text("echo first\n")
        (folder / "eigen" / "Eigen").mkdir(parents=True)
        (folder / "eigen" / "Eigen" / "Dense").touch()
        self.environment = {
            "PATH": str(self.programs),
            "HOME": str(self.home),
            "EHDMAPS_SOLVER_SOURCE": str(self.source),
            "EIGEN_INC": str(folder / "eigen"),
            "CALLS": str(self.calls),
        }

    def program(self, name, text="exit 0"):
        path = self.programs / name
        path.write_text(f"#!{shutil.which('bash')}\n{text}\n")
        path.chmod(0o755)

    def compiler(self):
        self.program("g++", 'echo "g++ 12.2.0"')
        self.program("make")

    def installation(self, version="v1912"):
        self.environment |= {"WM_PROJECT_DIR": "/opt/OpenFOAM", "WM_PROJECT_VERSION": version}
        self.program("wmake", WMAKE)

    def debian(self, version="1912.200626-1"):
        self.program("dpkg-query", f'[ "${{@: -1}}" = openfoam ] && echo "installed {version}"')

    def start(self, *arguments):
        return subprocess.Popen(
            [str(BUILD), *arguments], env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )

    def run(self, *arguments):
        return subprocess.run(
            [str(BUILD), *arguments], env=self.environment, capture_output=True, text=True, check=False
        )

    def refuses(self, *arguments):
        result = self.run(*arguments)
        assert result.returncode == 2, result
        assert result.stdout == ""
        return result.stderr

    def builds(self):
        result = self.run()
        assert result.returncode == 0, result.stderr
        assert result.stdout == f"up to date: {self.executable}\n"

    def number_of_builds(self):
        return len(self.calls.read_text().splitlines()) if self.calls.exists() else 0


@pytest.fixture
def bare(tmp_path):
    return Machine(tmp_path)


@pytest.fixture
def machine(bare):
    bare.compiler()
    bare.installation()
    return bare


def test_no_openfoam(bare):
    error = bare.refuses()
    assert "no OpenFOAM is found" in error
    assert "needed: OpenFOAM 1912" in error
    assert "--install" in error


@pytest.mark.parametrize("version", ["v2312", "7", "v19120", ""])
def test_another_version_of_an_installation(bare, version):
    bare.compiler()
    bare.installation(version)
    error = bare.refuses()
    assert f"OpenFOAM {version or 'unknown'} is found (WM_PROJECT_DIR=/opt/OpenFOAM); needed: 1912" in error
    assert "Source etc/bashrc of an OpenFOAM v1912" in error


def test_another_version_of_the_distribution(bare):
    bare.compiler()
    bare.debian("4.1-2")
    assert "OpenFOAM 4.1-2 is found; needed: 1912" in bare.refuses()


@pytest.mark.parametrize("missing", ["g++", "make"])
def test_no_compiler(machine, missing):
    (machine.programs / missing).unlink()
    assert f"{missing} not found on the PATH; needed: a C++ compiler and make" in machine.refuses()


def test_no_network(bare):
    bare.compiler()
    bare.debian()
    bare.program("apt-get", 'echo "E: Could not resolve the mirror"; exit 100')
    error = bare.refuses()
    assert "the source package openfoam=1912.200626-1 could not be fetched: E: Could not resolve the mirror" in error
    assert "needed: the network" in error
    assert not list(bare.cache.glob("openfoam-*"))


def test_no_eigen(machine):
    del machine.environment["EIGEN_INC"]
    machine.environment["EIGEN_OF_DEBIAN"] = "/nowhere/eigen3"
    assert "no Eigen is found in /nowhere/eigen3; needed: Eigen 3" in machine.refuses()


def test_install_without_apt(bare):
    assert "no apt-get is found; --install needs Debian 12" in bare.refuses("--install")


def test_install_without_rights(bare):
    bare.program("apt-get", "exit 100")
    (bare.programs / "id").unlink()
    bare.program("id", "echo 1000")
    error = bare.refuses("--install")
    assert "not root and no sudo, but to install: openfoam g++ make libeigen3-dev" in error
    assert "Let an administrator" in error


def test_install_that_fails(bare):
    bare.program("apt-get", 'echo "E: no network"; exit 100')
    (bare.programs / "id").unlink()
    bare.program("id", "echo 0")
    error = bare.refuses("--install")
    assert "E: no network" in error
    assert "apt-get could not install openfoam g++ make libeigen3-dev" in error


def test_unknown_argument(machine):
    assert "got the arguments: --fast; allowed: none, --install or --check" in machine.refuses("--fast")


def test_no_solver(machine):
    (machine.source / "Make" / "files").unlink()
    assert "no solver is found" in machine.refuses()


def test_build_and_record(machine):
    machine.builds()
    assert subprocess.run([machine.executable], capture_output=True, text=True, check=True).stdout == "first\n"
    record = dict(line.split(" ", 1) for line in machine.executable.with_suffix(".build").read_text().splitlines())
    assert record["openfoam"] == "v1912"
    assert record["compiler"] == "g++ 12.2.0"
    assert len(record["sources"]) == len(hashlib.sha256().hexdigest())
    assert sorted(path.name for path in machine.source.rglob("*")) == ["Make", "ehlFoam.C", "files", "options"]


def test_nothing_to_do_is_fast(machine):
    machine.builds()
    begin = time.monotonic()
    machine.builds()
    assert time.monotonic() - begin < 1
    assert machine.number_of_builds() == 1


def test_a_change_and_a_vanished_file(machine):
    (machine.source / "parts").mkdir()
    (machine.source / "parts" / "old.H").touch()
    machine.builds()
    (copy,) = machine.cache.glob("objects-*")
    assert (copy / "parts" / "old.H").exists()
    (machine.source / "parts" / "old.H").unlink()
    (machine.source / "ehlFoam.C").write_text("echo second\n")
    os.utime(machine.source / "ehlFoam.C", (0, 0))  # as a file out of an archive
    machine.builds()
    assert not (copy / "parts" / "old.H").exists()
    assert subprocess.run([machine.executable], capture_output=True, text=True, check=True).stdout == "second\n"


def test_check(machine):
    def check(code, *texts):
        result = machine.run("--check")
        assert result.returncode == code
        assert result.stderr == ""
        assert result.stdout.count("\n") == 1
        assert all(text in result.stdout for text in texts), result.stdout

    check(1, "missing: no ", f"run {BUILD}")
    assert not machine.cache.exists()
    machine.builds()
    check(0, "up to date: ")
    (machine.source / "Make" / "options").write_text("EXE_INC = -g\n")
    check(1, "out of date: the sources have changed")
    machine.environment["WM_PROJECT_VERSION"] = "v1912_210415"
    check(1, "out of date: built for OpenFOAM v1912, found is v1912_210415")
    machine.environment["WM_PROJECT_VERSION"] = "v2312"
    check(1, "out of date: OpenFOAM v2312 is found")
    del machine.environment["WM_PROJECT_DIR"]
    check(1, "out of date: no OpenFOAM is found")


def test_a_solver_that_does_not_compile(machine):
    machine.builds()
    (machine.source / "ehlFoam.C").write_text("broken\n")
    result = machine.run()
    assert result.returncode == 1
    assert "ehlFoam.C:1: error: broken" in result.stderr
    assert f"ehlFoam does not compile; the whole log: {machine.cache / 'build.log'}" in result.stderr
    assert machine.run("--check").returncode == 1


def test_a_killed_build_is_not_taken_for_complete(machine):
    (machine.source / "ehlFoam.C").write_text("killed\n")
    assert machine.run().returncode == 1
    assert list(machine.cache.glob("objects-*/Make/objects/half.o"))
    assert machine.run("--check").returncode == 1
    (machine.source / "ehlFoam.C").write_text("echo well\n")
    machine.builds()
    assert not list(machine.cache.glob("objects-*/Make/objects/half.o"))


def test_an_executable_without_its_record_is_not_taken_for_complete(machine):
    machine.builds()
    machine.executable.with_suffix(".build").unlink()
    assert "the last build was interrupted" in machine.run("--check").stdout
    machine.builds()
    assert machine.number_of_builds() == 2


def test_an_interrupted_download_is_thrown_away(bare):
    bare.compiler()
    bare.debian()
    (bare.cache / "unfinished" / "tree" / "src").mkdir(parents=True)
    bare.program("apt-get", "exit 100")
    bare.refuses()
    assert not (bare.cache / "unfinished" / "tree").exists()


def test_two_at_the_same_time(machine):
    (machine.source / "ehlFoam.C").write_text("# slow\n")
    builds = [machine.start(), machine.start()]
    errors = [build.communicate()[1] for build in builds]
    assert [build.returncode for build in builds] == [0, 0]
    assert sum("another build is under way" in error for error in errors) == 1
    assert machine.number_of_builds() == 1


def test_without_the_solver_a_test_is_skipped(monkeypatch):
    class Marked:
        def get_closest_marker(self, name):
            return name == "openfoam"

    monkeypatch.setattr(conftest, "why_not", lambda: "ehlFoam is missing: no bin/ehlFoam")
    with pytest.raises(pytest.skip.Exception, match="ehlFoam is missing"):
        conftest.pytest_runtest_setup(Marked())


@pytest.mark.openfoam
def test_the_built_solver_is_up_to_date():
    result = subprocess.run([str(BUILD), "--check"], capture_output=True, text=True, check=False)
    assert result.stdout.startswith("up to date: ")


@pytest.mark.openfoam
def test_the_built_solver_runs(capfd):
    """A check solves a point on few cells: within 1 % of the Reynolds equation, the error of 100 x 4 cells."""
    assert main(["openfoam", "--check"]) == 0
    told = capfd.readouterr().out
    film = float(re.search(r"\nruns: .* has a central film of (\S+) um, in ", told)[1])
    contact, *_ = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")
    (known,) = ReynoldsSolver().solve_line(contact, Lubricant.named("FVA3"), (2e4,), 2.0, 333.15)
    assert film == pytest.approx(1e6 * known.central_film, rel=0.01)
