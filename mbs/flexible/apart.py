"""Files that another package reads, in a process of its own: what leads it astray ends there."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import textwrap
from collections.abc import Sequence

from ehdmaps.extras import needs

SHORTEST_READ, BYTES_PER_SECOND = 20.0, 1e6
"""Seconds that the package has, and what it reads in one more; it takes half a second to start, and 10 MB a second."""

_NO_PACKAGE = 3
"""Exit status of the process that reads, where meshio or a package that it needs is not installed."""

# meshio prints what went wrong, and leaves the program.
_AROUND = """
import os, sys
output = os.fdopen(os.dup(1), "wb")
os.dup2(2, 1)
try:
{}
except ImportError as error:
    sys.stderr.write(str(error))
    sys.exit({})
except (Exception, SystemExit) as error:
    sys.stderr.write(f" {{error}}")
"""


def run_apart(
    code: str, arguments: Sequence[str], length: int, extra: str, package: str, where: str
) -> tuple[bytes, str]:
    """Read files with another package in a process of its own.

    Parameters
    ----------
    code : str
        Python that imports the package, and writes what it finds in sys.argv[1:] to the binary file `output`.
    arguments : sequence of str
        Content of sys.argv[1:].
    length : int
        Bytes of the files; the time that it may take grows with them.
    extra, package : str
        Names of the extra and of the package, for `ehdmaps.extras.needs`.
    where : str
        Begin of a message on a missing package.

    Returns
    -------
    content : bytes
        Content of `output`.
    words : str
        Complaints of the package.

    Raises
    ------
    DependencyError
        If the package cannot be loaded.
    """
    seconds = SHORTEST_READ + length / BYTES_PER_SECOND
    script = _AROUND.format(textwrap.indent(code.strip(), "    "), _NO_PACKAGE)
    with tempfile.TemporaryFile() as output:
        try:
            process = subprocess.run(
                # -P: nothing is imported from the folder in which we are.
                [sys.executable, "-P", "-c", script, *arguments],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.PIPE,
                timeout=seconds,
                check=False,
            )
            words = " ".join(process.stderr.decode("utf-8", "replace").split())
            if process.returncode == _NO_PACKAGE:
                with needs(extra, package, f"{where}: reading this format"):
                    raise ImportError(f"{words:.120}")
        except subprocess.TimeoutExpired:
            words = f"it did not end within {seconds:.3g} s"
        output.seek(0)
        return output.read(), words
