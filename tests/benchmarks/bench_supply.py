"""Bearing NU308 on oil layers, flooded and dry: stiffness, damping, preload, and torque beside a catalogue.

Run: python -m tests.benchmarks.bench_supply map.nc [--beside]

The map is that of the job nu308 (`ehdmaps generate nu308`). 923 N on the inner ring, 40 degC. Preload is the load of
the rollers against that load at 2500 rpm. Then two rows of rollers that turn as films and the pockets of the cage make
them, with the clearance of these. The last row is the rolling moment of SKF's catalogue formula.

With --beside the numbers of another program stand at the end of the rows. It has films, statics and sums of its own,
and took the film as r times that of the flooded contact, which loads the last fifth of a layer without any change of
the gap: below 2 um it states its own stiffness to 5 %.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import replace

import numpy as np

from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from mbs.analyses.bearing_point import bearing_points
from mbs.bearings.bearing import Bearing
from mbs.bearings.contact_report import BearingPoint
from mbs.bearings.films import MapFilms
from mbs.bearings.laws import hertz
from tests.cases.catalogue import skf_rolling_moment

LOAD, WARM, RPM = 923.0, 313.15, math.pi / 30.0
SPEEDS = (500.0, 1500.0, 2500.0)
POCKET = 0.2e-3
LAYERS = (10e-6, 5e-6, 2e-6, 1e-6, 0.7e-6, 0.5e-6)

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
    along = point.elements.load * np.cos(point.elements.angle)
    return float(-np.sum(np.minimum(along, 0.0)))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.bench_supply")
    parser.add_argument("map", help="map of NU308 by the job nu308")
    parser.add_argument("--beside", action="store_true", help="the numbers of another program too")
    arguments = parser.parse_args()
    emap = open_map(arguments.map)
    head = (
        "clearance, supply",
        "K at 500",
        "at 2500 rpm",
        "change",
        "C at 2500",
        "preload",
        "torque at 500, 1500, 2500",
    )
    units = ("", "N/um", "N/um", "%", "N s/mm", "N", "N mm")
    print(_row(*head), _row(*units), sep="\n")
    for clearance in (0.0, 30e-6):
        bearing = Bearing.named("NU308", clearance=clearance)
        for supply in (None, FLOODED, *(OilSupply(layer) for layer in LAYERS)):
            label = "dry" if supply is None else supply.label
            found = points(emap, bearing, supply)
            first, last = (1e-6 * point.along_across(point.stiffness) for point in (found[0], found[-1]))
            c = 1e-3 * found[-1].along_across(found[-1].damping)
            change = 100.0 * (last[0] / first[0] - 1.0)
            row = _row(
                f"{1e6 * clearance:g} um, {label}",
                f"{first[0]:.0f}/{first[1]:.0f}",
                f"{last[0]:.0f}/{last[1]:.0f}",
                f"{change:+.1f}" if abs(change) >= 0.05 else "0",
                f"{c[0]:.2f}/{c[1]:.2f}" if supply else "0",
                f"{abs(preload(found[-1])):.0f}",
                " ".join(f"{1e3 * point.loss.torque:5.0f}" for point in found) if supply else "-",
            )
            print(row + (f"   {REFERENCE.get((clearance, label), '')}" if arguments.beside else ""), flush=True)
    turned = [
        points(emap, replace(Bearing.named("NU308", clearance=30e-6), pocket_clearance=POCKET), supply)
        for supply in (FLOODED, OilSupply(5e-6))
    ]
    for name, found in zip(("flooded", "5 um"), turned, strict=True):
        torques = " ".join(f"{1e3 * point.loss.torque:5.0f}" for point in found)
        print(_row(f"30 um, {name}, {1e3 * POCKET:g} mm", "", "", "", "", "", torques))
    state = emap.lubricant.at(WARM)
    moments = (skf_rolling_moment(n, 1e6 * state.viscosity / state.density, LOAD) for n in SPEEDS)
    print(_row("catalogue formula", "", "", "", "", "", " ".join(f"{moment:5.0f}" for moment in moments)))


def _row(*cells: str) -> str:
    """Line of the table."""
    widths = (24, 10, 13, 8, 13, 9, 27)
    return cells[0].ljust(widths[0]) + "".join(
        cell.rjust(width) for cell, width in zip(cells[1:], widths[1:], strict=True)
    )


if __name__ == "__main__":
    main()
