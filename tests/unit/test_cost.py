import subprocess
import sys

import numpy as np
import pytest

from ehdmaps.errors import SolverError
from ehdmaps.jobs import cost as costs
from ehdmaps.jobs.cost import BYTES_PER_POINT, Cost, LargestProgram, Trial, total
from ehdmaps.jobs.make.tasks import LineTask, line_tasks
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.closed_form import FormulaSolver
from tests.cases.jobs import SMALL, WIDE, map_job, spaced


class Slow(FormulaSolver):
    """Solves points one by one, as CFD does."""

    slow = True


def slow_tasks(text):
    return line_tasks(parse_job(text, "job", "job.toml"), Slow())


def trial(seconds=1.0, usable=True, own=300, programs=60, began=2.0):
    return Trial(seconds, began, own, programs, usable, "" if usable else "lost")


def found(trials, slow=True, processes=2, points=100, seconds=50.0):
    return Cost(seconds, points, tuple(trials), slow, processes, 200)


def test_points_are_tried_at_the_ends_and_in_the_middle_of_the_axes():
    tasks = slow_tasks(WIDE)
    chosen = costs._places(tasks, 468)
    loads, speeds, temperatures = (sorted({costs._axes(task)[i] for task in chosen}) for i in range(3))
    every = [sorted({costs._axes(task)[i] for task in tasks}) for i in range(3)]
    assert loads == [every[0][i] for i in (0, 6, 12)]
    assert [speeds[0], speeds[-1], len(speeds)] == [every[1][0], every[1][-1], 3]
    assert temperatures == [every[2][0], every[2][-1]]
    assert len(chosen) == 18 and {task.contact.name for task in chosen} == {"inner", "outer"}
    assert len(costs._places(tasks, 20)) == 4


def test_a_cost_whose_logarithm_is_linear_in_the_places_on_the_axes_is_read_exactly():
    """Whatever the axes are: the tried points are nodes, and those between are read between them."""

    def dear(task: LineTask) -> float:
        place = costs._axes(task)
        i, j, k = (axis.index(value) for axis, value in zip(every, place, strict=True))
        return float(np.exp(0.1 + 0.01 * i + 0.02 * j * k + 0.005 * i * j))

    for text in (WIDE, SMALL, map_job('["2 N/mm"]', spaced("1 m/s", "9 m/s", 4), '["40 degC"]')):
        tasks = slow_tasks(text)
        every = [sorted({costs._axes(task)[i] for task in tasks}) for i in range(3)]
        chosen = costs._places(tasks, 1000)
        read = costs._between(tasks, chosen, [dear(task) for task in chosen])
        np.testing.assert_allclose(read, [dear(task) for task in tasks], rtol=1e-12)  # round-off


def test_one_dear_corner_and_one_refused_point_say_little_of_what_is_far_from_them():
    tasks = slow_tasks(WIDE)
    chosen = costs._places(tasks, 468)
    first = costs._axes(chosen[0])
    loads = sorted({costs._axes(task)[0] for task in tasks})
    for at_corner, half_way in ((100.0, 10.0), (1e-9, 0.1**0.5)):  # at a refused point a tenth of the median
        read = costs._between(tasks, chosen, [at_corner, *[1.0] * 17])
        by_place = {costs._axes(task): one for task, one in zip(tasks, read, strict=True)}
        assert by_place[(loads[3], *first[1:])] == pytest.approx(half_way, rel=1e-12)  # round-off
        assert by_place[(loads[6], *first[1:])] == pytest.approx(1.0, rel=1e-12)


def test_what_a_task_takes_is_found_with_its_end():
    task = slow_tasks(SMALL)[0]
    once = costs._tried(task)
    assert once.usable and once.seconds > 0.0 and once.own > 1e7
    given_up = costs._tried(Failing(task))
    assert (given_up.usable, given_up.reason) == (False, "no film")


class Failing:
    """A task whose solver gives up."""

    def __init__(self, task):
        self.failed = task.failed

    def run(self):
        raise SolverError("no film")


def test_time_is_shared_and_the_dearest_point_is_waited_for():
    assert found([trial(3.0), trial(1.0)]).wall_seconds == 50.0 / 2 + 2.0
    assert found([trial(90.0), trial(1.0)]).wall_seconds == 90.0
    assert found([trial(90.0, began=0.0)], slow=False).wall_seconds == 25.0


@pytest.mark.skipif(sys.platform != "linux", reason="programs are looked at in /proc")
def test_memory_of_a_program_is_its_own_and_not_that_of_the_process_that_began_it():
    # The bound above is what an empty Python takes; this process, full of libraries, takes far more.
    with LargestProgram() as programs:
        code = "import time; x = b'x' * 50_000_000; time.sleep(0.2)"
        subprocess.run([sys.executable, "-S", "-c", code], check=True)
    assert 50_000_000 <= programs.largest <= 80_000_000


def test_memory_is_that_of_all_processes_and_their_programs():
    several = [trial(own=250), trial(own=300, programs=50), trial(programs=70)]
    assert found(several).memory == 200 + 2 * 300 + 2 * 70 + 100 * BYTES_PER_POINT
    assert found(several, processes=1).memory == 300 + 70 + 100 * BYTES_PER_POINT


def test_the_words():
    several = [trial(3.0), trial(0.25), trial(usable=False)]
    tried = "3 points tried over the map took 0.25 to 3 s, 1 of them without a solution"
    parts = [found(several), found([trial()], slow=False, points=500)]
    assert parts[0].words == f"100 points, 50 s of processor time ({tried})"
    assert parts[1].words == "500 points, 50 s of processor time (1e+02 ms a point, from 1 lines)"
    assert total(parts) == "  time    about 54 s of wall time on 2 cores\n  memory  about 0.4 MB"
    lost = found([trial(usable=False)])
    tried = "1 points tried over the map took 1 to 1 s and have no solution"
    assert lost.words == f"100 points, not estimated; {tried}: lost"
    assert total([lost]).startswith("  time    not estimated\n")


class MovingOnly(Slow):
    """Solves nothing at rest."""

    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        if entrainment_speed == 0.0:
            raise SolverError("at rest")
        return super().solve_line(contact, lubricant, loads, entrainment_speed, temperature)


@pytest.mark.slow
def test_points_at_rest_are_not_tried():
    job = parse_job(map_job('["2 N/mm"]', '["0 m/s", "1 m/s", "2 m/s"]', '["40 degC"]'), "job", "job.toml")
    assert all(trial.usable for trial in costs.cost(line_tasks(job, MovingOnly()), 100, 1).trials)


@pytest.mark.slow
def test_a_job_is_tried_in_as_many_processes_as_it_will_have():
    tasks = slow_tasks(SMALL)
    whole = costs.cost(tasks, 2 * len(tasks), 2)
    assert len(whole.trials) == 18 and whole.slow and whole.solved
    assert whole.seconds > sum(one.seconds for one in whole.trials)  # of all points, not of those tried
    assert whole.trials[0].began > 0.0
