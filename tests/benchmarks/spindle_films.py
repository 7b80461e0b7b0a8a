"""The shipped spindle and electric drive with flooded isothermal films, with heat, and with heat on oil layers.

`python -m tests.benchmarks.spindle_films`: a row a machine, speed and condition with the largest load that a raceway of
each bearing carries, its radial stiffness and damping in slow motion, and the first modes with their damping ratios,
films with memory, cages as they stand.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from mbs.analyses.modes import modes
from mbs.analyses.statics import statics
from mbs.model.elements import Operation
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene

CONDITIONS = (
    ("flooded, isothermal", False, FLOODED),
    ("inlet heat", True, FLOODED),
    ("inlet heat, oil air", True, OilSupply.named("oil air")),
    ("inlet heat, grease", True, OilSupply.named("grease")),
)

MACHINES = (("spindle", (8000.0, 16000.0)), ("electric_drive", (4000.0, 12000.0)))

RPM = np.pi / 30.0


def main() -> None:
    """Print the table."""
    print("| machine | rpm | films | highest loads, N | K, N/um | C, N s/mm | modes, Hz (damping ratio, %) |")
    print("|---|---|---|---|---|---|---|")
    for name, speeds in MACHINES:
        for rpm in speeds:
            for words, heat, supply in CONDITIONS:
                model = assemble(read_scene(name), "table", supply=supply, inlet_heat=heat)
                found = statics(model, Operation(rpm * RPM)).dataset
                loads = ", ".join(f"{value:.0f}" for value in found["highest_raceway_load"].values)
                K, C = (found[f"bearing_{kind}"].values[:, 1, 1] for kind in ("stiffness", "damping"))
                stiff = ", ".join(f"{1e-6 * value:.0f}" for value in K)
                damped = ", ".join(f"{1e-3 * value:.2f}" for value in C)
                told = modes(model, Operation(rpm * RPM)).dataset
                pairs = [
                    f"{frequency:.0f} ({100.0 * ratio:.2f})"
                    for frequency, ratio in zip(
                        told["frequency"].values.ravel()[:4], told["damping_ratio"].values.ravel()[:4], strict=True
                    )
                ]
                row = name, f"{rpm:.0f}", words, loads, stiff, damped, ", ".join(pairs)
                print(f"| {' | '.join(row)} |", flush=True)


if __name__ == "__main__":
    main()
