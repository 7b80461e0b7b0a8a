"""Laws that read the film table, held against fresh solves: what `ehdmaps/table/checked.json` records.

Run: python -m tests.benchmarks.table_checked [--write]

The maps are the shipped ones, and of each oil of the catalogue among the examples those of the smallest and the largest
radius.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from dataclasses import replace
from importlib import resources
from pathlib import Path
from typing import Any

from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.batch import read_batch
from ehdmaps.jobs.make.batch_generate import plan_batch
from ehdmaps.jobs.make.generate import generate_in_memory
from ehdmaps.jobs.make.law_check import AGAINST
from ehdmaps.jobs.reader import read_job
from ehdmaps.maps.schema import FILM_TABLE
from ehdmaps.table.checked import FILE, checked_text
from ehdmaps.table.file import CHECKSUM, shipped_tables

CATALOGUE = Path(__file__).parents[2] / "examples" / "catalogue.toml"


def jobs() -> Iterator[tuple[str, Job]]:
    """Maps that are checked, by name."""
    for name in ("nu308", "n1014"):
        yield name, read_job(name)
    batch = replace(read_batch(CATALOGUE), checked=2)
    yield from ((planned.member.name, planned.job) for planned in plan_batch(batch) if planned.job.law_check)


def checked(job: Job) -> dict[str, Any]:
    """Attributes that the check of a map by fresh solves has."""
    attributes = generate_in_memory(job, workers=1, check=True).dataset.attrs
    assert FILM_TABLE in attributes and AGAINST not in attributes
    return {name: value for name, value in attributes.items() if name.startswith("law_")}


def main() -> None:
    """Check, and write or compare."""
    parser = argparse.ArgumentParser(description="Laws that read the film table, held against fresh solves.")
    parser.add_argument("--write", action="store_true", help="the record of the release")
    write = parser.parse_args().write
    found = {"content_sha256": shipped_tables().attributes[CHECKSUM], "maps": {}}
    for name, job in jobs():
        found["maps"][name] = row = checked(job)
        shares = [row[f"law_{part}_within_bar"] for part in ("film_compliance", "damping", "valley_damping")]
        print(f"{name:16s} {row['law_check_usable']} points, within bars {shares}; k {row['law_stiffness_error']}")
    with resources.as_file(resources.files("ehdmaps.table") / FILE) as path:
        if write:
            path.write_text(json.dumps(found, indent=1) + "\n")
        else:
            print("as recorded" if json.loads(path.read_text()) == found else "the record has other numbers: --write")
    print(checked_text(found["content_sha256"]))


if __name__ == "__main__":
    main()
