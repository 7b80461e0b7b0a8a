"""Points of one bearing of any kind in words: what was asked, the page of a single point, or a table of several."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.units import DAMPER, FILM, PRESSURE, RPM, SPRING, Display
from mbs.bearings.films import SIDES
from mbs.life import CLEAN, CONTAMINATED, LEAST_RATIO, Elements, a_iso, fatigue_limit, ratio_of_films
from mbs.model.findings import MEANINGLESS, Severity, WithFindings
from mbs.output.one_bearing.kind import (
    Column,
    Description,
    Kind,
    Pair,
    Points,
    Row,
    first_row,
    no_dust,
    row_of,
    shown,
)
from mbs.scene.fields import FORCE, HERTZ, MICROMETRE

if TYPE_CHECKING:
    from mbs.model.equilibrium import Equilibrium

_ROUND_OFF = 1e-8
"""Part of the largest of several numbers below which one of them is shown as zero."""


def point_text(kind: Kind, description: Description, points: Points, beside: Sequence[str] = ()) -> list[str]:
    """Lines that describe all points, and warn.

    Parameters
    ----------
    kind : Kind
        Kind of the bearing.
    description : Description
        What they have in common.
    points : sequence of sequence
        Points by load, then by speed.
    beside : sequence of str
        Further lines on a single point.
    """
    everything = [point for line in points for point in line]
    lines = heading(kind, description, everything[0])
    if len(everything) == 1:
        (only,) = everything
        lines += [*_page(kind, description, only), *beside, *_loaded(kind, only), *kind.last(only)]
    else:
        lines += _table(kind, description, everything)
    return unsound_lines(everything) + lines + kind.remarks(everything, description) + warning_lines(everything)


def heading(kind: Kind, description: Description, point: Any) -> list[str]:
    """Tell what was computed, and what of it was assumed or estimated.

    Parameters
    ----------
    kind : Kind
        Kind of the bearing.
    description : Description
        What all points have in common.
    point : object
        One of them.
    """
    geometry = point.geometry
    return [
        f"{geometry.title}: law {description.law}; {description.films}",
        *(f"  {line}" for line in kind.about(description, point)),
        *([f"  assumed: {', '.join(description.assumed)}"] if description.assumed else []),
        *(f"  {words}" for words in (geometry.spelled, geometry.estimated) if words),
    ]


_HERTZ = Pair("Hertz pressure", PRESSURE, "hertz_pressure")
_FILMS = (Pair("smallest central film", FILM, "central_film"), Pair("smallest film", FILM, "minimum_film"))


def _page(kind: Kind, description: Description, point: Any) -> list[str]:
    """The numbers of one point."""
    row, ways = row_of(kind, description, point), ("along", "across", "axial")[: 3 if kind.axial else 2]

    def in_ways(label: str, display: Display, name: str) -> str:
        values = [display.value(row[f"{name}_{way}"]) for way in ways]
        largest = max(map(abs, values))
        clean = (0.0 if abs(value) < _ROUND_OFF * largest else value for value in values)
        return f"  {label:32s} {display.unit:8s} " + " ".join(f"{value:12.5g}" for value in clean)

    def heads(*words: str) -> str:
        return f"  {'':32s} {'':8s} " + " ".join(f"{word:>12s}" for word in words)

    between, after = kind.pairs(point)
    load, tilts = FORCE.text(point.size, 6), list[str]()
    speed = RPM.text(point.inner_speed)
    if kind.axial:
        load += f" radial and {FORCE.text(point.axial, 6)} axial"
        speed += f", outer ring {RPM.text(point.outer_speed)}" if point.outer_speed else ""
    if description.tilts:
        tilts = [f"  {'tilt about y and z':32s} {'mrad':8s} {1e3 * row['tilt_y']:12.5g} {1e3 * row['tilt_z']:12.5g}"]
    return [
        f"{load} on the inner ring at {speed}: entrainment speed {point.entrainment_speed:.4g} m/s",
        heads(*ways) + " the load" * (not kind.axial),
        in_ways("inner ring moves by", MICROMETRE, "displacement"),
        in_ways("stiffness", SPRING, "stiffness"),
        in_ways("damping, low-frequency limit", DAMPER, "damping"),
        *tilts,
        heads(*SIDES) + " raceway",
        *(
            f"  {label:32s} {display.unit:8s} "
            + " ".join(f"{shown(no_dust(display.value(x))):>12s}" for x in row[name])
            for label, display, name in (_HERTZ, *between, *_FILMS, *after)
        ),
        lambda_line(row["film_parameter"], MICROMETRE.text(description.roughness))
        + kind.beside_lambda(point, description),
        *(
            f"  {line}"
            for line in (
                *kind.closing(point, row),
                *_passing(kind.element, row),
                *_electric(description, row),
                *_life(kind.element, point, row),
            )
        ),
    ]


def _passing(element: str, row: Row) -> list[str]:
    """A line on the frequencies at which the bearing repeats itself; none at rest."""
    if row["element_frequency"] == 0.0:
        return []
    cage, outer, inner, turns = (
        HERTZ.text(row[f"{name}_frequency"]) for name in ("cage", "outer_pass", "inner_pass", "element")
    )
    return [
        f"passes of the outer raceway {outer} (BPFO), of the inner raceway {inner} (BPFI); turns of the cage {cage} "
        f"(FTF), of a {element} {turns} (BSF), in pure rolling"
    ]


def _electric(description: Description, row: Row) -> list[str]:
    """Lines on a bearing whose oil has a permittivity; none of others."""
    if description.dielectric is None:
        return []
    from mbs.output.one_bearing.electric import electric_lines  # with what only they need

    return electric_lines(description, row)


def _life(element: str, point: Any, row: Row) -> list[str]:
    """Lines on the life of one point: by its loads, and with its oil."""
    words = (
        f"equivalent load {FORCE.text(row['equivalent_load'])}, L10r {row['reference_life']:.4g} million turns "
        f"{rating_words(element, point)}"
    )
    kappa, film = row["viscosity_ratio"], row["film_parameter"]
    if math.isnan(kappa):
        return [words]
    own = "" if math.isnan(film) else f", {ratio_of_films(film):.2g} by the film"
    if kappa < LEAST_RATIO:
        return [words, f"viscosity ratio {kappa:.2g}{own}: below {LEAST_RATIO:g} ISO 281 has no a_ISO"]
    if point.geometry.thrust:
        return [words, f"viscosity ratio {kappa:.2g} by ISO 281{own}; a_ISO of thrust bearings: not yet"]
    factors = life_factors(element, point, row)
    return [
        words,
        f"viscosity ratio {kappa:.2g} by ISO 281{own}; with the former L10r is multiplied by a_ISO {factors[0]:.2g} in "
        f"slightly contaminated, {factors[1]:.2g} in filtered oil (e_C {CONTAMINATED:g}, {CLEAN:g})",
    ]


_POWERS = {"ball": "3", "roller": "10/3"}


def rating_words(element: str, point: Any) -> str:
    """Rule and rating of a life, and what another rating makes of it.

    Parameters
    ----------
    element : str
        Name of the rolling elements.
    point : object
        A point of the bearing.
    """
    power = _POWERS["ball" if element == "ball" else "roller"]
    return (
        f"(ISO/TS 16281) with C {FORCE.text(point.ratings[0])} by its inner geometry (ISO 281); with a maker's C: "
        f"(C/P)^{power}"
    )


def life_factors(element: str, point: Any, row: Row) -> list[float]:
    """Factors a_ISO in slightly contaminated and in filtered oil; NaN where ISO 281 has none, and for thrust bearings.

    Parameters
    ----------
    element : str
        Name of the rolling elements.
    point : object
        A point of the bearing.
    row : mapping
        Numbers of the point.
    """
    kind: Elements = "ball" if element == "ball" else "roller"
    kappa = row["viscosity_ratio"]
    if math.isnan(kappa) or point.geometry.thrust:
        return [math.nan, math.nan]
    limit = fatigue_limit(point.ratings[1], point.geometry.pitch_diameter, kind) / row["equivalent_load"]
    return [a_iso(kappa, cleanliness * limit, kind) for cleanliness in (CONTAMINATED, CLEAN)]


def _loaded(kind: Kind, point: Any) -> list[str]:
    """A line for each loaded rolling element."""
    angles, loads = point.elements.angle, first_row(point.elements.load)
    hidden = "; the others not shown" if point.loaded < angles.size else ""
    return [
        f"  {point.loaded} of {angles.size} {kind.element}s carry more than 1 % of the highest load{hidden}",
        f"  {kind.element:>6s} {'angle':>7s} {kind.heads[0]}".rstrip(),
        f"  {'':>6s} {'deg':>7s} {kind.heads[1]}".rstrip(),
        *(
            f"  {index:6d} {math.degrees(angles[index]):7.1f} {kind.of_one(point, index)}"
            for index in np.argsort(angles)
            if loads[index] > 0.01 * loads.max()
        ),
    ]


def _table(kind: Kind, description: Description, points: Sequence[Any]) -> list[str]:
    """A line for each point."""
    columns = [one for one in kind.columns if not (one.rough and description.surface.smooth)]
    if description.dielectric is not None:
        from mbs.output.one_bearing.electric import COLUMNS  # with what only they need

        columns += COLUMNS
    heads = ([one.head for one in columns], [one.unit for one in columns])
    lines = [_joined(columns, words).rstrip() for words in heads]
    for point in points:
        if point.failed:
            lines.append(hole_line(point.size, point.inner_speed))
            continue
        row = row_of(kind, description, point)
        lines.append(_joined(columns, [one.text(row) for one in columns]) + " !" * bool(point.problems))
    return lines


def _joined(columns: Sequence[Column], words: Sequence[str]) -> str:
    """A line of the table."""
    return " ".join(f"{word:>{one.width}s}" for one, word in zip(columns, words, strict=True))


WIDE_RANGE = 20.0
"""A range of loads whose end is further above its beginning is spaced, and drawn, in the logarithm."""

REGIMES = ((1.0, "boundary: the surfaces touch"), (3.0, "mixed: asperities touch"), (math.inf, "full film"))
"""What is usually said of Lambda below these values."""

ROUGHNESS = 0.3e-6
"""Combined rms roughness of both surfaces that is assumed where none is stated [m]."""


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


def matrix_line(balance: Equilibrium, index: int) -> str:
    """Stiffness and damping of an element of a machine along x, y and z.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium of the machine.
    index : int
        Which of its elements.
    """
    parts = (
        ", ".join(f"{axis} {display.factor * matrix[k, k]:.5g}" for k, axis in enumerate("xyz")) + f" {display.unit}"
        for matrix, display in (
            (balance.element_stiffness[index], SPRING),
            (balance.element_damping[index], DAMPER),
        )
    )
    return "  K " + "; C ".join(parts)
