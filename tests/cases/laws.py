"""Film fields and maps for the tests of the contact law: closed forms, quick to evaluate, known everywhere."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.special import erf

from ehdmaps.maps import schema
from ehdmaps.maps.contact_curve import ContactCurve, Curve
from ehdmaps.maps.kernels.ends import one_end
from ehdmaps.maps.records import DERIVED, contacts_json, record_json
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.closed_form import FormulaSolver, HertzSolver
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.films import moes_central_and_slope, rolling_film_damping
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import film_from_moes, moes_groups
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import Status, contact_solution

NU308 = BearingGeometry.named("NU308").without_clearance
OIL = Lubricant.named("FVA3")
CONTACTS = NU308.contacts(STEEL, "iso16281")
LINE = LineContact("line", 5.515e-3, STEEL, "half_space", reference_depth=5e-3)


@dataclass(frozen=True)
class ValleyField:
    """Moes' film formula with a valley at M = 2.5: damping falls by a factor ten within 30 % of load."""

    line_contacts: tuple[LineContact, ...] = CONTACTS
    load_range: tuple[float, float] = (100.0, 1e6)
    speed_range: tuple[float, float] = (0.05, 10.0)
    temperature_range: tuple[float, float] = (293.15, 393.15)
    depth: float = 0.9
    width: float = 0.2
    dry: bool = False

    @property
    def contacts(self):
        return tuple(contact.name for contact in self.line_contacts)

    def first_loads(self, speeds, temperatures):
        """The lowest load everywhere; see `FilmField.first_loads`."""
        return np.full((len(speeds), len(temperatures)), self.load_range[0])

    @property
    def ends(self):
        """The highest load everywhere; see `FilmField.ends`."""
        return one_end(self.load_range[1])

    def locked_factors(self, contact, loads, speed, temperature):
        """Nothing is known of films that oscillate; see `FilmField.locked_factors`."""

    def film_differences(self, contact, loads, speed, temperature):
        """Nothing is known of films that oscillate; see `FilmField.film_differences`."""

    def films(self, contact, loads, speeds, temperatures):
        solids = self.line_contacts[self.contacts.index(contact)]
        out = np.empty((3, *loads.shape))
        for k, temperature in enumerate(temperatures):
            state = OIL.at(float(temperature))
            alpha = state.pressure_viscosity.pressure_viscosity
            for j, speed in enumerate(speeds):
                w = loads[:, j, k]
                oil = (float(speed), state.viscosity, alpha, solids.radius, solids.reduced_modulus)
                M, L = moes_groups(w, *oil)
                H, slope = moes_central_and_slope(M, L)
                film = film_from_moes(H, float(speed), state.viscosity, solids.radius, solids.reduced_modulus)
                z = (np.log(M) - math.log(2.5)) / self.width
                valley = np.exp(-(z**2))
                # The offset is changed so that its derivative is exactly the changed compliance.
                offset = film * np.exp(0.15 * self.width * math.sqrt(math.pi) / 2.0 * erf(z))
                exponent = slope * M / H
                out[0, :, j, k] = offset
                out[1, :, j, k] = -offset * (exponent + 0.15 * valley) / w
                loss = rolling_film_damping(film, state.viscosity, solids.radius) * (film * exponent / w) ** 2
                out[2, :, j, k] = loss * (1.0 - self.depth * valley)
        return out[0], out[1], out[2]


SMALL_FIELD = ValleyField(load_range=(1e3, 1e6), speed_range=(0.3, 3.0), temperature_range=(313.15, 343.15))
"""Quick to compile, with the valley inside."""


def exact_curve(field, contacts, loads, speed, temperature) -> Curve:
    """Series curve of a field at loads within its map, without any table."""
    speeds, temperatures = np.array([speed]), np.array([temperature])
    curves = [ContactCurve(field, contact, speeds, temperatures) for contact in contacts]
    total = None
    for curve in curves:
        piece = curve.with_structure(curve.mapped(np.asarray(loads)[:, None, None]))
        total = piece if total is None else total + piece
    return Curve(total.approach[:, 0, 0], total.slope[:, 0, 0], total.loss[:, 0, 0])


def exact_law(field, contacts, loads, speed, temperature):
    """Approach, stiffness and damping of `exact_curve`."""
    curve = exact_curve(field, contacts, loads, speed, temperature)
    return curve.approach, 3.0 * np.cbrt(loads) ** 2 / curve.slope, curve.loss_ratio * loads


LOADS = tuple(np.geomspace(1e3, 1e6, 19))


def dataset_of(
    solver=None,
    contacts=CONTACTS,
    loads=LOADS,
    speeds=(0.3, 0.6, 1.2, 2.4),
    temperatures=(313.15, 323.15, 333.15, 343.15),
    bearing=NU308,
) -> xr.Dataset:
    """Map dataset of a closed-form solver, as the schema wants it."""
    solver = solver or FormulaSolver()
    shape = (len(contacts), len(loads), len(speeds), len(temperatures))
    fields = [variable for variable in schema.table() if variable.required and not variable.axis]
    values = {
        variable.name: np.zeros(shape, dtype=object if variable.dtype == "str" else variable.dtype)
        for variable in fields
    }
    values["reason"][...] = ""
    for i, contact in enumerate(contacts):
        for k, speed in enumerate(speeds):
            for m, temperature in enumerate(temperatures):
                films = solver.solve_line(contact, OIL, tuple(loads), speed, temperature)
                for j, film in enumerate(films):
                    solution = contact_solution(film, contact, OperatingPoint(loads[j], speed, temperature))
                    for name, array in values.items():
                        if name != "filled":
                            array[i, j, k, m] = getattr(solution, name)
    coordinates = {
        "contact": [contact.name for contact in contacts],
        "load": loads,
        "entrainment_speed": speeds,
        "temperature": temperatures,
    }
    attributes = dict.fromkeys(schema.ATTRIBUTES, "")
    attributes |= {
        "schema_version": schema.SCHEMA_VERSION,
        "contacts": contacts_json(contacts),
        "structural_law": contacts[0].structural_law,
        "geometry": record_json(bearing.record() if bearing else None),
        "lubricant": record_json(OIL.record()),
    }
    return schema.dataset(coordinates, values, attributes)


def dry_dataset(**axes) -> xr.Dataset:
    """Map dataset of the solver `hertz`."""
    return dataset_of(HertzSolver(), **axes)


def with_holes(dataset, *places, status=Status.STAGNATED):
    """Copy of a dataset that has no solution at some places (contact, load, speed, temperature)."""
    copy = dataset.copy(deep=True).drop_vars(list(DERIVED), errors="ignore")
    for place in places:
        copy["status"].values[place] = int(status)
        for name in ("film_offset", "film_compliance", "loss_compliance", "central_film", "minimum_film"):
            copy[name].values[place] = np.nan
    return copy
