"""`EHDMap`: a map file as a value, the contact laws made from it, and its curves over load.

`curves` are dense, at one speed and temperature, for charts and tables. They come from the same film field as the laws
do, without the table in between.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property, partial
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, MapError
from ehdmaps.maps import schema
from ehdmaps.maps.backbone import FILMS
from ehdmaps.maps.compilation import OF_TABLE, Resolution
from ehdmaps.maps.film_field import (
    RIGID,
    FilmField,
    FirstLoads,
    LowLoads,
    first_loads,
    known_from,
    low_loads,
)
from ehdmaps.maps.grid_field import GridField, line_field, lines_by_contact
from ehdmaps.maps.law import SPEED_REACH, ContactLaw, LawKind, OutsidePolicy
from ehdmaps.maps.law_errors import LawErrors
from ehdmaps.maps.reading import check_content, check_tables, content_sha256, own_points, read_map, validate
from ehdmaps.maps.records import (
    bearing_from_json,
    check_oil,
    completed,
    contacts_of,
    lubricant_from_json,
    read_json,
    record_json,
    restructured,
    supply_from_json,
    surface_from_json,
)
from ehdmaps.maps.rolling_film import NAMES as ROLLING
from ehdmaps.maps.rolling_film import LaterLines, RollingFilm, rolling_film
from ehdmaps.maps.usable import check_backbone, check_loads, known_grid
from ehdmaps.physics.approach import StructuralLaw
from ehdmaps.physics.bearing import BearingGeometry, with_law
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.heat import INLET_HEAT, ISOTHERMAL
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.surface import SMOOTH, Surface

if TYPE_CHECKING:
    import xarray as xr

    from ehdmaps.maps.edges.continued import ContinuedField
    from ehdmaps.maps.edges.reach import Reach

_CLOSED_FORMS = ("formula", "hertz")
"""Solvers whose films differ from those of the film table by tens of percent: their laws are held at the edges of the
map, where those of the table would join with a kink."""

_MOST_LAWS = 6
"""Laws of a map that are kept: those of a roller and of both its contacts, with two supplies."""


class EHDMap:
    """A map of stiffness, damping, approach and films over load, entrainment speed and temperature.

    Parameters
    ----------
    dataset : xarray.Dataset
        Points as `ehdmaps.maps.schema` describes them, of any version.
    backbone : xarray.Dataset, optional
        The group of refinement lines of the law.
    where : str
        Name for messages.

    Attributes
    ----------
    backbone : xarray.Dataset or None
        The refinement lines; None also where they do not stand for the points, see `own_points`.

    Raises
    ------
    MapError
        With everything in which the dataset is no map.
    """

    def __init__(self, dataset: xr.Dataset, backbone: xr.Dataset | None = None, where: str = "map") -> None:
        validate(dataset, where, backbone)
        if why := own_points(dataset, backbone):
            dataset, backbone = _with_own_points(dataset, why), None
        self._dataset = completed(dataset, contacts_of(dataset))
        self.backbone = backbone

    def __getstate__(self) -> dict[str, object]:
        """For other processes: without the laws that were made of it, and what these were read from."""
        return {name: value for name, value in self.__dict__.items() if name not in ("_laws", "_fields")}

    @property
    def dataset(self) -> xr.Dataset:
        """All that the map holds; of an old map also the films that follow from it."""
        return self._dataset

    @property
    def attributes(self) -> Mapping[str, Any]:
        """Statements of the map on itself: settings, versions, findings of its check."""
        return self.dataset.attrs

    def axis(self, name: str) -> FloatArray:
        """Values of an axis [N/m], [m/s] or [K], shape (n,).

        Parameters
        ----------
        name : {"load", "entrainment_speed", "temperature"}
            The axis.
        """
        return np.asarray(self.dataset[name].values, dtype=np.float64)

    def points(self, name: str) -> FloatArray | None:
        """A variable at all points, in the order of `ehdmaps.maps.schema.DIMS`; None where the map does not hold it.

        Parameters
        ----------
        name : str
            Such as "central_film".
        """
        return self.dataset[name].transpose(*schema.DIMS).values if name in self.dataset else None

    @cached_property
    def solver(self) -> str:
        """Name of the solver of its films; empty where it states none."""
        return str(self.dataset.attrs.get("solver", ""))

    def with_structure(
        self,
        structural_law: StructuralLaw,
        reference_depth: float | None = None,
        roller_length: float | None = None,
        fe_approaches: Mapping[str, float] | None = None,
    ) -> EHDMap:
        """The same films between solids of another structural law.

        Approach, stiffness, damping and their errors are derived from the films by that law, and so are the laws of
        the map that is returned; it is a map like any other, which may be saved. The errors of damping of a map of
        schema 1 are not known by another law, hence NaN.

        Parameters
        ----------
        structural_law : {"iso16281", "palmgren", "half_space", "fe"}
            Law of the elastic part of the approach, see `ehdmaps.physics.approach`.
        reference_depth : float, optional
            d* of half_space [m]; that of the map's contacts if left out. Those of a bearing have D/e.
        roller_length : float, optional
            Length of the whole roller, for iso16281 and palmgren [m]; that of the map's contacts if left out.
        fe_approaches : mapping of str to float, optional
            Approaches by finite elements of the contacts by their names, for fe [m]; those of the map's contacts if
            left out, or those that come with the package for the map's bearing.

        Raises
        ------
        InputError
            If there is no such law, if it lacks a length, or if it does not hold for the loads of the map.
        """
        known = fe_approaches or {}
        given = (
            replace(
                contact,
                reference_depth=contact.reference_depth if reference_depth is None else reference_depth,
                roller_length=contact.roller_length if roller_length is None else roller_length,
                fe_approach=known.get(contact.name, contact.fe_approach),
            )
            for contact in self.contacts
        )
        contacts = tuple(with_law(contact, structural_law, self.bearing) for contact in given)
        if contacts == self.contacts:
            return self
        dataset = restructured(self.dataset, contacts)
        if schema.CHECKSUM in dataset.attrs:
            dataset.attrs[schema.CHECKSUM] = content_sha256(dataset, self.backbone)
        return EHDMap(dataset, self.backbone)

    def with_surface(self, surface: Surface) -> EHDMap:
        """The same films, whose laws are those of other surfaces where nothing else is asked for.

        Parameters
        ----------
        surface : Surface
            Roughness of the surfaces.
        """
        return self if surface == self.surface else self._stating(schema.SURFACE, record_json(surface), surface.smooth)

    def with_supply(self, supply: OilSupply) -> EHDMap:
        """The same films, whose laws are those of another oil supply where nothing else is asked for.

        Parameters
        ----------
        supply : OilSupply
            Oil before each contact.
        """
        return self if supply == self.supply else self._stating(schema.OIL_SUPPLY, record_json(supply), supply.flooded)

    def _stating(self, attribute: str, text: str, usual: bool) -> EHDMap:
        """The same films with another attribute of the job; without it where that is the usual one."""
        dataset = self.dataset.copy()
        dataset.attrs.pop(attribute, None)
        if not usual:
            dataset.attrs[attribute] = text
        return self._of_the_same_films(dataset)

    def _of_the_same_films(self, dataset: xr.Dataset) -> EHDMap:
        """A map that differs in attributes of which no table of a law depends: what was made is kept for both."""
        if schema.CHECKSUM in dataset.attrs:
            dataset.attrs[schema.CHECKSUM] = content_sha256(dataset, self.backbone)
        other = EHDMap(dataset, self.backbone)
        other._laws = self._laws
        return other

    @cached_property
    def contacts(self) -> tuple[LineContact, ...]:
        """The line contacts, in the order of the contact axis, with their structural law."""
        return contacts_of(self.dataset)

    @property
    def structural_law(self) -> StructuralLaw:
        """The law of the elastic part of the approach."""
        return self.contacts[0].structural_law

    @cached_property
    def lubricant(self) -> Lubricant:
        """The oil."""
        oil = lubricant_from_json(self.dataset.attrs["lubricant"])
        check_oil(oil, self.dataset["temperature"].values[[0, -1]].tolist())
        return oil

    @cached_property
    def supply(self) -> OilSupply:
        """The oil supply that the job of the map states, flooded where it states none; points are flooded anyway."""
        stated = self.dataset.attrs.get(schema.OIL_SUPPLY)
        return FLOODED if stated is None else supply_from_json(stated)

    @cached_property
    def surface(self) -> Surface:
        """Surfaces that the job of the map states, smooth where it states none; its points are those of smooth ones."""
        stated = self.dataset.attrs.get(schema.SURFACE)
        return SMOOTH if stated is None else surface_from_json(stated)

    @cached_property
    def bearing(self) -> BearingGeometry | None:
        """The bearing; None for a bare contact."""
        return bearing_from_json(self.dataset.attrs["geometry"])

    def law(
        self,
        kind: LawKind,
        outside: OutsidePolicy = "error",
        supply: OilSupply | None = None,
        surface: Surface | None = None,
    ) -> ContactLaw:
        """Make a contact law from the map; takes about a second, some seconds with rough surfaces.

        What was made is kept: the same law is a moment's work when it is asked for again, with counts of its own.

        Parameters
        ----------
        kind : {"series", "inner", "outer", "line"}
            A roller in equilibrium between both raceways, or one of the contacts of the map.
        outside : {"error", "clamp", "asymptote"}
            What happens outside the map, see `ContactLaw`.
        supply : OilSupply, optional
            Oil before each contact; what the job of the map states if left out, see `supply`.
        surface : Surface, optional
            Roughness of the surfaces; that of the map's job if left out, smooth where it states none.

        Raises
        ------
        InputError
            For a kind that the map does not have.
        MapError
            If the map has one load only, or if no two loads are known at any speed and temperature, see `reach`.
        """
        by_name = {contact.name: contact for contact in self.contacts}
        allowed = [name for name in get_args(LawKind) if name in by_name or (name == "series" and "inner" in by_name)]
        if kind not in allowed:
            raise InputError(f"contact law, kind: got {kind!r}; allowed in this map: {', '.join(allowed)}")
        key = kind, outside, supply or self.supply, self.surface if surface is None else surface
        if key in self._laws:
            return self._laws[key].again(self.law_errors)
        names = ("inner", "outer") if kind == "series" else (kind,)
        contacts = tuple(by_name[name] for name in names)
        check_loads(self.axis("load"), contacts)
        if len(self._laws) >= _MOST_LAWS:
            self._laws.pop(next(iter(self._laws)))
        field, continued = self._field_of_law(names, contacts)
        self._laws[key] = ContactLaw(
            kind,
            contacts,
            self.lubricant,
            field,
            outside,
            self._resolution,
            rolling=self.rolling_film,
            supply=key[2],
            surface=key[3],
            errors=self.law_errors,
            continued=continued,
            title="" if self.bearing is None else self.bearing.title,
        )
        return self._laws[key]

    @cached_property
    def _laws(self) -> dict[tuple[LawKind, OutsidePolicy, OilSupply, Surface], ContactLaw]:
        """Laws that were made, the latest last."""
        return {}

    @cached_property
    def _fields(self) -> dict[tuple[str, ...], tuple[FilmField, ContinuedField | None]]:
        """Films that laws were made from, by contacts."""
        return {}

    def _field_of_law(
        self, names: tuple[str, ...], contacts: tuple[LineContact, ...]
    ) -> tuple[FilmField, ContinuedField | None]:
        """Films of a law, and those that go on beyond the map; what one oil supply reads of them serves for others."""
        if names not in self._fields:
            field = self.film_field(names)
            goes_on = self.solver not in _CLOSED_FORMS
            self._fields[names] = field, _continued(field, contacts, self.lubricant) if goes_on else None
        return self._fields[names]

    @property
    def from_table(self) -> bool:
        """True where the films of its laws are read from the film table, as its points were."""
        return schema.FILM_TABLE in self.dataset.attrs

    @cached_property
    def inlet_heat(self) -> bool:
        """True where the films of its laws are read from the film table with heat in the inlet, by its rule."""
        return self.from_table and self.physics == INLET_HEAT

    @cached_property
    def physics(self) -> str:
        """Word for what its films know of heat, see `ehdmaps.physics.heat.PHYSICS`."""
        settings = read_json(self.dataset.attrs.get("solver_settings") or "{}", "solver_settings")
        return str(settings.get("physics", ISOTHERMAL))

    @property
    def own_points(self) -> str:
        """Reason why its points are somebody's own, from which alone its laws are made; empty where they are not.

        That is so where films were changed after the map was made, and where the film table has become another one
        since: what a law reads is what the file says. What the check of its former laws found is then left out.
        """
        return str(self.dataset.attrs.get(schema.OWN_POINTS, ""))

    @property
    def known_between(self) -> bool:
        """True where films between its points are known, from refinement lines or from the film table."""
        return self.backbone is not None or self.from_table

    @cached_property
    def law_errors(self) -> LawErrors:
        """Bounds of the errors of the laws of this map."""
        return LawErrors(self, self.contacts, self.lubricant)

    def film_field(self, contacts: tuple[str, ...] | None = None) -> FilmField:
        """Film between the points, what a law is made from: of the film table, the backbone, or the map's own grid.

        Parameters
        ----------
        contacts : tuple of str, optional
            Those that are wanted; all if left out.

        Raises
        ------
        MapError
            If no law can be made of them.
        """
        chosen = tuple(contact for contact in self.contacts if contacts is None or contact.name in contacts)
        if self.from_table or self.backbone is not None:
            self._check_films(chosen)
            ranges = self._range("load"), self._range("entrainment_speed"), self._range("temperature")
            if self.backbone is not None:
                return line_field(self.backbone, chosen, self.lubricant, *ranges)
            from ehdmaps.maps.table_field import TableField  # with the film table, that other maps do not need

            return TableField(chosen, self.lubricant, *ranges, inlet_heat=self.inlet_heat)
        reach, read = known_grid(self.dataset, chosen)
        data = self.dataset.sel(contact=[contact.name for contact in chosen]).transpose(*schema.DIMS, ...)
        offset, compliance, loss = (np.asarray(data[name].values, dtype=np.float64) for name in FILMS)
        if reach.whole:  # with its standstill
            return GridField(chosen, self.lubricant, *reach.axes, offset, compliance, loss)
        axes = reach.loads, reach.speeds, reach.temperatures
        offset, compliance, loss = (reach.part(np.where(read, film, np.nan)) for film in (offset, compliance, loss))
        return GridField(chosen, self.lubricant, *axes, offset, compliance, loss, reach=reach)

    def reach(self, contacts: tuple[str, ...] | None = None) -> Reach:
        """Loads, speeds and temperatures at which the films of contacts are known.

        Parameters
        ----------
        contacts : tuple of str, optional
            Those of a law; all, as of a roller between both raceways, if left out.

        Raises
        ------
        MapError
            If no law can be made of them.
        """
        chosen = tuple(contact for contact in self.contacts if contacts is None or contact.name in contacts)
        self._check_films(chosen)
        if self.known_between:
            return self._whole_reach
        return known_grid(self.dataset, chosen)[0]

    @cached_property
    def rolling_film(self) -> RollingFilm | None:
        """Rolling force and mass flow at any load, speed and temperature; None where the map does not hold them.

        Maps of schema 1 and 2 and those of the solvers `formula` and `hertz` hold none. Where points are missing, see
        `reach`, both go on straight.
        """
        lines: xr.Dataset | LaterLines | None = self.backbone
        values = [self.points(name) for name in ROLLING]
        found = [array for array in values if array is not None]
        if len(found) < len(ROLLING) or not np.any(self.axis("entrainment_speed") > 0.0):
            return None
        reach, read = self._whole_reach, np.ones(found[0].shape, dtype=bool)
        if not self.known_between:
            try:
                reach, read = known_grid(self.dataset, self.contacts)
            except MapError:
                return None
        if self.from_table:
            from ehdmaps.maps.table_field import table_lines

            loads, speeds, kelvins = (self._range(axis) for axis in schema.DIMS[1:])
            lines = partial(table_lines, self.contacts, self.lubricant, loads, speeds, kelvins, SPEED_REACH)
        both = reach.part(np.stack([np.where(read, array, np.nan) for array in found]))
        axes = reach.loads, reach.speeds, reach.temperatures
        return rolling_film(both, reach.part(read), axes, lines, self.contacts, self.lubricant, self.inlet_heat)

    @cached_property
    def low_loads(self) -> LowLoads | None:
        """Loads where laws take films as those of rigid contacts, and whether that is right; None without any film."""
        moving = self.dataset["entrainment_speed"].values > 0.0
        if not np.any(moving) or not np.any(self.dataset["film_offset"].values > 0.0):
            return None
        temperatures = self.dataset["temperature"].values.astype(np.float64)
        (lowest, _), speeds = self._range("load"), self._range("entrainment_speed")
        first: FirstLoads
        if self.from_table:
            first = partial(first_loads, self.contacts, self.lubricant, lowest, RIGID)
        elif self.backbone is None:
            try:
                first = self.reach().first_loads
            except MapError:
                return None
        else:
            start = max(_known_from(group) for group, *_ in lines_by_contact(self.backbone, self.contacts))
            first = partial(first_loads, self.contacts, self.lubricant, lowest, start)
        ends = float(temperatures[0]), float(temperatures[-1])
        return low_loads(first, self.contacts, self.lubricant, lowest, speeds, ends)

    def check_usable(self, contacts: tuple[str, ...] | None = None) -> None:
        """Refuse a map of whose films no law of these contacts can be made; only what the law reads is looked at.

        Parameters
        ----------
        contacts : tuple of str, optional
            Those of the law; all if left out.

        Raises
        ------
        MapError
            With every reason.
        """
        chosen = tuple(contact for contact in self.contacts if contacts is None or contact.name in contacts)
        check_loads(self.dataset["load"].values, chosen)
        self._check_films(chosen)

    def _check_films(self, chosen: tuple[LineContact, ...]) -> None:
        """Refuse films of these contacts that cannot be interpolated."""
        if self.from_table:
            return  # the field itself tells what the table lacks
        if self.backbone is None:
            known_grid(self.dataset, chosen)
        else:
            ranges = self._range("load"), self._range("entrainment_speed")
            for group, reference, read in lines_by_contact(self.backbone, chosen):
                check_backbone(group, reference, read, self.lubricant, *ranges)

    @property
    def _whole_reach(self) -> Reach:
        """Reach of laws whose films are known all over the map."""
        from ehdmaps.maps.edges.reach import whole_reach

        return whole_reach(self._axes)

    @property
    def _axes(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Loads [N/m], entrainment speeds [m/s] and temperatures [K]."""
        return self.axis("load"), self.axis("entrainment_speed"), self.axis("temperature")

    @property
    def _resolution(self) -> Resolution | None:
        """Nodes of laws with films from the film table; None for those that others have."""
        return OF_TABLE if self.from_table else None

    def _range(self, axis: str) -> tuple[float, float]:
        """Lowest value above zero, and highest value, of an axis."""
        values = self.axis(axis)
        positive = values[values > 0.0]
        if not positive.size:
            raise MapError(f"map: has a backbone and no {axis} above zero; generate the map again")
        return float(positive[0]), float(positive[-1])


