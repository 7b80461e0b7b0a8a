"""Temperatures, clearances and heat of bearings as variables of a dataset."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import xarray as xr

from mbs.bearings.thermal import BearingHeat, BearingState

_STATE: tuple[tuple[str, str, str, Callable[[BearingState], float]], ...] = (
    ("inner_raceway_temperature", "K", "temperature of the inner raceway", lambda state: state.inner),
    ("outer_raceway_temperature", "K", "temperature of the outer raceway", lambda state: state.outer),
    ("operating_clearance", "m", "diametral clearance in operation", lambda state: state.clearance.operating),
)
_CHANGES: tuple[tuple[str, str, str, Callable[[BearingState], float]], ...] = (
    ("stated_clearance", "m", "diametral clearance at 20 degC, not mounted", lambda state: state.clearance.stated),
    ("clearance_by_temperature", "m", "what expansion adds to it", lambda state: state.clearance.by_temperature),
    ("clearance_by_fits", "m", "what the fits add to it", lambda state: state.clearance.by_fits),
)


def _heat(read: Callable[[BearingHeat], float]) -> Callable[[BearingState], float]:
    """Read of the heat of a bearing; NaN where its temperatures are given."""
    return lambda state: math.nan if state.heat is None else read(state.heat)


_HEAT: tuple[tuple[str, str, str, Callable[[BearingState], float]], ...] = (
    ("oil_temperature", "K", "temperature of the oil in the bearing", lambda state: state.oil),
    ("friction_power", "W", "friction of the bearing", _heat(lambda heat: heat.friction)),
    ("added_power", "W", "what of it the scene adds to the rolling", _heat(lambda heat: heat.added)),
    ("heat_to_shaft", "W", "heat to the shaft", _heat(lambda heat: heat.to_shaft)),
    ("heat_to_housing", "W", "heat to the housing", _heat(lambda heat: heat.to_housing)),
    ("heat_to_oil", "W", "heat that the oil carries away", _heat(lambda heat: heat.to_oil)),
)

_States = Sequence[BearingState] | Sequence[Any]


def with_states(dataset: xr.Dataset, states: _States, dims: tuple[str, ...] = ()) -> xr.Dataset:
    """The dataset with temperatures and clearances of all bearings, and with their heat where there is any.

    Parameters
    ----------
    dataset : xarray.Dataset
        A result.
    states : sequence of BearingState
        One a bearing; nested for each of `dims`.
    dims : tuple of str
        Dims over which there are more of them, such as ("case", "speed").
    """
    everything = list(_flat(states))
    if not everything:
        return dataset
    rows = _STATE
    if any(state.clearance.operating != state.clearance.stated for state in everything):
        rows += _CHANGES
    if any(state.heat is not None for state in everything):
        rows += _HEAT
    first: Any = states
    for _ in dims:
        first = first[0]
    names = np.array([state.name for state in first], dtype=np.str_)
    variables = {
        name: ((*dims, "bearing"), np.array(_values(states, read)), {"units": unit, "long_name": words})
        for name, unit, words, read in rows
    }
    return dataset.assign_coords(bearing=names).assign(variables)


def _values(states: Any, read: Callable[[BearingState], float]) -> Any:
    """A number of each state, nested as they are."""
    return read(states) if isinstance(states, BearingState) else [_values(entry, read) for entry in states]


def _flat(states: Any) -> Any:
    """All states, one after the other."""
    if isinstance(states, BearingState):
        yield states
    else:
        for entry in states:
            yield from _flat(entry)
