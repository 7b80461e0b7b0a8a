"""Content of a map file, in words and in the units that engineers use."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.errors import InputError
from ehdmaps.jobs.make.report import (
    AXES,
    correction_lines,
    error_lines,
    extrapolated_lines,
    films_lines,
    law_lines,
    reach_lines,
    spacing_lines,
    status_lines,
    value_lines,
)
from ehdmaps.jobs.supply import supply_words, surface_words
from ehdmaps.maps import schema
from ehdmaps.maps.backbone import ERROR
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.grid_field import has_own_lines
from ehdmaps.maps.records import record_from_json
from ehdmaps.maps.rough_layer import (
    BOUNDARY,
    DEEPEST_MEANT,
    FILM_PARAMETER,
    FILM_SHARE,
    LEAST_SPEED,
    MEAN_DISTANCE,
    MIXED,
    OVERLAP,
    MeanPlanes,
    RoughLayer,
    SmoothContact,
    overlapping,
    rough_variables,
    sharing_effect,
)
from ehdmaps.physics.approach import FE_LOAD
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import usable_points
from ehdmaps.program import plain
from ehdmaps.units import FILM, LENGTH, LOAD, PRESSURE, TEMPERATURE, Display, span

SHOWN_TEMPERATURES = (313.15, 373.15)
"""Where the oil's viscosity is shown [K]: those of its data sheet."""

_VISCOSITY = Display("mPa s", 1e3)
_PER_PRESSURE = Display("1/GPa", 1e9)
_CALL = re.compile(r"\w+\((.*)\)")


def describe(emap: EHDMap, name: str) -> str:
    """Return what `show` prints.

    Parameters
    ----------
    emap : EHDMap
        The map.
    name : str
        Name of the file.

    Raises
    ------
    MapError
        If its contacts, its bearing or its oil do not read.
    """
    return "\n".join(_lines(emap, name))


def _lines(emap: EHDMap, name: str) -> Iterator[str]:
    dataset, attributes = emap.dataset, emap.dataset.attrs
    yield plain(attributes.get("title", "EHD map"))
    created = plain(attributes.get("created", "at an unknown time"))
    yield f"  file {plain(name)}, schema {attributes['schema_version']}, made {created}"
    yield ""
    yield from _geometry_lines(emap)
    yield ""
    yield from _oil_lines(emap.lubricant)
    yield from map(_line, stated_rows(emap))
    yield ""
    yield f"axes ({dataset['status'].size} points)"
    yield f"  {'contact':20s} {dataset.sizes['contact']:5d}  {', '.join(map(str, dataset['contact'].values))}"
    for axis, display in AXES:
        whose = ", of the raceways" if axis == "temperature" else ""
        yield f"  {axis:20s} {dataset.sizes[axis]:5d}  {span(dataset[axis].values, display)}{whose}"
    yield ""
    yield "values (per unit length of contact)"
    yield from value_lines(dataset)
    if not emap.surface.smooth:
        yield from roughness_lines(emap)
    yield ""
    yield "statuses"
    yield from status_lines(dataset, emap.surface.roughness)
    yield from extrapolated_lines(dataset)
    yield ""
    yield from reach_lines(emap)
    yield ""
    if films := list(films_lines(dataset)):
        yield from films
        yield ""
    yield "accuracy of the points"
    yield from error_lines(dataset)
    for found in (list(law_lines(dataset)), list(spacing_lines(dataset))):
        if found:
            yield ""
            yield from found
    corrected = list(correction_lines(dataset))
    if corrected:
        yield ""
        yield from corrected
    if emap.low_loads is not None:
        yield ""
        yield f"contact laws at low loads: {emap.low_loads.text}"
    if emap.backbone is not None:
        yield ""
        yield from backbone_lines(emap.backbone)
    yield ""
    yield "provenance"
    yield from map(_line, provenance_rows(attributes))


