"""The film of a contact on an oil layer, from the film of the flooded contact.

A line has no side flow: what passes through the contact in the steady state is the layer, or the flow m of the flooded
contact where that is less. With r = min(1, h_oil/m) at equal load, speed and temperature the film is

    h = r h_flooded F(r),    c = l/(S + s)^2,    s = s_flooded s(r)^n + s_e,    l = l_flooded l(r)^n + s_e b/u,

S the compliance of the structure, s and l the compliance and the loss compliance of the film with the meniscus where it
is: at the frequencies of noise it has no time to move. F, s(r) and l(r) are of the starved contact between rigid
surfaces (`ehdmaps.physics.oil_supply`), n = -d ln(h)/d ln(w) of the flooded film is one for light loads and near zero
in a loaded contact. There it is s_e that counts (`edge_compliance`): a heavier load moves the edge of the contact, at
the half-width b, to the meniscus.

F runs from 1 to 1.2257 as r goes to zero: the film of a lightly loaded contact goes to the layer itself, and the load
to nothing. A gap wider than the layer is dry.

- The corner at r = 1 is rounded, r = (1 + (m/h_oil)^8)^(-1/8); that takes 8 % off the film where m is h_oil, and less
  than 1 % where they differ by a third.
- s = sqrt(r), in which F and G are smooth, is rounded below r = `ROUNDED`^3, so that the load goes to zero as the cube
  of the approach, as the table of a law wants it.
- Below the first known load the film does not fade at 0.005 R: the hyperbola w (h - hs) = A feeds the layer. Its flow
  is that of the film, m/h going over into 1.2257 of the rigid contact. Layers thicker than those 0.005 R
  fade into the law of the flooded contact: 1/h^8 is that of the layer and that of the fade, less that of the
  hyperbola.
- A map without mass flow has m = 1.2257 h. That is right for light loads, where layers act; in a loaded contact m/h is
  0.8 to 1.2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.contact_curve import FilmSamples, Tail, dry_slope
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.rolling_film import FlowFilm, RollingFilm
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.oil_supply import CORNER, RIGID_FLOW, compliance_ratio, damping_ratio, edge_compliance, film_ratio

ROUNDED = 0.2
"""Cube root of the flow ratio r below which sqrt(r) is rounded."""

_FADING = 1.5


def oil_layer(
    contact: LineContact,
    thickness: float,
    tail: Tail,
    rolling: RollingFilm | None,
    speeds: FloatArray,
    temperatures: FloatArray,
    field: FilmField | None = None,
) -> OilLayer:
    """Layer before a contact, at given speeds and temperatures.

    Parameters
    ----------
    contact : LineContact
        The contact.
    thickness : float
        Layer, of both surfaces together [m], finite.
    tail : Tail
        Film of the contact below the first known load.
    rolling : RollingFilm or None
        Mass flow of the flooded contact; None where it is not known.
    speeds, temperatures : array (n_u,), (n_T,)
        Entrainment speeds [m/s], > 0, and temperatures [K].
    field : FilmField, optional
        Films of the contact, which the flow follows outside the map.
    """
    flow = None if rolling is None else rolling.flow_film(contact.name, tail.load, speeds, temperatures, field)
    return OilLayer(contact, thickness, tail, flow, speeds)


@dataclass(frozen=True)
class OilLayer:
    """From the film of a flooded contact to that of the same contact on an oil layer.

    Attributes
    ----------
    contact : LineContact
        The contact.
    thickness : float
        Layer before it, of both surfaces together [m].
    tail : Tail
        Film of the contact below the first known load.
    flow : FlowFilm, optional
        Mass flow of the flooded contact from the first known load on. None where the map holds none.
    speeds : array (n_u,)
        Entrainment speeds [m/s].
    """

    contact: LineContact
    thickness: float
    tail: Tail
    flow: FlowFilm | None
    speeds: FloatArray

    def __call__(self, film: FilmSamples) -> FilmSamples:
        """Film on the layer, at the same loads.

        Parameters
        ----------
        film : FilmSamples
            Film of the flooded contact, with as many loads below the first known one at all speeds and temperatures.
        """
        first = np.cbrt(self.tail.load[0, 0]) * (1.0 - 1e-12)
        rows = int(np.count_nonzero(film.root[:, 0, 0] < first))
        below, above = _rows(film, slice(None, rows)), _rows(film, slice(rows, None))
        return self._below(below).then(self._above(above))

    def _above(self, film: FilmSamples) -> FilmSamples:
        """Film at and above the first known load."""
        log_slope = film.slope / film.offset
        ratio, ratio_slope = self._flow_per_film(film)
        layered = self._layered(film.root, film.load * film.offset, 3.0 / film.root + log_slope, ratio, ratio_slope)
        dry = dry_slope(self.contact, film.root)
        slope = layered.offset * layered.log_slope
        own = np.maximum(-film.slope, 0.0)
        exponent = np.clip(-film.root * log_slope / 3.0, 0.0, 1.0)
        s = layered.root_ratio
        held = (compliance_ratio(s) * s**2) ** exponent
        edge, time = self._edge(film.load, layered, exponent)
        edge *= 3.0 * film.root**2  # by g, as the slopes
        # (c/w) D^2 is 9 g l where D is that of c
        raised = (damping_ratio(s) * s**-1.5) ** exponent * (held * (dry + own) / (dry - film.slope)) ** 2
        loss = film.loss * raised + 3.0 * edge * time / film.root
        return FilmSamples(film.root, layered.offset, slope, loss * ((dry - slope) / (dry + own * held + edge)) ** 2)

    def _edge(self, load: FloatArray, layered: _Layered, exponent: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Compliance by the moving edge [m2/N], and half the time through the Hertz zone [s], at loads > 0."""
        half = np.asarray(half_width(load, self.contact.radius, self.contact.reduced_modulus))
        edge = edge_compliance(layered.root_ratio, exponent, layered.offset, load, half, self.contact.radius)
        return edge, half / self.speeds[:, None]

    def _below(self, film: FilmSamples) -> FilmSamples:
        """Film below the first known load."""
        tail, root, load = self.tail, film.root, film.load
        strength = tail.strength + tail.pole * load
        log_strength_slope = 3.0 * tail.pole * np.maximum(root, 0.0) ** 2 / strength
        layered = self._layered(root, strength, log_strength_slope, *self._flow_per_tail(root))

        # The film of the hyperbola over that of the fade is zero without load.
        part = film.offset * load / strength
        by_layer = film.offset / layered.offset
        log_slope = film.slope / film.offset
        steep = 3.0 * tail.strength / strength * film.offset * np.maximum(root, 0.0) ** 2 / strength
        sum_ = by_layer**CORNER + 1.0 - part**CORNER
        sum_slope = by_layer**CORNER * (log_slope - layered.log_slope) - part**CORNER * log_slope
        sum_slope -= part ** (CORNER - 1.0) * steep
        offset = film.offset * sum_ ** (-1.0 / CORNER)
        slope = offset * (log_slope - sum_slope / sum_)

        # c/w of the hyperbola goes like sqrt(w) and is raised by the layer, so that it is finite without load.
        unit = tail.damping / tail.load * np.exp((tail.damping_exponent - 1.5) * ((load / tail.load) ** 3 - 1.0) / 3.0)
        dry = dry_slope(self.contact, root)
        of_fade = film.loss / (dry - film.slope) ** 2
        of_hyperbola = unit * np.sqrt(load / tail.load)
        of_layer = unit * self._raised(root, strength, layered, unit) ** 2
        both = (of_layer / of_fade) ** CORNER + 1.0 - (of_hyperbola / of_fade) ** CORNER
        ratio = of_fade * both ** (1.0 / CORNER)
        return FilmSamples(root, offset, slope, ratio * (dry - slope) ** 2)

    def _raised(self, root: FloatArray, strength: FloatArray, layered: _Layered, unit: FloatArray) -> FloatArray:
        """Root of c/w on the layer over that of the hyperbola, `unit` (w/w1)^(1/2), times (w/w1)^(1/4): finite."""
        tail, s, held = self.tail, np.maximum(layered.root_ratio, 1e-30), np.maximum(root, 0.0)
        exponent = np.minimum(tail.strength / strength, 1.0)
        own = 3.0 * tail.strength
        dry = dry_slope(self.contact, root) * held**4
        light = damping_ratio(layered.root_ratio) ** (0.5 * exponent) * s ** (0.75 * (1.0 - exponent))
        light *= (layered.per_root * np.cbrt(tail.load)) ** -0.75
        stiff = np.where(dry > 0.0, dry * (compliance_ratio(layered.root_ratio) * s**2) ** -exponent, 0.0)

        # what the edge adds to compliance and loss, over those of the held film; nothing without load
        load = np.maximum(held, 1e-9 * np.cbrt(tail.load)) ** 3
        edge, time = self._edge(load, layered, exponent)
        kept = (compliance_ratio(layered.root_ratio) * s**2) ** exponent
        compliance = tail.strength / load**2
        flooded = unit * np.sqrt(load / tail.load) * load * (self.contact.structural_compliance(load) + compliance) ** 2
        more = edge / (compliance * kept)
        lost = edge * time / (flooded * (damping_ratio(layered.root_ratio) * s**-1.5) ** exponent * kept**2)
        there = root > 0.0
        more, lost = np.where(there, more, 0.0), np.where(there, lost, 0.0)
        raised: FloatArray = light * (dry + own) / (stiff + own * (1.0 + more)) * np.sqrt(1.0 + lost)
        return raised

    def _flow_per_film(self, film: FilmSamples) -> tuple[FloatArray, FloatArray]:
        """m/h at and above the first known load, and its logarithm's derivative by g."""
        if self.flow is None:
            return np.full_like(film.root, RIGID_FLOW), np.zeros_like(film.root)
        logs, slopes = self.flow.at(np.log(film.load))
        return np.exp(logs) / film.offset, 3.0 * slopes / film.root - film.slope / film.offset

    def _flow_per_tail(self, root: FloatArray) -> tuple[FloatArray, FloatArray]:
        """m/h of the hyperbola, and its logarithm's derivative by g: from that of the map to that of the rigid film.

        ln(m/h) leaves the rigid one as the pressure does, like w^1.5, and joins the map with its slope.
        """
        if self.flow is None:
            return np.full_like(root, RIGID_FLOW), np.zeros_like(root)
        tail = self.tail
        logs, slopes = self.flow.at(np.log(tail.load)[None])
        excess = logs[0] - np.log(tail.film_offset * RIGID_FLOW)
        exponent = slopes[0] + 1.0 - tail.pole / tail.film_offset
        held = np.maximum(root, 1e-30) / np.cbrt(tail.load)
        rest = exponent - _FADING * excess
        fading = held ** (3.0 * _FADING)
        log_ratio = fading * (excess + rest * 3.0 * np.log(held))
        slope = 3.0 * (_FADING * log_ratio + fading * rest) / (held * np.cbrt(tail.load))
        return RIGID_FLOW * np.exp(log_ratio), slope

    def _layered(
        self, root: FloatArray, strength: FloatArray, strength_slope: FloatArray, ratio: FloatArray, slope: FloatArray
    ) -> _Layered:
        """Film on the layer where w h of the flooded contact is `strength`, m/h `ratio`; slopes are of logarithms."""
        per_root = np.cbrt(self.thickness / (ratio * strength))
        flow = root * per_root  # cube root of h_oil/m
        flow_slope = per_root * (1.0 - root * (slope + strength_slope) / 3.0)
        third = 3.0 * CORNER
        corner = 1.0 + np.maximum(flow, 0.0) ** third
        passed = flow * corner ** (-1.0 / third)
        passed_slope = corner ** (-1.0 - 1.0 / third) * flow_slope
        rounded = passed**4 + ROUNDED**4
        factor = (rounded / (1.0 + ROUNDED**4)) ** 0.125
        root_ratio = passed * factor
        root_slope = factor * (1.0 + 0.5 * passed**4 / rounded) * passed_slope
        share, share_slope = film_ratio(root_ratio)
        log_slope = -slope - 3.0 * np.maximum(flow, 0.0) ** (third - 1.0) / corner * flow_slope
        return _Layered(
            offset=self.thickness / ratio * corner ** (-1.0 / CORNER) * share,
            log_slope=log_slope + share_slope / share * root_slope,
            root_ratio=root_ratio,
            per_root=per_root * corner ** (-1.0 / third) * factor,
        )


@dataclass(frozen=True)
class _Layered:
    """Film h on the layer, d ln(h)/dg, s = sqrt(r), and s/g, which is positive without load too."""

    offset: FloatArray
    log_slope: FloatArray
    root_ratio: FloatArray
    per_root: FloatArray


def _rows(film: FilmSamples, rows: slice) -> FilmSamples:
    """Some of the samples."""
    return FilmSamples(film.root[rows], film.offset[rows], film.slope[rows], film.loss[rows])
