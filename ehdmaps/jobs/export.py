"""Curves of a map as a table for spreadsheets and other programs: SI, units in the header, a comment line first."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.jobs.curves import curves, film_between, rough_layers
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.rough_films import FILM_PARAMETER, FILM_SHARE, film_share
from ehdmaps.maps.rough_layer import RoughLayer
from ehdmaps.maps.usable import check_grid
from ehdmaps.outputs import MARK
from ehdmaps.program import plain

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
    """What is written.

    Attributes
    ----------
    contact : str
        "series", both contacts of a roller, or a contact of the map.
    speeds, temperatures : tuple of float
        [m/s], [K]; every pair is a curve.
    points : int
        Loads of a curve, evenly over their logarithm from the lowest to the highest of the map.
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
    if films:
        check_grid(emap.dataset, contacts)
    axis = emap.dataset["load"].values
    loads = np.geomspace(axis[0], axis[-1], chosen.points if axis.size > 1 else 1)
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
            found = curves(field, contacts, loads, speed, temperature, layers)
            columns = [loads, found.approach, found.film_offset, found.stiffness, found.damping]
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
    return film_share(layer, film, loads, speeds, temperatures)[:, 0, 0]
