"""Capacitance as a variable of a map."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.electrics.contact import electrics_of
from ehdmaps.electrics.dielectric import Dielectric, under_pressure
from ehdmaps.electrics.gaps import line_integral
from ehdmaps.physics.hertz import max_pressure

if TYPE_CHECKING:
    import xarray as xr

    from ehdmaps.maps.emap import EHDMap


def with_capacitance(emap: EHDMap, permittivity: float | Dielectric) -> xr.Dataset:
    """The dataset of a map with capacitances a length, and the ends of their bands, over load, speed and temperature.

    Parameters
    ----------
    emap : EHDMap
        The map. Its films have the rule's error, and those of the map are not added.
    permittivity : float or Dielectric
        Relative permittivity at the temperatures of the map, or all that is known of the oil.

    Returns
    -------
    xarray.Dataset
        `capacitance`, `capacitance_low`, `capacitance_high` [F/m]; NaN in holes. `to_dataframe().to_csv` makes a table.
    """
    oil = permittivity if isinstance(permittivity, Dielectric) else Dielectric(permittivity)
    data = emap.dataset
    names = ("capacitance", "capacitance_low", "capacitance_high")
    found = {name: data["central_film"] * np.nan for name in names}
    films = [data[name] for name in ("central_film", "minimum_film", "film_offset")]
    for contact in emap.contacts:
        for kelvin in data["temperature"].values:
            place = {"contact": contact.name, "temperature": kelvin}
            load, *here = (part.values for part in _broadcast(data["load"], *(film.sel(place) for film in films)))
            known = np.all([values > 0.0 for values in here], axis=0)
            whole = line_integral(contact, load[known], *(values[known] for values in here))
            pressure = np.asarray(max_pressure(load[known], contact.radius, contact.reduced_modulus))
            zone = under_pressure(
                oil.at(emap.lubricant, float(kelvin)), emap.lubricant, float(kelvin), pressure, "line"
            )
            numbers = electrics_of(whole, oil, emap.lubricant, float(kelvin), zone, 0.0, here[1][known])
            for name, values in zip(names, (numbers.capacitance, numbers.low, numbers.high), strict=True):
                filled = np.full(known.shape, np.nan)
                filled[known] = values
                found[name].loc[place] = filled
    ends = ("", ", gas behind the contacts", ", oil everywhere")
    return data.assign(
        {
            name: array.assign_attrs(units="F/m", long_name=f"capacitance a length of the contact{end}")
            for (name, array), end in zip(found.items(), ends, strict=True)
        }
    )


def _broadcast(*arrays: xr.DataArray) -> tuple[xr.DataArray, ...]:
    """Arrays over the same axes, in the order of the films."""
    import xarray as xr

    first, *films = arrays
    dims = films[0].dims
    return tuple(part.transpose(*dims) for part in xr.broadcast(first, *films))
