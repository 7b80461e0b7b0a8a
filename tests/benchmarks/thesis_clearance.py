"""The machine nu308_flexible of the thesis without clearance and with the assumed one, dry, flooded and in oil and air.

Run: python -m tests.benchmarks.thesis_clearance

k and c of a bearing along its load at 200 and 2000 rpm, k beside the dry one, and the change over speed of the
frequencies of the modes that have more than half of their energy in the bearings.
"""

from __future__ import annotations

import contextlib
import io
import re

from mbs.cli import main as mbs

SWEEP = ["sweep", "nu308_flexible", "--cage-angles", "1", "--speed", "200 rpm", "2000 rpm", "2", "--bands", "numerics"]
SUPPLIES = {
    "dry": ["--law", "hertz"],
    "flooded": ["--law", "table"],
    "oil air": ["--law", "table", "--supply", "oil air"],
}
_LOAD = re.compile(r"bearing_left: .*along the load k (\S+)(?: to (\S+))? N/um.*?(?:, c (\S+)(?: to (\S+))? N s/mm|$)")
_MODE = re.compile(r"^ +\d+ +\S+ to +\S+ +([+-]\S+) % [^;]*\s(\d[\d.]*) to (\d[\d.]*)(?:;.*)?$")


def text_of(options: list[str]) -> str:
    """What the sweep prints."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()):
        mbs([*SWEEP, *options])
    return out.getvalue()


def row_of(text: str) -> tuple[list[float], list[float], list[float]]:
    """k and c at both speeds, and changes of the frequencies of modes of the bearings [%]."""
    found = next(match for line in text.splitlines() if (match := _LOAD.search(line)))
    k, k_fast, c, c_fast = found.groups()
    modes = text.partition("undamped modes   ")[2].partition("complex modes   ")[0]
    changes = [
        float(match[1])
        for line in modes.splitlines()
        if (match := _MODE.search(line)) and min(float(match[2]), float(match[3])) > 0.5
    ]
    return [float(k), float(k_fast or k)], [float(c or 0.0), float(c_fast or c or 0.0)], changes


def main() -> None:
    """Print the table."""
    print("clearance  films     k, N/um, at 200 / 2000 rpm   beside dry, %    c, N s/mm      modes of the bearings, %")
    for clearance in ("0 um", "20 um"):
        dry: list[float] = []
        for name, options in SUPPLIES.items():
            k, c, changes = row_of(text_of([*options, "--clearance", clearance]))
            dry = dry or k
            beside = " / ".join(f"{100.0 * (one / other - 1.0):+.1f}" for one, other in zip(k, dry, strict=True))
            damping = " / ".join(f"{one:.2f}" for one in c) if any(c) else "-"
            moved = f"{min(changes):+.1f} to {max(changes):+.1f}" if changes else "0"
            numbers = f"{k[0]:12.1f} / {k[1]:.1f} {'-' if k is dry else beside:>19s}"
            print(f"{clearance:9s}  {name:8s}  {numbers} {damping:>15s} {moved:>20s}")


if __name__ == "__main__":
    main()
