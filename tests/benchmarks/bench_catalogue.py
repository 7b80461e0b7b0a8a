"""What the film table saves for the maps of a catalogue, and what it costs in accuracy.

    python -m tests.benchmarks.bench_catalogue [BATCH.toml] [--oil FVA3] [--maps 3]

Some maps of one oil of a batch, from the smallest to the largest radius, are made twice: read from the film table, and
with all films solved. Times are processor times of one process, without checks of the laws.
"""

import argparse
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from ehdmaps.jobs.make.batch import read_batch
from ehdmaps.jobs.make.generate import generate_in_memory
from ehdmaps.jobs.make.law_check import SMALL_DAMPING
from ehdmaps.maps.schema import FILM_TABLE
from ehdmaps.physics.hertz import half_width

FILMS = ("film_offset", "central_film", "minimum_film", "rolling_force", "mass_flow", "stiffness")


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("batch", nargs="?", default=str(Path(__file__).parents[2] / "examples" / "catalogue.toml"))
    parser.add_argument("--oil", default="FVA3")
    parser.add_argument("--maps", type=int, default=3)
    given = parser.parse_args(argv)
    members = [member for member in read_batch(given.batch).members if member.oil == given.oil]
    members.sort(key=lambda member: member.job.contacts[0].radius)
    chosen = [members[place] for place in np.linspace(0, len(members) - 1, given.maps).round().astype(int)]
    made(chosen[0].job, "table"), made(replace(chosen[0].job, loads=chosen[0].job.loads[:2]), "solved")  # compiled
    found, ratios = {}, []
    for member in chosen:
        (read, seconds), (solved, longer) = made(member.job, "table"), made(member.job, "solved")
        assert FILM_TABLE in read.attrs, "not served by the film table"
        ratios.append(longer / seconds)
        print(f"{member.name:20s} read {seconds:.2f} s; solved {longer:.1f} s   x {ratios[-1]:.0f}")
        compare(member.job, read, solved, found)
    print()
    print("relative difference of points that are read to those that are solved")
    print(f"{'':22s} {'points':>7s} {'median':>8s} {'95 %':>8s} {'99 %':>8s} {'largest':>8s}")
    for name, parts in found.items():
        values = np.concatenate(parts)
        marks = " ".join(f"{value:8.1e}" for value in (*np.quantile(values, (0.5, 0.95, 0.99)), values.max()))
        print(f"{name:22s} {values.size:7d} {marks}")


def made(job, films):
    """A map in memory without a check of its laws, and its processor time."""
    begin = time.process_time()
    job = replace(job, law_check=0, solver_options={**job.solver_options, "films": films})
    dataset = generate_in_memory(job, workers=1).dataset
    return dataset, time.process_time() - begin


def compare(job, read, solved, found):
    """Add the differences of two maps, by name."""
    usable = ((read["status"] <= 1) & (solved["status"] <= 1)).values
    for name in FILMS:
        found.setdefault(name, []).append(np.abs(read[name].values / solved[name].values - 1.0)[usable])
    loads, speeds = np.array(job.loads), np.array(job.entrainment_speeds)
    width = np.stack([half_width(loads, line.radius, line.reduced_modulus) for line in job.contacts])
    with np.errstate(divide="ignore"):
        unit = solved["stiffness"].values * width[:, :, None, None] / speeds[:, None]
    apart = np.abs(read["damping"].values - solved["damping"].values)
    relative = apart / np.maximum(np.abs(solved["damping"].values), SMALL_DAMPING * unit)
    found.setdefault("damping", []).append(relative[usable])


if __name__ == "__main__":
    main()