def roughness_lines(emap: EHDMap) -> Iterator[str]:
    """Yield what the roughness makes of the films: Lambda, and the film's share of the load."""
    rough = rough_variables(emap.dataset, emap.contacts, emap.lubricant, emap.surface)
    parameter, share = (rough[name].values[np.isfinite(rough[name].values)] for name in (FILM_PARAMETER, FILM_SHARE))
    if not parameter.size:
        return
    yield f"  {emap.surface.label}, combined rms of both surfaces"
    below = [f"{100.0 * np.mean(parameter < limit):.0f} % of the points below {limit:g}" for limit in (BOUNDARY, MIXED)]
    yield f"    Lambda, minimum film over roughness: {', '.join(below)}; median {np.median(parameter):.3g}"
    most = ", ".join(f"{100.0 * np.mean(share < part):.0f} % below {part:g}" for part in (0.5, 0.9, 0.99))
    yield f"    share of the film in the load: {most} (of the points); smallest {np.min(share):.2g}"
    beyond = overlapping(rough[FILM_SHARE].values, rough[MEAN_DISTANCE].values)
    if beyond.any():
        reach = np.max(rough[FILM_PARAMETER].values[beyond])
        yield f"    at {100.0 * np.mean(beyond):.0f} % of the points, Lambda up to {reach:.2g}, {OVERLAP}"
    yield from _band_lines(emap, rough)


def _band_lines(emap: EHDMap, rough: xr.Dataset) -> Iterator[str]:
    """Yield k and c over those of smooth surfaces where films are below mixed, with soft and with stiff asperities."""
    ordered = emap.dataset.transpose(*schema.DIMS, ...)
    mixed = rough[FILM_PARAMETER].values < MIXED
    if not mixed.any():
        return
    soft, stiff = emap.surface.corners
    yield f"    k and c over those of smooth surfaces, at points with Lambda below {MIXED:g}; asperities are not known:"
    distance = rough_variables(emap.dataset, emap.contacts, emap.lubricant, soft)[MEAN_DISTANCE].values
    films = [ordered[name].values for name in ("film_offset", "film_compliance", "loss_compliance")]
    loads, speeds, temperatures = (ordered[name].values for name in schema.DIMS[1:])
    for word, corner in (("softest", soft), ("stiffest", stiff)):
        found = np.full((2, *mixed.shape), np.nan)
        for i, contact in enumerate(emap.contacts):
            solids = np.asarray(contact.structural_compliance(loads))
            for j, k in np.argwhere(mixed[i].any(axis=0)):
                here = mixed[i, :, j, k]
                film, gives, lost = (values[i, here, j, k] for values in films)
                smooth = SmoothContact(loads[here], film, gives, lost, solids[here])
                layer = RoughLayer(corner, contact, emap.lubricant, max(float(speeds[j]), LEAST_SPEED))
                found[:, i, here, j, k] = sharing_effect(layer, smooth, float(speeds[j]), float(temperatures[k]))
        parts = [values[np.isfinite(values)] for values in found]
        words = [
            f"{name} {np.median(part):.2f} in the median, {np.quantile(part, 0.05):.2f} at 5 %"
            for name, part in zip("kc", parts, strict=True)
            if part.size
        ]
        yield (
            f"      {word} usual asperities (product {corner.asperity_product:g}, slope {corner.asperity_slope:g}): "
            f"{'; '.join(words)}"
        )
    if (deep := distance < DEEPEST_MEANT).any():
        where = f"at {100.0 * np.mean(deep):.0f} % of the points, by up to {-np.min(distance[deep]):.2g} times"
        yield f"      with the softest, {where}: {MeanPlanes.MERGED.value}"


def _geometry_lines(emap: EHDMap) -> Iterator[str]:
    """Yield bearing and contacts."""
    bearing = emap.bearing
    if bearing is None:
        yield "geometry: a bare line contact"
    else:
        name = f" ({plain(bearing.name)})" if bearing.label else ""
        yield f"bearing {plain(bearing.label or bearing.name)}{name}"
        if bearing.estimated:
            yield f"  {plain(bearing.estimated)}"
    yield from map(_line, geometry_rows(emap))


