"""Mutation trials: twenty planted faults, and whether the short tier of the tests finds them.

    python -m tests.benchmarks.mutations                # all of them; 20 to 60 minutes
    python -m tests.benchmarks.mutations gap sign-of-c  # those whose name has one of these words

Each fault (a sign, a factor of two, a wrong axis, a unit left out) is planted alone in a copy of the tree. The whole
short tier twenty times would take hours, so each fault is shown only those of its files that are likely to see it,
which makes the trial harder, not easier: the doctests of the changed module, test files that import it, those that
import what imports it, and so on, to the first failure. A test that fails in a copy without the fault as well does not
count. A fault that is not found within `LIMIT` counts as missed, though a later file might have found it. Kernels that
are quick enough as Python run so, as each fault would be compiled anew.

Exit status 1 where fewer than nineteen of twenty are found, in the same share of those that were asked for.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
LIMIT = 300.0
"""Seconds of tests for a fault."""

LEAST_SHARE = 0.95


@dataclass(frozen=True)
class Fault:
    """A fault: its name, the file, what stands there and what is put in its place.

    Attributes
    ----------
    python : bool
        Whether tests run with kernels as Python.
    """

    name: str
    file: str
    right: str
    wrong: str
    python: bool = False


FAULTS = (
    Fault("half-width, factor two", "ehdmaps/physics/hertz.py", "sqrt(8.0 * load", "sqrt(4.0 * load", True),
    Fault(
        "viscosity, unit left out",
        "ehdmaps/physics/viscosity.py",
        "kinematic * _MM2 * density",
        "kinematic * density",
        True,
    ),
    Fault(
        "entrainment for the sum of speeds",
        "ehdmaps/physics/moes.py",
        "viscosity * 2.0 * speed",
        "viscosity * speed",
        True,
    ),
    Fault("elastic kernel, sign of its correction", "ehdmaps/ehl/grid.py", "- 2.0 * correction", "+ 2.0 * correction"),
    Fault(
        "derivative of the flow, sign",
        "ehdmaps/ehl/reynolds.py",
        "eta_slope - rho_slope / rho",
        "eta_slope + rho_slope / rho",
    ),
    Fault(
        "squeeze term, sign-of-c", "ehdmaps/ehl/linearisation.py", "added[i] = -mass_rate[i]", "added[i] = mass_rate[i]"
    ),
    Fault(
        "compliance of the solids, factor",
        "ehdmaps/kernel/c/law/law.c",
        "*compliance += b * part / w;",
        "*compliance += part / w;",
    ),
    Fault(
        "damping of a faded film, factor",
        "ehdmaps/kernel/c/law/law.c",
        "found.dc *= part / slope;",
        "found.dc /= slope;",
    ),
    Fault(
        "film memory, tangent",
        "ehdmaps/kernel/c/film/film.c",
        "? load.slope / rise : 0.0",
        "? 2.0 * load.slope / rise : 0.0",
    ),
    Fault(
        "bend of a viscosity law, turned over",
        "ehdmaps/table/coordinates.py",
        "np.sqrt(ALPHA / alpha)",
        "np.sqrt(alpha / ALPHA)",
    ),
    Fault(
        "response from the table, sign of c",
        "ehdmaps/table/films.py",
        "= reduced_response * points.unit",
        "= np.conj(reduced_response) * points.unit",
    ),
    Fault(
        "tilt of a roller, sign",
        "ehdmaps/kernel/c/cylinder/cylinder.c",
        "m->theta_z * r.cosine - m->theta_y * r.sine",
        "m->theta_z * r.cosine + m->theta_y * r.sine",
    ),
    Fault(
        "gap of a roller, wrong axis",
        "ehdmaps/kernel/c/cylinder/cylinder.c",
        "m->y * r.cosine + m->z * r.sine",
        "m->z * r.cosine + m->y * r.sine",
    ),
    Fault("friction torque, unit left out", "mbs/bearings/contact_report.py", "1e-3 * 1e-7 * f0", "1e-7 * f0", True),
    Fault("time of a film, factor left out", "mbs/bearings/slices_in_balance.py", "(dg * (1.0 - dy), k,", "(dg, k,"),
    Fault(
        "step of integration, factor two",
        "ehdmaps/kernel/c/run/advance.c",
        "(0.5 - numbers->beta)",
        "(1.0 - numbers->beta)",
    ),
    Fault(
        "energy over a step, factor two",
        "ehdmaps/kernel/c/run/advance.c",
        "0.5 * numbers->h * (run->powers",
        "numbers->h * (run->powers",
    ),
    Fault("highest order, unit left out", "mbs/spectral/orders.py", "signal.highest * _TURN /", "signal.highest /"),
    Fault("ROSS, hertz for rad/s", "mbs/exports/ross.py", "2.0 * math.pi * bearing.frequencies", "bearing.frequencies"),
    Fault("CalculiX, stiffness across, factor two", "mbs/exports/calculix.py", "part = 0.5 * (", "part = ("),
)
"""Twenty faults, over physics, ehl, maps, table, bearings, transient, spectral and exports."""


def likely_files(file: str) -> list[str]:
    """Return the file of a fault, for its doctests, and test files in order of likelihood."""
    tests = [
        path
        for folder in ("unit", "verification", "properties", "system")
        for path in sorted((ROOT / "tests" / folder).glob("test_*.py"))
        if path.name not in ("test_imports.py", "test_docstrings.py")  # which say nothing of numbers
    ]
    words = set(Path(file).stem.split("_"))
    tests.sort(key=lambda path: -len(words & set(path.stem.split("_"))))
    modules = [file]
    ordered: list[Path] = []
    for _ in range(3):  # those that import it, those that import these, and once more
        ordered += [path for path in tests if path not in ordered and _names(path, modules)]
        modules = [str(path.relative_to(ROOT)) for path in _sources() if _names(path, modules)]
    # what is loaded by its name, as targets of exports are
    word = Path(file).stem
    ordered += [path for path in tests if path not in ordered and re.search(rf"\b{word}\b", path.read_text("utf-8"))]
    own = [file] if file.endswith(".py") else []  # pytest refuses what has no doctests
    return own + [str(path.relative_to(ROOT)) for path in ordered]


def _sources() -> Iterator[Path]:
    for package in ("ehdmaps", "mbs"):
        yield from (ROOT / package).rglob("*.py")


def _names(path: Path, files: list[str]) -> bool:
    """Tell whether a file imports one of some modules, given by their files."""
    text = path.read_text(encoding="utf-8")
    for file in files:
        package, _, name = file.removesuffix(".py").removesuffix("/__init__").replace("/", ".").rpartition(".")
        wanted = (
            rf"^\s*(from|import) {re.escape(f'{package}.{name}')}\b|^\s*from {re.escape(package)} import .*\b{name}\b"
        )
        if re.search(wanted, text, re.MULTILINE):
            return True
    return False


def copy_tree(place: Path) -> Path:
    """Return a copy of what git tracks, as it is now."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, place / name)
    return place


