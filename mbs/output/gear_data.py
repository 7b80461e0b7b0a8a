"""What statics says of gear meshes: the force on the first gear, its parts, and what takes the axial one."""

from __future__ import annotations

import numpy as np
import xarray as xr

from mbs.gears.gear import GearMesh
from mbs.model.equilibrium import Equilibrium
from mbs.scene.assembly import Model

_ROUND_OFF = 1e-9
_PARTS = ("tangential", "radial", "axial")


def gear_forces(model: Model, balance: Equilibrium) -> dict[str, tuple[float, float, float]]:
    """Tangential, radial and axial force on the first gear of each mesh [N], by its name.

    Parameters
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium of the model.

    Returns
    -------
    dict of str to (float, float, float)
        Tangential on the pitch circle, positive against the turn +x; radial away from the other gear; axial along x.
    """
    found = {}
    for index in model.system.select(GearMesh):
        mesh = model.system.elements[index].element
        assert isinstance(mesh, GearMesh)
        force = balance.forces[index][:3]
        # the sum of both normals of the flanks is twice the radial part of one, along the centres
        towards = mesh.rows[0, :3] + mesh.rows[1, :3]
        towards = towards / np.linalg.norm(towards)
        along = np.cross([1.0, 0.0, 0.0], towards)
        found[mesh.name] = float(-force @ along), float(-force @ towards), float(force[0])
    return found


def with_gears(dataset: xr.Dataset, model: Model, balance: Equilibrium) -> xr.Dataset:
    """The result of statics with the forces of its gear meshes; the same without gears.

    Parameters
    ----------
    dataset : Dataset
        The result.
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium of the model.
    """
    found = gear_forces(model, balance)
    if not found:
        return dataset
    attributes = {"units": "N", "long_name": "force on the first gear: tangential (against +x), radial (apart), axial"}
    forces = xr.DataArray(
        np.array(list(found.values())),
        {"gear_mesh": list(found), "part": list(_PARTS)},
        ("gear_mesh", "part"),
        attrs=attributes,
    )
    return dataset.assign(gear_force=forces)


def gear_lines(model: Model, balance: Equilibrium) -> list[str]:
    """Lines on the gear meshes of an equilibrium.

    Parameters
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium of the model.
    """
    pairs = {mesh.name: mesh.pair for mesh in model.gears}
    lines = []
    for name, (tangential, radial, axial) in gear_forces(model, balance).items():
        pair = pairs[name]
        size = max(abs(tangential), abs(radial))
        if abs(axial) <= _ROUND_OFF * size:
            lines.append(f"{name}: {abs(tangential):.6g} N tangential, {radial:.6g} N radial on each gear")
            continue
        lines.append(
            f"{name}: {abs(tangential):.6g} N tangential, {radial:.6g} N radial, {axial:+.6g} N axial on {pair.on}, "
            f"{-axial:+.6g} N on {pair.against}"
        )
        bodies = [place.partition(":")[0] for place in (pair.on, pair.against)]
        rigid = [body for body in bodies if _is_rigid_in_x(model, body)]
        if rigid:
            lines.append(
                f"  {' and '.join(rigid)}: no freedom x, so that the axial force is taken by what is not in the scene; "
                "for a locating bearing give the body the freedom x, and a spring along x"
            )
    return lines


def _is_rigid_in_x(model: Model, body: str) -> bool:
    """Whether no coordinate of a body moves any of its frames along x."""
    return not any(np.any(frame.transform[0]) for frame in model.system.body(body).frames.values())
