"""Pages of keys: what the readers allow, joined with the words on each key."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ehdmaps.jobs import solvers
from tests.manual.probes import job_readings, scene_readings
from tests.manual.recording import Reading, Readings, shortest

DOCS = Path(__file__).parents[2] / "docs"
Words = Mapping[str, Mapping[str, Any]]

_SECOND_NAMES = (" NAME", " SECOND", " THIRD")
_LEFT_OUT = ("assumed",)
"""Keys of every table, which the page explains at its beginning."""

_AS_ELSEWHERE = ("[correction]", "geometry", "[[bearings]] supply")
"""Tables whose keys are those of another one, as the words on the key with the table say."""

_JOB = """# Keys of job files

A job states a bearing or contact, an oil, the axes of a map and the solver; `ehdmaps check` lists all problems of a
file at once. A quantity is a text with a unit, `"62 N/mm"`; any unit of its kind will do. Limits include both ends. A
key without a default is optional unless it is marked "required". Unknown keys are errors. Models and limits are in the
[reference](reference_ehdmaps.md). This page is made by `python -m tests.manual --write` from what the readers allow.
"""
_SCENE = """# Keys of scene files

A scene states bodies, bearings, loads and analyses of a machine; `mbs check` lists all problems of a file at once. A
quantity is a text with a unit, `"500 rpm"`; any unit of its kind will do. Limits include both ends. A key without a
default is optional unless it is marked "required". Unknown keys are errors. Models and limits are in the
[reference](reference_mbs.md#scene-file). This page is made by `python -m tests.manual --write` from what the readers
allow.

Places are written `"body:frame"`; `"body"` alone is its frame `centre`, and `"ground"` is fixed. Every table may
have `assumed`, a list of those of its keys whose values are assumptions; results list them.
"""


class WordsError(ValueError):
    """Words and readers do not belong together."""


def job_page() -> str:
    """The page of keys of job files."""
    return _JOB + _tables(_joined(job_readings()), _of_solvers(_words("job_keys.toml")), "docs/job_keys.toml")


def scene_page() -> str:
    """The page of keys of scene files; tables that jobs have too are on the page of these, but for other keys."""
    of_jobs, words = _words("job_keys.toml"), _words("scene_keys.toml")
    joined = _joined(scene_readings()).items()
    readings = {table: keys for table, keys in joined if table not in of_jobs or table in words}
    return _SCENE + _tables(readings, words, "docs/scene_keys.toml")


def _words(name: str) -> Words:
    """Words of a file."""
    return tomllib.loads((DOCS / name).read_text(encoding="utf-8"))


def _of_solvers(words: Words) -> Words:
    """Words with those that solvers have in their own tables; their defaults are those of the solver that is made."""
    joined = dict(words)
    for name, entry in solvers.SOLVERS.items():
        table, made = f"[solver] {name}", entry.build() if entry.options else None
        known = dict(words.get(table, {}))
        for option in entry.options:
            found = {"words": option.meaning, **known.get(option.key, {})}
            default = getattr(made, option.key, None)
            if "otherwise" not in found and "default" not in found and default is not None:
                found["default"] = default
            known[option.key] = found
        if entry.options:
            joined[table] = known
    return joined


def _joined(readings: Readings) -> Readings:
    """Readings by tables without the names that probes have in them."""
    joined: Readings = {}
    for table, keys in readings.items():
        if table not in _AS_ELSEWHERE and _plain(table) not in _AS_ELSEWHERE:
            into = joined.setdefault(_plain(table), {})
            for key, reading in keys.items():
                into.setdefault(_plain(f" {key}").strip(), reading)
    of_jobs = joined.get("job file", {})
    for key in of_jobs.keys() & joined.get("batch file", {}).keys():
        del joined["batch file"][key]
    return joined


def _plain(text: str) -> str:
    """A name of a table without those of probes."""
    for name in _SECOND_NAMES:
        text = text.replace(name, " PLACE" if name != " NAME" else "")
    return text


def _tables(readings: Readings, words: Words, where: str) -> str:
    """All tables, in the order of the words.

    Raises
    ------
    WordsError
        Readers ask for keys without words, or there are words without such keys.
    """
    named = {table for table, keys in readings.items() if keys.keys() <= {"", "PLACE"} and table not in words}
    asked = {table: keys for table, keys in readings.items() if table not in named}
    rows = {(table, key) for table, keys in asked.items() for key in keys if key not in _LEFT_OUT}
    said = {(table, key) for table, keys in words.items() for key in keys if key not in ("_", "_title")}
    problems = [f"{table} {key}: read, without words" for table, key in sorted(rows - said)]
    problems += [f"{table} {key}: has words, and no reader asks for it" for table, key in sorted(said - rows)]
    if problems:
        raise WordsError(f"{where}:\n" + "\n".join(problems))
    return "".join(_table(table, readings[table], entries) for table, entries in words.items() if table in readings)


def _table(name: str, readings: Mapping[str, Reading], words: Mapping[str, Any]) -> str:
    """One table with its heading."""
    level = "##" if " " not in name or name.endswith("file") else "###"
    lines = ["", f"{level} {words.get('_title', name)}", ""]
    if "_" in words:
        lines += [words["_"], ""]
    lines += ["| key | allowed | default | meaning |", "|---|---|---|---|"]
    for key, entry in words.items():
        if key in readings:
            read = readings[key]
            allowed = ", ".join(filter(None, (entry.get("allowed"), "; ".join(read.allowed)))) or read.form
            lines.append(f"| `{key}` | {allowed} | {_default(entry, read)} | {entry['words']} |")
    return "\n".join(lines) + "\n"


def _default(entry: Mapping[str, Any], reading: Reading) -> str:
    """What holds where a key is left out."""
    if "default" in entry:
        value = entry["default"]
        return f"`{shortest(value)}`" if type(value) is float else f"`{json.dumps(value)}`"
    return str(entry.get("otherwise") or ("required" if reading.required else ""))
