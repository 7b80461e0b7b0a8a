"""`EHDMap`: a map file as a value, and the contact laws made from it."""

from __future__ import annotations

from functools import cached_property
from os import PathLike, fspath
from typing import get_args

import numpy as np
import xarray as xr

from ehdmaps.errors import InputError, MapError
from ehdmaps.maps import schema
from ehdmaps.maps.backbone import BackboneField
from ehdmaps.maps.checksum import check_content
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.grid_field import GridField
from ehdmaps.maps.law import ContactLaw, LawKind, OutsidePolicy
from ehdmaps.maps.reading import read_map
from ehdmaps.maps.records import bearing_from_json, check_oil, contacts_from_json, lubricant_from_json
from ehdmaps.maps.usable import check_backbone, check_usable
from ehdmaps.maps.validation import validate
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant


class EHDMap:
    """A map of stiffness, damping, approach and films over load, entrainment speed and temperature.

    Parameters
    ----------
    dataset : xarray.Dataset
        As `ehdmaps.maps.schema` describes it.
    backbone : xarray.Dataset, optional
        The group of refinement lines of the law.
    where : str
        Name for messages.

    Attributes
    ----------
    dataset : xarray.Dataset
        All that the map holds.

    Raises
    ------
    MapError
        With everything in which the dataset is no map.
    """

    def __init__(self, dataset: xr.Dataset, backbone: xr.Dataset | None = None, where: str = "map") -> None:
        validate(dataset, where, backbone)
        self.dataset = dataset
        self.backbone = backbone

    @cached_property
    def contacts(self) -> tuple[LineContact, ...]:
        """The line contacts, in the order of the contact axis."""
        contacts = contacts_from_json(self.dataset.attrs["contacts"])
        axis = tuple(str(name) for name in self.dataset["contact"].values)
        names = tuple(contact.name for contact in contacts)
        if names != axis:
            raise MapError(
                f"map, attribute contacts: names {', '.join(names)}; the contact axis has {', '.join(axis)}; "
                "they must be alike; generate the map again"
            )
        return contacts

    @cached_property
    def lubricant(self) -> Lubricant:
        """The oil."""
        oil = lubricant_from_json(self.dataset.attrs["lubricant"])
        check_oil(oil, self.dataset["temperature"].values[[0, -1]].tolist())
        return oil

    @cached_property
    def bearing(self) -> BearingGeometry | None:
        """The bearing; None for a bare contact."""
        return bearing_from_json(self.dataset.attrs["geometry"])

    def law(self, kind: LawKind, outside: OutsidePolicy = "error") -> ContactLaw:
        """Make a contact law from the map; takes about a second.

        Parameters
        ----------
        kind : {"series", "inner", "outer", "line"}
            A roller in equilibrium between both raceways, or one of the contacts of the map.
        outside : {"error", "clamp", "asymptote"}
            What happens outside the map, see `ContactLaw`.

        Raises
        ------
        InputError
            For a kind that the map does not have.
        MapError
            If the map has holes left, or clusters of filled ones, or its backbone has.
        """
        by_name = {contact.name: contact for contact in self.contacts}
        allowed = [name for name in get_args(LawKind) if name in by_name or (name == "series" and "inner" in by_name)]
        if kind not in allowed:
            raise InputError(f"contact law, kind: got {kind!r}; allowed in this map: {', '.join(allowed)}")
        names = ("inner", "outer") if kind == "series" else (kind,)
        check_usable(self.dataset, names)
        if self.backbone is not None:
            check_backbone(self.backbone)
        return ContactLaw(kind, tuple(by_name[name] for name in names), self.lubricant, self.film_field(names), outside)

    def film_field(self, contacts: tuple[str, ...] | None = None) -> FilmField:
        """Film between the solved points, what a law is made from.

        Parameters
        ----------
        contacts : tuple of str, optional
            Those that are wanted; all if left out.
        """
        chosen = tuple(contact for contact in self.contacts if contacts is None or contact.name in contacts)
        if self.backbone is not None:
            return self._backbone_field(self.backbone, chosen)
        data = self.dataset.sel(contact=[contact.name for contact in chosen]).transpose(*schema.DIMS, ...)
        loads = data["load"].values.astype(np.float64)
        dry = np.array([contact.structural_compliance(loads) for contact in chosen])[:, :, None, None]
        stiffness = data["stiffness"].values.astype(np.float64)
        return GridField(
            line_contacts=chosen,
            lubricant=self.lubricant,
            loads=loads,
            speeds=data["entrainment_speed"].values.astype(np.float64),
            temperatures=data["temperature"].values.astype(np.float64),
            film_offset=data["film_offset"].values.astype(np.float64),
            film_compliance=1.0 / stiffness - dry,
            loss_compliance=data["damping"].values / stiffness**2,
        )

    def _backbone_field(self, group: xr.Dataset, contacts: tuple[LineContact, ...]) -> FilmField:
        """Field from the group of refinement lines."""
        (reference,) = contacts_from_json(f"[{group.attrs[schema.REFERENCE_CONTACT]}]")
        loads, speeds, temperatures = (
            self.dataset[name].values.astype(np.float64) for name in ("load", "entrainment_speed", "temperature")
        )
        positive = speeds[speeds > 0.0]
        return BackboneField(
            group,
            reference,
            contacts,
            self.lubricant,
            load_range=(float(loads[0]), float(loads[-1])),
            speed_range=(float(positive[0]), float(positive[-1])),
            temperature_range=(float(temperatures[0]), float(temperatures[-1])),
        )


def open_map(path: str | PathLike[str]) -> EHDMap:
    """Read a map file written by `ehdmaps generate`; all of it, the file is closed again.

    Variables that are not in the table of `ehdmaps.maps.schema` are left alone.

    Raises
    ------
    MapError
        If it cannot be read, is no map, or was changed since it was made.
    """
    name = fspath(path)
    emap = EHDMap(*read_map(name), name)
    check_content(emap.dataset, emap.backbone, name)
    return emap