def first_failure(tree: Path, tests: list[str], python: bool, left_out: list[str], patience: float) -> str | None:
    """Return the first test that fails in a tree; empty if none does, and none where the time is over."""
    environment = {
        **os.environ,
        "PYTHONPATH": str(tree),
        "NUMBA_DISABLE_JIT": str(int(python)),
        "NUMBA_CACHE_DIR": str(tree.parent / f"compiled-{tree.name}"),
        "EHDMAPS_REDUCED": str(tree.parent / "reduced"),
        "CI": "1",
        **{name: "1" for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS")},
        "MPLBACKEND": "Agg",
    }
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "--no-header", "--tb=no"]
    command += [f"--deselect={name}" for name in left_out]
    try:
        done = subprocess.run(
            [*command, *tests], cwd=tree, env=environment, capture_output=True, text=True, check=False, timeout=patience
        )
    except subprocess.TimeoutExpired:
        return None
    failed = re.search(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", done.stdout, re.MULTILINE)
    if failed:
        return failed[1]
    if done.returncode not in (0, 5):
        return f"tests ended with status {done.returncode}: {(done.stdout + done.stderr)[-300:]}"
    return ""


def trial(fault: Fault, clean: Path, tree: Path) -> tuple[bool, str]:
    """Plant a fault in a tree and look for it; returns whether it was found, and by which test."""
    path = tree / fault.file
    text = path.read_text(encoding="utf-8")
    if text.count(fault.right) != 1:
        raise SystemExit(f"{fault.file}: {fault.right!r} stands {text.count(fault.right)} times; look after FAULTS")
    path.write_text(text.replace(fault.right, fault.wrong), encoding="utf-8")
    try:
        return _hunt(fault, clean, tree)
    finally:
        path.write_text(text, encoding="utf-8")


def _hunt(fault: Fault, clean: Path, tree: Path) -> tuple[bool, str]:
    """Look for a planted fault; what fails without it too is left out."""
    tests, left_out, end = likely_files(fault.file), list[str](), time.monotonic() + LIMIT
    while (patience := end - time.monotonic()) > 0.0:
        failed = first_failure(tree, tests, fault.python, left_out, patience)
        if failed is None:
            break
        if not failed:
            return False, f"passed: {len(tests)} files"
        if not first_failure(clean, [failed], fault.python, [], LIMIT):
            return True, failed
        left_out.append(failed)
    return False, f"not within {LIMIT:g} s of {len(tests)} files"


def main() -> int:
    """Try all faults, or those with given words in their names, and print what found them."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.mutations", description=__doc__.split("\n", 1)[0])
    parser.add_argument("words", metavar="WORD", nargs="*", help="of the names of faults; default: all")
    arguments = parser.parse_args()
    chosen = [f for f in FAULTS if not arguments.words or any(word in f.name for word in arguments.words)]
    found = 0
    with tempfile.TemporaryDirectory() as folder:
        clean, tree = (copy_tree(Path(folder) / name) for name in ("clean", "faulty"))
        for fault in chosen:
            begin = time.monotonic()
            seen, by = trial(fault, clean, tree)
            found += seen
            print(f"{'found' if seen else 'MISSED'}  {time.monotonic() - begin:4.0f} s  {fault.name}: {by}", flush=True)
    print(f"{found} of {len(chosen)} found")
    return int(found < LEAST_SHARE * len(chosen))


if __name__ == "__main__":
    sys.exit(main())
