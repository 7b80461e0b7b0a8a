"""A page that reads both film tables in the browser: films, k, c and capacitance of the contacts of catalogue bearings.

The page has the nodes of the tables, contacts of bearings, and oils over temperature as Chebyshev series; the script
`ehdmaps/report/catalogue.js` reads them as Python does. Charts are those of all reports, whose curves are drawn anew.
"""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import BSpline

from ehdmaps.arrays import FloatArray
from ehdmaps.electrics import dielectric, gaps
from ehdmaps.electrics.contact import line_capacitance, point_capacitance
from ehdmaps.errors import EhdmapsError, MapError
from ehdmaps.physics import closed_form, hertz
from ehdmaps.physics.bearing import BEARINGS, BearingGeometry
from ehdmaps.physics.catalogue import designated, designations
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.designations.oil_class import CLASSES
from ehdmaps.physics.isotherm import DENSITY_RISE
from ehdmaps.physics.lubricant import DEFAULT_OIL, LUBRICANTS, Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_designations, ball_estimate
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.rollers.needle_catalogue import needle_designations
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.viscosity import ROELANDS_PRESSURE
from ehdmaps.report.axis import log_axis
from ehdmaps.report.chart import SEQUENCE, Chart, Curve, figure
from ehdmaps.report.page import Markup, Moving, Section, document, sentences, tag
from ehdmaps.table import coordinates, films, nodes, oils
from ehdmaps.table.fields import FILMS
from ehdmaps.table.file import shipped_tables
from ehdmaps.table.interpolation import DEGREE, Axes, knots_of
from ehdmaps.table.nodes import Nodes
from ehdmaps.table.points import films as point_films
from ehdmaps.table.points import nodes as point_nodes
from ehdmaps.table.points.file import shipped_point_table

KEPT = 5
"""Numbers of a film that the page has: the first of both tables."""

TEMPERATURES = (253.15, 393.15)
"""Widest range of an oil [K]; where its laws hold."""

_DEGREE, _CLOSE = 40, 1e-10
"""Degree of a Chebyshev series, and what it may miss."""

LOADS = np.geomspace(1.0, 5e4, 51)
"""Loads of a rolling element in the charts [N]."""

SHOWN: Mapping[str, Any] = {
    "bearing": "NU308",
    "oil": DEFAULT_OIL,
    "speed": 1500.0,
    "temperature": 60.0,
    "load": 1000.0,
}
"""What the page shows first: rpm, degC, N."""
DIGITS = 10
"""Digits of numbers in the page, apart from those of the tables: far more than the 1e-6 that it keeps."""

PERMITTIVITY, OUTER_GAP = 2.2, 1e-4

QUANTITIES = (
    ("film", "film thickness", "um", 1e6, (1e-3, 1e2), ("central", "minimum")),
    ("stiffness", "stiffness of the contact", "N/um", 1e-6, (1.0, 1e4), ("stiffness",)),
    ("damping", "damping of the contact", "N s/m", 1.0, (1e-2, 1e5), ("damping",)),
    ("capacitance", "capacitance of the contact", "pF", 1e12, (1.0, 1e4), ("capacitance",)),
)
"""Charts: name, words, unit, factor from SI, range of the axis, and curves of each contact."""

_PLACES = ("inner", "outer")

_LINE = ("radius", "modulus", "dry")
_POINT = ("radius", "modulus", "ellipticity", "width", "pressure", "approach", "stiffness", "widest", "scale")
"""What the script calls the numbers of a contact."""


