"""`ehdmaps status`: how far a map or a batch is that is being made, or whose making was interrupted."""

from __future__ import annotations

import argparse
from datetime import UTC, datetime
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.jobs.defaults import designated_job
from ehdmaps.jobs.make.batch import SUMMARY, is_batch
from ehdmaps.jobs.make.status import RunStatus, Seen, duration, look, status_path
from ehdmaps.jobs.make.store import store_path
from ehdmaps.jobs.reader import is_map, read_job, shipped_jobs
from ehdmaps.outputs import MAP, TABLE

_STORE = ".store"
_STATUS = ".store.status"


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Look; status 1 if a map is neither finished nor being made."""
    outputs = _here() if arguments.map is None else [_output(arguments.map, arguments.output)]
    descriptions = [_described(output) for output in outputs]
    return "\n".join(text for text, _ in descriptions), max(status for _, status in descriptions)


def _here() -> list[Path]:
    """Maps of this folder that are being made, or were."""
    traces = [path.name for path in Path().iterdir() if path.name.endswith((_STORE, _STATUS)) and path.is_file()]
    names = {name.removesuffix(_STATUS).removesuffix(_STORE) for name in traces}
    if not names:
        raise InputError(
            "no store of a map is in this folder; allowed: a folder where `ehdmaps generate` runs or ran, or the "
            "name of a map, of its store, or of a job"
        )
    return [Path(name) for name in sorted(names)]


def _output(name: str, output: str | None) -> Path:
    """Return the map or batch that is meant by a map, a store, a job or a batch file."""
    if is_batch(name):
        return Path(output or Path(name).stem) / f"{Path(name).stem}.batch"
    if output is not None:
        if Path(output).is_dir():
            raise InputError(f"-o: got {output}, which is a folder; allowed: a map; a folder goes with a batch")
        return Path(output)
    if Path(name).is_dir():
        raise InputError(f"{name}: is a folder; allowed: the batch file, with -o {name}, or a map")
    for ending in (_STATUS, _STORE):
        if name.endswith(ending):
            return Path(name.removesuffix(ending))
    place = Path(name)
    if store_path(place).exists() or status_path(place).exists() or is_map(name):
        return place
    if name in shipped_jobs() or place.is_file() or designated_job(name) is not None:
        return Path(f"{read_job(name).name}.nc")
    raise InputError(
        f"{name}: is not there, nor its store; allowed: a map, its store, or a job whose map is made in this folder"
    )


def _described(output: Path) -> tuple[str, int]:
    """Tell about a map or a batch, and the exit status."""
    seen = look(output)
    if seen is not None:
        return "\n".join(_lines(output, seen)), 0 if seen.running or not seen.known else 1
    table = output.with_name(SUMMARY)
    if output.name.endswith(".batch") and table.is_file() and TABLE.ours(table):
        return f"{output}: finished; see {table}", 0
    if output.is_file() and MAP.ours(output):
        return f"{output}: finished; no process works on it; see `ehdmaps show`", 0
    if not store_path(output).exists():
        raise InputError(f"{output}: is not there, nor its store; allowed: a map that `ehdmaps generate` makes or made")
    return f"{output}: not finished; what is solved is kept in {store_path(output)}; how far it is, is not known", 1


def _lines(output: Path, seen: Seen) -> list[str]:
    """Lines on a map that is not finished."""
    status, running = seen.status, seen.running
    who = f"process {status.process} on {status.host}"
    head = (
        f"running, {who} with {status.workers} worker{'s' if status.workers > 1 else ''}"
        if running
        else f"not finished: interrupted, {who} has ended; the same command goes on"
    )
    if not seen.known:
        head = f"{who}: only there it can be told whether it runs; it was heard of {_ago(status)} ago"
    part = f" ({100.0 * status.done / status.total:.1f} %)" if status.total else ""
    failed = ", ".join(f"{count} {word.replace('_', ' ')}" for word, count in sorted(status.failed.items()))
    return [
        f"{output}: {head}",
        f"  job      {status.job}",
        f"  points   {status.done} of {status.total}{part}, {status.taken_over} of them taken over",
        f"  rate     {_pace(status, running)}",
        f"  failed   {failed or 'none'}",
        f"  begun    {status.begun}",
        f"  written  {status.written}, {_ago(status)} ago",
    ]


def _ago(status: RunStatus) -> str:
    """Time since a status was written."""
    return duration(max((datetime.now(UTC) - datetime.fromisoformat(status.written)).total_seconds(), 0.0))


def _pace(status: RunStatus, running: bool) -> str:
    """Rate and, of a run that goes on, time left."""
    if status.rate is None:
        return "not known yet" if running else "not known"
    left = f", {duration((status.total - status.done) / status.rate)} left" if running else ""
    return f"{status.rate:.3g} points/s{left}"
