"""The examples in the docstrings of ehdmaps.physics, and what importing it costs."""

import doctest
import importlib
import pkgutil
import subprocess
import sys

import pytest

import ehdmaps.physics

MODULES = sorted(module.name for module in pkgutil.iter_modules(ehdmaps.physics.__path__, "ehdmaps.physics."))


@pytest.mark.parametrize("name", MODULES)
def test_examples_of_the_docstrings_hold(name):
    failed, _ = doctest.testmod(importlib.import_module(name))
    assert failed == 0


def test_package_docstring_lists_every_module():
    for name in MODULES:
        short = name.rsplit(".", 1)[1]
        assert short.startswith("_") or f"\n{short} " in ehdmaps.physics.__doc__, short


def test_import_needs_numpy_only():
    code = (
        f"import sys, importlib; [importlib.import_module(m) for m in {MODULES!r}]; "
        "sys.exit(', '.join({'scipy', 'numba', 'xarray', 'matplotlib', 'PyFoam'} & set(sys.modules)) or None)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
