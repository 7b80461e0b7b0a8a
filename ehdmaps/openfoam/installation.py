"""Location of OpenFOAM and `ehlFoam`, which build it is, what is missing, and the command that builds it."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.extras import lacking
from ehdmaps.outputs import cache_folder, others_may_write

BUILD_COMMAND = "ehdmaps openfoam"
"""Command that builds `ehlFoam`, by the script of `build_script`; with --install it installs what is needed, too."""

FOLDER_VARIABLE = "EHDMAPS_OPENFOAM"
"""Environment variable with the folder of the build."""

DEBIAN = Path("/usr/share/openfoam")
"""Project folder of the distribution's package, which sets no environment of its own."""

DEBIAN_ENVIRONMENT = {"WM_PROJECT_DIR": str(DEBIAN), "WM_PROJECT_VERSION": "v1912"}

_NO_PATH = re.compile(r"[\s\"']")
"""Characters that OpenFOAM does not take in the path of a case."""

_CASES = "openfoam_cases"
_CASE = "lineContact"
_NO_CASES = f"no folder {_CASES} is beside the package ehdmaps, nor in it"
_VERSION = re.compile(r"OpenFOAM\W+(?:version\W+)?(v?\d[\w.+-]*)", re.IGNORECASE)
_PROCESSOR = re.compile(r"\bprocessor (\w+)")
_LOADED = re.compile(r"^Using: +OpenFOAM\W+v?(\d{4})\b", re.MULTILINE)
"""What the library that a program has loaded says of itself."""

_PLACES = ("WM_PROJECT_DIR", "LD_LIBRARY_PATH", "LD_PRELOAD")
"""Environment variables that say which OpenFOAM a program finds."""

_PATIENCE = 60.0
"""Seconds that a program has to print its help, which takes it a tenth of one."""

_RELEASE = re.compile(r"v?(\d+)")


@dataclass(frozen=True)
class Installation:
    """Installation that runs a case.

    Attributes
    ----------
    solver : Path
        The program.
    template : Path
        The case that is copied.
    build : str
        Record of the build: OpenFOAM version, compiler, processor, hash of the sources.
    template_hash : str
        Hash of the template's files.
    environment : tuple of (str, str)
        What the programs need besides the environment of this process.
    """

    solver: Path
    template: Path
    build: str
    template_hash: str
    environment: tuple[tuple[str, str], ...]

    @property
    def openfoam_version(self) -> str:
        """Version of OpenFOAM for which `ehlFoam` was built, as its record says."""
        match = _VERSION.search(self.build)
        return match[1] if match else "unknown"

    @property
    def version(self) -> str:
        """Text that tells one build, or one template, from the next."""
        return f"{self.build}; template {self.template_hash}"

    def full_environment(self) -> dict[str, str]:
        """Environment of the programs: one thread each, no colours."""
        return {**os.environ, **dict(self.environment), "TERM": "dumb", "OMP_NUM_THREADS": "1"}


