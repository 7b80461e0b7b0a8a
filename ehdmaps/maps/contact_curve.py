"""Approach and damping of one contact over load: the mapped range, the tail below it, the continuation above.

The curves are over g = w^(1/3), the cube root of the load. At the end of the tail, where the load goes to zero as
the cube of the approach, everything is smooth in g, through zero and on to negative g, where there is no load.

The tail is the film at the lowest loads: rigid and isoviscous, w ~ 1/h, faded to nothing at a thick film. With the film
offset h1 and the film compliance s1 at the lowest known load w1, see `ehdmaps.maps.film_field`,

    w = Q(h) A/(h - hs),    A = w1^2 s1,    hs = h1 - w1 s1,

which joins what is known with equal value and slope. Q is the quintic that falls from 1 at ha = max(0.005 R, h1) to
0 at 4 ha. The damping of the contact follows

    c = Q(h) c1 v^1.5 exp((n1 - 1.5)(v^3 - 1)/3),    v = w1 s1/(h - hs),

n1 = d ln c/d ln w at w1: equal value and slope at w1 (v = 1), and c ~ h^-1.5 of a rigid film where v is small.
c/w does not contain Q, so that it stays finite where both vanish.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import MapError
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.kernels.ends import ends_at
from ehdmaps.physics.contact import LineContact

THICK_FILM = 0.005
"""h/R at which the fade begins, unless the map itself reaches thicker films."""

_FADE_RATIO = 4.0
_LEAST_COMPLIANCE = 1e-3
_NEWTON_STEPS = 60
_CLOSE = 1e-9


@dataclass(frozen=True)
class Tail:
    """Film below the lowest known load, for every pair of speed and temperature.

    Attributes
    ----------
    load : array (n_u, n_T)
        w1 [N/m].
    film_offset, film_compliance : array (n_u, n_T)
        h1 [m] and s1 [m2/N] at w1.
    damping, damping_exponent : array (n_u, n_T)
        c [N s/m2] and d ln c/d ln w at w1.
    radius : float
        R [m].
    """

    load: FloatArray
    film_offset: FloatArray
    film_compliance: FloatArray
    damping: FloatArray
    damping_exponent: FloatArray
    radius: float

    @property
    def fade_film(self) -> FloatArray:
        """Film ha at which the fade begins [m]; it ends at 4 ha."""
        return np.maximum(THICK_FILM * self.radius, self.film_offset)

    @property
    def fade_load(self) -> FloatArray:
        """Load at ha [N/m]."""
        return self.strength / (self.fade_film - self.pole)

    @property
    def _compliance(self) -> FloatArray:
        """s1, kept above zero where the noise of a heavily loaded map has eaten it."""
        return np.maximum(self.film_compliance, _LEAST_COMPLIANCE * self.film_offset / self.load)

    @property
    def strength(self) -> FloatArray:
        """A [N]: w (h - hs) of the film that does not fade."""
        return self.load**2 * self._compliance

    @property
    def pole(self) -> FloatArray:
        """hs [m]."""
        return self.film_offset - self.load * self._compliance

    def films(self, root: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Film at given cube roots of the load.

        Parameters
        ----------
        root : array (n, n_u, n_T)
            g = w^(1/3), <= w1^(1/3). Negative values continue the film smoothly beyond 4 ha; there is no load.

        Returns
        -------
        film_offset : array
            h [m].
        slope : array
            dh/dg, negative.
        log_ratio : array
            ln(c/w), c/w in s/m.
        """
        strength, pole, fade = self.strength, self.pole, self.fade_film
        # Above the fade the hyperbola is inverted at once; in the fade tau goes from 1 at ha to 0 at 4 ha.
        unfaded = root >= np.cbrt(self.fade_load)
        safe = np.where(unfaded, root, 1.0)
        over = strength / (safe * safe * safe)
        film = pole + over
        slope = -3.0 * over / safe

        faded = np.nonzero(~unfaded)
        lines = faded[1:]
        start = fade[lines]
        span, reach = (_FADE_RATIO - 1.0) * start, _FADE_RATIO * start - pole[lines]
        unit = np.cbrt(strength[lines])
        tau = _faded_place(root[faded] / unit, span, reach)
        _, tau_slope = _faded_root(tau, span, reach)
        film[faded] = _FADE_RATIO * start - span * tau
        slope[faded] = -span / (unit * tau_slope)

        part = self.load * self._compliance / (film - pole)
        log_ratio = (
            np.log(self.damping / self.load)
            + 0.5 * np.log(part)
            + (self.damping_exponent - 1.5) * (part * part * part - 1.0) / 3.0
        )
        return film, slope, log_ratio


