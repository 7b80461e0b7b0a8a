"""Every reader of ehdmaps given damaged files: jobs, maps, stores of solved points, statuses of runs."""

from __future__ import annotations

import argparse
import json
import tempfile
from collections.abc import Callable, Mapping
from functools import cache
from importlib import resources
from itertools import pairwise
from pathlib import Path

import netCDF4
import numpy as np

from ehdmaps.jobs.commands.status import run as run_status
from ehdmaps.jobs.job import MOST_POINTS
from ehdmaps.jobs.make.generate import generate
from ehdmaps.jobs.make.status import status_path
from ehdmaps.jobs.make.store import Arrays, Store, store_path
from ehdmaps.jobs.reader import parse_job, read_job
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.outputs import MARK
from ehdmaps.physics.closed_form import FormulaSolver
from tests.fuzzing.search import Reader, as_written

_JOBS = ("nu308", "nu308_openfoam")
"""Shipped jobs that are damaged, beside `_BARE`."""

_BARE = """schema = 1
[contact]
radius = "5 mm"
reference_depth = "5 mm"
[material]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m^3"
[lubricant]
viscosity_law = "roelands"
viscosity_40 = "95 mm^2/s"
viscosity_100 = "10.6 mm^2/s"
pressure_viscosity = "22.4 1/GPa"
density = "880 kg/m^3"
[supply]
oil_layer = "5 um"
[grid]
load = ["1 N/mm", "10 N/mm", "100 N/mm"]
entrainment_speed = ["0 m/s", "1 m/s"]
temperature = ["40 degC"]
[solver]
name = "formula"
structural_law = "half_space"
"""

_MAP = """schema = 1
[bearing]
name = "NU308"
[lubricant]
name = "FVA3"
[grid]
load = ["10 N/mm", "100 N/mm", "300 N/mm"]
entrainment_speed = ["1 m/s", "2 m/s"]
temperature = ["40 degC"]
[solver]
name = "formula"
structural_law = "iso16281"
law_check = 0
"""


class _WithBackbone(FormulaSolver):
    """Closed formulas that ask for a backbone: a whole map without a solve."""

    wants_backbone = True
    natural_frequencies = (0.5, 2.0)


def _jobs() -> Reader:
    """Job files."""
    shipped = resources.files("ehdmaps.jobs") / "shipped"
    texts = [*((shipped / f"{name}.toml").read_bytes() for name in _JOBS), _BARE.encode()]

    def read(folder: Path) -> str:
        job = read_job(str(folder / "job.toml"))
        for axis in (job.loads, job.entrainment_speeds, job.temperatures):
            if not axis or any(low >= high for low, high in pairwise(axis)):
                return f"an axis that does not rise: {axis!r:.200}"
        for temperature in (job.temperatures[0], job.temperatures[-1]):
            if not job.lubricant.at(temperature).viscosity > 0.0:
                return "an oil without viscosity"
        return "" if 0 < job.points <= MOST_POINTS else f"{job.points} points"

    return Reader("job file", [{"job.toml": text} for text in texts], read)


def _maps() -> Reader:
    """Maps with their checksum: what is read is what was written."""
    good = [_made(backbone) for backbone in (False, True)]
    known = [_opened(content) for content in good]

    def read(folder: Path) -> str:
        emap = open_map(folder / "map.nc")
        same = any(emap.dataset.equals(entry.dataset) and _equal(emap.backbone, entry.backbone) for entry in known)
        # Without the attribute of its checksum a map counts as its owner's.
        return "" if same or schema.CHECKSUM not in emap.dataset.attrs else "another map than was written"

    return Reader("map", [{"map.nc": content} for content in good], read)


def _unsealed_maps() -> Reader:
    """Maps without a checksum, and as a classic file of another library: what is read makes a law, or is refused."""
    good = [*(_unsealed(_made(backbone)) for backbone in (False, True)), _classic()]

    def read(folder: Path) -> str:
        emap = open_map(folder / "map.nc")
        emap.film_field(("inner",))
        stiffness = emap.with_structure("palmgren").dataset["stiffness"].values
        return "" if np.all(stiffness[np.isfinite(stiffness)] > 0.0) else "a stiffness below zero"

    return Reader("map without checksum", [{"map.nc": content} for content in good], read)


