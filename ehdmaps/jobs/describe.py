"""What a map file holds, in words."""

from __future__ import annotations

import json
from collections.abc import Iterator

import xarray as xr

from ehdmaps.jobs.report import AXES, error_lines, law_lines, span, status_lines, value_lines


def describe(dataset: xr.Dataset, backbone: xr.Dataset | None, name: str) -> str:
    """Return what `show` prints.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map.
    backbone : xarray.Dataset or None
        Its group of refinement lines, if it has one.
    name : str
        Of the file.
    """
    return "\n".join(_lines(dataset, backbone, name))


def _lines(dataset: xr.Dataset, backbone: xr.Dataset | None, name: str) -> Iterator[str]:
    attributes = dataset.attrs
    yield attributes.get("title", "EHD map")
    created = attributes.get("created", "at an unknown time")
    yield f"  file {name}, schema {attributes['schema_version']}, made {created}"
    yield ""
    yield f"axes ({dataset['status'].size} points)"
    yield f"  {'contact':20s} {dataset.sizes['contact']:5d}  {', '.join(map(str, dataset['contact'].values))}"
    for axis, display in AXES:
        yield f"  {axis:20s} {dataset.sizes[axis]:5d}  {span(dataset[axis].values, display)}"
    yield ""
    yield "values (per unit length of contact)"
    yield from value_lines(dataset)
    yield ""
    yield "statuses"
    yield from status_lines(dataset)
    yield ""
    yield "accuracy of the points"
    yield from error_lines(dataset)
    law = list(law_lines(dataset))
    if law:
        yield ""
        yield from law
    if backbone is not None:
        yield ""
        yield "refinement lines of the contact law (group backbone)"
        for dim, size in backbone.sizes.items():
            yield f"  {dim!s:20s} {size:5d}"
        yield f"  variables: {', '.join(str(variable) for variable in backbone.data_vars)}"
    yield ""
    yield "provenance (records in SI units)"
    yield f"  job             {attributes.get('job_name', '')} (sha256 {attributes['job_sha256'][:12]}...)"
    yield f"  solver          {attributes['solver']} {_record(attributes['solver_settings'])}"
    if "openfoam_build" in attributes:
        yield f"  OpenFOAM        {attributes['openfoam_version']}; ehlFoam built with {attributes['openfoam_build']}"
    scaling = float(attributes.get("structural_scaling", 1.0))
    scaled = f", times {scaling:.6g} for the material" if scaling != 1.0 else ""
    yield f"  structural law  {attributes['structural_law']}{scaled}"
    yield f"  geometry        {_record(attributes['geometry']) or 'a bare contact'}"
    for contact in json.loads(attributes["contacts"]):
        yield f"  contact         {contact['name']}: reduced radius {contact['radius'] * 1e3:.5g} mm"
    unverified = "" if int(attributes.get("lubricant_verified", 1)) else "NOT VERIFIED: "
    yield f"  lubricant       {unverified}{_record(attributes['lubricant'])}"
    yield f"  versions        {_record(attributes['package_versions'])}"


def _record(text: str) -> str:
    """Return a JSON record as 'name value, name value'."""
    record = json.loads(text)
    if not record:
        return ""
    return ", ".join(
        f"{key} {value:g}" if isinstance(value, float) else f"{key} {value}" for key, value in record.items()
    )