def _with_own_points(dataset: xr.Dataset, why: str) -> xr.Dataset:
    """A map whose points are its user's own, without what was stated of the laws that it had."""
    stated = (schema.FILM_TABLE, schema.UNSERVED, schema.CHECKSUM)
    kept = {
        name: value
        for name, value in dataset.attrs.items()
        if name not in stated and not str(name).startswith(("law_", "tolerance"))
    }
    own = dataset.copy()
    own.attrs = {**kept, schema.OWN_POINTS: why}
    return own


def _known_from(group: xr.Dataset) -> float:
    """Lowest zeta from which on all lines of one reference contact are solved."""
    group = group.transpose(*schema.BACKBONE_DIMS, ...)
    solved = np.all([np.isfinite(group[name].values) for name in FILMS], axis=0)
    return known_from(group[schema.BACKBONE_DIMS[0]].values, solved)


def open_map(path: str | PathLike[str], structural_law: StructuralLaw | None = None) -> EHDMap:
    """Read a map file written by `ehdmaps generate`; all of it, the file is closed again.

    Variables that are not in the table of `ehdmaps.maps.schema` are left alone.

    Parameters
    ----------
    path : str or path
        The file.
    structural_law : {"iso16281", "palmgren", "half_space", "fe"}, optional
        Law by which approach, stiffness and damping are derived from the films; that of the map's job if left out. A
        map of a bare contact has the length of one law only: see `EHDMap.with_structure`.

    Raises
    ------
    MapError
        If it cannot be read, is no map, or was changed since it was made.
    InputError
        If there is no such structural law, or it does not suit the map.
    """
    name = fspath(path)
    dataset, backbone = read_map(name)
    check_tables(dataset, name, backbone)
    # Before anything is derived: who changed a film is told that, and not what follows from it.
    check_content(dataset, backbone, name)
    emap = EHDMap(dataset, backbone, name)
    return emap if structural_law is None else emap.with_structure(structural_law)


def _continued(field: FilmField, contacts: tuple[LineContact, ...], lubricant: Lubricant) -> ContinuedField | None:
    """Films that go on beyond their map."""
    from ehdmaps.maps.edges.continued import continued_field  # with the film table, that other maps do not need

    return continued_field(field, contacts, lubricant)
