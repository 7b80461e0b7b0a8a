"""Approach and damping of one contact over load: mapped range, low-load tail, continuation above.

The curves are over g = w^(1/3), the cube root of the load. At the end of the tail, where the load goes to zero as
the cube of the approach, everything is smooth in g, through zero and on to negative g, where there is no load.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import MapError
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.tail import Tail
from ehdmaps.physics.contact import LineContact

_SMALL_STEP = 1e-4


@dataclass(frozen=True)
class FilmSamples:
    """Samples of the film of a contact over g = w^(1/3), without its structure.

    Layers between the film and the structure take such samples and give back others, at the same roots.

    Attributes
    ----------
    root : array (n, n_u, n_T)
        g [(N/m)^(1/3)], rising; negative where there is no load.
    offset : array (n, n_u, n_T)
        Film offset h [m].
    slope : array (n, n_u, n_T)
        dh/dg [m/(N/m)^(1/3)], negative where the film thins with load.
    loss : array (n, n_u, n_T)
        (c/w) D^2 with D = d(delta)/dg of the contact, structure and all [m s/(N/m)^(2/3)], positive. Losses of
        contacts in series add, and a loss stands for the film alone: a film between walls of any structure keeps it.
    """

    root: FloatArray
    offset: FloatArray
    slope: FloatArray
    loss: FloatArray

    @property
    def load(self) -> FloatArray:
        """w [N/m]."""
        return load_of(self.root)

    def then(self, following: FilmSamples) -> FilmSamples:
        """These samples and those of higher loads."""
        both = ((getattr(self, item.name), getattr(following, item.name)) for item in fields(self))
        return FilmSamples(*(np.concatenate(pair) for pair in both))


@dataclass(frozen=True)
class Curve:
    """Samples of a curve over g = w^(1/3); the sum of two curves is two contacts in series.

    Attributes
    ----------
    approach : array (n, n_u, n_T)
        delta [m].
    slope : array (n, n_u, n_T)
        D = d(delta)/dg [m/(N/m)^(1/3)], positive and finite also where the stiffness vanishes.
    loss : array (n, n_u, n_T)
        (c/w) D^2, as of `FilmSamples`.
    """

    approach: FloatArray
    slope: FloatArray
    loss: FloatArray

    @property
    def loss_ratio(self) -> FloatArray:
        """c/w [s/m], positive."""
        return self.loss / self.slope**2

    def __add__(self, other: Curve) -> Curve:
        """Contacts in series at equal load: approaches add, the rate divides as the slopes do."""
        return Curve(self.approach + other.approach, self.slope + other.slope, self.loss + other.loss)


def load_of(root: FloatArray) -> FloatArray:
    """Load w = g^3 [N/m], zero below g = 0."""
    load: FloatArray = np.maximum(root, 0.0) ** 3
    return load


def dry_slope(contact: LineContact, root: FloatArray) -> FloatArray:
    """d(delta)/dg of a contact without any film; zero at and below g = 0."""
    with np.errstate(invalid="ignore"):
        slope: FloatArray = np.where(
            root > 0.0, 3.0 * np.maximum(root, 0.0) ** 2 * contact.structural_compliance(load_of(root)), 0.0
        )
    return slope


@dataclass(frozen=True)
class _Edge:
    """Film at one end of the load range: offset h, compliance s, damping c, n = d ln c/d ln w; (n_u, n_T) each."""

    load: FloatArray
    film_offset: FloatArray
    film_compliance: FloatArray
    damping: FloatArray
    damping_exponent: FloatArray


class ContactCurve:
    """Approach, its slope and c/w of one contact over g, at each pair of speed and temperature.

    Parameters
    ----------
    field : FilmField
        Where the film comes from.
    contact : LineContact
        Its structural law.
    speeds, temperatures : array (n_u,), (n_T,)
        Entrainment speeds [m/s], > 0, and temperatures [K].

    Raises
    ------
    MapError
        If the approach does not rise with load, or a damping is not positive.
    """

    def __init__(self, field: FilmField, contact: LineContact, speeds: FloatArray, temperatures: FloatArray) -> None:
        self._field = field
        self._contact = contact
        self._speeds = speeds
        self._temperatures = temperatures
        first = field.first_loads(speeds, temperatures)
        low, self._high = self._edges(first, np.full_like(first, field.load_range[1]))
        self._tail = Tail(
            first, low.film_offset, low.film_compliance, low.damping, low.damping_exponent, contact.radius
        )

    @property
    def tail(self) -> Tail:
        """Film below the first known load."""
        return self._tail

    @property
    def fade_load(self) -> FloatArray:
        """Load below which the tail fades out [N/m], (n_u, n_T)."""
        return self._tail.fade_load

    def film(self, root: FloatArray, known: FloatArray, above: FloatArray) -> FilmSamples:
        """Film below, within and above the loads that are known.

        Parameters
        ----------
        root : array (., n_u, n_T)
            g of the tail.
        known, above : array (., n_u, n_T)
            Loads from the first known one to the highest of the map, and above [N/m].
        """
        return self.below(root).then(self.mapped(known)).then(self.above(above))

    def below(self, root: FloatArray) -> FilmSamples:
        """Tail: film at and below the first known load; `root` is g (n, n_u, n_T)."""
        offset, slope, log_ratio = self._tail.films(root)
        return FilmSamples(root, offset, slope, np.exp(log_ratio) * (dry_slope(self._contact, root) - slope) ** 2)

    def mapped(self, load: FloatArray) -> FilmSamples:
        """Film from the first known load to the highest of the map [N/m], (n, n_u, n_T)."""
        offset, compliance, loss = self._field.films(self._contact.name, load, self._speeds, self._temperatures)
        root = np.cbrt(load)
        return FilmSamples(root, offset, -3.0 * root**2 * compliance, 9.0 * root * loss)

    def above(self, load: FloatArray) -> FilmSamples:
        """Film above the mapped loads: its offset and c go on with their exponents at the end of the map."""
        edge = self._high
        root = np.cbrt(load)
        ratio = load / edge.load
        exponent = -edge.film_compliance * edge.load / edge.film_offset
        with np.errstate(over="ignore"):  # of an impossible film, whose mapped part is refused
            offset = edge.film_offset * ratio**exponent
            slope = 3.0 * exponent * offset / root
            damping = edge.damping * ratio**edge.damping_exponent
            loss = damping / load * (dry_slope(self._contact, root) - slope) ** 2
        return FilmSamples(root, offset, slope, loss)

    def with_structure(self, film: FilmSamples) -> Curve:
        """Curve of the contact with a film; what no law can be made from is refused."""
        load = film.load
        slope = dry_slope(self._contact, film.root) - film.slope
        curve = Curve(self._contact.structural_approach(load) - film.offset, slope, film.loss)
        for values, what in ((slope, "stiffness"), (film.loss, "damping")):
            wrong = ~(values > 0.0)  # NaN too
            if bool(np.any(wrong)):
                i, j, k = (int(index[0]) for index in np.nonzero(wrong))
                fastest = self._field.speed_range[1]
                remedy = "look at that part of the map, solve it again with a finer grid"
                if self._speeds[j] > fastest * (1.0 + 1e-9):
                    remedy = (
                        f"the map ends at {fastest:.4g} m/s, and its films do not go on so far: take outside='clamp', "
                        "or make a map that reaches there, with refinement lines"
                    )
                raise MapError(
                    f"law of the contact {self._contact.name!r}: its {what} is not positive at "
                    f"{load[i, j, k]:.4g} N/m, {self._speeds[j]:.4g} m/s, {self._temperatures[k]:.2f} K; "
                    f"a law needs a positive one everywhere; {remedy}"
                )
        return curve

    def _edges(self, low: FloatArray, high: FloatArray) -> tuple[_Edge, _Edge]:
        """Film and damping at both ends of the range; the exponents of c from inside it, to second order."""
        steps = np.exp(_SMALL_STEP * np.arange(3.0))[:, None, None]
        loads = np.concatenate((low * steps, high / steps))  # read at once: a reading costs more than its loads
        film, film_compliance, loss = self._field.films(self._contact.name, loads, self._speeds, self._temperatures)
        damping = loss / (self._contact.structural_compliance(loads) + film_compliance) ** 2
        logs = np.log(damping)
        edges = []
        for load, at, direction in ((low, 0, 1.0), (high, 3, -1.0)):
            exponent = direction * (-1.5 * logs[at] + 2.0 * logs[at + 1] - 0.5 * logs[at + 2]) / _SMALL_STEP
            edges.append(_Edge(load, film[at], film_compliance[at], damping[at], exponent))
        return edges[0], edges[1]