def _line(row: tuple[str, str]) -> str:
    """A line of a name and its value."""
    return f"  {row[0]:20s} {row[1]}"


def geometry_rows(emap: EHDMap) -> Iterator[tuple[str, str]]:
    """Yield the dimensions of bearing and contacts, and the solids: names and values.

    Parameters
    ----------
    emap : EHDMap
        The map.
    """
    if emap.bearing is not None:
        yield from _bearing_rows(emap.bearing)
    for contact in emap.contacts:
        depth = f", depth d* {LENGTH.text(contact.reference_depth)}" if contact.reference_depth else ""
        by_fe = f", approach {FILM.text(contact.fe_approach, 5)} at {LOAD.text(FE_LOAD)}" if contact.fe_approach else ""
        shown = {"half_space": depth, "fe": by_fe}.get(contact.structural_law, "")
        yield f"{contact.name} contact", f"reduced radius {LENGTH.text(contact.radius, 5)}{shown}"
    material = emap.contacts[0].material
    modulus = PRESSURE.text(material.youngs_modulus)
    yield "material", f"Young's modulus {modulus}, Poisson's ratio {material.poisson_ratio:g}"
    scaling = float(emap.dataset.attrs.get("structural_scaling", 1.0))
    scaled = f", times {scaling:.6g} for the material" if scaling != 1.0 else ""
    yield "structural law", f"{plain(emap.dataset.attrs['structural_law'])}{scaled}"


def _bearing_rows(bearing: BearingGeometry) -> Iterator[tuple[str, str]]:
    """Yield the dimensions of a bearing."""
    inner, outer = LENGTH.text(bearing.inner_raceway_diameter, 5), LENGTH.text(bearing.outer_raceway_diameter, 5)
    yield "raceway diameters", f"{inner} inner, {outer} outer"
    size = f"{LENGTH.text(bearing.roller_diameter, 5)} diameter, {LENGTH.text(bearing.roller_length, 5)} long"
    yield "rollers", f"{bearing.rolling_elements}{bearing.row_words}, {size}"
    words = f" ({bearing.clearance_range.words})" if bearing.clearance_range else ""
    yield "diametral clearance", FILM.text(bearing.diametral_clearance) + words


def _oil_lines(oil: Lubricant) -> Iterator[str]:
    """Yield the oil: what a data sheet has, and by which laws it goes on."""
    yield f"oil {plain(oil.title)}" + ("" if oil.verified else ": NOT VERIFIED")
    if oil.estimated:
        yield f"  {oil.estimated}"
    yield from map(_line, oil_rows(oil))


def oil_rows(oil: Lubricant) -> Iterator[tuple[str, str]]:
    """Yield the properties of an oil: names and values.

    Parameters
    ----------
    oil : Lubricant
        The oil.
    """
    record = oil.record()
    over_temperature, over_pressure = record["viscosity_over_temperature"], record["viscosity_law"]
    yield "viscosity", f"{_at_temperatures(oil, 'viscosity', _VISCOSITY)} (law {over_temperature})"
    coefficient = _at_temperatures(oil, "pressure_viscosity", _PER_PRESSURE)
    kind = "assumed" if oil.reach_assumed else "stated"
    limit = f", reach {PRESSURE.text(oil.fitted_pressure)} {kind}" if oil.fitted_pressure < float("inf") else ""
    yield "pressure-viscosity", f"{coefficient} (law {over_pressure}{limit})"
    slope = f", {oil.density_slope:+g} kg/m3 a K" if oil.density_slope else ""
    yield "density", f"{oil.density_15:.5g} kg/m3 at 15 degC{slope} (over pressure: {oil.density_law})"
    if oil.thermal_conductivity is not None:
        yield "conductivity", f"{oil.thermal_conductivity:.4g} W/(m K), heat capacity {oil.heat_capacity:.4g} J/(kg K)"


