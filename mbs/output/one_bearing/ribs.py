"""Points of bearings of rollers and ribs, and such bearings of a machine: what `mbs.output.one_bearing.kind` asks."""

from __future__ import annotations

from ehdmaps.physics.hertz import LINE_LIMIT
from ehdmaps.physics.rollers.ribbed_geometry import RibbedGeometry
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from ehdmaps.units import PRESSURE, RPM, TEMPERATURE
from mbs.bearings.locating.locating_force import Settled
from mbs.bearings.tapered.roller_findings import line_pressures
from mbs.bearings.tapered.tapered_point import RIB_FRICTION, TaperedPoint
from mbs.output.one_bearing.kind import (
    CONTACT_SIDES,
    Description,
    Kind,
    Number,
    Row,
    column,
    columns_of,
    numbers_of,
    shown,
    smallest,
    tilting,
)
from mbs.output.state_text import beside_class
from mbs.scene.fields import DEGREE, FORCE

_SPEEDS = (
    Number("cage_speed", "rad/s", "speed of the cage, in pure rolling"),
    Number("centrifugal_load", "N", "centrifugal load of a roller"),
)
_RIB = (
    Number("highest_rib_load", "N", "highest load of the rib", lambda p, _: p.elements.load[2].max()),
    Number("rib_pressure", "Pa", "largest Hertz pressure at the rib", lambda p, _: p.rib_pressure.max()),
    Number("rib_film", "m", "smallest central film at the rib", lambda p, _: smallest(p.rib_film)),
    Number("rib_sliding_speed", "m/s", "sliding speed at the rib", lambda p, _: p.sliding_speed),
    Number("rib_power", "W", f"power of all rib contacts with a friction of {RIB_FRICTION:g}"),
)
_BOTH = ("contact", "roller")
_EACH = (
    Number("roller_load", "N", "load of the contact of the roller", lambda p, _: p.elements.load[:2], _BOTH),
    Number("rib_load", "N", "load of the rib", lambda p, _: p.elements.load[2], ("roller",)),
)


def _about(description: Description, point: TaperedPoint) -> list[str]:
    """Lines on the geometry, its slices and the load."""
    force = point.force
    geometry = force.geometry
    rows = geometry.row_places
    apart = f"; 2 rows at {1e3 * rows[0]:.4g} and {1e3 * rows[1]:.4g} mm, ribs in the first" if len(rows) > 1 else ""
    return [
        f"{geometry.rolling_elements} rollers of {1e3 * geometry.roller_diameter:.4g} x "
        f"{1e3 * geometry.roller_length:.4g} mm on {1e3 * geometry.pitch_diameter:.4g} mm; {_angles(geometry)}{apart}",
        f"profile {force.profile}, {force.positions.size} slices, {TEMPERATURE.text(description.temperature)}, "
        f"{tilting(description, 'roller')}",
    ]


def _angles(geometry: TaperedGeometry) -> str:
    """Contact angle and cones, or ribs."""
    if isinstance(geometry, RibbedGeometry):
        return (
            f"clearance {1e6 * geometry.diametral_clearance:.4g} um{beside_class(geometry)}; ribs carry "
            f"{geometry.ways}, open by {DEGREE.value(geometry.rib_angle):.3g} deg against spherical ends (assumed)"
        )
    angles = [DEGREE.value(x) for x in (geometry.cup_angle, geometry.half_cone_angle, geometry.cone_angle)]
    return (
        f"contact angle {angles[0]:.4g} deg, half cone angle of the rollers {angles[1]:.3g} deg, cone "
        f"{angles[2]:.4g} deg"
    )


def _closing(point: TaperedPoint, row: Row) -> list[str]:
    """Lines on the rib and the cage."""
    return [
        f"rib: up to {FORCE.text(row['highest_rib_load'])} and {1e-9 * row['rib_pressure']:.3g} GPa, slides with "
        f"{point.sliding_speed:.3g} m/s, film {shown(1e6 * row['rib_film'], 3)} um (order of magnitude); "
        f"{point.rib_power:.3g} W at a friction of {RIB_FRICTION:g}, assumed",
        f"cage {RPM.text(point.cage_speed)}, centrifugal load of a roller {FORCE.text(point.centrifugal_load)}",
    ]


def _of_one(point: TaperedPoint, index: int) -> str:
    """Loads, their places and pressures of a roller."""
    inner, outer, rib = point.elements.load[:, index]
    off, pressures = 1e3 * point.elements.centre[:, index], 1e-9 * point.pressure[:, index]
    loads = f"{inner:9.5g} {outer:9.5g} {rib:9.4g}"
    return f"{loads} {off[0]:11.3g} {off[1]:9.3g} {pressures[0]:11.3g} {pressures[1]:9.3g}"


RIBBED = Kind(
    element="roller",
    words="bearing of rollers and ribs",
    static_limit=LINE_LIMIT,
    axial=True,
    numbers=(*numbers_of(_SPEEDS, axial=True, speed=" in the middle of a roller"), *_RIB),
    sides=CONTACT_SIDES,
    each=_EACH,
    columns=columns_of(
        "roller",
        [column("rib", "N", 8, 4, "highest_rib_load")],
        [],
        axial=True,
    ),
    about=_about,
    closing=_closing,
    heads=(
        f"{'load, N':>29s} {'off the middle, mm':>21s} {'Hertz pressure, GPa':>21s}",
        f"{'inner':>9s} {'outer':>9s} {'rib':>9s} {'inner':>11s} {'outer':>9s} {'inner':>11s} {'outer':>9s}",
    ),
    of_one=_of_one,
)
"""Tapered roller bearings, and those of cylindrical rollers that ribs hold along the axis."""


def roller_words(at: Settled) -> tuple[str, list[str]]:
    """Loads and pressures of a bearing of rollers and ribs of a machine; there are no more lines.

    Parameters
    ----------
    at : Settled
        The bearing at rest.
    """
    rollers = at.loads
    cone, pressures = rollers.load[0], line_pressures(at.force, rollers).max(axis=1)
    words = (
        f"{rollers.loaded} of {cone.size} rollers loaded, up to "
        f"{cone.max():.5g} N at the inner raceway, rib up to {rollers.load[2].max():.4g} N; Hertz pressure up to "
        f"{PRESSURE.value(pressures[0]):.4g} inner, {PRESSURE.text(pressures[1])} outer"
    )
    return words, []
