"""The result of a modal identification, and its dataset."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from ehdmaps.arrays import ComplexArray, FloatArray, variable
from mbs.modal.records import Responses
from mbs.modal.residues import Parts, laplace, synthesise
from mbs.modal.stabilisation import Candidate


@dataclass(frozen=True, eq=False)
class ModalFit:
    """Modes identified in a band.

    Attributes
    ----------
    responses : Responses
        What was fitted: the lines of the band.
    poles : array of complex, shape (modes,)
        Poles of the structure, the exponential window taken out, rising in frequency [1/s].
    deviation : array, shape (modes, 2)
        Standard deviation of their real and imaginary part by the noise that is left [1/s]; NaN if not refined.
    scatter : array, shape (modes, 2)
        Standard deviation over the orders of the fit [1/s].
    counts : tuple of int
        Orders that found each mode.
    parts : Parts
        Residues and residual terms.
    error : array, shape (rows,)
        Rms of what the fit leaves of each response, over the rms of the response.
    candidates : tuple of Candidate
        The stabilisation diagram; its poles still have the window in them.
    refined : bool
        Whether the poles are those of the least error, else medians over the orders.
    """

    responses: Responses
    poles: ComplexArray
    deviation: FloatArray
    scatter: FloatArray
    counts: tuple[int, ...]
    parts: Parts
    error: FloatArray
    candidates: tuple[Candidate, ...]
    refined: bool

    @property
    def frequency(self) -> FloatArray:
        """|pole|/(2 pi), as of `mbs.linearised.modes.Modes` [Hz]."""
        return np.asarray(np.abs(self.poles) / (2.0 * np.pi))

    @property
    def damping_ratio(self) -> FloatArray:
        """-real part over magnitude."""
        return np.asarray(-self.poles.real / np.abs(self.poles))

    @property
    def uncertainty(self) -> FloatArray:
        """Deviation by noise where the poles are refined, else scatter over the orders, shape (modes, 2) [1/s]."""
        return self.deviation if self.refined else self.scatter

    @property
    def frequency_uncertainty(self) -> FloatArray:
        """Standard uncertainty of the frequency [Hz]."""
        along = self.poles / np.abs(self.poles)
        deviation = np.hypot(along.real * self.uncertainty[:, 0], along.imag * self.uncertainty[:, 1])
        return np.asarray(deviation / (2.0 * np.pi))

    @property
    def damping_uncertainty(self) -> FloatArray:
        """Standard uncertainty of the damping ratio."""
        # d zeta for a change of the pole: -d(real)/|p| + real d|p|/|p|^2.
        size = np.abs(self.poles)
        real = -1.0 / size + self.poles.real**2 / size**3
        imaginary = self.poles.real * self.poles.imag / size**3
        return np.asarray(np.hypot(real * self.uncertainty[:, 0], imaginary * self.uncertainty[:, 1]))

    def synthesise(self, frequency: FloatArray) -> ComplexArray:
        """Responses of the fit at frequencies [Hz], shape (rows, lines), with the window of the measured ones."""
        s = laplace(frequency, self.responses.decay)
        return synthesise(s, self.responses.derivatives, self.poles, self.parts)


def fit_dataset(fit: ModalFit) -> xr.Dataset:
    """The fit with its measured responses.

    Parameters
    ----------
    fit : ModalFit
        What is described.
    """
    units = "SI unit of the sensor per N or N m"
    measured = fit.responses
    curves = fit.synthesise(measured.frequency)
    rows, mode = ("row", "frequency_line"), ("mode",)
    variables = {
        "frequency": variable(mode, fit.frequency, "Hz", "|pole|/(2 pi)"),
        "damping_ratio": variable(mode, fit.damping_ratio, "1", "damping ratio"),
        "frequency_uncertainty": variable(
            mode,
            fit.frequency_uncertainty,
            "Hz",
            "standard uncertainty of the frequency, by noise or by orders of the fit",
        ),
        "damping_ratio_uncertainty": variable(
            mode, fit.damping_uncertainty, "1", "standard uncertainty of the damping ratio, by noise or by orders"
        ),
        "pole_real": variable(mode, fit.poles.real, "1/s", "decay, window taken out"),
        "pole_imaginary": variable(mode, fit.poles.imag, "rad/s", "damped frequency"),
        "orders": variable(mode, np.array(fit.counts, dtype=np.int64), "1", "orders that found it"),
        "residue_real": (("mode", "row"), fit.parts.residues.real, _residue("real")),
        "residue_imaginary": (("mode", "row"), fit.parts.residues.imag, _residue("imaginary")),
        "term_below": variable(
            ("row",), fit.parts.below, "displacement per N, 1/s2", "residual term of the modes below the band"
        ),
        "term_above": variable(
            ("row",), fit.parts.above, "displacement per N", "residual term of the modes above the band"
        ),
        "fit_error": variable(("row",), fit.error, "1", "rms that the fit leaves, over the rms of the response"),
        "response_real": variable(rows, measured.response.real, units, "measured, real part"),
        "response_imaginary": variable(rows, measured.response.imag, units, "measured, imaginary part"),
        "fit_real": variable(rows, curves.real, units, "fit, real part"),
        "fit_imaginary": variable(rows, curves.imag, units, "fit, imaginary part"),
        "coherence": variable(rows, measured.coherence, "1", "coherence; NaN where not known"),
        "quantity": variable(
            ("row",), [sensor.quantity for sensor, _ in measured.pairs], "", "what the sensor measures"
        ),
    }
    coordinates = {
        "mode": np.arange(1, fit.poles.size + 1),
        "row": list(measured.labels),
        "frequency_line": variable("frequency_line", measured.frequency, "Hz", "frequency"),
    }
    attributes = {
        "method": "lscf",
        "refined": int(fit.refined),
        "hits": measured.hits,
        "window_decay_per_s": measured.decay,
    }
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)


def _residue(part: str) -> dict[str, str]:
    """Attributes of a part of the residues."""
    return {"units": "displacement per N, 1/s", "long_name": f"residue, {part} part"}
