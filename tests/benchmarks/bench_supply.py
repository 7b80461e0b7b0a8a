"""Bearing NU308 of the gearbox on oil layers beside flooded and dry, against a program of its own.

Run: python -m tests.benchmarks.bench_supply map.nc

The map is that of the job nu308 (`ehdmaps generate nu308 --out map.nc`). 923 N on the inner ring, 40 degC. The program
beside (`REFERENCE`) has films, statics and sums of its own, and took the film as r times that of the flooded contact,
which loads the last fifth of a layer without any change of the gap: below 2 um it states its own stiffness to 5 %.
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np

from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from mbs.analyses.bearing_point import BearingPoint, bearing_points
from mbs.bearings.bearing import Bearing
from mbs.bearings.films import MapFilms
from mbs.bearings.laws import hertz

LOAD, WARM, RPM = 923.0, 313.15, math.pi / 30.0
SPEEDS = (500.0, 1500.0, 2500.0)
LAYERS = (10e-6, 5e-6, 2e-6, 1e-6, 0.5e-6)

REFERENCE = {
    (0.0, "dry"): "359/195 359/195 0",
    (0.0, "flooded"): "363/332 573/602 520",
    (0.0, "oil layer 10 um"): "363/332 573/603 513",
    (0.0, "oil layer 5 um"): "363/332 576/603 491",
    (0.0, "oil layer 2 um"): "362/330 600/609 375",
    (0.0, "oil layer 1 um"): "353/354 386/482 23",
    (0.0, "oil layer 0.5 um"): "359/325 364/325 0",
    (30e-6, "dry"): "323/56 323/56",
    (30e-6, "flooded"): "308/55 294/61 - 194 478 731",
    (30e-6, "oil layer 10 um"): "307/55 289/63 - 145 327 474",
    (30e-6, "oil layer 5 um"): "308/55 296/67 - 130 274 382",
    (30e-6, "oil layer 2 um"): "313/54 312/56 - 110 219 288",
    (30e-6, "oil layer 1 um"): "311/55 328/57 - 104 107 65",
    (30e-6, "oil layer 0.5 um"): "323/56 326/57",
}
"""K along/across at 500 and 2500 rpm [N/um], preload [N] without clearance, torque at three speeds [N mm] with it."""


def points(emap: EHDMap, bearing: Bearing, supply: OilSupply | None) -> list[BearingPoint]:
    """Points over the speed; dry without a supply."""
    law = hertz(bearing) if supply is None else emap.law("series", outside="clamp", supply=supply)
    films = MapFilms(emap, supply or FLOODED)
    return bearing_points(bearing, law, films, [(LOAD, 0.0)], [RPM * n for n in SPEEDS], WARM)[0]


def preload(point: BearingPoint) -> float:
    """Load of the rollers against the load [N]."""
    along = point.rollers.load * np.cos(point.rollers.angle)
    return float(-np.sum(np.minimum(along, 0.0)))


def main() -> None:
    """Print the table."""
    emap = open_map(sys.argv[1])
    print("clearance  supply             K along/across at 500, 2500 rpm [N/um]  C at 2500   preload   torque [N mm]")
    for clearance in (0.0, 30e-6):
        bearing = Bearing.named("NU308", clearance=clearance)
        for supply in (None, FLOODED, *(OilSupply(layer) for layer in LAYERS)):
            label = "dry" if supply is None else supply.label
            start = time.process_time()
            found = points(emap, bearing, supply)
            spent = time.process_time() - start
            k = [1e-6 * point.along_across(point.stiffness) for point in found]
            c = 1e-3 * found[-1].along_across(found[-1].damping)
            torque = " ".join(f"{1e3 * point.loss.torque:4.0f}" for point in found) if supply else "   -    -    -"
            stiff = "   ".join(f"{along:4.0f}/{across:3.0f}" for along, across in (k[0], k[-1]))
            print(
                f"{1e6 * clearance:4.0f} um    {label:17s}  {stiff}   {100.0 * (k[-1][0] / k[0][0] - 1.0):+6.1f} %   "
                f"{c[0]:5.2f}/{c[1]:4.2f}   {abs(preload(found[-1])):5.0f}   {torque}   "
                f"reference: {REFERENCE.get((clearance, label), '')}   ({spent:.1f} s)",
                flush=True,
            )


if __name__ == "__main__":
    main()
