"""`ehdmaps solids`: the law of the approach of a bearing's contacts by finite elements, off-line, once per bearing."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.show.solids_report import COMPARED_LOADS, compared_laws, compared_text, solids_text
from ehdmaps.jobs.solids import job_sections
from ehdmaps.outputs import FIGURE, MARK, Kind, Output, check_outputs, has_mark, write_text
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.program import tell
from ehdmaps.solids.plane_bearing import bearing_record
from ehdmaps.version import version

SOLIDS = Kind("finite elements of a bearing", (".json",), has_mark)


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Solve the solids of a bearing, or compare the laws that are known."""
    job = read_job(arguments.job, finding_solids=True)
    outputs = [Output("-o", arguments.output, SOLIDS), Output("--plot", arguments.plot, FIGURE)]
    check_outputs(outputs, [arguments.job])
    bearing = job.bearing
    if bearing is None:
        raise InputError(f"{arguments.job}: has [contact]; allowed: a job with [bearing], whose solids are known")
    known = _known(job, bearing) if arguments.compare and arguments.output is None else None
    record = {} if known else _solved_record(arguments, job, bearing)
    approaches = known or {name: one["fe_approach"] for name, one in record["contacts"].items()}
    contacts = bearing.contacts(job.contacts[0].material, "fe", approaches)
    compared = {contact.name: compared_laws(contact, bearing, COMPARED_LOADS) for contact in contacts}
    if arguments.output is not None:
        write_text(arguments.output, _json(record), SOLIDS)
        tell(f"{arguments.output}: written")
    if arguments.plot is not None:
        from ehdmaps.jobs.show.solids_plot import plot_solids

        plot_solids(contacts, bearing, job_sections(job.solids, bearing, contacts[0].material), Path(arguments.plot))
        tell(f"{arguments.plot}: written")
    if arguments.json:
        return _json({**record, "load": list(COMPARED_LOADS), "laws": compared}), 0
    texts = [] if known else [solids_text(record, bearing)]
    if arguments.compare:
        texts.append(compared_text(compared, COMPARED_LOADS, bearing.title))
    return "\n\n".join(texts), 0


def _known(job: Job, bearing: BearingGeometry) -> Mapping[str, float] | None:
    """Approaches that the job states, or that come with the package; None where they are to be found."""
    if job.solids.approaches:
        return job.solids.approaches
    if job.solids.sections:
        return None
    try:
        return bearing.fe_approaches(job.contacts[0].material)
    except InputError:
        return None


def _solved_record(arguments: argparse.Namespace, job: Job, bearing: BearingGeometry) -> dict[str, Any]:
    """Solve, and note how."""
    sections = job_sections(job.solids, bearing, job.contacts[0].material)
    options = [name for name in ("mesh_convergence", "contact") if getattr(arguments, name)]
    record = bearing_record(
        bearing,
        sections,
        meshes=arguments.mesh_convergence,
        contact=arguments.contact,
        tell=lambda line: tell(f"ehdmaps solids: {line}"),
    )
    command = " ".join(["ehdmaps solids", job.name, *(f"--{name.replace('_', '-')}" for name in options)])
    return {"program": f"{MARK} {version()}", "command": command, **record}


def _json(record: Mapping[str, Any]) -> str:
    """A record as JSON."""
    return json.dumps(record, indent=1, allow_nan=False, ensure_ascii=False) + "\n"