def _jobs_of_maps() -> Reader:
    """Maps whose job is read again."""
    good = [_made(False), _classic()]

    def read(folder: Path) -> str:
        job = read_job(folder / "map.nc")
        return "" if job.text == _without_lines() else "another job than was written"

    return Reader("job of a map", [{"map.nc": content} for content in good], read)


def _stores() -> Reader:
    """Stores of solved points: each is what was put there, or counts as not solved."""
    kept: dict[str, Arrays] = {
        f"key {number}": {"film": np.linspace(0.0, number, 5), "reason": np.array(["", "some words"])}
        for number in range(4)
    }

    def write(path: Path) -> None:
        with Store(path) as store:
            for key, arrays in kept.items():
                store.put(key, arrays)

    def read(folder: Path) -> str:
        with Store(folder / "map.nc.store") as store:
            for key, arrays in kept.items():
                stored = store.get(key)
                if stored is None:
                    continue
                if stored.keys() != arrays.keys() or any(
                    not np.array_equal(stored[name], arrays[name]) for name in stored
                ):
                    return f"other arrays than were put under {key!r}"
        return ""

    content = as_written("map.nc.store", write)
    return Reader("store", [{"map.nc.store": content}], read, writes=True)


def _statuses() -> Reader:
    """Files that tell how far a map is."""
    status = {
        "mark": MARK,
        "job": "NU308, FVA3, solver reynolds",
        "process": 4711,
        "host": "here",
        "workers": 2,
        "begun": "2026-01-01T10:00:00+00:00",
        "written": "2026-01-01T11:00:00+00:00",
        "total": 4000,
        "done": 1200,
        "taken_over": 100,
        "failed": {"stagnated": 3},
        "rate": 0.33,
    }

    def read(folder: Path) -> str:
        text, code = run_status(argparse.Namespace(map=str(folder / "map.nc"), output=None))
        return "" if text and code in (0, 1) else f"status {code} with {text!r:.80}"

    name = status_path(Path("map.nc")).name
    return Reader("status of a run", [{name: json.dumps(status, indent=1).encode()}], read)


READERS: Mapping[str, Callable[[], Reader]] = {
    "job file": _jobs,
    "map": _maps,
    "map without checksum": _unsealed_maps,
    "job of a map": _jobs_of_maps,
    "store": _stores,
    "status of a run": _statuses,
}
"""What makes each reader with its good files."""


def _without_lines() -> str:
    """The job of a map without the lines of a law."""
    return f'{_MAP}backbone = "none"\n'


@cache
def _made(backbone: bool) -> bytes:
    """A small map by the film formula, with or without the lines of a law."""
    text = _MAP if backbone else _without_lines()
    solver = _WithBackbone() if backbone else FormulaSolver()

    def write(path: Path) -> None:
        generate(parse_job(text, "small", "job"), path, workers=1, solver=solver)
        store_path(path).unlink(missing_ok=True)

    return as_written("map.nc", write)


def _opened(content: bytes) -> EHDMap:
    """The map in a file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "map.nc"
        path.write_bytes(content)
        return open_map(path)


def _unsealed(content: bytes) -> bytes:
    """The same map without its checksum."""

    def write(path: Path) -> None:
        path.write_bytes(content)
        with netCDF4.Dataset(path, "a") as file:
            file.delncattr(schema.CHECKSUM)

    return as_written("map.nc", write)


def _classic() -> bytes:
    """The map without a backbone as netCDF 3 has it, whose sizes stand in the file as they are."""
    dataset = _opened(_made(False)).dataset
    classic = dataset.assign_attrs({key: value for key, value in dataset.attrs.items() if key != schema.CHECKSUM})
    for name in ("contact", "reason"):
        classic[name].encoding = {"dtype": "S1"}

    def write(path: Path) -> None:
        classic.to_netcdf(path, format="NETCDF3_64BIT")

    return as_written("map.nc", write)


def _equal(first: object, second: object) -> bool:
    """Tell whether two groups are the same, or both not there."""
    if first is None or second is None:
        return first is second
    return bool(first.equals(second))  # type: ignore[attr-defined]
