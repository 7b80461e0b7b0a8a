"""The energy balance of a run as variables of its dataset."""

from __future__ import annotations

import xarray as xr

from mbs.transient.energy import EnergyBalance

_TERMS = (
    ("energy_in", "energy that came in, by source; of an element that does not say what it stores its whole work"),
    ("energy_out", "energy that was dissipated, by whom; integration: by the method of integration"),
    ("energy_stored", "change of stored energy from beginning to end"),
)


def with_energy(dataset: xr.Dataset, energy: EnergyBalance) -> xr.Dataset:
    """A dataset with the energy balance of its run, term by term [J].

    Parameters
    ----------
    dataset : xarray.Dataset
        What a run recorded.
    energy : EnergyBalance
        The balance of the run.
    """
    sources, sinks = {"loads": energy.loads}, dict(energy.parts)
    stores = {"kinetic": energy.kinetic, "elastic": energy.elastic}
    for entry in energy.elements:
        if not entry.told:
            sources[entry.name] = entry.work
            continue
        sources[f"turning of {entry.name}"] = entry.driven or 0.0
        sources[f"speed on {entry.name}"] = entry.by_speed
        sinks[entry.name], stores[entry.name] = entry.dissipated or 0.0, entry.change or 0.0
    sinks["integration"] = energy.numerical
    for (name, words), terms in zip(_TERMS, (sources, sinks, stores), strict=True):
        dim, attributes = f"{name}_term", {"units": "J", "long_name": words}
        dataset = dataset.assign({name: (dim, list(terms.values()), attributes)}).assign_coords({dim: list(terms)})
    words = "what the energy balance of the run does not close"
    return dataset.assign(energy_residual=((), energy.residual, {"units": "J", "long_name": words}))
