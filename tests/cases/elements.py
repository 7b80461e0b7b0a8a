"""Bodies, stiffnesses and an element for the tests of systems, small enough to be solved by hand."""

from __future__ import annotations

import numpy as np

from mbs.model.body import Inertia
from mbs.model.elements import ElementDefaults, Forces, Port

MASS = Inertia(2.0, 0.01, 0.02)


def stiff(**freedoms):
    order = ("x", "y", "z", "theta_x", "theta_y", "theta_z")
    return np.diag([freedoms.get(key, 0.0) for key in order])


def force(**freedoms):
    return np.diag(stiff(**freedoms))


class OneSided(ElementDefaults):
    """A contact that only pushes: f = -k max(y - gap, 0)^1.5."""

    def __init__(self, name, on, against="ground", k=1e12, gap=0.0):
        self.name, self.k, self.gap = name, k, gap
        self.ports = (Port(on, against),)

    def evaluate(self, displacement, velocity, operation):
        depth = max(displacement[1] - self.gap, 0.0)
        f, K = np.zeros(6), np.zeros((6, 6))
        f[1], K[1, 1] = -self.k * depth**1.5, 1.5 * self.k * depth**0.5
        return Forces(f, K, np.zeros((6, 6)))