def installation(environment: Mapping[str, str] | None = None) -> Installation:
    """Find OpenFOAM and `ehlFoam`.

    Parameters
    ----------
    environment : mapping, optional
        That of this process if left out.

    Raises
    ------
    InputError
        With everything that is missing, and what to do.
    """
    known = os.environ if environment is None else environment
    folder = build_folder(known)
    solver, record = folder / "bin" / "ehlFoam", folder / "bin" / "ehlFoam.build"
    places = (folder, cases_folder())
    template = next((place / _CASE for place in places if place and (place / _CASE / "system").is_dir()), None)
    extra = () if "WM_PROJECT_DIR" in known else tuple(DEBIAN_ENVIRONMENT.items())
    build = ""
    problems = list(lacking("openfoam", "PyFoam", "the solver 'openfoam'"))
    if extra and not DEBIAN.is_dir():
        problems.append(
            f"OpenFOAM: WM_PROJECT_DIR is not set and there is no {DEBIAN}; the solver 'openfoam' needs "
            "OpenFOAM v1912; install the package openfoam, or source etc/bashrc of an installation"
        )
    if shutil.which("setpriv", path=known.get("PATH")) is None:
        problems.append("setpriv is not in PATH; install the package util-linux")
    if _NO_PATH.search(str(solver)):
        problems.append(
            f"ehlFoam: got the program {str(solver)!r}; OpenFOAM takes no spaces or quotes in its path; set "
            f"{FOLDER_VARIABLE} to another folder and build there"
        )
    elif not os.access(solver, os.X_OK):
        problems.append(
            f"ehlFoam: there is no program {solver}; build it with `{BUILD_COMMAND} --install`, "
            f"or set {FOLDER_VARIABLE} to the folder of a build"
        )
    elif others := others_may_write(folder) or others_may_write(solver.parent) or others_may_write(solver):
        problems.append(f"ehlFoam: {others}; or set {FOLDER_VARIABLE} to the folder of a build of yours")
    elif not record.is_file():
        problems.append(f"ehlFoam: there is no record {record} of its build; build it again with `{BUILD_COMMAND}`")
    else:
        build = " ".join(record.read_text(encoding="utf-8", errors="replace").split())[:500]
        refused = tuple(_other_machine(solver, build, known)) or _does_not_start(
            solver, build, {**known, **dict(extra)}
        )
        problems += refused
    if template is None:
        problems.append(
            f"case {_CASE}: is not in {folder}, and {_NO_CASES}; install ehdmaps again, or copy "
            f"{_CASES}/{_CASE} of the project into that folder"
        )
    if _NO_PATH.search(tempfile.gettempdir()):
        problems.append(
            f"the folder for temporary files: got {tempfile.gettempdir()!r}; OpenFOAM takes no spaces or quotes in it; "
            "set TMPDIR to another folder"
        )
    if problems or template is None:
        raise InputError(problems)
    return Installation(
        solver=solver,
        template=template,
        build=build,
        template_hash=_hash(template),
        environment=extra,
    )


def case_problems(solver: str, keep_cases: Path | None) -> list[str]:
    """Tell why cases may not be kept in a folder; none where they may.

    Parameters
    ----------
    solver : str
        What messages call the solver.
    keep_cases : Path or None
        The folder; None where none are kept.
    """
    if keep_cases is None or not _NO_PATH.search(str(keep_cases.absolute())):
        return []
    return [
        f"{solver}, keep_cases: got {str(keep_cases.absolute())!r}; OpenFOAM takes no spaces or quotes in the path of "
        "a case; choose another folder"
    ]


def missing() -> tuple[str, ...]:
    """Return what is missing, one sentence each; empty if cases can run."""
    try:
        installation()
    except InputError as error:
        return error.problems
    return ()


def cases_folder(package: Path = Path(__file__).parents[1]) -> Path | None:
    """Return the folder with the sources of `ehlFoam`, its case and the script that builds it.

    Parameters
    ----------
    package : Path
        Folder of the package ehdmaps.

    Returns
    -------
    Path or None
        `openfoam_cases` of a clone; else that in the package, where installations have it; None where there is neither.
    """
    places = (package.parent / _CASES, package / _CASES)
    return next((place for place in places if (place / "build").is_file()), None)


def build_script() -> Path:
    """Return the script that builds `ehlFoam`.

    Raises
    ------
    InputError
        If it is not there.
    """
    cases = cases_folder()
    if cases is None:
        raise InputError(
            f"the sources of ehlFoam: {_NO_CASES}; install ehdmaps again, from its wheel, sdist or a clone"
        )
    return cases / "build"


def build_folder(environment: Mapping[str, str]) -> Path:
    """Return the folder of the build, as the build command has it."""
    return cache_folder("openfoam", FOLDER_VARIABLE, environment)