def _faded_root(tau: FloatArray, span: FloatArray, reach: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Cube root of Q(tau)/(h - hs) with h - hs = reach - span tau, and its derivative by tau.

    Q = tau^3 (10 - 15 tau + 6 tau^2): its cube root goes through zero without a kink.
    """
    shape = 10.0 - 15.0 * tau + 6.0 * tau**2
    distance = reach - span * tau
    value = tau * np.cbrt(shape / distance)
    log_slope = (12.0 * tau - 15.0) / shape + span / distance
    return value, np.cbrt(shape / distance) + value * log_slope / 3.0


def _faded_place(wanted: FloatArray, span: FloatArray, reach: FloatArray) -> FloatArray:
    """Solve `_faded_root` = wanted for tau <= 1, by Newton's method inside a closing bracket."""
    top, _ = _faded_root(np.ones_like(span), span, reach)
    high = np.ones_like(wanted)
    # For tau < 0 the root lies below its tangent at zero, since span < reach.
    low = np.minimum(0.0, wanted / np.cbrt(10.0 / reach)) - 1e-9
    tau = np.clip(wanted / top, low, high)
    for _ in range(_NEWTON_STEPS):
        value, slope = _faded_root(tau, span, reach)
        above = value > wanted
        high, low = np.where(above, tau, high), np.where(above, low, tau)
        newton = tau - (value - wanted) / np.where(slope > 0.0, slope, np.inf)
        following = np.where((newton >= low) & (newton <= high), newton, 0.5 * (low + high))
        moved = float(np.max(np.abs(following - tau), initial=0.0))
        tau = following
        if moved < _CLOSE:
            break
    return tau


_STEEPEST = 3.0
"""Largest exponent, of either sign, with which c goes on above the highest load. Where a map ends in the damping
valley, those of its end are some ten times that, and c would overflow within a factor of ten of the load."""

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
    held: FloatArray = np.maximum(root, 0.0)
    return held * held * held  # numpy's cube takes ten times as long


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
        low, self._high = self._edges(first, ends_at(field.ends, speeds, temperatures))
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
            damping = edge.damping * ratio ** np.clip(edge.damping_exponent, -_STEEPEST, _STEEPEST)
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
                raise MapError(
                    f"law of the contact {self._contact.name!r}: its {what} is not positive at "
                    f"{load[i, j, k]:.4g} N/m, {self._speeds[j]:.4g} m/s, {self._temperatures[k]:.2f} K; "
                    "a law needs a positive one everywhere; look at that part of the map, solve it again with a finer "
                    "grid"
                )
        return curve

    def _edges(self, low: FloatArray, high: FloatArray) -> tuple[_Edge, _Edge]:
        """Film and damping at both ends of the range; the exponents of c from inside it, to second order."""
        steps = np.exp(_SMALL_STEP * np.arange(3.0))[:, None, None]
        loads = np.concatenate((low * steps, high / steps))  # read at once: a reading costs more than its loads
        film, film_compliance, loss = self._field.films(self._contact.name, loads, self._speeds, self._temperatures)
        damping = loss / (self._contact.structural_compliance(loads) + film_compliance) ** 2
        with np.errstate(invalid="ignore"):  # of an impossible film, which is refused
            logs = np.log(damping)
        edges = []
        for load, at, direction in ((low, 0, 1.0), (high, 3, -1.0)):
            exponent = direction * (-1.5 * logs[at] + 2.0 * logs[at + 1] - 0.5 * logs[at + 2]) / _SMALL_STEP
            edges.append(_Edge(load, film[at], film_compliance[at], damping[at], exponent))
        return edges[0], edges[1]
