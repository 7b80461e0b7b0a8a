"""Make a shipped housing anew, or show how its mesh converges: `python -m examples.housings NAME`, in a clone."""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Sequence

from ehdmaps.errors import AnalysisError
from ehdmaps.program import Parser, run


def parser() -> argparse.ArgumentParser:
    """Return the parser."""
    found = Parser(
        prog="python -m examples.housings",
        description="Make a housing of a shipped system anew: gmsh meshes it, CalculiX gives stiffness and mass, and "
        "they are reduced to the bearing seats and the modes with the seats held.",
        epilog='Needs gmsh (pip install "ehdmaps[housings]") and CalculiX (ccx). Exit status: 0 done; 1 meshing or '
        "solving failed; 2 bad input or a missing program, nothing written. Size and cutoff are those of the shipped "
        "file if left out.",
    )
    found.add_version()
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
    return run(parser(), _command, argv, no_result=AnalysisError)


def _command(arguments: argparse.Namespace) -> tuple[str, int]:
    """Load what makes housings, and do it."""
    return importlib.import_module("examples.housings.command").run(arguments), 0


if __name__ == "__main__":
    sys.exit(main())
