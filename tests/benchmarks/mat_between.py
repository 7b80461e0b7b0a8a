"""How far linear interpolation between the points of a map is from its contact law: what users of `--to mat` get.

Run: python -m tests.benchmarks.mat_between MAP.nc

At 500 random places of the inner contact, evenly over the logarithms of load and speed and over temperature, the seed
is fixed. The interpolation is the one of MATLAB's and Octave's `interpn` over these axes.
"""

from __future__ import annotations

import sys

import numpy as np
from scipy.interpolate import RegularGridInterpolator

import ehdmaps
from ehdmaps.exports.map_curves import curves, rough_layers

PLACES, CONTACT = 500, "inner"
FIELDS = ("approach", "stiffness", "damping")


def main() -> None:
    """Print relative differences of each field: median, 95 % quantile, largest."""
    emap = ehdmaps.open_map(sys.argv[1])
    loads, speeds, temperatures = (emap.dataset[name].values for name in ("load", "entrainment_speed", "temperature"))
    axes = (np.log(loads), np.log(speeds), temperatures)
    random = np.random.default_rng(1)
    places = np.column_stack([random.uniform(axis[0], axis[-1], PLACES) for axis in axes])
    field, layers = emap.film_field((CONTACT,)), rough_layers(emap)
    contacts = tuple(contact for contact in emap.contacts if contact.name == CONTACT)
    wanted = [curves(field, contacts, np.exp([w]), float(np.exp(u)), float(T), layers) for w, u, T in places]
    for name in FIELDS:
        values = emap.dataset[name].sel(contact=CONTACT).values
        between = RegularGridInterpolator(axes, values)(places)
        apart = np.abs(between / np.array([getattr(one, name)[0] for one in wanted]) - 1.0)
        print(
            f"{name:10} median {np.median(apart):.2g}, 95 % {np.quantile(apart, 0.95):.2g}, largest {apart.max():.2g}"
        )


if __name__ == "__main__":
    main()
