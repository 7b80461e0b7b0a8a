"""Whatever stands in a job file: a Job or an InputError that says what is wrong, never another exception."""

import copy

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ehdmaps.errors import InputError
from ehdmaps.jobs.job import MOST_POINTS, Job
from ehdmaps.jobs.reader import parse_job
from ehdmaps.units import quantity

GOOD = {
    "schema": 1,
    "bearing": {
        "inner_raceway_diameter": "52 mm",
        "outer_raceway_diameter": "80 mm",
        "roller_diameter": "14 mm",
        "roller_length": "15 mm",
        "rollers": 12,
        "diametral_clearance": "0 mm",
    },
    "material": {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3},
    "lubricant": {
        "viscosity_law": "roelands",
        "viscosity_40": "95 mm^2/s",
        "viscosity_100": "10.6 mm^2/s",
        "pressure_viscosity": "22.4 1/GPa",
        "roelands_z": 0.67,
        "density": "880 kg/m^3",
    },
    "grid": {
        "load": {"from": "0.1 N/mm", "to": "1000 N/mm", "points": 5, "spacing": "log"},
        "entrainment_speed": ["0.5 m/s", "1 m/s"],
        "temperature": ["20 degC", "40 degC"],
    },
    "solver": {"name": "reynolds", "density": 6.5, "structural_law": "iso16281", "fill": "none"},
}
PATHS = [(table,) for table in GOOD] + [
    (table, key) for table, keys in GOOD.items() if isinstance(keys, dict) for key in keys
] + [("grid", "load", key) for key in ("from", "to", "points", "spacing")]  # fmt: skip

UNITS = ("mm", "N/mm", "degC", "GPa", "1/GPa", "m/s", "mPa s", "kg/m^3", "mm^2/s", "", "furlong", "m^9^9")
quantities = st.builds(
    "{} {}".format,
    st.one_of(st.floats(), st.integers(), st.sampled_from(["1e-320", "0", "-0", "1e400"]), st.floats(0.01, 100.0)),
    st.sampled_from(UNITS),
)
scalars = st.one_of(
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=20),
    quantities,
    st.sampled_from(["NU308", "FVA3", "hertz", "barus", "half_space", "linear", "openfoam"]),
)
values = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)


def toml(value):
    """Write a value as TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{toml(str(key))} = {toml(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, str):
        return '"' + "".join(c if c.isalnum() or c in " /^.-*_" else f"\\U{ord(c):08X}" for c in value) + '"'
    return repr(value)


def written(job):
    return "\n".join(f"{toml(key)} = {toml(value)}" for key, value in job.items())


mutations = st.lists(
    st.tuples(
        st.sampled_from(PATHS),
        st.one_of(st.just(("drop", None)), st.tuples(st.just("set"), values), st.tuples(st.just("add"), values)),
    ),
    min_size=1,
    max_size=4,
)


def mutated(changes):
    job = copy.deepcopy(GOOD)
    for path, (kind, value) in changes:
        parent = job
        for key in path[:-1]:
            parent = parent.get(key) if isinstance(parent, dict) else None
        if not isinstance(parent, dict):
            continue
        if kind == "drop":
            parent.pop(path[-1], None)
        else:
            parent[path[-1] if kind == "set" else f"{path[-1]}x"] = value
    return job


def job_or_problems(text):
    try:
        job = parse_job(text, "job", "job.toml")
    except InputError as error:
        assert error.problems
        assert all(problem.startswith("job.toml: ") and len(problem) < 1000 for problem in error.problems)
    else:
        assert isinstance(job, Job)
        assert 0 < job.points <= MOST_POINTS
        for axis in (job.loads, job.entrainment_speeds, job.temperatures):
            assert list(axis) == sorted(set(axis))


def test_the_unchanged_job_is_good():
    assert parse_job(written(GOOD), "job", "job.toml").points == 40


@pytest.mark.slow
@settings(max_examples=100, deadline=None)
@given(mutations)
def test_a_mutated_job_is_read_or_refused(changes):
    job_or_problems(written(mutated(changes)))


@settings(max_examples=100, deadline=None)
@given(
    st.one_of(
        st.text(), quantities, st.from_regex(r"[0-9.]{1,5} [a-zA-Z]{1,6}([*/ ^][a-zA-Z0-9]{1,3}){0,3}", fullmatch=True)
    ),
    st.sampled_from(["m", "K", "N/m", "Pa s", "1/Pa", "Hz", "rad/s"]),
)
def test_any_text_is_a_finite_quantity_or_refused(text, unit):
    try:
        value = quantity(text, unit)
    except InputError as error:
        assert "allowed: a number with a unit of" in error.problems[0]
    else:
        assert abs(value) < float("inf")
