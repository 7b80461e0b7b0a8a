"""What the package docstring of ehdmaps.physics lists, and what importing it costs."""

import pkgutil
import subprocess
import sys

import ehdmaps.physics

MODULES = sorted(module.name for module in pkgutil.iter_modules(ehdmaps.physics.__path__, "ehdmaps.physics."))


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
