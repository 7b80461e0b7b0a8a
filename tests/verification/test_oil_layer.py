"""Laws on an oil layer against starved solutions, whose meniscus is an unknown."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.maps.contact_curve import ContactCurve
from ehdmaps.maps.emap import open_map
from ehdmaps.maps.oil_layer import oil_layer
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.operating_point import OperatingPoint

SPEED, WARM = 1.0, 313.15


@pytest.mark.parametrize(("load", "ratio"), [(500.0, 0.8), (500.0, 0.5), (500.0, 0.3), (2e3, 0.5)])
def test_film_and_damping_of_light_contacts(reynolds_map, load, ratio):
    """The rule against the solver: the film, 2.5 % with the rounded corner at 0.8; c with the meniscus held, 20 %."""
    emap = open_map(reynolds_map)
    contact = emap.contacts[0]
    speeds, kelvins = np.array([SPEED]), np.array([WARM])
    layer = ratio * float(emap.rolling_film.flow("inner", load, SPEED, WARM))
    curve = ContactCurve(emap.film_field(), contact, speeds, kelvins)
    root = np.array([[[np.cbrt(load)]]])
    known = load >= float(curve.tail.load[0, 0])
    flooded = curve.mapped(root**3) if known else curve.below(root)
    film = oil_layer(contact, layer, curve.tail, emap.rolling_film, speeds, kelvins)(flooded)
    c = float(curve.with_structure(film).loss_ratio[0, 0, 0]) * load

    point = OperatingPoint(load, SPEED, WARM)
    solved = ReynoldsSolver().supplied_film(contact, emap.lubricant, point, OilSupply(layer)).film
    assert film.offset[0, 0, 0] == pytest.approx(solved.film_offset, rel=2.5e-2)
    compliance = contact.structural_compliance(load) + solved.film_compliance
    assert c == pytest.approx(solved.loss_compliance / compliance**2, rel=0.2)
