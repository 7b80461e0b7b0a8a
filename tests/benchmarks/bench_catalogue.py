"""What lines that many bearings share save, and what they cost in accuracy.

    python -m tests.benchmarks.bench_catalogue [BATCH.toml] [--oil FVA3] [--maps 3] [--every 1]

Some maps of one oil of a batch, from the smallest to the largest radius, are read from the lines of all its bearings
and solved at their own points; times are processor times of one process. On its own a map has lines of its own
besides: their time is that of every tenth of them, times ten.
"""

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np

from ehdmaps.jobs import solvers
from ehdmaps.jobs.batch import Batch, read_batch
from ehdmaps.jobs.batch_plan import plan_batch
from ehdmaps.jobs.family_maps import Solved, make_map
from ehdmaps.jobs.law_points import SMALL_DAMPING
from ehdmaps.jobs.refinement import refinement
from ehdmaps.jobs.tasks import line_tasks
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.solution import Status

FILMS = ("film_offset", "central_film", "minimum_film", "rolling_force", "mass_flow")
SOME_LINES = 10


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("batch", nargs="?", default=str(Path(__file__).parents[2] / "examples" / "catalogue.toml"))
    parser.add_argument("--oil", default="FVA3")
    parser.add_argument("--maps", type=int, default=3)
    parser.add_argument("--every", type=int, default=1, help="line of the map that is solved")
    given = parser.parse_args(argv)
    batch = read_batch(given.batch)
    members = tuple(member for member in batch.members if member.oil == given.oil)
    (shared,) = plan_batch(Batch(batch.name, batch.text, members, checked=0)).shared
    family = shared.family
    family.lines.tasks[0].run()  # compiled, or loaded
    begin = time.process_time()
    results = {task.key: task.run() for task in family.lines.tasks}
    lines = time.process_time() - begin
    solved = Solved(family, results, {})
    by_radius = sorted(range(len(members)), key=lambda index: members[index].job.contacts[0].radius)
    chosen = [by_radius[place] for place in np.linspace(0, len(members) - 1, given.maps).round().astype(int)]
    print(f"{len(members)} maps with {given.oil}: {family.lines.points} points of lines for all, {lines:.1f} s")
    found, own, made = {}, [], []
    with tempfile.TemporaryDirectory() as folder:
        for index in chosen:
            begin = time.process_time()
            dataset = make_map(solved, index, Path(folder) / "map.nc", {})
            made.append(time.process_time() - begin)
            own.append(compared(members[index].job, dataset, given.every, found))
            name = members[index].name
            print(f"{name:20s} read and written {made[-1]:.2f} s; on its own {own[-1]:.1f} s")
    print()
    print("relative difference to the points solved on their own")
    print(f"{'':22s} {'points':>7s} {'median':>8s} {'95 %':>8s} {'99 %':>8s} {'largest':>8s}")
    for name, parts in found.items():
        values = np.concatenate(parts)
        marks = " ".join(f"{value:8.1e}" for value in (*np.quantile(values, (0.5, 0.95, 0.99)), values.max()))
        print(f"{name:22s} {values.size:7d} {marks}")
    print()
    count = len(members)
    each, alone = float(np.mean(made)), float(np.mean(own))
    ratio = count * alone / (lines + count * each)
    together, apart = lines + count * each, count * alone
    print(f"all {count} maps without checks: {together:.0f} s shared, {apart:.0f} s on their own   x {ratio:.0f}")


def compared(job, dataset, every, found):
    """Solve the points and some lines of a map on its own; its processor time, and differences by name."""
    solver = solvers.build(job.solver, job.solver_options)
    loads, tasks = np.array(job.loads), line_tasks(job, solver)
    begin = time.process_time()
    fresh = [(task, task.run()) for task in tasks[::every]]
    seconds = (time.process_time() - begin) * len(tasks) / len(fresh)
    for task, arrays in fresh:
        contact, _, speed, temperature = task.place
        usable = np.isin(arrays["status"], [int(known) for known in Status if known.usable])
        read = {
            name: dataset[name].values[contact, :, speed, temperature][usable]
            for name in (*FILMS, "film_compliance", "loss_compliance", "stiffness", "damping", "max_pressure")
        }
        w, line = loads[usable], task.contact
        k = 1.0 / (line.structural_compliance(w) + arrays["film_compliance"][usable])
        c = arrays["loss_compliance"][usable] * k**2
        width = half_width(w, line.radius, line.reduced_modulus)
        least = SMALL_DAMPING * k * width / task.entrainment_speed
        for name in FILMS:
            value = arrays[name][usable]
            found.setdefault(name, []).append(np.abs(read[name] / value - 1.0))
        found.setdefault("stiffness k", []).append(np.abs(read["stiffness"] / k - 1.0))
        found.setdefault("damping c", []).append(np.abs(read["damping"] - c) / np.maximum(np.abs(c), least))
    own = refinement(job, solver).tasks[::SOME_LINES]
    begin = time.process_time()
    for task in own:
        task.run()
    return seconds + (time.process_time() - begin) * len(refinement(job, solver).tasks) / len(own)


if __name__ == "__main__":
    main()
