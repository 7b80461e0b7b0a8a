"""Target `csv` of `ehdmaps export`: curves over load of a contact law as a table for spreadsheets and other programs.

SI, units in the header, a comment line first.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import Problems
from ehdmaps.exports.map_curves import curves, film_between, rough_layers
from ehdmaps.exports.target import Target, chosen_kind, chosen_place
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.rough_layer import FILM_PARAMETER, FILM_SHARE, RoughLayer, load_sharing
from ehdmaps.maps.usable import known_grid
from ehdmaps.outputs import MARK, TABLE, Output, check_outputs, write_text
from ehdmaps.program import count, plain
from ehdmaps.units import SPEED, TEMPERATURE, Display

COLUMNS = (
    "entrainment_speed [m/s]",
    "temperature [K]",
    "load [N/m]",
    "approach [m]",
    "film_offset [m]",
    "stiffness [N/m2]",
    "damping [N s/m2]",
)
FILMS = ("central_film", "minimum_film")
"""Films of one contact, which the map has at its points only: between them they are interpolated."""


@dataclass(frozen=True)
class Chosen:
    """Selection of what is written.

    Attributes
    ----------
    contact : str
        "series", both contacts of a roller, or a contact of the map.
    speeds, temperatures : tuple of float
        [m/s], [K]; every pair is a curve.
    points : int
        Loads of a curve, evenly over their logarithm from the lowest to the highest that is known there.
    """

    contact: str
    speeds: tuple[float, ...]
    temperatures: tuple[float, ...]
    points: int


def table(emap: EHDMap, chosen: Chosen, name: str) -> str:
    """Return the table: one line a load, curve after curve.

    Parameters
    ----------
    emap : EHDMap
        The map.
    chosen : Chosen
        Curves within its ranges.
    name : str
        Name of the map file, for the comment.

    Raises
    ------
    MapError
        If no contact law can be made from the map.
    """
    return "\n".join(_lines(emap, chosen, name)) + "\n"


def _lines(emap: EHDMap, chosen: Chosen, name: str) -> Iterator[str]:
    """Yield comment, header and rows."""
    names = ("inner", "outer") if chosen.contact == "series" else (chosen.contact,)
    contacts = tuple(contact for contact in emap.contacts if contact.name in names)
    field = emap.film_field(names)
    films = FILMS if len(contacts) == 1 else ()
    reach = known_grid(emap.dataset, contacts)[0] if films else emap.reach(names)
    points = chosen.points if reach.axes[0].size > 1 else 1
    layers = rough_layers(emap)
    rough = f", {emap.surface.label}" if layers else ""
    rough += "; central and minimum film and Lambda of smooth surfaces" if layers and films else ""
    title = plain(emap.dataset.attrs.get("title", "EHD map")).replace('"', "'")
    of = "inner and outer contact in series" if chosen.contact == "series" else f"{chosen.contact} contact"
    yield f"# {MARK}: {plain(name)}, {title}; {of}, per unit length of contact; films of the contact laws{rough}"
    of_roughness = (FILM_PARAMETER, FILM_SHARE) if films and layers else ()
    yield ",".join([*COLUMNS, *(f"{film} [m]" for film in films), *(f"{name} [1]" for name in of_roughness)])
    for temperature in chosen.temperatures:
        for speed in chosen.speeds:
            loads = np.geomspace(*reach.loads_at(speed, temperature), points)
            curve = curves(field, contacts, loads, speed, temperature, layers)
            columns = [loads, curve.approach, curve.film_offset, curve.stiffness, curve.damping]
            between = [film_between(emap, film, contacts[0].name, loads, speed, temperature) for film in films]
            columns += between
            if of_roughness:
                share = _share(field, layers[contacts[0].name], loads, speed, temperature)
                columns += [between[FILMS.index("minimum_film")] / emap.surface.roughness, share]
            for row in zip(*columns, strict=True):
                yield ",".join(f"{value:.10g}" for value in (speed, temperature, *row))


def _share(field: FilmField, layer: RoughLayer, loads: FloatArray, speed: float, temperature: float) -> FloatArray:
    """Share of the film in the load, over load."""
    speeds, temperatures = np.array([speed]), np.array([temperature])
    film = np.zeros((loads.size, 1, 1))
    if speed > 0.0 and not field.dry:
        film, _, _ = field.films(layer.contact.name, loads[:, None, None], speeds, temperatures)
    return load_sharing(layer, film, loads, speeds, temperatures)[0][:, 0, 0]


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what chooses the curves."""
    parser.add_argument("--speed", help='entrainment speed, such as "1.7 m/s"; default: all of the map')
    parser.add_argument("--temperature", help='of the raceways, such as "40 degC"; default: all of the map')
    parser.add_argument(
        "--contact", metavar="NAME", help="series | inner | outer | line; default: series, of a bare contact line"
    )
    parser.add_argument("--points", metavar="N", type=count, default=200, help="loads of a curve; default: 200")


def _write(emap: EHDMap, path: Path, output: Path | None, arguments: argparse.Namespace) -> str:
    """Write the table; by default beside the map."""
    output = output or path.with_suffix(".csv")
    check_outputs([Output("-o", output, TABLE)], [path])
    write_text(output, table(emap, _chosen(arguments, emap), path.name), TABLE)
    return f"{output}: written"


def _chosen(arguments: argparse.Namespace, emap: EHDMap) -> Chosen:
    """Read what is asked for; all problems at once."""
    problems = Problems()
    kind = chosen_kind(emap, arguments.contact, problems)

    def read(axis: str, text: str | None, unit: str, display: Display) -> tuple[float, ...]:
        if text is None:
            return tuple(map(float, emap.dataset[axis].values))
        return (chosen_place(emap, axis, text, unit, display, problems),)

    speeds = read("entrainment_speed", arguments.speed, "m/s", SPEED)
    temperatures = read("temperature", arguments.temperature, "K", TEMPERATURE)
    if arguments.points < 2:
        problems.append(f"--points: got {arguments.points}; allowed: 2 to 1024")
    problems.check()
    return Chosen(kind, speeds, temperatures, arguments.points)


TARGET = Target(
    summary="curves over load of stiffness, damping, approach and films",
    writes="MAP.csv",
    read_back_by="numpy",
    add_arguments=_add_arguments,
    write=_write,
)
