"""What every export says of itself: where it comes from, over what range, and in which axes and signs."""

from __future__ import annotations

from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.outputs import MARK
from ehdmaps.program import plain
from ehdmaps.units import LOAD, SPEED, TEMPERATURE, Display
from ehdmaps.version import version

BEARING_AXES = (
    "axes: x along the axis of the bearing (axial), y and z radial; rotations tx, ty, tz about them, right-handed",
    "signs: forces and moments act on the inner ring, whose pose is relative to the outer ring; "
    "K = -d f / d pose, C = -d f / d velocity",
    "units: SI (m, rad, N, N m, s), temperatures in kelvin",
)
"""Axes, signs and units of bearings, for people."""

_AXES = (("load", LOAD), ("entrainment_speed", SPEED), ("temperature", TEMPERATURE))


def origin(emap: EHDMap, name: str, beyond: str = "refused") -> tuple[str, ...]:
    """Return the lines that tell where an export comes from; the first carries the mark of our files.

    Parameters
    ----------
    emap : EHDMap
        The map.
    name : str
        Name of its file.
    beyond : str
        What happens to points outside of the map.
    """
    attributes = emap.dataset.attrs
    stated = [
        ("map", name),
        ("title", attributes.get("title", "EHD map")),
        ("content sha256", attributes.get(schema.CHECKSUM, "none, the map is older than this checksum")),
        ("structural law", attributes.get("structural_law", "")),
        ("surfaces", emap.surface.label),
        ("solver", attributes.get("solver", "")),
    ]
    return (
        f"{MARK} {version()}",
        *(f"{key}: {plain(value)}" for key, value in stated if value),
        *(f"{label}: {_span(emap, axis, display)}; {beyond} beyond" for axis, label, display in _ranges()),
    )


def _ranges() -> tuple[tuple[str, str, Display], ...]:
    """Return axes of the map with the words for them."""
    return tuple((axis, f"range of {axis.replace('_', ' ')}", display) for axis, display in _AXES)


def _span(emap: EHDMap, axis: str, display: Display) -> str:
    """Return a range of the map in words."""
    values = emap.dataset[axis].values
    low, high = display.text(float(values[0])), display.text(float(values[-1]))
    return low if values.size == 1 else f"{low} to {high}"
