"""Error of the springs and dampers by which films of balls have a memory, beside the table's own stated error.

Run: python -m tests.benchmarks.ball_memory

|dZ/Z| at the worst of the table's five frequencies, of random contacts of six ball bearings, three oils, 20 to 120
degC, 0.3 to 25 m/s, 2 N to 3.5 GPa, by how much their film gives way: k over the stiffness of the dry contact.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.solids import STEEL
from ehdmaps.table.points.file import shipped_point_table
from mbs.bearings.balls.response import ContactResponse

COUNT = 2000
BEARINGS = ("6005", "6208", "6310", "7208B", "7014C", "6304")
OILS = ("FVA3", "ISO VG 32", "ISO VG 100")


def main() -> None:
    """Print the errors."""
    rng, table, rows = np.random.default_rng(1), shipped_point_table(), []
    while len(rows) < COUNT:
        contact = ball_estimate(str(rng.choice(BEARINGS))).contacts(STEEL)[rng.integers(2)]
        oil, kelvin = Lubricant.named(str(rng.choice(OILS))), 273.15 + rng.uniform(20.0, 120.0)
        speed, heaviest = np.exp(rng.uniform(np.log(0.3), np.log(25.0))), (3.5e9 / contact.max_pressure(1.0)) ** 3
        load = np.array([np.exp(rng.uniform(np.log(2.0), np.log(heaviest)))])
        films = table.films(contact, oil, load, speed, kelvin)
        if not np.all(films.usable):
            continue
        response = ContactResponse(load, films)
        dry = films.stiffness[0] / contact.stiffness(load[0])
        rows.append((dry, response.misfit[0], response.stated[0]))
    dry, misfit, stated = np.array(rows).T
    print("k / dry k     contacts   |dZ/Z| median, 95 %, largest   stated by the table median, 95 %")
    for low, high in ((0.0, 0.2), (0.2, 0.5), (0.5, 0.8), (0.8, 0.95), (0.95, np.inf)):
        on = (dry >= low) & (dry < high)
        a, b = (np.quantile(x[on], [0.5, 0.95, 1.0]) for x in (misfit, stated))
        errors = "   ".join(" ".join(f"{value:.3f}" for value in part) for part in (a, b[:2]))
        print(f"{low:4.2f} to {high:4.2f} {np.count_nonzero(on):8d}   {errors}")


if __name__ == "__main__":
    main()
