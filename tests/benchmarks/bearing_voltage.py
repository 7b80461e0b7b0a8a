"""Bearing voltage ratio and breakdown of a drive over speed: what docs/electrics.md works out for two 6208.

Run: python -m tests.benchmarks.bearing_voltage [--plot FIG.png]

The ratio is C_wr/(C_wr + C_rf + sum of C_b): C_wr from the winding to the rotor, C_rf from the rotor to the frame.
"""

from __future__ import annotations

import argparse
import contextlib
import csv
import io
import math
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from mbs.cli import main as mbs

COMMAND = [
    *("bearing", "6208", "--load", "500 N", "--axial", "300 N", "--speed", "300 rpm", "6000 rpm", "8"),
    *("--oil", "ISO VG 100", "--permittivity", "2.2", "--temperature", "40 degC", "--temperature", "70 degC"),
]
WINDING_ROTOR, ROTOR_FRAME = 50e-12, 1000e-12
"""Of a motor of some 10 kW, assumed [F]: put yours."""

COMMON_MODE = 300.0
"""Highest common-mode voltage of an inverter at 600 V [V]."""


def rows() -> list[dict[str, float]]:
    """Points of the command, by speed and temperature."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "c.csv"
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            mbs([*COMMAND, "-o", str(path)])
        with path.open(encoding="utf-8") as file:
            table = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return [{name.partition(" [")[0]: float(value or "nan") for name, value in row.items()} for row in table]


def main() -> None:
    """Print the table, and draw it."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--plot", type=Path)
    asked = parser.parse_args()
    found = rows()
    print("speed, rpm   degC   bearing, pF (band)     ratio, %    voltage, V   breakdown, V")
    for row in found:
        each = [row[f"capacitance{end}"] for end in ("", "_low", "_high")]
        ratio = [WINDING_ROTOR / (WINDING_ROTOR + ROTOR_FRAME + 2.0 * value) for value in each]
        row |= {"ratio": ratio[0], "voltage": COMMON_MODE * ratio[0]}
        print(
            f"{row['speed'] * 30.0 / math.pi:10.0f} {row['temperature'] - 273.15:6.0f} "
            f"{1e12 * each[0]:9.0f} ({1e12 * each[1]:.0f} to {1e12 * each[2]:.0f}) {100 * ratio[0]:11.2f} "
            f"{row['voltage']:12.1f} {row['breakdown_low']:10.1f} to {row['breakdown_high']:.1f}"
        )
    if asked.plot:
        figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.4), layout="constrained")
        for number, kelvin in enumerate(sorted({row["temperature"] for row in found})):
            part = [row for row in found if row["temperature"] == kelvin]
            rpm, ratio, voltage, low, high = (
                np.array([row[name] for row in part])
                for name in ("speed", "ratio", "voltage", "breakdown_low", "breakdown_high")
            )
            rpm *= 30.0 / math.pi
            label, colour = f"{kelvin - 273.15:.0f} degC", f"C{number}"
            left.plot(rpm, 100.0 * ratio, "o-", color=colour, label=label)
            right.plot(rpm, voltage, "-", color=colour, label=f"voltage, {label}")
            right.fill_between(rpm, low, high, color=colour, alpha=0.2, label=f"breakdown, {label}")
        left.set(xlabel="speed, rpm", ylabel="bearing voltage ratio, %", ylim=(0.0, None))
        right.set(xlabel="speed, rpm", ylabel="V", yscale="log")
        for axis in (left, right):
            axis.legend(fontsize=7)
        figure.savefig(asked.plot, dpi=120)


if __name__ == "__main__":
    main()
