"""`python -m mbs.housings NAME`: make a shipped housing anew, or show how its mesh converges."""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from collections.abc import Sequence

from ehdmaps.errors import EhdmapsError, InputError

DONE, NOT_MET, BAD_INPUT = 0, 1, 2
"""0: done; 1: meshing or solving failed; 2: bad input or a missing program, nothing written."""


def parser() -> argparse.ArgumentParser:
    """Return the parser."""
    found = argparse.ArgumentParser(
        prog="python -m mbs.housings",
        description="Make a housing of a shipped system anew: gmsh meshes it, CalculiX gives stiffness and mass, and "
        "they are reduced to the bearing seats and the modes with the seats held.",
        epilog="Needs gmsh (pip install 'ehdmaps[housings]') and CalculiX (ccx). Exit status: 0 done; 1 meshing or "
        "solving failed; 2 bad input or a missing program, nothing written. Size and cutoff are those of the shipped "
        "file if left out.",
    )
    found.add_argument("name", metavar="NAME", help="gearbox_housing, nu308_housing, n1014_housing")
    found.add_argument("-o", "--output", metavar="FILE.nc", help="NAME.nc if left out")
    found.add_argument("--size", metavar="LENGTH", help='of the elements, such as "12 mm"')
    found.add_argument("--cutoff", metavar="FREQUENCY", help='of the modes that are kept, such as "8 kHz"')
    found.add_argument("--keep", metavar="FOLDER", help="new folder where the files of CalculiX stay")
    found.add_argument("--picture", metavar="FIG.png", help="drawing of the mesh; also .pdf, .svg")
    found.add_argument("--convergence", action="store_true", help="show a table over mesh sizes; nothing is written")
    return found


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status."""
    arguments = parser().parse_args(argv)
    # Before numpy loads: two runs give the same file, whatever the number of cores.
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    try:
        text = importlib.import_module("mbs.housings.command").run(arguments)
    except EhdmapsError as error:
        from mbs.errors import AnalysisError

        problems = error.problems if isinstance(error, InputError) else tuple(str(error).splitlines())
        head = f"mbs.housings: {len(problems)} problem{'s' if len(problems) > 1 else ''}"
        sys.stderr.write("\n".join([head, *(f"  {problem}" for problem in problems)]) + "\n")
        return NOT_MET if isinstance(error, AnalysisError) else BAD_INPUT
    except KeyboardInterrupt:
        sys.stderr.write("\nstopped\n")
        return 130
    sys.stdout.write(text + "\n")
    return DONE


if __name__ == "__main__":
    sys.exit(main())
