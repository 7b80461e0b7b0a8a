"""Estimated inner geometry beside that which was published, and the stiffness that follows beside its band.

`python -m tests.benchmarks.inner_geometry`: a row a bearing of `tests/data/witness/inner_geometry.csv`. K is that of
dry balls at a tenth of C0 (radial, a fifth of it axial; angular contact: axial, a fifth of it radial), by the
published balls and pitch diameter with the grooves of the estimate, over that of the estimate, and the band that
`mbs bearing` prints for the estimate.
"""

from __future__ import annotations

import contextlib
import io
import tempfile
from pathlib import Path

import xarray as xr

from ehdmaps.physics.catalogue import estimate
from ehdmaps.physics.designations.reader import BALLS, plain_name
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_ratings import ball_static_rating
from mbs.cli import main as mbs_main
from tests.cases.witnesses import rows

K = ("stiffness_along", "stiffness_axial")


def of_known(row: dict[str, str]) -> tuple[tuple[float, float, float], ...]:
    """Ratio of K along and axial by the published balls to that of the estimate, and the band of both, over it."""
    geometry = ball_estimate(row["designation"])
    first, second = 0.1 * ball_static_rating(geometry), 0.02 * ball_static_rating(geometry)
    radial, axial = (second, first) if geometry.contact_angle else (first, second)
    keys = (
        f'{{ name = "{row["designation"]}", balls = {row["elements"]}, '
        f'ball_diameter = "{row["element_diameter_mm"]} mm", pitch_diameter = "{row["pitch_diameter_mm"]} mm" }}'
    )
    found = []
    for bearing in (row["designation"], keys):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            path = Path(folder) / "a.nc"
            at = ("--load", f"{radial} N", "--axial", f"{axial} N", "--speed", "100 rpm", "--clearance", "0 um")
            know = ("--know", "clearance = +- 0.01 um", "--bands", "all")
            assert mbs_main(["bearing", bearing, *at, "--law", "hertz", *know, "-o", str(path)]) == 0
            with xr.open_dataset(path) as data:
                found.append({name: float(data[name].values.ravel()[0]) for name in data if name.startswith(K)})
    ours, theirs = found
    return tuple(
        (theirs[name] / ours[name], ours[f"{name}_low"] / ours[name], ours[f"{name}_high"] / ours[name]) for name in K
    )


def main() -> None:
    """Print the table."""
    print("| bearing | published: elements, size, pitch, mm | estimate | size, pitch | K along, axial (band) |")
    print("|---|---|---|---|---|")
    for row in rows("inner_geometry"):
        name, size, pitch = row["designation"], float(row["element_diameter_mm"]), float(row["pitch_diameter_mm"])
        balls = bool(plain_name(name, BALLS))
        found = ball_estimate(name) if balls else estimate(name)
        mine = 1e3 * (found.ball_diameter if balls else found.roller_diameter)
        count = found.balls if balls else found.rollers
        of_k = [f"{k:.2f} ({low:.2f} to {high:.2f})" for k, low, high in of_known(row)] if balls else ["-"]
        print(
            f"| {name}, {row['source']} | {row['elements']} x {size:g}, {pitch:g} | {count} x {mine:.2f}, "
            f"{1e3 * found.pitch_diameter:.4g} | {100.0 * (mine / size - 1.0):+.1f} %, "
            f"{100.0 * (1e3 * found.pitch_diameter / pitch - 1.0):+.1f} % | {', '.join(of_k)} |"
        )


if __name__ == "__main__":
    main()
