"""A contact law as its equations say, one place at a time: splines of scipy, roots by bisection, the solids' own laws.

It shares the coefficients of the table with the law in C, and no rule of reading them.
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
from scipy.interpolate import BSpline
from scipy.optimize import brentq

from ehdmaps.maps.kernels.ends import ends_of
from ehdmaps.maps.kernels.tables import COLDEST


class Line:
    """A table at one speed and temperature: load and damping of a contact at rest over its approach."""

    def __init__(self, table, u, T):
        place = (math.log(u) - table.log_speed_start) * table.log_speed_step
        heat = (1.0 / (T - COLDEST) - table.temperature_start) * table.temperature_step
        numbers = [table.coefficients.reshape(*table.coefficients.shape[:2], -1, 2), table.place]
        for wanted in (place, heat):
            # coefficient i belongs to node i - 1: its quadratic spline is centred there
            n = numbers[0].shape[0]
            x = min(max(wanted, 0.0), n - 3.0)
            numbers = [BSpline(np.arange(n + 3) - 2.5, part, 2)(x) for part in numbers]
        (self.offset, self.inverse), n = numbers[1], numbers[0].shape[0]
        self.spline, self.cells = BSpline(np.arange(n + 4) - 3.0, numbers[0], 3), n - 3
        self.start, self.step = table.start, table.step

    def __call__(self, approach):
        s = math.asinh((approach - self.offset) * self.inverse)
        g, log_ratio = self.spline(min(max((s - self.start) * self.step, 0.0), float(self.cells)))
        load = max(float(g), 0.0) ** 3
        return load, load * math.exp(log_ratio)

    def approach(self, load):
        low, high = (
            self.offset + math.sinh(s) / self.inverse for s in (self.start, self.start + self.cells / self.step)
        )
        return root(lambda at: self(at)[0] - load, low, high)

    @cached_property
    def lift_off(self):
        low, high = self.start, self.start + self.cells / self.step
        s = brentq(lambda s: float(self.spline((s - self.start) * self.step)[0]), low, high, xtol=1e-15)
        return self.offset + math.sinh(s) / self.inverse


def root(function, low, high):
    """Place between two others at which a rising function is zero."""
    return brentq(function, low, high, xtol=1e-22, rtol=1e-15, maxiter=500)


class Reference:
    """A law at one speed, temperature and centrifugal load.

    Parameters
    ----------
    law : ContactLaw
        The law, which gives its table and its contacts.
    u, T, q : float
        Speed [m/s], temperature [K], centrifugal load [N/m].
    """

    def __init__(self, law, u, T, q=0.0):
        table = law.table if q else law.plain_table
        speed = min(abs(u), table.highest_speed)
        held, T = max(speed, table.lowest_speed), min(max(T, table.lowest_temperature), table.highest_temperature)
        self.q, self.contacts = q, law.contacts
        self.parts = [Line(part, held, T) for part in ((table.inner, table.outer) if q else (table.own,))]
        part = min(speed / table.film_speed, 1.0) if table.film_speed > 0.0 else 1.0
        self.film = part**3 * (10.0 - 15.0 * part + 6.0 * part**2)
        end = float(ends_of(table.ends, np.array([held]), np.array([T]))[0])
        self.held = table.held_load * end / table.highest_load - q

    def solids(self, load):
        """Approach of the solids alone [m]."""
        loads = [load] * (len(self.contacts) - 1) + [load + self.q]
        return sum(
            float(one.structural_approach(w)) if w > 0.0 else 0.0 for one, w in zip(self.contacts, loads, strict=True)
        )

    def whole(self, load):
        """Approach with the whole film [m] and damping [N s/m2] at a load."""
        loads = [load, load + self.q][: len(self.parts)]
        at = [part.approach(w) for part, w in zip(self.parts, loads, strict=True)]
        damping = [part(place)[1] for part, place in zip(self.parts, at, strict=True)]
        if len(at) == 1:
            return at[0], damping[0]
        step = 1e-6
        slopes = [
            (part.approach(w * (1.0 + step)) - part.approach(w * (1.0 - step))) / (2.0 * step * w)
            for part, w in zip(self.parts, loads, strict=True)
        ]
        # each contact takes its share of the rate, and of the power
        shares = [slope / sum(slopes) for slope in slopes]
        return sum(at), sum(c * share**2 for c, share in zip(damping, shares, strict=True))

    def approach(self, load):
        """Approach [m] and damping [N s/m2] at a load."""
        if load > self.held:
            at, damping = self.approach(self.held)
            step = 1e-4 * self.held
            compliance = (self.solids(self.held + step) - self.solids(self.held - step)) / (2.0 * step)
            return at + compliance * (load - self.held), damping
        at, damping = self.whole(load)
        return (1.0 - self.film) * self.solids(load) + self.film * at, self.film * damping