def _other_machine(solver: Path, build: str, environment: Mapping[str, str]) -> Iterator[str]:
    """Say where the record of a build has another OpenFOAM or another processor than this machine has."""
    made_for, here = _VERSION.search(build), openfoam_here(environment)
    if made_for is None or (here and _release(here) != _release(made_for[1])):
        has = f"built for OpenFOAM {made_for[1]}" if made_for else "without the version of OpenFOAM in its record"
        yield (
            f"ehlFoam: {solver} is {has}, found is OpenFOAM {here or 'of no known version'}; source etc/bashrc of the "
            f"OpenFOAM that it is built for, or build it again with `{BUILD_COMMAND}`"
        )
    made_on = _PROCESSOR.search(build)
    if made_on is None or made_on[1] != processor():
        yield (
            f"ehlFoam: {solver} is built for the instructions of another processor (record "
            f"{made_on[1] if made_on else 'none'}, here {processor()}) and may crash on this one; build it again with "
            f"`{BUILD_COMMAND}`, or set {FOLDER_VARIABLE} to a folder for builds of this machine"
        )


def _does_not_start(solver: Path, build: str, environment: Mapping[str, str]) -> Iterator[str]:
    """Say why a program cannot run here, or which other OpenFOAM its libraries are of: it is asked for its help."""
    try:
        asked = subprocess.run(
            [solver, "-help"],
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
            errors="replace",
            timeout=_PATIENCE,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        yield f"ehlFoam: {solver} cannot be started ({error}); build it again with `{BUILD_COMMAND}`"
        return
    places = [f"{name} {environment[name][:300]!r}" for name in _PLACES if environment.get(name)]
    see = f"see to {' and '.join(places)}"
    made_for, loaded = _VERSION.search(build), _LOADED.search(asked.stdout)
    if asked.returncode:
        said = [line.strip() for line in asked.stdout.splitlines() if line.strip()]
        cause = " | ".join(said[-2:])[-300:] or f"status {asked.returncode}"
        yield f"ehlFoam: {solver} does not start ({cause}); {see}, or build it again with `{BUILD_COMMAND}`"
    elif made_for and loaded and loaded[1] != _release(made_for[1]):
        yield (
            f"ehlFoam: {solver} is built for OpenFOAM {made_for[1]}, the libraries that it finds are of OpenFOAM "
            f"{loaded[1]}; {see}, or build it again with `{BUILD_COMMAND}`"
        )


def openfoam_here(environment: Mapping[str, str]) -> str:
    """Version of the OpenFOAM that programs find: of the environment, or else of the distribution; empty if unknown."""
    if "WM_PROJECT_DIR" in environment and Path(environment["WM_PROJECT_DIR"]) != DEBIAN:
        return environment.get("WM_PROJECT_VERSION", "")
    return _debian_version()


@cache
def _debian_version() -> str:
    """Version of the package openfoam; empty where there is none, or no such command."""
    command = ["dpkg-query", "-W", "-f", "${source:Version}", "openfoam"]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=False, timeout=30.0).stdout.strip()
    except (OSError, subprocess.TimeoutExpired):
        return ""


@cache
def processor(cpu_information: Path = Path("/proc/cpuinfo")) -> str:
    """Hash that tells the instructions of one processor from those of the next, as the build command records it."""
    flags = b""
    with suppress(OSError), cpu_information.open("rb") as file:
        flags = next((line for line in file if line.startswith((b"flags", b"Features"))), b"")
    return hashlib.sha256(flags).hexdigest()[:16]


def _release(version: str) -> str:
    """Number of a release: 1912 of v1912 and of 1912.200626-1."""
    match = _RELEASE.match(version)
    return match[1] if match else version


def _hash(template: Path) -> str:
    """Hash the files of the template that a run uses; its parameter file is replaced and does not count."""
    digest = hashlib.sha256()
    for part in ("system", "0", "constant"):
        for path in sorted((template / part).rglob("*")):
            if path.is_file() and "polyMesh" not in path.parts and path.name != "ehlProperties":
                digest.update(str(path.relative_to(template)).encode())
                digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
