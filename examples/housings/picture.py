"""Surface of a mesh in a drawing that goes into a figure."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.colors import LightSource
from matplotlib.figure import Figure

from examples.housings.designs import Housing, Place
from examples.housings.mesh import Mesh

_MM = 1e3
_VIEWS = ((22.0, -55.0), (22.0, 125.0), (-25.0, -55.0))
_COLOUR = (0.72, 0.78, 0.84)
_EDGE = (0.2, 0.2, 0.2, 0.35)


def housing_figure(housing: Housing, mesh: Mesh) -> Figure:
    """Surface of a housing from two sides and from below, with seats and sensors named.

    Parameters
    ----------
    housing : Housing
        Gives title, seats and sensors.
    mesh : Mesh
        Mesh of the housing.
    """
    figure = Figure(figsize=(15.0, 5.6), layout="constrained")
    figure.suptitle(f"{housing.title}: {len(mesh.elements)} second-order tetrahedra, {mesh.positions.size} coordinates")
    used, triangles = np.unique(mesh.surface[:, :3], return_inverse=True)
    corners = mesh.positions[used] * _MM
    places: Mapping[str, Place] = {**{name: seat.centre for name, seat in housing.seats.items()}, **housing.sensors}
    low, high = corners.min(axis=0), corners.max(axis=0)
    for index, (elevation, azimuth) in enumerate(_VIEWS):
        panel = figure.add_subplot(1, len(_VIEWS), index + 1, projection="3d", computed_zorder=False)
        panel.plot_trisurf(
            *corners.T,
            triangles=triangles.reshape(-1, 3),
            color=_COLOUR,
            edgecolor=_EDGE,
            linewidth=0.3,
            lightsource=LightSource(azdeg=azimuth - 30.0, altdeg=50.0 if elevation > 0.0 else -50.0),
        )
        for name, place in places.items():
            at = np.array(place) * _MM
            panel.scatter(*at, s=14, color="#c8102e" if name in housing.sensors else "#1f5fa8", zorder=3)
            panel.text(*at, f" {name}", fontsize=6.5, zorder=4)
        panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
        panel.set(xlabel="x, mm", ylabel="y, mm", zlabel="z, mm")
        panel.set_box_aspect(high - low)
        panel.view_init(elevation, azimuth)
        panel.tick_params(labelsize=6)
    return figure
