"""A job array of Slurm that makes the shards of a job or a batch: as a script, or submitted by submitit.

Slurm is spoken to by its script only: anything that understands ``#SBATCH`` lines takes it. Each task of the array is
the command `ehdmaps generate --shard`, which knows nothing of Slurm: tasks that were killed are submitted again, and go
on where they were.
"""

from __future__ import annotations

import os
import re
import shlex
import sys
from dataclasses import dataclass
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.extras import needs
from ehdmaps.jobs.work import Work
from ehdmaps.program import plain

_TIME = re.compile(r"[0-9]{1,6}(?:-[0-9]{1,2})?(?::[0-9]{1,2}){0,2}")
_PARTITION = re.compile(r"[A-Za-z0-9_.,-]{1,100}")


@dataclass(frozen=True)
class Array:
    """What a job array asks for.

    Attributes
    ----------
    shards : int
        Tasks of the array.
    cpus : int
        Cores of each.
    time, partition : str or None
        Time limit and partition, as Slurm has them; those of the cluster where they are None.
    """

    shards: int
    cpus: int = 1
    time: str | None = None
    partition: str | None = None

    def __post_init__(self) -> None:
        problems = []
        if self.time is not None and not _TIME.fullmatch(self.time):
            problems.append(
                f"--time: got {self.time[:40]!r}; allowed: minutes, minutes:seconds, hours:minutes:seconds, or "
                "days-hours:minutes"
            )
        if self.partition is not None and not _PARTITION.fullmatch(self.partition):
            problems.append(f"--partition: got {self.partition[:40]!r}; allowed: names of partitions, with commas")
        if problems:
            raise InputError(problems)


def check_shards(work: Work, array: Array) -> None:
    """Refuse more shards than there are tasks.

    Parameters
    ----------
    work : Work
        The job or the batch.
    array : Array
        The array.

    Raises
    ------
    InputError
        If some shards would have nothing to do.
    """
    if array.shards > len(work.tasks):
        raise InputError(
            f"--array: got {array.shards} shards of {len(work.tasks)} tasks; allowed: at most as many shards as tasks"
        )


def check_names(work: Work, folder: Path) -> None:
    """Refuse names that a line of a script cannot hold.

    Parameters
    ----------
    work : Work
        The job or the batch.
    folder : Path
        Folder in which the commands run.

    Raises
    ------
    InputError
        For every name with a character that is not printable, such as the end of a line.
    """
    problems = [
        f"submit: got {name[:200]!r}, which is not printable; allowed: names of printable characters; rename {what}"
        for what, name in (("the job", work.source), ("the map", str(work.output)), ("the folder", str(folder)))
        if not name.isprintable()
    ]
    if problems:
        raise InputError(problems)


def commands(work: Work, solver: str | None, array: Array) -> tuple[list[str], list[str]]:
    """Command of a shard, without the number of the shard, and command that merges, as lists of arguments.

    Parameters
    ----------
    work : Work
        The job or the batch.
    solver : str or None
        What stands for --solver.
    array : Array
        The array.
    """
    program = [sys.executable, "-m", "ehdmaps.jobs.cli"]
    # A name may begin as an option does.
    source = work.source if not work.source.startswith("-") else f"./{work.source}"
    common = [source, f"--output={work.output}", *([] if solver is None else ["--solver", solver])]
    workers = ["--workers", str(array.cpus)]
    return [*program, "generate", *common, *workers], [*program, "merge", *common, *workers]


def script(work: Work, solver: str | None, array: Array, folder: Path) -> str:
    """Return the script of the array: a first run submits the tasks, and a run that waits for them merges.

    Parameters
    ----------
    work : Work
        The job or the batch.
    solver : str or None
        What stands for --solver.
    array : Array
        The array.
    folder : Path
        Folder in which the commands run, on every node.

    Raises
    ------
    InputError
        For names that a script cannot hold.
    """
    check_names(work, folder)
    shard, merge = (shlex.join(command) for command in commands(work, solver, array))
    wants = [f"--cpus-per-task={array.cpus}"]
    wants += [] if array.time is None else [f"--time={array.time}"]
    wants += [] if array.partition is None else [f"--partition={array.partition}"]
    name = work.place.name
    head = "\n".join(f"#SBATCH {want}" for want in wants)
    return f"""#!/bin/sh
# {plain(work.what)}: {len(work.tasks)} tasks in {array.shards} shards, then merged.
#   id=$(sbatch --parsable THIS_FILE)
#   sbatch --dependency=afterany:$id --array=0 THIS_FILE
# A shard that was killed: sbatch --array=NUMBER THIS_FILE; then merge again.
#SBATCH --job-name={_quoted(f"ehdmaps-{name}"[:60])}
#SBATCH --array=1-{array.shards}
#SBATCH --output={_quoted(f"{str(folder / name).replace('%', '%%')}.slurm-%A_%a.log")}
{head}
cd {shlex.quote(str(folder))} || exit 1
if [ "$SLURM_ARRAY_TASK_ID" = 0 ]; then
  exec {merge}
fi
exec {shard} --shard "$SLURM_ARRAY_TASK_ID/{array.shards}"
"""


def _quoted(text: str) -> str:
    """A text as one value of an ``#SBATCH`` line, which Slurm reads by rules of its own: no shell looks at it."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def submit(work: Work, solver: str | None, array: Array) -> str:
    """Submit the array, and the merge after it, by submitit; return the identifiers in words.

    Parameters
    ----------
    work : Work
        The job or the batch.
    solver : str or None
        What stands for --solver.
    array : Array
        The array.

    Raises
    ------
    DependencyError
        If submitit is not installed.
    InputError
        If the cluster does not take the jobs, or a name is one that it cannot have.
    """
    check_names(work, Path.cwd())
    logs = f"{work.place}.slurm"
    if "%" in os.path.abspath(logs):
        raise InputError(
            f"submit: got logs in {os.path.abspath(logs)}, where Slurm takes % for a sign of its own; allowed with "
            "--submit: names of map and folders without %; rename it, or leave --submit out for a script"
        )
    with needs("cluster", "submitit", "submit --submit"):
        import submitit
    shard, merge = commands(work, solver, array)
    command = submitit.helpers.CommandFunction
    wants = {} if array.time is None else {"time": array.time}
    if array.partition is not None:
        wants["partition"] = array.partition
    try:
        executor = submitit.AutoExecutor(folder=logs, cluster="slurm")
        executor.update_parameters(name="ehdmaps", cpus_per_task=array.cpus, slurm_additional_parameters=wants)
        tasks = executor.map_array(command(shard), ["--shard"] * array.shards, _shard_names(array.shards))
        number = tasks[0].job_id.partition("_")[0]
        executor.update_parameters(slurm_additional_parameters={**wants, "dependency": f"afterany:{number}"})
        last = executor.submit(command(merge))
    except (OSError, RuntimeError, ValueError) as error:
        raise InputError(
            f"submit: the cluster does not take the job ({' '.join(str(error).split())[:300]}); allowed: a machine "
            "with Slurm's sbatch; leave --submit out for a script"
        ) from error
    return f"submitted: array {number} of {array.shards} shards, and merge {last.job_id} after it; logs in {logs}"


def _shard_names(count: int) -> list[str]:
    """Shards as the command line has them."""
    return [f"{index}/{count}" for index in range(1, count + 1)]
