"""Points of a bearing as a labelled dataset, as netCDF and CSV files, and in words."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.outputs import MARK, TABLE, Kind, write_text
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import Surface
from ehdmaps.units import DAMPER, FILM, PRESSURE, RPM, SPRING, TEMPERATURE, written
from mbs.bearings.bearing import Bearing
from mbs.bearings.contact_report import BearingPoint
from mbs.bearings.films import SIDES
from mbs.bearings.thermal import BearingState
from mbs.model.findings import MEANINGLESS, Severity, WithFindings
from mbs.output.files import RESULT, described
from mbs.output.state_text import beside_class, flooded_note, loss_words, state_words
from mbs.scene.contact_laws import surface_label
from mbs.scene.fields import FORCE, MICROMETRE

if TYPE_CHECKING:
    import xarray as xr


WIDE_RANGE = 20.0
"""A range of loads whose end is further above its beginning is spaced, and drawn, in the logarithm."""

Points = Sequence[Sequence[BearingPoint]]
"""By load, then by speed."""


@dataclass(frozen=True, eq=False)
class BearingDescription:
    """Description that all points of a result have in common, in words and numbers.

    Attributes
    ----------
    bearing : Bearing
        Geometry with its clearance, profile, slices.
    law, films : str
        Law and films, in words.
    supply : OilSupply
        Oil supply of the contacts.
    surface : Surface
        Surfaces of the contacts, whose load film and asperities share where they are rough.
    oil : Lubricant
        The oil.
    direction : float
        Direction of the load, from y towards z [deg].
    temperature, roughness : float
        [K], [m].
    assumed : tuple of str
        What was not given.
    state : BearingState or None
        Temperatures of the raceways, and what they make of the clearance; None where both have `temperature`.
    """

    bearing: Bearing
    law: str
    films: str
    supply: OilSupply
    surface: Surface
    oil: Lubricant
    direction: float
    temperature: float
    roughness: float
    assumed: tuple[str, ...]
    state: BearingState | None = None


def result_kind(path: str | None) -> Kind:
    """Kind of file that a result is written as, by the ending of its name."""
    if path is not None and Path(path).suffix.lower() == ".csv":
        return TABLE
    return dataclasses.replace(RESULT, endings=(".nc", ".csv"))


_ROW = (
    ("stiffness_along", "N/m", "stiffness of the bearing along the load"),
    ("stiffness_across", "N/m", "stiffness of the bearing across the load"),
    ("damping_along", "N s/m", "damping of the bearing along the load, low-frequency limit"),
    ("damping_across", "N s/m", "damping of the bearing across the load, low-frequency limit"),
    ("displacement_along", "m", "inner ring against the outer one, along the load"),
    ("displacement_across", "m", "inner ring against the outer one, across the load"),
    ("entrainment_speed", "m/s", "mean of the two surface speeds"),
    ("highest_roller_load", "N", "load of the most loaded roller"),
    ("loaded_rollers", "1", "rollers that carry more than 1 % of the highest roller load"),
    ("film_parameter", "1", "Lambda, smallest film over the combined rms roughness"),
    ("rolling_torque", "N m", "torque that rolling takes; none without a map that has rolling forces"),
    ("rolling_power", "W", "power that the films of all rollers take"),
)
_SIDE = (
    ("hertz_pressure", "Pa", "largest Hertz pressure"),
    ("max_pressure", "Pa", "largest pressure, that of the film where a map knows it"),
    ("central_film", "m", "smallest central film"),
    ("minimum_film", "m", "smallest film"),
)


def bearing_row(point: BearingPoint, roughness: float) -> dict[str, float]:
    """Numbers of a point that do not depend on the contact, by name, SI."""
    if point.failed:
        return {name: math.nan for name, _, _ in _ROW}
    stiffness, damping = point.along_across(point.stiffness), point.along_across(point.damping)
    moved = point.axes @ point.displacement
    values = (
        *stiffness,
        *damping,
        *moved,
        point.entrainment_speed,
        float(point.rollers.load.max()),
        point.loaded,
        point.film_parameter(roughness),
        point.loss.torque,
        point.loss.total,
    )
    return {name: float(value) for (name, _, _), value in zip(_ROW, values, strict=True)}


def bearing_dataset(description: BearingDescription, points: Points) -> xr.Dataset:
    """Dataset over load and speed, with the loads of all rollers and the slices of the most loaded one.

    Parameters
    ----------
    description : BearingDescription
        What they have in common.
    points : sequence of sequence of BearingPoint
        Points by load, then by speed.
    """
    import xarray as xr  # a third of a second, which points for people do not need

    dims = ("load", "speed")
    rows = [[bearing_row(point, description.roughness) for point in line] for line in points]
    variables: dict[str, Any] = {
        name: (dims, np.array([[row[name] for row in line] for line in rows]), {"units": unit, "long_name": words})
        for name, unit, words in _ROW
    }
    shares = [[point.film_share(description.surface, description.oil) for point in line] for line in points]
    variables["film_share"] = (
        dims,
        np.array(shares),
        {"units": "1", "long_name": "share of the film in the load of the most loaded roller; 1 for smooth surfaces"},
    )
    for name, unit, words in _SIDE:
        values = np.array([[getattr(point.contacts, name) for point in line] for line in points])
        variables[name] = ((*dims, "contact"), values, {"units": unit, "long_name": f"{words} of the contact"})
    loads = np.array([[point.rollers.load for point in line] for line in points])
    variables["roller_load"] = ((*dims, "roller"), loads, {"units": "N", "long_name": "load of the roller"})
    variables["slice_load"] = (
        (*dims, "slice"),
        np.array([[point.rollers.load_per_length[point.most_loaded] for point in line] for line in points]),
        {"units": "N/m", "long_name": "load per length of the most loaded roller on the inner raceway"},
    )
    for name, unit, words in _SIDE:
        slices = np.array(
            [[[getattr(side, name)[p.most_loaded] for side in p.contacts.sides] for p in line] for line in points]
        )
        plain = words.replace("largest ", "").replace("smallest ", "")
        attributes = {"units": unit, "long_name": f"{plain}, along the most loaded roller"}
        variables[f"slice_{name}"] = ((*dims, "contact", "slice"), slices, attributes)
    outside = np.array([["; ".join(point.problems) for point in line] for line in points], dtype=np.str_)
    variables["outside"] = (dims, outside, {"units": "1", "long_name": "why the laws do not hold at the point"})
    first = points[0][0]
    coordinates = {
        "load": ("load", [line[0].size for line in points], {"units": "N", "long_name": "load on the inner ring"}),
        "speed": ("speed", [p.speed for p in points[0]], {"units": "rad/s", "long_name": "speed of the inner ring"}),
        "contact": ("contact", list(SIDES), {"units": "1", "long_name": "contact of a roller with this raceway"}),
        "roller": ("roller", first.rollers.angle, {"units": "rad", "long_name": "angle of the roller, y towards z"}),
        "slice": ("slice", first.rollers.position, {"units": "m", "long_name": "place along the roller"}),
    }
    return described(xr.Dataset(variables, coords=coordinates), **_attributes(description, points))


def _attributes(description: BearingDescription, points: Points) -> dict[str, Any]:
    """Attributes that describe the dataset."""
    bearing, geometry = description.bearing, description.bearing.geometry
    everything = [point for line in points for point in line]
    return {
        "bearing": geometry.name,
        "bearing_law": description.law,
        "films": description.films,
        "oil_supply": description.supply.label,
        "surface": surface_label(description.surface),
        "load_direction_deg": description.direction,
        "temperature_K": description.temperature,
        **_warm(description.state),
        "diametral_clearance_m": geometry.diametral_clearance,
        "roughness_m": description.roughness,
        "profile": str(bearing.profile),
        "slices": bearing.slices,
        "slices_coupled": int(bearing.coupled),
        "assumed": "; ".join(description.assumed),
        "warnings": "\n".join(dict.fromkeys(line for point in everything for line in (*point.problems, *point.notes))),
    }


def _warm(state: BearingState | None) -> dict[str, float]:
    """Attributes of a bearing whose rings have temperatures of their own."""
    if state is None:
        return {}
    return {
        "inner_raceway_temperature_K": state.inner,
        "outer_raceway_temperature_K": state.outer,
        "stated_clearance_m": state.clearance.stated,
    }


Columns = Sequence[tuple[str, str, str]]
"""Variables of a table: name, unit, meaning."""


def write_csv(
    dataset: xr.Dataset, path: str, what: str = "bearing", row: Columns = _ROW, side: Columns = _SIDE
) -> None:
    """Write a row for each load and speed, in SI.

    Parameters
    ----------
    dataset : xarray.Dataset
        Points of a bearing over load and speed.
    path : str
        The file.
    what : str
        Kind of the bearing, in words.
    row, side : sequence
        Variables of a point, and those of its inner and outer contacts.

    Raises
    ------
    InputError
        If it may not be replaced, or cannot be written.
    """
    about = {key: value for key, value in dataset.attrs.items() if key != "warnings"}
    head = [
        f"# table {MARK}: one {what} at operating points, SI",
        *(f"# {key}: {value}" for key, value in about.items()),
    ]
    columns = ["load [N]", "speed [rad/s]", *(f"{name} [{unit}]" for name, unit, _ in row)]
    columns += [f"{name}_{contact} [{unit}]" for name, unit, _ in side for contact in SIDES]
    lines = [*head, ",".join([*columns, "outside"])]
    for i, load in enumerate(dataset["load"].values):
        for j, speed in enumerate(dataset["speed"].values):
            here = dataset.isel(load=i, speed=j)
            numbers = [load, speed, *(float(here[name]) for name, _, _ in row)]
            numbers += [float(here[name].sel(contact=contact)) for name, _, _ in side for contact in SIDES]
            # Quoted: the cause has commas.
            cause = str(here["outside"].values).replace('"', "'")
            fields = ["" if math.isnan(number) else f"{number:.9g}" for number in numbers]
            lines.append(",".join([*fields, f'"{cause}"' if cause else ""]))
    write_text(path, "\n".join(lines) + "\n", TABLE)


_PLACES = 11

REGIMES = ((1.0, "boundary: the surfaces touch"), (3.0, "mixed: asperities touch"), (math.inf, "full film"))
"""What is usually said of Lambda below these values."""


def bearing_text(description: BearingDescription, points: Points, corners: Sequence[BearingPoint] = ()) -> list[str]:
    """Lines that describe all points, and warn.

    Parameters
    ----------
    description : BearingDescription
        What they have in common.
    points : sequence of sequence of BearingPoint
        Points by load, then by speed.
    corners : sequence of BearingPoint
        The only point with the softest and the stiffest usual asperities; empty where they are not looked at.
    """
    everything = [point for line in points for point in line]
    lines = bearing_heading(description)
    if len(everything) == 1:
        lines += _page(everything[0], description) + _asperity_band(corners) + _rollers(everything[0])
        lines += _along(everything[0]) if description.bearing.coupled else []
    else:
        lines += _table(everything, description)
    torque = max((point.loss.torque for point in everything if not point.failed), default=math.nan)
    flooded = flooded_note(torque, [description.supply])
    return unsound_lines(everything) + lines + flooded + warning_lines(everything)


def bearing_heading(description: BearingDescription) -> list[str]:
    """Tell what was computed, and what of it was assumed."""
    bearing = description.bearing
    clearance = f"clearance {MICROMETRE.text(bearing.geometry.diametral_clearance)}{beside_class(bearing.geometry)}"
    state = clearance if description.state is None else state_words(description.state)
    slices = f"{bearing.slices} {'coupled ' if bearing.coupled else ''}slices"
    return [
        f"{bearing.geometry.title}: law {description.law}; {description.films}",
        f"  {TEMPERATURE.text(description.temperature)}, {state}, profile {bearing.profile}, {slices}, "
        f"load at {description.direction:.4g} deg from y (a roller) towards z, {surface_label(description.surface)}",
        f"  assumed: {', '.join(description.assumed) or 'nothing'}",
        *([f"  {bearing.geometry.estimated}"] if bearing.geometry.estimated else []),
    ]


def _page(point: BearingPoint, description: BearingDescription) -> list[str]:
    """The numbers of one point."""
    row, roughness = bearing_row(point, description.roughness), MICROMETRE.text(description.roughness)
    contacts = point.contacts

    def pair(label: str, unit: str, along: float, across: float) -> str:
        return f"  {label:32s} {unit:8s} {_clean(along, across):12.5g} {_clean(across, along):12.5g}"

    return [
        f"{FORCE.text(point.size, 6)} on the inner ring at {RPM.text(point.speed)}: entrainment speed "
        f"{point.entrainment_speed:.4g} m/s",
        f"  {'':32s} {'':8s} {'along':>12s} {'across':>12s} the load",
        pair("inner ring moves by", "um", 1e6 * row["displacement_along"], 1e6 * row["displacement_across"]),
        pair("stiffness", SPRING.unit, *(SPRING.factor * row[f"stiffness_{way}"] for way in ("along", "across"))),
        pair(
            "damping, low-frequency limit",
            DAMPER.unit,
            *(DAMPER.factor * row[f"damping_{way}"] for way in ("along", "across")),
        ),
        f"  {'':32s} {'':8s} {'inner':>12s} {'outer':>12s} raceway",
        _sides("Hertz pressure", PRESSURE.unit, 1e-9 * contacts.hertz_pressure),
        *(
            []
            if np.array_equal(contacts.max_pressure, contacts.hertz_pressure)
            else [_sides("film pressure with spike", PRESSURE.unit, 1e-9 * contacts.max_pressure)]
        ),
        _sides("smallest central film", FILM.unit, 1e6 * contacts.central_film),
        _sides("smallest film", FILM.unit, 1e6 * contacts.minimum_film),
        lambda_line(row["film_parameter"], roughness) + _share_words(point, description),
        f"  {loss_words(point.loss)}",
    ]


def _share_words(point: BearingPoint, description: BearingDescription) -> str:
    """Share that the film carries of the load of the most loaded roller; nothing for smooth surfaces."""
    if description.surface.smooth:
        return ""
    share, planes = point.load_sharing(description.surface, description.oil)
    if math.isnan(share):
        return ""
    words = f"; the film carries {share:.0%} of the load of the most loaded roller"
    return f"{words}\n  {planes}" if planes else words


def _asperity_band(corners: Sequence[BearingPoint]) -> list[str]:
    """K and C with the softest and with the stiffest usual asperities."""
    if not corners:
        return []
    both = [(display, point.along_across(getattr(point, name))) for point in corners for display, name in _MATRICES]
    values = [display.value(float(value)) for display, diagonal in both for value in diagonal]
    soft, stiff = values[:4], values[4:]
    k, k_across, c, c_across = (f"{a:.4g} to {b:.4g}" for a, b in zip(soft, stiff, strict=True))
    return [
        "  asperities are seldom known; with the softest to the stiffest usual ones stiffness is "
        f"{k} along, {k_across} {SPRING.unit} across, damping {c} along, {c_across} {DAMPER.unit} across"
    ]


_MATRICES = ((SPRING, "stiffness"), (DAMPER, "damping"))


def regime(film_parameter: float) -> str:
    """Lubrication regime by Lambda, in usual words."""
    return next(words for limit, words in REGIMES if film_parameter < limit or limit == math.inf)


def lambda_line(film_parameter: float, roughness: str) -> str:
    """A line on Lambda and the regime of lubrication.

    Parameters
    ----------
    film_parameter : float
        Parameter Lambda; NaN where no film is known.
    roughness : str
        Roughness in words.

    Examples
    --------
    >>> lambda_line(5.0, "0.3 um"), lambda_line(math.nan, "0.3 um")
    ('  Lambda 5 (smallest film over 0.3 um of roughness; full film)', '  no film is known, and so no Lambda')
    """
    if math.isnan(film_parameter):
        return "  no film is known, and so no Lambda"
    return f"  Lambda {film_parameter:.3g} (smallest film over {roughness} of roughness; {regime(film_parameter)})"


def _sides(label: str, unit: str, values: Iterable[float]) -> str:
    """A line of an inner and an outer value."""
    return f"  {label:32s} {unit:8s} " + " ".join(f"{shown(value):>12s}" for value in values)


def _rollers(point: BearingPoint) -> list[str]:
    """A line for each loaded roller."""
    rollers, contacts = point.rollers, point.contacts
    lines = [
        f"  {point.loaded} of {rollers.load.size} rollers carry more than 1 % of the highest load"
        f"{'; the others not shown' if point.loaded < rollers.load.size else ''}",
        f"  {'roller':>6s} {'angle':>7s} {'load':>9s} {'Hertz pressure, GPa':>21s} {'smallest film, um':>21s}",
        f"  {'':>6s} {'deg':>7s} {'N':>9s} " + f"{SIDES[0]:>11s}{SIDES[1]:>10s} " * 2,
    ]
    for index in np.argsort(rollers.angle):
        if rollers.load[index] <= 0.01 * rollers.load.max():
            continue
        pressures = [1e-9 * float(np.max(side.hertz_pressure[index])) for side in contacts.sides]
        films = [1e6 * smallest(side.minimum_film[index]) for side in contacts.sides]
        lines.append(
            f"  {index:6d} {math.degrees(rollers.angle[index]):7.1f} {rollers.load[index]:9.5g} "
            f"{shown(pressures[0], 3):>11s}{shown(pressures[1], 3):>10s} "
            f"{shown(films[0], 3):>11s}{shown(films[1], 3):>10s}"
        )
    return [line.rstrip() for line in lines]


def _along(point: BearingPoint) -> list[str]:
    """Load and pressures along the most loaded roller, at some of its slices, both ends among them."""
    rollers, index = point.rollers, point.most_loaded
    count = rollers.position.size
    shown = np.unique(np.linspace(0, count - 1, min(count, _PLACES)).round().astype(int))
    rows = [
        ("place, mm", 1e3 * rollers.position, "8.2f"),
        ("load per length, N/mm", 1e-3 * rollers.load_per_length[index], "8.1f"),
        *(
            (f"{name} Hertz pressure, GPa", 1e-9 * side.hertz_pressure[index], "8.3f")
            for name, side in zip(SIDES, point.contacts.sides, strict=True)
        ),
    ]
    return [
        "  along the most loaded roller",
        *(f"  {words:27s}" + "".join(f"{values[i]:{form}}" for i in shown) for words, values, form in rows),
    ]


def _table(points: list[BearingPoint], description: BearingDescription) -> list[str]:
    """A line for each point."""
    rough = not description.surface.smooth
    lines = [
        f"{'load':>10s} {'speed':>8s} {'K along':>9s} {'across':>9s} {'c along':>9s} {'rollers':>7s} {'highest':>9s} "
        f"{'Hertz':>7s} {'smallest':>9s} {'Lambda':>7s} {'rolling':>8s}" + (f" {'film':>6s}" if rough else ""),
        f"{'N':>10s} {'rpm':>8s} {SPRING.unit:>9s} {SPRING.unit:>9s} {DAMPER.unit:>9s} {'loaded':>7s} {'N':>9s} "
        f"{'GPa':>7s} {'film, um':>9s} {'':>7s} {'N mm':>8s}" + (f" {'share':>6s}" if rough else ""),
    ]
    for point in points:
        if point.failed:
            lines.append(hole_line(point.size, point.speed))
            continue
        row = bearing_row(point, description.roughness)
        share = f" {point.film_share(description.surface, description.oil):6.3f}" if rough else ""
        lines.append(
            f"{point.size:10.5g} {RPM.value(point.speed):8.5g} {SPRING.value(row['stiffness_along']):9.4g} "
            f"{SPRING.value(row['stiffness_across']):9.4g} {DAMPER.value(row['damping_along']):9.4g} {point.loaded:7d} "
            f"{row['highest_roller_load']:9.5g} {1e-9 * float(point.contacts.hertz_pressure.max()):7.4g} "
            f"{shown(1e6 * float(np.min(point.contacts.minimum_film)), 4):>9s} {shown(row['film_parameter'], 3):>7s} "
            f"{shown(1e3 * row['rolling_torque'], 4):>8s}{share}{' !' if point.problems else ''}"
        )
    return lines


def hole_line(load: float, speed: float) -> str:
    """Line of a table for a point without an answer, at a load [N] and a speed [rad/s]."""
    return f"{load:10.5g} {RPM.value(speed):8.5g} {'no answer, see below':>29s} !"


def warning_lines(points: Sequence[WithFindings]) -> list[str]:
    """Each warning and note once, with how many points it is about.

    Parameters
    ----------
    points : sequence of WithFindings
        The points.
    """
    graves = (Severity.BEYOND, Severity.WARNING, Severity.NOTE)
    return [f"{grave.word}: {words}" for grave in graves for words in _of_several(points, grave)]


def unsound_lines(points: Sequence[WithFindings]) -> list[str]:
    """The first line of points whose figures mean nothing, with the reasons; none of others.

    Parameters
    ----------
    points : sequence of WithFindings
        The points.
    """
    words = "; ".join(_of_several(points, Severity.UNSOUND))
    return [f"{Severity.UNSOUND.word}: {MEANINGLESS}{words}"] if words else []


def _of_several(points: Sequence[WithFindings], severity: Severity) -> list[str]:
    """Words of findings of a severity, each kind once."""
    # The number in a sentence differs from point to point; the last one is shown.
    groups: dict[str, list[str]] = {}
    for point in points:
        for finding in point.findings:
            if finding.severity is severity:
                groups.setdefault(without_numbers(finding.words), []).append(finding.words)
    return [
        words[-1] + (f" ({len(words)} of {len(points)} points, the last of them here)" if len(points) > 1 else "")
        for words in groups.values()
    ]


def without_numbers(sentence: str) -> str:
    """A sentence without its numbers, by which warnings of one kind are known.

    Examples
    --------
    >>> without_numbers("5.1 GPa is too much") == without_numbers("40 GPa is too much")
    True
    """
    return "".join(letter for letter in sentence if not (letter.isdigit() or letter in ".-+"))


def smallest(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
    """Smallest number; NaN if there is none.

    Parameters
    ----------
    values : ndarray
        Any of them may be NaN.
    """
    known = values[np.isfinite(values)]
    return float(known.min()) if known.size else math.nan


def _clean(value: float, beside: float) -> float:
    """Zero in place of what is round-off beside another value."""
    return 0.0 if abs(value) < 1e-9 * abs(beside) else value


def shown(value: float, digits: int = 5) -> str:
    """A number; a dash where there is none.

    Parameters
    ----------
    value : float
        The number, or NaN.
    digits : int
        Digits that count.
    """
    return "-" if math.isnan(value) else written(value, digits)
