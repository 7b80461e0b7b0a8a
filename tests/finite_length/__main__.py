"""Load and largest pressure along a dry roller on its inner raceway, by four methods.

    python -m tests.finite_length NU308 --plot FIG.png
    python -m tests.finite_length NU310 --solve nu310.json    # finite elements on three meshes: minutes, gigabytes, ccx

Profiles are iso and straight; loads are light, heavy and tilted. At the sharp edge of a straight roller the pressure is
singular.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.outputs import write_figure
from ehdmaps.physics.bearing import BearingGeometry
from tests.finite_length.compare import compare_lengths
from tests.finite_length.figure import length_figure
from tests.finite_length.reference import make_reference, read_reference, save_reference, shipped_reference
from tests.finite_length.report import length_text


def main(words: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.finite_length", description="A roller of finite length.")
    parser.add_argument("bearing", help="finite elements are kept for NU308 and N1014")
    parser.add_argument("--plot", metavar="FIG.png", help="all cases on one page")
    parser.add_argument("--reference", metavar="FILE.json", help="finite elements of another bearing")
    parser.add_argument("--solve", metavar="FILE.json", help="solve the finite elements anew and write them")
    arguments = parser.parse_args(words)
    bearing = BearingGeometry.named(arguments.bearing)
    if arguments.solve:
        reference = make_reference(bearing)
        save_reference(reference, Path(arguments.solve))
    else:
        reference = read_reference(arguments.reference) if arguments.reference else shipped_reference(bearing.name)
    cases = compare_lengths(reference, bearing)
    print("\n".join(length_text(reference, cases)))
    if arguments.plot:
        write_figure(length_figure(reference, cases), arguments.plot)


if __name__ == "__main__":
    main()
