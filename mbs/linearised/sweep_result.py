"""Results of a sweep over speed, in arrays over speed and mode, and modes that come close and exchange their shapes.

Two undamped modes of one system come close and turn away from each other, with a gap g as wide as they are coupled
(veering); each then has the shape of the other. With damping the eigenvalues of the pair are those of

    [[a1 + i w1, i k], [i k, a2 + i w2]],    a decay rates, k the coupling, g = 2 k:

at w1 = w2 they differ by sqrt((a1 - a2)^2 - 4 k^2). Where the decay rates differ by more than g that is real: the
complex modes cross, each keeps its shape, and what turns away is an accident of leaving damping out. Numbers follow
the shapes there, and the frequency otherwise.

References
----------
W. D. Heiss, J. Phys. A 37 (2004) 2455-2464 (crossing and avoided crossing on both sides of an exceptional point).
"""

from __future__ import annotations

import dataclasses
import itertools
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from mbs.linearised.dynamic import LostMode
from mbs.linearised.mode_part import ModePart
from mbs.linearised.modes import damping_ratio
from mbs.linearised.validity import DynamicLoad
from mbs.model.elements import Input, Sensor


@dataclass(frozen=True, eq=False)
class UndampedSweep:
    """Undamped modes over speed, in the order that they have at the first one; all of them exist at every speed.

    Attributes
    ----------
    frequency, damping_ratio : array, shape (speeds, n)
        Frequencies of the modes of mass and stiffness [Hz]; modal damping ratios, which may exceed 1.
    shares : array, shape (parts, speeds, n)
        Part of the strain energy that each part has.
    bearing_share : array, shape (speeds, n)
        That of all bearings.
    frequency_error : array, shape (speeds, n)
        Band of the frequency, either way, from the errors that the map states [Hz]; NaN for laws that state none.
    frequency_spread : array, shape (speeds, n)
        Half of what the frequency varies over the angles of the cage, to first order [Hz]; 0 for one angle.
    assurance : array, shape (speeds, n)
        Least assurance on the way from the speed before, 1 at the first.
    summed_shift : array, shape (speeds, n)
        f/f(first speed) - 1 by energy: the sum of phi' dK phi/(2 phi' K phi) over the steps, dK of the bearings alone,
        and at a crossing the step from one branch to the other.
    direct_shift : array, shape (n,)
        The same at the last speed in one step with the first shapes: right to first order in the change.
    resembles : array of int, shape (n,)
        Mode whose shape at the last speed is most like that of this one at the first: another one where both came close
        on the way and exchanged their shapes.
    """

    frequency: FloatArray
    damping_ratio: FloatArray
    shares: FloatArray
    bearing_share: FloatArray
    frequency_error: FloatArray
    frequency_spread: FloatArray
    assurance: FloatArray
    summed_shift: FloatArray
    direct_shift: FloatArray
    resembles: IntArray

    @property
    def shift(self) -> FloatArray:
        """f/f(first speed) - 1, shape (speeds, n); NaN for free motions."""
        first = np.where(self.frequency[0] > 0.0, self.frequency[0], np.nan)
        return np.asarray(self.frequency / first - 1.0)


@dataclass(frozen=True, eq=False)
class ComplexSweep:
    """Oscillating complex modes over speed; NaN where a mode does not exist.

    A mode that becomes overdamped ends; if it oscillates again it is counted as another one.

    Attributes
    ----------
    eigenvalues : array, shape (speeds, modes)
        Eigenvalues with positive imaginary part [1/s].
    shares : array, shape (parts, speeds, modes)
        Part of the strain energy that each part has.
    bearing_share : array, shape (speeds, modes)
        That of all bearings.
    whirl : array, shape (speeds, modes)
        How fast gyroscopic terms raise the frequency with the speed, d omega/d Omega [1]: positive for forward whirl,
        negative for backward whirl, 0 for a motion in a plane.
    assurance : array, shape (speeds, modes)
        Least assurance on the way from the speed before, 1 where a mode begins.
    number : array of int, shape (modes,)
        Undamped mode, from 0 on, that it is nearest to where it begins; two that are never there together may share it.
    frequency_error, damping_ratio_error : array, shape (speeds, modes)
        Bands of both, either way, from the errors that the map states [Hz], [1]; NaN for laws that state none.
    frequency_spread, damping_ratio_spread : array, shape (speeds, modes)
        Half of what both vary over the angles of the cage, to first order [Hz], [1]; 0 for one angle.
    lost : tuple of tuple of LostMode
        Modes that could not be brought to the films of their own frequency, at each speed.
    reduction : ModePart
        What modes of bodies leave out that are not kept, shape (speeds, modes) each; its size is in the bands, too. NaN
        where no body is reduced, or none tells.
    """

    eigenvalues: ComplexArray
    shares: FloatArray
    bearing_share: FloatArray
    whirl: FloatArray
    assurance: FloatArray
    number: IntArray
    frequency_error: FloatArray
    damping_ratio_error: FloatArray
    frequency_spread: FloatArray
    damping_ratio_spread: FloatArray
    lost: tuple[tuple[LostMode, ...], ...]
    reduction: ModePart

    @property
    def frequency(self) -> FloatArray:
        """|eigenvalue|/(2 pi) [Hz]."""
        return np.asarray(np.abs(self.eigenvalues) / (2.0 * np.pi))

    @property
    def damping_ratio(self) -> FloatArray:
        """-real part over magnitude, below 1."""
        return damping_ratio(self.eigenvalues)


