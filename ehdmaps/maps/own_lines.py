"""Films between refinement lines, whether the contacts of a map share them or each has its own.

Isothermal films of one oil go by Moes' M and L at a temperature, so that one reference contact stands for all. Heat has
a group of its own, QL = -(d eta0/dT) u^2/k_f, in which contacts of equal M and L differ: the outer contact then has
lines of its own, on the axes of those of the inner one (`ehdmaps.maps.schema.OWN`).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce

import numpy as np
import xarray as xr

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.maps import schema
from ehdmaps.maps.backbone import BackboneField
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.records import contacts_from_json
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant

_OF_OUTER = "outer"


def has_own_lines(group: xr.Dataset) -> bool:
    """Whether each contact has lines of its own.

    Parameters
    ----------
    group : xarray.Dataset
        Group "backbone" of a map.
    """
    return f"{schema.OWN}film_offset" in group.variables


def lines_by_contact(
    group: xr.Dataset, contacts: Sequence[LineContact]
) -> tuple[tuple[xr.Dataset, LineContact, tuple[LineContact, ...]], ...]:
    """Lines, the contact that they were solved for, and the contacts that are read from them.

    Parameters
    ----------
    group : xarray.Dataset
        Group "backbone" of a map.
    contacts : sequence of LineContact
        Contacts that are wanted.

    Raises
    ------
    MapError
        If the record of the reference contact does not read.
    """
    (reference,) = contacts_from_json(f"[{group.attrs[schema.REFERENCE_CONTACT]}]")
    if not has_own_lines(group):
        return ((group, reference, tuple(contacts)),)
    found = []
    for contact in contacts:
        own = contact.name == _OF_OUTER
        found.append((_of_outer(group) if own else group, contact if own else reference, (contact,)))
    return tuple(found)


def _of_outer(group: xr.Dataset) -> xr.Dataset:
    """The lines of the outer contact, named as those of a reference contact."""
    names = {name: str(name).removeprefix(schema.OWN) for name in group.data_vars if str(name).startswith(schema.OWN)}
    return group[list(names)].rename(names)


def line_field(
    group: xr.Dataset,
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    load_range: tuple[float, float],
    speed_range: tuple[float, float],
    temperature_range: tuple[float, float],
) -> FilmField:
    """Films of contacts between their lines: a `BackboneField`, or one a contact where each has its own.

    Parameters
    ----------
    group : xarray.Dataset
        Group "backbone" of a map.
    contacts : sequence of LineContact
        Contacts that are wanted.
    lubricant : Lubricant
        The oil.
    load_range, speed_range, temperature_range : tuple of float
        Range of the map's axes [N/m], [m/s], [K].

    Raises
    ------
    MapError
        If a line has too few solved points to be read.
    """
    fields = tuple(
        BackboneField(lines, reference, read, lubricant, load_range, speed_range, temperature_range)
        for lines, reference, read in lines_by_contact(group, contacts)
    )
    return fields[0] if len(fields) == 1 else _OwnFields(fields)


class _OwnFields:
    """Films of contacts that each have their own lines; a `FilmField`.

    Parameters
    ----------
    fields : tuple of BackboneField
        One a contact.
    """

    def __init__(self, fields: tuple[BackboneField, ...]) -> None:
        self.contacts = tuple(name for field in fields for name in field.contacts)
        self.load_range = fields[0].load_range
        self.speed_range = fields[0].speed_range
        self.temperature_range = fields[0].temperature_range
        self.dry = False
        self._fields = {name: field for field in fields for name in field.contacts}

    def films(
        self, contact: str, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Film offset, film compliance and loss compliance of one contact; see `FilmField.films`."""
        return self._fields[contact].films(contact, loads, speeds, temperatures)

    def first_loads(self, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """Loads from which on the lines are read, the lowest of all contacts; see `FilmField.first_loads`."""
        return reduce(np.minimum, (field.first_loads(speeds, temperatures) for field in self._fields.values()))

    def locked_factors(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> FloatArray | None:
        """Factors of the closed formula of the locked film; see `FilmField.locked_factors`."""
        return self._fields[contact].locked_factors(contact, loads, speed, temperature)

    def film_differences(
        self, contact: str, loads: FloatArray, speed: float, temperature: float
    ) -> tuple[FloatArray, ComplexArray] | None:
        """What films with memory leave out; see `FilmField.film_differences`."""
        return self._fields[contact].film_differences(contact, loads, speed, temperature)
