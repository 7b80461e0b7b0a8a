"""Time and memory of a job, from points of it that are tried.

By a fast solver some lines tell what all take. By a slow one a point may take a hundred times what another does, and
does so in corners of the map: points are tried at both ends and in the middle of the axes, in as many processes as the
run has, and what one takes between them is read between them: its logarithm is linear in its place on the axes, so that
a corner that takes a hundred times as long is one, and not a quarter of the map. Points without a solution are tried
and counted like others: most take longest.

The memory is that of all processes, each at its largest and counted whole, as those had that tried.
"""

from __future__ import annotations

import contextlib
import re
import resource
import sys
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from ehdmaps.arrays import FloatArray
from ehdmaps.compiling import stopwatch
from ehdmaps.errors import SolverError
from ehdmaps.jobs.make.status import duration
from ehdmaps.jobs.make.tasks import LineTask
from ehdmaps.physics.solution import Status
from ehdmaps.workers import worker_pool

TRIED_LINES = 4
"""Lines that are tried of a fast solver."""

TRIED_PLACES = (3, 3, 2)
"""Loads, speeds and temperatures at which points of a slow one are tried."""

FEW_POINTS, FEW_PLACES = 72, (2, 2, 1)
"""Fewer points are tried where there are no more than so many in all: the trial is not to be most of the work."""

BYTES_PER_POINT = 800
SECONDS_PER_POINT = 1e-4
"""Results, dataset and the copy that is written; keeping and assembling: measured on a map of 200 000 points."""

_LEAST = 0.1
"""Part of the median that a point counts for which is refused at once: those beside it take their time."""

_LOOKED = 0.02
"""How often the memory of programs is looked at [s]."""

_PEAK = re.compile(r"^VmHWM:\s+(\d+) kB$", re.MULTILINE)

_UNIT = 1024 if sys.platform != "darwin" else 1
"""Bytes of what the system counts memory in."""


@dataclass(frozen=True)
class Trial:
    """Cost of one task: processor time [s], memory of its process and of the largest program that it ran [bytes].

    `began` is the processor time that its process had spent before its first task [s].
    """

    seconds: float
    began: float
    own: int
    programs: int
    usable: bool
    reason: str


@dataclass(frozen=True)
class Cost:
    """Cost of some tasks.

    Attributes
    ----------
    seconds : float
        Processor time of all [s].
    points : int
        Number of points.
    trials : tuple of Trial
        What was tried.
    slow : bool
        Whether these were single points of a slow solver.
    processes : int
        Processes that work; 1 means that there are no others.
    parent : int
        Memory of the process that hands out the work [bytes].
    """

    seconds: float
    points: int
    trials: tuple[Trial, ...]
    slow: bool
    processes: int
    parent: int

    @property
    def solved(self) -> bool:
        """True unless all points that were tried have no solution."""
        return any(trial.usable for trial in self.trials)

    @property
    def wall_seconds(self) -> float:
        """Time on a machine with nothing else to do [s]; the last point is waited for by one process alone."""
        longest = max(trial.seconds for trial in self.trials) if self.slow else 0.0
        return max(self.seconds / self.processes + self.trials[0].began, longest)

    @property
    def memory(self) -> float:
        """Memory of all processes and of the programs that they run [bytes]."""
        own, programs = max(trial.own for trial in self.trials), max(trial.programs for trial in self.trials)
        python = self.parent + self.processes * own if self.processes > 1 else max(self.parent, own)
        return python + self.processes * programs + self.points * BYTES_PER_POINT

    @property
    def words(self) -> str:
        """The time in words: processor time and what was tried."""
        taken = [trial.seconds for trial in self.trials]
        lost = [trial for trial in self.trials if not trial.usable]
        spent = f"{self.points} points, {_time(self.seconds)} of processor time"
        if not self.slow:
            return f"{spent} ({1e3 * self.seconds / max(self.points, 1):.2g} ms a point, from {len(taken)} lines)"
        tried = f"{len(taken)} points tried over the map took {min(taken):.2g} to {max(taken):.2g} s"
        if not self.solved:
            return f"{self.points} points, not estimated; {tried} and have no solution: {lost[0].reason}"
        return f"{spent} ({tried}, {len(lost)} of them without a solution)"


def total(costs: Sequence[Cost]) -> str:
    """Say what several costs make together, wall time and memory, in two lines.

    Parameters
    ----------
    costs : sequence of Cost
        Costs of one run, part after part.
    """
    time, count = "not estimated", costs[0].processes
    if all(one.solved for one in costs):
        wall = _time(sum(one.wall_seconds for one in costs))
        time = f"about {wall} of wall time on {count} core{'s' * (count > 1)}"
    return f"  time    {time}\n  memory  about {float(f'{max(one.memory for one in costs) / 1e6:.2g}'):g} MB"


def _time(seconds: float) -> str:
    """A time for people, with two digits where it is short."""
    return duration(seconds) if seconds >= 10.0 else f"{seconds:.2g} s"


