"""A whole night of OpenFOAM: made with kills on the way, looked at over load and speed, its laws beside fresh films.

Run: python -m tests.benchmarks.overnight MAP.nc [--make JOB] [--kills N] [--workers N] [--again N] [--witness N]
                                                 [--plot FIG.png]

With --make the map is generated first, by the command that a user runs. That process is killed by SIGKILL --kills
times, at random shares of its points, and started again. Then five tables:

kills     what each start took over; points solved once more, alone and without a kill, against the map, bit by bit
solved    shares; what is said of points, above all causes where there is no solution, and where they lie
time      processor time a point over load and speed; its sum and how much the dearest points take
witness   films, k and c of --witness points of the map beside `reynolds` with the same physics
laws      where the map gives them, what its axes lose between its points, and random points against fresh solutions

The picture shows the share that is solved, the film and the time over load and speed.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.colors import LogNorm

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.report import LOG_TAIL, law_lines, reach_lines, spacing_lines, status_rows
from ehdmaps.jobs.reader import read_job
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.solution import FilmSolution, Status, contact_solution

SEED = 2026
FILMS = ("film_offset", "film_compliance", "loss_compliance", "central_film", "minimum_film", "max_pressure")
"""What is compared bit by bit."""

JUDGED = ("film_offset", "stiffness", "damping")
"""What is compared between the solvers."""

BANDS = 5
"""Bands of loads and of speeds in the table of times."""


def made(job: str, output: Path, kills: int, workers: int | None) -> None:
    """Generate a map, killed at random shares of its points."""
    command = [sys.executable, "-m", "ehdmaps", "generate", job, "-o", str(output)]
    command += [] if workers is None else ["--workers", str(workers)]
    shares = np.sort(np.random.default_rng(SEED).uniform(0.05, 0.95, kills))
    for share in [*shares.tolist(), None]:
        process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        assert process.stderr is not None
        killed = False
        for line in process.stderr:
            if "taken over" in line:
                print(f"  {line.strip()}", flush=True)
            done = re.match(r"\s*(\d+) of (\d+) points", line)
            if share is not None and done and int(done[1]) >= share * int(done[2]):
                process.kill()
                killed = True
                print(f"  kill -9 at {done[1]} of {done[2]} points", flush=True)
                break
        process.stderr.close()
        printed = process.stdout.read() if process.stdout else ""
        if process.wait() not in ((-9,) if killed else (0, 1)):
            raise SystemExit(f"{' '.join(command)} ended with {process.returncode}")
        if not killed:
            print("  then whole: " + next(line for line in printed.splitlines() if line.startswith("points")))
            return


def usable(dataset: xr.Dataset) -> BoolArray:
    """Points with a solution."""
    return np.isin(dataset["status"].values, [int(status) for status in Status if status.usable])


def drawn(mask: BoolArray, count: int, seed: int) -> list[tuple[int, ...]]:
    """Some places of a mask at random."""
    where = np.argwhere(mask)
    chosen = np.random.default_rng(seed).permutation(len(where))[:count]
    return [tuple(int(index) for index in where[one]) for one in np.sort(chosen)]


def fresh(
    job: Job, emap: EHDMap, place: Sequence[int], solver: str
) -> tuple[FilmSolution, LineContact, OperatingPoint]:
    """One point of the map solved alone, with its contact and its place."""
    options = job.solver_options if solver == job.solver else solvers.carried(job.solver_options, solver)
    contact, axes = emap.contacts[place[0]], ("load", "entrainment_speed", "temperature")
    point = OperatingPoint(*(float(emap.axis(name)[index]) for name, index in zip(axes, place[1:], strict=True)))
    (film,) = solvers.build(solver, options).solve_line(
        contact, emap.lubricant, (point.load,), point.entrainment_speed, point.temperature
    )
    return film, contact, point


def again(job: Job, emap: EHDMap, count: int) -> None:
    """Solve some points once more, and count those that are equal to the bit."""
    dataset = emap.dataset.transpose("contact", "load", "entrainment_speed", "temperature", ...)
    places = drawn(np.ones(dataset["status"].shape, bool), count, SEED)
    same = 0
    for place in places:
        film, *_ = fresh(job, emap, place, job.solver)
        pairs = [(float(getattr(film, name)), float(dataset[name].values[place])) for name in FILMS]
        alike = int(film.status) == int(dataset["status"].values[place]) and all(
            a == b or (np.isnan(a) and np.isnan(b)) for a, b in pairs
        )
        same += alike
        if not alike:
            print(f"  differs at {place}: {film.status.word}, {pairs}")
    print(
        f"  {same} of {len(places)} random points, solved once more alone, are equal to the bit: "
        f"status, {', '.join(name.replace('_', ' ') for name in FILMS)}"
    )


def statuses(dataset: xr.Dataset) -> None:
    """Print shares, and causes without the last lines of their logs."""
    solved = usable(dataset)
    print(f"  {np.count_nonzero(solved)} of {solved.size} points, {100 * solved.mean():.1f} %")
    for group in status_rows(dataset):
        print(f"  {group.words:20s} {group.count:5d}  {100 * group.share:6.2f} %")
        for cause in sorted(group.causes, key=lambda cause: -cause.count):
            print(f"    {cause.count:5d} x {LOG_TAIL.sub('', cause.text)}\n            {cause.where}")


def times(dataset: xr.Dataset) -> None:
    """Mean processor time a point over bands of load and speed."""
    seconds = dataset["solve_seconds"].transpose("load", "entrainment_speed", "contact", "temperature").values
    loads, speeds = dataset["load"].values / 1e3, dataset["entrainment_speed"].values
    rows, columns = (np.array_split(np.arange(axis.size), min(BANDS, axis.size)) for axis in (loads, speeds))
    print(
        f"  {'s a point, mean (largest)':26s}"
        + "".join(f"{speeds[c[0]]:8.2g} to {speeds[c[-1]]:<6.2g}" for c in columns)
        + " m/s"
    )
    for row in rows:
        cells = [seconds[np.ix_(row, column)] for column in columns]
        text = "".join(f"{np.nanmean(cell):9.1f} ({np.nanmax(cell):4.0f}) " for cell in cells)
        print(f"  {loads[row[0]]:9.3g} to {loads[row[-1]]:<6.3g} N/mm  {text}")
    all_of = np.sort(seconds[np.isfinite(seconds)])[::-1]
    tenth = all_of[: max(all_of.size // 10, 1)].sum() / all_of.sum()
    print(
        f"  {all_of.sum():.0f} s of processor time; a point takes {np.median(all_of):.2f} s in the median, "
        f"{all_of.mean():.2f} s in the mean, "
        f"{all_of[0]:.0f} s at most; the dearest tenth takes {100 * tenth:.0f} % of it"
    )


def witness(job: Job, emap: EHDMap, count: int) -> None:
    """Differences from `reynolds` at some points."""
    dataset = emap.dataset.transpose("contact", "load", "entrainment_speed", "temperature", ...)
    rows, stated = [], []
    for place in drawn(usable(dataset), count, SEED + 1):
        solution = fresh(job, emap, place, "reynolds")
        if not solution[0].status.usable:
            continue
        other = contact_solution(*solution)
        rows.append([float(dataset[name].values[place]) / getattr(other, name) - 1.0 for name in JUDGED])
        errors = (f"{name}_error" for name in JUDGED)
        stated.append([abs(float(dataset[name].values[place])) + abs(getattr(other, name)) for name in errors])
    found, errors_of_both = np.array(rows), np.array(stated)
    print(f"  OpenFOAM less reynolds at {len(rows)} of {count} random points, both with heat and a limiting stress")
    print("                    median of sizes   95 % within   largest   within what both state")
    for index, words in enumerate(JUDGED):
        sizes: FloatArray = np.abs(found[:, index])
        held = np.mean(sizes <= errors_of_both[:, index])
        print(
            f"    {words.replace('_', ' '):14s} {100 * np.median(sizes):12.3f} %  "
            f"{100 * np.quantile(sizes, 0.95):12.2f} %  {100 * sizes.max():6.1f} %  {100 * held:8.0f} % of the points"
        )


def edges(nodes: FloatArray) -> FloatArray:
    """Edges of cells around logarithmic nodes."""
    logs = np.log(nodes)
    between = 0.5 * (logs[1:] + logs[:-1])
    return np.exp(np.concatenate([[2.0 * logs[0] - between[0]], between, [2.0 * logs[-1] - between[-1]]]))


def drawing(dataset: xr.Dataset, path: Path) -> None:
    """Share solved, central film and time over load and speed."""
    figure, axes = plt.subplots(1, 3, figsize=(13.0, 3.8), layout="constrained")
    speeds, loads = dataset["entrainment_speed"].values, dataset["load"].values / 1e3
    order = ("contact", "temperature", "load", "entrainment_speed")
    share = usable(dataset.transpose(*order, ...)).mean(axis=(0, 1))
    film = dataset["central_film"].isel(contact=0).transpose("temperature", "load", "entrainment_speed").values[0]
    seconds = np.nanmean(dataset["solve_seconds"].transpose(*order).values, axis=(0, 1))
    panels = (
        ("solved, %", 100.0 * share, {"vmin": 0.0, "vmax": 100.0, "cmap": "Greens"}),
        (
            f"central film at {dataset['temperature'].values[0] - 273.15:.0f} degC, inner contact, um",
            1e6 * film,
            {"norm": LogNorm(), "cmap": "viridis"},
        ),
        ("processor time a point, s", seconds, {"norm": LogNorm(), "cmap": "magma"}),
    )
    for axis, (title, values, options) in zip(axes, panels, strict=True):
        shown = axis.pcolormesh(edges(speeds), edges(loads), values, **options)
        figure.colorbar(shown, ax=axis)
        axis.set(xscale="log", yscale="log", xlabel="entrainment speed, m/s", title=title)
        axis.title.set_fontsize(10)
    axes[0].set_ylabel("load, N/mm")
    figure.savefig(path, dpi=120)


def main() -> None:
    """Make the map where asked, and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("map", type=Path)
    parser.add_argument("--make", metavar="JOB")
    parser.add_argument("--kills", type=int, default=0)
    parser.add_argument("--workers", type=int)
    parser.add_argument("--again", type=int, default=0)
    parser.add_argument("--witness", type=int, default=0)
    parser.add_argument("--plot", type=Path)
    asked = parser.parse_args()
    if asked.make or asked.again:
        print("kills")
    if asked.make:
        made(asked.make, asked.map, asked.kills, asked.workers)
    job, emap = read_job(str(asked.map)), open_map(asked.map)
    if asked.again:
        again(job, emap, asked.again)
    dataset = emap.dataset
    print("solved")
    statuses(dataset)
    print("time")
    times(dataset)
    if asked.witness:
        print("witness")
        witness(job, emap, asked.witness)
    print("laws")
    for lines in (reach_lines(emap), spacing_lines(dataset), law_lines(dataset)):
        print("\n".join(f"  {line}" for line in lines))
    if asked.plot:
        drawing(dataset, asked.plot)


if __name__ == "__main__":
    main()