@dataclass(frozen=True, eq=False)
class BearingSweep:
    """Bearings over speed, along the direction n of their force.

    Attributes
    ----------
    names : tuple of str
        Names of the bearings.
    load : array, shape (speeds, bearings)
        Radial force [N].
    stiffness, damping : array, shape (speeds, bearings)
        n' K n [N/m] and n' C n [N s/m], the mean over the angles of the cage; NaN without a force.
    stiffness_spread, damping_spread : array, shape (speeds, bearings)
        Half of what they vary over these angles, as a part of the mean; 0 for one angle.
    angles : int
        Angles of the cage within one pitch of the rollers.
    stiffness_error, damping_error : array, shape (speeds, bearings)
        Bands of both at the first angle, either way, from the errors that the map states [N/m], [N s/m]; NaN for laws
        that state none.
    """

    names: tuple[str, ...]
    load: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    stiffness_spread: FloatArray
    damping_spread: FloatArray
    angles: int
    stiffness_error: FloatArray
    damping_error: FloatArray


@dataclass(frozen=True, eq=False)
class ResponseSweep:
    """Frequency responses over speed.

    Attributes
    ----------
    frequencies : array, shape (frequencies,)
        [Hz].
    inputs, sensors : tuple
        Inputs and sensors of the responses.
    values : array, shape (speeds, frequencies, sensors, inputs)
        Sensor unit per N or N m.
    peak_frequency, peak_size : array, shape (speeds, peaks, sensors, inputs)
        Place [Hz] and size of each peak, by rising frequency, on an axis with more frequencies around the lightly
        damped modes of each speed; NaN where a response has fewer peaks than others.
    error : array, shape (speeds,)
        Largest one seen beside direct solutions, see `mbs.linearised.linear`.
    """

    frequencies: FloatArray
    inputs: tuple[Input, ...]
    sensors: tuple[Sensor, ...]
    values: ComplexArray
    peak_frequency: FloatArray
    peak_size: FloatArray
    error: FloatArray

    def largest(self, sensor: int, entry: int) -> FloatArray:
        """Size of a response, at the frequency nearest to each peak that of the peak, shape (speeds, frequencies).

        Parameters
        ----------
        sensor, entry : int
            Which sensor and input.
        """
        largest: FloatArray = np.abs(self.values[:, :, sensor, entry])
        at, size = self.peak_frequency[:, :, sensor, entry], self.peak_size[:, :, sensor, entry]
        for speed, peak in np.argwhere(np.isfinite(at)).tolist():
            nearest = int(np.argmin(np.abs(self.frequencies - at[speed, peak])))
            largest[speed, nearest] = max(largest[speed, nearest], size[speed, peak])
        return largest


@dataclass(frozen=True, eq=False)
class Sweep:
    """The linearised system over speed.

    Attributes
    ----------
    speeds : array, shape (speeds,)
        [rad/s].
    displacement : array, shape (speeds, n)
        Equilibrium [m or rad].
    forces : tuple of array, shape (speeds, m)
        Forces of each element in its ports [N or N m].
    outside : dict of str to array of bool, shape (speeds,)
        Whether each element lies outside its map at the equilibrium, by name.
    parts : tuple of str
        Flexible bodies, springs, elements.
    undamped, damped, bearings, responses
        See there.
    between : int
        Speeds that were put in between to follow the modes.
    film_share : float
        Median part of the bands of complex modes that is what films with memory leave out.
    lifted : tuple of tuple of DynamicLoad
        Dynamic loads that lift contacts off at the amplitudes of the inputs, by speed.
    """

    speeds: FloatArray
    displacement: FloatArray
    forces: tuple[FloatArray, ...]
    outside: dict[str, npt.NDArray[np.bool_]]
    parts: tuple[str, ...]
    undamped: UndampedSweep
    damped: ComplexSweep
    bearings: BearingSweep
    responses: ResponseSweep
    between: int
    film_share: float = 0.0
    lifted: tuple[tuple[DynamicLoad, ...], ...] = ()