def catalogue_page() -> str:
    """Make the text of the page.

    Raises
    ------
    MapError
        If the film table has no films of compressible oils.
    """
    known = catalogue_bearings()
    charts = [_chart(*quantity) for quantity in QUANTITIES]
    record = {
        **_tables(),
        "bearing": {name: _record(geometry) for name, geometry in known.items()},
        "oil": dict(_oils()),
        "names": {"line": _LINE, "point": _POINT},
        "loads": LOADS.tolist(),
        "charts": {
            f"catalogue-{name}": {
                "low": low,
                "high": high,
                "factor": factor,
                "curves": [[place, key] for place in range(2) for key in keys],
            }
            for name, _, _, factor, (low, high), keys in QUANTITIES
        },
    }
    text = json.dumps(_short(record), separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    asked = Section("asked", "Bearing, oil, speed and temperature", [*_inputs(list(known), list(record["oil"]))])
    found = Section("films", "Films, stiffness, damping and capacitance", [tag("div", *charts, class_="charts")])
    told = sentences(
        [
            f"{len(known)} bearings: cylindrical rollers, needles and balls; inner geometry of most is estimated.",
            "Contacts of one rolling element: flooded, smooth, isothermal films of pure rolling; the outer ring rests.",
            "No line: the tables have no film there, or refuse it. `ehdmaps solve` says why.",
            "Capacitance of the oil with gas beside it behind the contact; the gap is where the oil of a ball ends.",
        ]
    )
    data = Markup(f'<script type="application/json" id="tables">{text}</script>')
    script = files("ehdmaps.report").joinpath("catalogue.js").read_text(encoding="utf-8")
    sections = [asked, found, Section("notes", "What this is", [told, data])]
    return document(
        "Films of catalogue bearings", "Read from the film tables of ehdmaps.", sections, [Moving("", script)]
    )


@cache
def catalogue_bearings() -> dict[str, BearingGeometry | BallGeometry]:
    """Bearings of all lists, by designation."""
    found: dict[str, BearingGeometry | BallGeometry] = {}
    makers: Sequence[tuple[Sequence[str], Callable[[str], BearingGeometry | BallGeometry]]] = (
        (tuple(BEARINGS), BearingGeometry.named),
        (designations(), designated),
        (needle_designations(), designated),
        (ball_designations(), ball_estimate),
    )
    for names, make in makers:
        for name in names:
            with suppress(EhdmapsError):
                found.setdefault(name, make(name))
    return found


def _record(geometry: BearingGeometry | BallGeometry) -> dict[str, Any]:
    """Contacts of a bearing of steel, and its entrainment speed by that of the inner ring."""
    speed = geometry.entrainment_speed(1.0)
    if isinstance(geometry, BearingGeometry):
        contacts = [
            [one.radius, one.reduced_modulus, float(one.structural_approach(1.0))]
            for one in geometry.contacts(STEEL, "iso16281")
        ]
        return {"kind": "line", "speed": speed, "length": geometry.roller_length, "contacts": contacts}
    return {"kind": "point", "speed": speed, "contacts": [_ellipse(one) for one in geometry.contacts(STEEL)]}


def _ellipse(one: Ellipse) -> list[float]:
    """Numbers of a dry ellipse by the load 1 N, in the order of `_POINT`."""
    a = float(one.semi_axes(1.0)[0])
    return [
        one.rolling_radius,
        one.reduced_modulus,
        one.ellipticity,
        a**3,
        float(one.max_pressure(1.0)) / a,
        float(one.approach(1.0)) / a**2,
        float(one.stiffness(1.0)),
        min(one.widest_film, 1e9),
        2.0 * math.pi * math.sqrt(one.rolling_radius * one.transverse_radius),
    ]


def _oils() -> Iterator[tuple[str, dict[str, Any]]]:
    """Oils with names, and classes of ISO 3448, over temperature."""
    for name in (*LUBRICANTS, *(f"ISO VG {grade}" for grade in CLASSES)):
        try:
            oil = Lubricant.named(name)
        except EhdmapsError:  # a class that is too thin for its viscosity index
            continue
        if oil.density_law == "incompressible":
            continue
        places = np.linspace(*TEMPERATURES, 141)
        states = oils.oil_states(oil, places)
        good = np.flatnonzero(np.isfinite(states.alpha))
        while good.size > 1:
            low, high = float(places[good[0]]), float(places[good[-1]])
            if (found := _series(oil, low, high)) is not None:
                yield name, {"low": low, "high": high, "fitted": states.fitted, **found}
                break
            good = good[5:]  # a rule for alpha ends where an oil is cold


def _series(oil: Lubricant, low: float, high: float) -> dict[str, Any] | None:
    """Chebyshev series of the states of an oil over temperature; None where they do not hold it."""
    x = np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))
    tried = np.linspace(-1.0, 1.0, 101)

    def read(places: FloatArray) -> FloatArray:
        states = oils.oil_states(oil, 0.5 * ((high - low) * places + low + high))
        exponents = states.exponents if np.any(np.ptp(states.exponents, axis=1)) else states.exponents[:, :1]
        return np.column_stack([np.log(states.viscosity), np.log(states.alpha), exponents])

    coefficients = np.polynomial.chebyshev.chebfit(x, read(x), _DEGREE)
    if not np.max(np.abs(np.polynomial.chebyshev.chebval(tried, coefficients).T - read(tried))) < _CLOSE:
        return None
    viscosity, alpha, *exponents = coefficients.T.tolist()
    return {"viscosity": viscosity, "alpha": alpha, "exponents": exponents}