def cost(tasks: Sequence[LineTask], points: int, processes: int) -> Cost:
    """Try some tasks of a job, and tell what all of them cost.

    Parameters
    ----------
    tasks : sequence of LineTask
        Tasks of one solver.
    points : int
        Number of points in all, those included whose tasks are not known yet.
    processes : int
        Processes that will work.
    """
    slow = tasks[0].slow
    if slow:
        tasks = [task for task in tasks if task.entrainment_speed > 0.0] or tasks  # at rest there is nothing to solve
        chosen = _places(tasks, points)
        with worker_pool(1) as pool:  # compiles, where that is due: memory of compiling is none of the run's
            pool.submit(_tried, chosen[0]).result()
        with worker_pool(processes) as pool:
            trials = [future.result() for future in [pool.submit(_tried, task) for task in chosen]]
        total = float(np.sum(_between(tasks, chosen, [trial.seconds for trial in trials])))
        of_tasks = sum(task.points for task in tasks)
        return Cost(total * points / of_tasks, points, tuple(trials), slow, processes, _largest(resource.RUSAGE_SELF))
    tasks[0].run()  # compiles, where the solver does
    chosen = list(tasks[:: max(len(tasks) // TRIED_LINES, 1)][:TRIED_LINES])
    trials = [_tried(task) for task in chosen]
    per_point = sum(trial.seconds for trial in trials) / sum(task.points for task in chosen)
    trials = [replace(trial, began=0.0) for trial in trials]
    total = points * (per_point + SECONDS_PER_POINT * processes)
    return Cost(total, points, tuple(trials), slow, processes, _largest(resource.RUSAGE_SELF))


def _tried(task: LineTask) -> Trial:
    """Do a task, and tell what it took, without compiling."""
    began, watch = time.process_time(), stopwatch()
    with LargestProgram() as programs:
        try:
            arrays = task.run()
        except SolverError as error:
            arrays = task.failed(str(error))
    seconds = watch()
    usable = Status(int(arrays["status"][0])).usable
    return Trial(seconds, began, _largest(resource.RUSAGE_SELF), programs.largest, usable, str(arrays["reason"][0]))


class LargestProgram(threading.Thread):
    """Looks at the programs that this process runs while it is open.

    What the system tells of ended programs counts what the process was in which they began, which is this one.

    Attributes
    ----------
    largest : int
        Largest memory of one of them [bytes]; 0 on systems that do not tell it.
    """

    def __init__(self) -> None:
        super().__init__(daemon=True)
        self.largest, self._over = 0, threading.Event()

    def __enter__(self) -> LargestProgram:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self.join()

    def run(self) -> None:
        """Look at them until it is closed."""
        own = Path("/proc/self/task")
        while not self._over.wait(_LOOKED):
            with contextlib.suppress(OSError):  # it ended meanwhile, or a system without such files
                children = " ".join((thread / "children").read_text() for thread in own.iterdir())
                for child in children.split():
                    found = _PEAK.search(Path(f"/proc/{child}/status").read_text())
                    self.largest = max(self.largest, 1024 * int(found[1]) if found else 0)


def _largest(who: int) -> int:
    """Largest memory so far of this process, or of the largest program that it ran [bytes]."""
    return resource.getrusage(who).ru_maxrss * _UNIT


def _axes(task: LineTask) -> tuple[float, float, float]:
    """Place of a task: its first load, speed and temperature."""
    return task.loads[0], task.entrainment_speed, task.temperature


def _places(tasks: Sequence[LineTask], points: int) -> list[LineTask]:
    """Tasks at the ends and in the middle of the axes; one contact after the other, which are alike."""
    counts = TRIED_PLACES if points > FEW_POINTS else FEW_PLACES
    there: dict[tuple[float, float, float], list[LineTask]] = {}
    for task in tasks:
        there.setdefault(_axes(task), []).append(task)
    axes = [sorted({place[i] for place in there}) for i in range(3)]
    nodes = [_spread(axis, count) for axis, count in zip(axes, counts, strict=True)]
    return [there[i, j, k][index % len(there[i, j, k])] for index, (i, j, k) in enumerate(product(*nodes))]


def _spread(axis: Sequence[float], count: int) -> list[float]:
    """Values of an axis from its first to its last; one is the middle."""
    if count == 1:
        return [axis[len(axis) // 2]]
    return [axis[i] for i in sorted({round(i) for i in np.linspace(0, len(axis) - 1, count)})]


def _between(tasks: Sequence[LineTask], chosen: Sequence[LineTask], seconds: Sequence[float]) -> FloatArray:
    """Time of each task from those of the chosen ones, all places of a grid; its logarithm is linear in the places."""
    places = np.array([_axes(task) for task in tasks])
    at = np.array([_axes(task) for task in chosen])
    nodes, wanted = [], []
    for axis, known in zip(places.T, at.T, strict=True):
        values = np.unique(axis)
        rank = np.arange(values.size, dtype=float)
        nodes.append(np.interp(np.unique(known), values, rank))
        wanted.append(np.clip(np.interp(axis, values, rank), nodes[-1][0], nodes[-1][-1]))
    taken = np.array(seconds)
    grid = np.log(np.maximum(taken, _LEAST * np.median(taken))).reshape([axis.size for axis in nodes])
    for number, axis in enumerate(nodes):
        if axis.size == 1:  # no line through one point
            grid, nodes[number] = np.repeat(grid, 2, axis=number), np.array([axis[0], axis[0] + 1.0])
    return np.asarray(np.exp(RegularGridInterpolator(nodes, grid)(np.array(wanted).T)))