_BESIDE = 3
"""Speeds beside a crossing where both modes have shapes of their own."""


def exchanged(found: UndampedSweep) -> list[tuple[int, int]]:
    """Modes, from 0 on, each with the one that has its shape at the last speed; of two that exchange, the first."""
    like = found.resembles
    return [(k, int(other)) for k, other in enumerate(like) if other > k or (other < k and like[other] != k)]


def straightened(found: UndampedSweep) -> UndampedSweep:
    """The same modes, with both branches exchanged behind each crossing.

    Parameters
    ----------
    found : UndampedSweep
        Each mode followed along its frequency.
    """
    # Each exchange gives at least one mode of a cycle its own shape back.
    for _ in range(found.resembles.size):
        # Pairs whose exchange gives one of them its own shape back at the last speed.
        away = np.flatnonzero(found.resembles != np.arange(found.resembles.size)).tolist()
        pairs = [pair for pair in itertools.combinations(away, 2) if _same_cycle(found, *pair)]
        crossing = [pair for pair in pairs if _cross(found, *pair)]
        if not crossing:
            break
        found = _swapped(found, *min(crossing, key=lambda pair: _gap(found, *pair)))
    return found


def _same_cycle(sweep: UndampedSweep, first: int, second: int) -> bool:
    """Tell whether the shape of one mode goes over to the other one, perhaps by way of more."""
    at = int(sweep.resembles[first])
    while at not in (first, second):
        at = int(sweep.resembles[at])
    return at == second


def _nearest(sweep: UndampedSweep, first: int, second: int) -> int:
    """Index of the speed at which two modes are closest."""
    return int(np.argmin(np.abs(sweep.frequency[:, first] - sweep.frequency[:, second])))


def _gap(sweep: UndampedSweep, first: int, second: int) -> float:
    """Least distance of two modes [Hz]."""
    return float(np.min(np.abs(sweep.frequency[:, first] - sweep.frequency[:, second])))


def _cross(sweep: UndampedSweep, first: int, second: int) -> bool:
    """Tell whether the decay rates of two modes, beside where they are closest, differ by more than the gap."""
    near = _nearest(sweep, first, second)
    widths = sweep.damping_ratio * sweep.frequency
    apart = np.abs(widths[:, first] - widths[:, second])
    before, after = apart[max(near - _BESIDE, 0) : near + 1], apart[near : near + _BESIDE + 1]
    return _gap(sweep, first, second) < min(float(before.max()), float(after.max()))


def _swapped(sweep: UndampedSweep, first: int, second: int) -> UndampedSweep:
    """The modes with two of them exchanged from where they are closest on."""
    near = _nearest(sweep, first, second)
    at = near if _is_other(sweep, first, near) else near + 1
    order = np.tile(np.arange(sweep.frequency.shape[1]), (sweep.frequency.shape[0], 1))
    order[at:, [first, second]] = [second, first]
    shift = np.log1p(sweep.summed_shift)
    shift[at:, [first, second]] = _continued(sweep, shift, first, second, at)
    resembles = sweep.resembles.copy()
    resembles[sweep.resembles == first], resembles[sweep.resembles == second] = second, first
    return dataclasses.replace(
        sweep,
        frequency=np.take_along_axis(sweep.frequency, order, axis=1),
        damping_ratio=np.take_along_axis(sweep.damping_ratio, order, axis=1),
        shares=np.take_along_axis(sweep.shares, order[None], axis=2),
        bearing_share=np.take_along_axis(sweep.bearing_share, order, axis=1),
        frequency_error=np.take_along_axis(sweep.frequency_error, order, axis=1),
        assurance=np.take_along_axis(sweep.assurance, order, axis=1),
        summed_shift=np.expm1(shift),
        resembles=resembles,
    )


def _is_other(sweep: UndampedSweep, mode: int, near: int) -> bool:
    """Tell whether the shapes are exchanged already at a speed, by where the strain energy is there and beside it."""
    last = sweep.frequency.shape[0] - 1
    before, after = (sweep.shares[:, index, mode] for index in (max(near - _BESIDE, 0), min(near + _BESIDE, last)))
    here = sweep.shares[:, near, mode]
    return bool(np.abs(here - after).sum() < np.abs(here - before).sum())


def _continued(sweep: UndampedSweep, shift: FloatArray, first: int, second: int, at: int) -> FloatArray:
    """Logarithms of the shift from a speed on, each along the other branch, and the step over the gap before it."""
    before = max(at - 1, 0)
    columns = np.array([second, first])
    along = shift[at:, columns] - shift[before, columns]
    step = np.log(sweep.frequency[before, columns] / sweep.frequency[before, columns[::-1]])
    return np.asarray(shift[before, columns[::-1]] + step + along)