def stated_rows(emap: EHDMap) -> Iterator[tuple[str, str]]:
    """Yield oil supply and surfaces that the job of a map states: names and values.

    Parameters
    ----------
    emap : EHDMap
        The map.
    """
    attributes = emap.dataset.attrs
    yield "supply", supply_words(emap.supply if schema.OIL_SUPPLY in attributes else None)
    yield "surfaces", surface_words(emap.surface if schema.SURFACE in attributes else None)


def _at_temperatures(oil: Lubricant, name: str, display: Display) -> str:
    """Return a property of the oil at the temperatures of a data sheet; not where its laws break down."""
    texts = []
    for temperature in SHOWN_TEMPERATURES:
        try:
            state = oil.at(temperature)
        except InputError:
            continue
        value = state.viscosity if name == "viscosity" else state.pressure_viscosity.pressure_viscosity
        texts.append(f"{display.text(value)} at {TEMPERATURE.text(temperature)}")
    return ", ".join(texts) or "not known at 40 and 100 degC"


def backbone_lines(backbone: xr.Dataset) -> Iterator[str]:
    """Yield the size of the group of refinement lines."""
    sizes = [backbone.sizes[name] for name in schema.BACKBONE_DIMS]
    yield "refinement lines of the contact law (group backbone)"
    statuses = [name for name in ("status", f"{schema.OWN}status") if name in backbone]
    status = np.stack([backbone[name].values for name in statuses])
    solved = int((status != schema.NOT_NEEDED).sum())
    whose = ", of each contact its own" if has_own_lines(backbone) else ""
    yield (
        f"  {solved} points: {sizes[0]} loads about the damping valley, {sizes[1]} speeds, {sizes[2]} temperatures"
        f"{whose}"
    )
    bridged = solved - int(usable_points(status).sum())
    if bridged:
        yield f"  {bridged} of them without a solution: single ones are bridged along their lines"
    if schema.NATURAL not in backbone.variables:
        yield "  response over frequency: none; films in time lock by a closed formula"
        return
    at, error = backbone[schema.NATURAL].values, backbone[ERROR].values
    known = error[np.isfinite(error)]
    words = f"median {np.median(known):.2g}, 95 % {np.quantile(known, 0.95):.2g}" if known.size else "not known"
    yield (
        f"  response at {at.size} natural frequencies omega sqrt(b^2 + 2 h R)/u, {at[0]:g} to {at[-1]:g}; "
        f"estimated error of the film compliance: {words}"
    )


def provenance_rows(attributes: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield how a map came about: names and values, an empty name where a value goes on with the one before.

    Parameters
    ----------
    attributes : dict
        Attributes of the map.
    """
    job = f"{plain(attributes.get('job_name', ''))} (sha256 {plain(attributes['job_sha256'])[:12]}...)"
    yield "job", job.strip()
    yield "solver", plain(attributes["solver"])
    for key, value in record_from_json(attributes["solver_settings"], "solver_settings").items():
        yield "", f"{key.replace('_', ' ')} {_setting(value)}"
    if "openfoam_build" in attributes:
        version = plain(attributes.get("openfoam_version", "of an unknown version"))
        yield "OpenFOAM", f"{version}; ehlFoam built with {plain(attributes['openfoam_build'])}"
    versions = record_from_json(attributes["package_versions"], "package_versions")
    yield "versions", ", ".join(f"{package} {version}" for package, version in versions.items())
    if schema.CODE in attributes:
        yield "code", f"hash {plain(attributes[schema.CODE])} of all sources, Python, numba, LLVM, numpy and scipy"
    yield (
        "content",
        f"as made (sha256 {attributes[schema.CHECKSUM][:12]}...)"
        if schema.CHECKSUM in attributes
        else "may have been changed since: the map has no checksum",
    )


def _setting(value: object) -> str:
    """Return a setting of a solver: numbers short, records as 'name value, name value'."""
    if isinstance(value, float):
        return f"{value:g}"
    call = _CALL.fullmatch(str(value))
    return plain(call[1].replace("=", " ").replace("_", " ") if call else value)