def _short(value: Any) -> Any:
    """A record whose numbers have `DIGITS` digits."""
    if isinstance(value, dict):
        return {key: _short(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_short(one) for one in value]
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def _coded(array: npt.NDArray[Any]) -> str:
    """An array as text."""
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode()


def _axis(places: FloatArray) -> dict[str, Any]:
    """Nodes of an axis along which splines are, and what makes their coefficients of values."""
    knots = knots_of(places)
    inverse = np.linalg.inv(BSpline.design_matrix(places, knots, DEGREE).toarray())
    return {"nodes": places.tolist(), "knots": knots.tolist(), "inverse": inverse.ravel().tolist()}


def _part(part: Nodes) -> dict[str, Any]:
    """One part of the table of lines."""
    axes: Axes = part.axes
    return {
        "zeta": _axis(axes.zeta),
        "size": _axis(axes.size),
        "alpha": axes.alpha.tolist(),
        "bend": axes.bend.tolist(),
        "values": _coded(part.values[..., :KEPT].astype("<f4")),
        "codes": _coded(part.codes[..., :3]),
    }


def _tables() -> dict[str, Any]:
    """Both tables, the constants by which they are read, and what capacitances need."""
    try:
        table = shipped_tables().tables["dowson-higginson"]
    except KeyError:
        raise MapError("film table: has no films of compressible oils; make it again") from None
    points = shipped_point_table().nodes
    axes = points.axes
    holes = np.where(points.codes[..., 0] == point_nodes.HOLE, nodes.CODES, 0).astype(np.uint8)
    return {
        "line": {"piezoviscous": _part(table.piezoviscous), "isoviscous": _part(table.isoviscous)},
        "point": {
            **{name: _axis(getattr(axes, name)) for name in ("zeta", "size", "shape")},
            "alpha": axes.alpha.tolist(),
            "bend": axes.bend.tolist(),
            "values": _coded(points.values[..., :4].astype("<f4")),
            "codes": _coded(holes),
        },
        "constants": _constants(),
        "gap": _gaps(),
    }


def _constants() -> dict[str, Any]:
    """Constants of the tables and of what they refuse, by their names in Python."""
    curvature = Lubricant.named(DEFAULT_OIL).at(333.15).isotherm().density_curvature
    homes: tuple[tuple[Any, tuple[str, ...]], ...] = (
        (coordinates, ("ALPHA", "HARDENING_L", "BENDING_L", "LEAST_ALPHA")),
        (oils, ("MATCHED", "BESIDE", "VALLEY_WIDTH")),
        (nodes, ("BEYOND_HEAVY", "BEYOND_FLAT", "BEYOND_LIGHT", "FARTHEST", "CODES", "LEAST_ERROR", "LARGEST_ERROR")),
        (films, ("WORST_ERROR",)),
        (closed_form, ("HEAVIEST_LOAD_NUMBER", "LIGHTEST_LOAD_NUMBER", "THICKEST_FILM")),
        (hertz, ("LARGEST_PRESSURE",)),
        (point_nodes, ("KNEE", "KNEE_OF_KAPPA", "KNEE_OF_L", "KNEE_L")),
        (point_films, ("LIGHTEST",)),
        (dielectric, ("VACUUM",)),
    )
    found = {name: getattr(home, name) for home, names in homes for name in names}
    mapped = [[oils.mapping_factor(field.name, fitted) for field in FILMS[:3]] for fitted in (True, False)]
    fields = [{"scale": field.scale, "rigid": field.rigid_slope, "fades": field.fades} for field in FILMS[:KEPT]]
    return {
        **found,
        "SLACK": 1e-9,
        "ROELANDS_PRESSURE": ROELANDS_PRESSURE,
        "MAPPED": mapped,
        "FIELDS": fields,
        "POINT_SLOPES": [field.rigid_slope for field in point_nodes.FILMS[:4]],
        "DENSER": DENSITY_RISE * curvature,
        "STIFFER": curvature,
    }


def _gaps() -> dict[str, Any]:
    """Splines, quadratures and numbers of `ehdmaps.electrics.gaps`."""
    beside, around = gaps._beside_lines(), gaps._beside_points()
    across, along = around.get_knots()
    places, weights = np.polynomial.legendre.leggauss(dielectric._PLACES)
    place, weight = 0.5 * (places + 1.0), 0.5 * weights
    strips, shares = np.polynomial.legendre.leggauss(2 * gaps._STRIPS)
    return {
        "lines": {"x": beside.x.tolist(), "c": beside.c.tolist()},
        "points": {"x": across.tolist(), "y": along.tolist(), "c": around.get_coeffs().tolist()},
        "strips": [strips[gaps._STRIPS :].tolist(), (2.0 * shares[gaps._STRIPS :]).tolist()],
        "shares": {
            "point": [place.tolist(), (2.0 * place * weight).tolist()],
            "line": [np.sqrt(1.0 - place**2).tolist(), weight.tolist()],
        },
        "THIN": gaps._THIN,
        "THICK": gaps._THICK,
        "THICKEST": gaps._THICKEST,
        "LONGEST": gaps.LONGEST,
        "POINT": gaps._POINT,
        "LINE": gaps._LINE,
    }


def contact_numbers(
    name: str, oil: str, load: FloatArray, speed: float, temperature: float
) -> list[dict[str, FloatArray]]:
    """The numbers that the page shows of the inner and the outer contact, as Python reads them.

    Parameters
    ----------
    name, oil : str
        Designation of the bearing and name of the oil.
    load : array (n,)
        Loads of a rolling element [N].
    speed : float
        Entrainment speed [m/s].
    temperature : float
        T [K].
    """
    geometry, lubricant = catalogue_bearings()[name], Lubricant.named(oil)
    if isinstance(geometry, BearingGeometry):
        lines = geometry.contacts(STEEL, "iso16281")
        return [_of_line(one, lubricant, load, geometry.roller_length, speed, temperature) for one in lines]
    return [_of_point(one, lubricant, load, speed, temperature) for one in geometry.contacts(STEEL)]


def _of_line(
    contact: LineContact, oil: Lubricant, load: FloatArray, length: float, speed: float, temperature: float
) -> dict[str, FloatArray]:
    """Numbers of a contact of a roller."""
    w = load / length
    read = shipped_tables().of(oil).films(contact, oil, w, speed, temperature)
    dry = np.array([contact.structural_compliance(float(one)) for one in w])
    k = 1.0 / (dry + read.film_compliance)
    electric = line_capacitance(contact, oil, w, speed, temperature, PERMITTIVITY)
    whole = {"stiffness": k, "damping": read.loss_compliance * k**2, "capacitance": electric.capacitance}
    films = {"offset": read.film_offset, "central": read.central_film, "minimum": read.minimum_film}
    return films | {key: values * length for key, values in whole.items()}


def _of_point(
    contact: Ellipse, oil: Lubricant, load: FloatArray, speed: float, temperature: float
) -> dict[str, FloatArray]:
    """Numbers of a contact of a ball."""
    read = shipped_point_table().films(contact, oil, load, speed, temperature)
    electric = point_capacitance(contact, oil, load, speed, temperature, PERMITTIVITY, OUTER_GAP)
    whole = {"stiffness": read.stiffness, "damping": read.damping, "capacitance": electric.capacitance}
    return {"offset": read.film_offset, "central": read.central_film, "minimum": read.minimum_film, **whole}


def _chart(name: str, words: str, unit: str, factor: float, ends: tuple[float, float], keys: tuple[str, ...]) -> Markup:
    """A chart of what the page shows first."""
    speed = BearingGeometry.named(SHOWN["bearing"]).entrainment_speed(SHOWN["speed"] * math.pi / 30.0)
    temperature = SHOWN["temperature"] + 273.15
    both = contact_numbers(SHOWN["bearing"], SHOWN["oil"], LOADS, speed, temperature)
    curves = [
        Curve(
            f"{place}, {key}" if keys[1:] else place,
            factor * numbers[key],
            (SEQUENCE[1], SEQUENCE[4])[side],
            dash="5 3" if key == "minimum" else "",
        )
        for side, (place, numbers) in enumerate(zip(_PLACES, both, strict=True))
        for key in keys
    ]
    load = log_axis("load of the rolling element", "N", np.array([LOADS[0], LOADS[-1]]))
    across = log_axis(words, unit, np.array(ends))
    return figure(Chart(f"catalogue-{name}", words[0].upper() + words[1:], "", load, across, LOADS, curves))


def _inputs(bearings: list[str], lubricants: list[str]) -> Iterator[Markup]:
    """Fields of what can be asked, and the table of one load."""
    names = tag("datalist", *(tag("option", name) for name in bearings), id="catalogue-bearings")
    chosen = [
        (
            "bearing",
            "designation",
            tag("input", list="catalogue-bearings", id="catalogue-bearing", value=SHOWN["bearing"]),
        ),
        ("oil", "oil", tag("select", *(tag("option", name) for name in lubricants), id="catalogue-oil")),
    ]
    for name, words, value in (
        ("speed", "speed of the inner ring [rpm]", SHOWN["speed"]),
        ("temperature", "temperature [degC]", SHOWN["temperature"]),
        ("load", "load of a rolling element [N]", SHOWN["load"]),
        ("permittivity", "permittivity of the oil", PERMITTIVITY),
        ("gap", "gap where the oil ends [mm], balls", 1e3 * OUTER_GAP),
    ):
        given = tag("input", type="number", step="any", id=f"catalogue-{name}", value=float(value))
        chosen.append((name, words, given))
    yield tag(
        "p", *(tag("label", f"{words} ", entry, " ", for_=f"catalogue-{name}") for name, words, entry in chosen), names
    )
    yield tag("p", id="catalogue-problem", class_="warning")
    rows = [
        ("central film [um]", "central", "1e6"),
        ("minimum film [um]", "minimum", "1e6"),
        ("k [N/um]", "stiffness", "1e-6"),
        ("c [N s/m]", "damping", "1"),
        ("capacitance [pF]", "capacitance", "1e12"),
    ]
    body = [
        tag("tr", tag("th", words, scope="row"), tag("td", class_="number"), tag("td", class_="number"),
            data_key=key, data_factor=factor)
        for words, key, factor in rows
    ]  # fmt: skip
    head = tag("tr", *(tag("th", words, scope="col") for words in ("at the load", *_PLACES)))
    yield tag("table", tag("thead", head), tag("tbody", *body), id="catalogue-table")
