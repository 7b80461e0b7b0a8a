"""A pair of gears as it is described: geometry, contact ratio, varying mesh stiffness, transmission error.

Spur gears are helical gears of helix angle zero. Module and pressure angle are those of the normal section, which the
tool has; stiffness, damping, backlash and transmission error are those along the line of action in the transverse
section, as of ISO 6336 and ISO 21771.

Gears with profile shift x1, x2 mesh without play at the working pressure angle alpha_w and the centre distance a,

    inv alpha_w = inv alpha_t + 2 tan(alpha_n) (x1 + x2)/(z1 + z2),    a cos alpha_w = m_t (z1 + z2)/2 cos alpha_t,

inv t = tan t - t. Their tip circles, where none are given, keep the clearance at the roots of the other gear
(DIN 3960): d_a = d + 2 m_n (1 + x + k), k m_n = a - m_t (z1 + z2)/2 - m_n (x1 + x2).

References
----------
ISO 21771:2007 and DIN 3960, geometry of cylindrical gears. ISO 6336-1:2006, clause 9, method B: stiffness of teeth.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems

if TYPE_CHECKING:
    from mbs.gears.relief import Relief

FEWEST_TEETH, MOST_TEETH = 5, 10_000
MOST_HARMONICS = 50
STEEPEST = math.radians(45.0)
"""Largest helix angle, either hand [rad]."""

MOST_SHIFT = 2.0
"""Largest profile shift, in modules."""

PLACED = 1e-6
"""How far the distance of the centres may be off [m]."""

LEAST_STIFFNESS = 0.01
"""Least of the varying stiffness, as a part of the mean."""


def contact_ratio(
    teeth: tuple[int, int],
    pressure_angle: float,
    addendum: float | tuple[float, float] = 1.0,
    working_angle: float | None = None,
) -> float:
    """Transverse contact ratio of a pair of gears.

    Parameters
    ----------
    teeth : (int, int)
        Numbers of teeth of both gears.
    pressure_angle : float
        Pressure angle of the transverse section [rad].
    addendum : float or (float, float)
        How far the tips, or those of each gear, stand out of the pitch circle, in modules of the transverse section:
        the cosine of the helix angle for usual tools without profile shift.
    working_angle : float, optional
        Working pressure angle of the transverse section [rad]; the pressure angle without profile shift.

    Returns
    -------
    float
        Mean number of pairs in contact: the length of the path of contact over the base pitch.

    Raises
    ------
    InputError
        If a tip would reach below the other's base circle (such teeth are cut with a profile shift), or if less than
        one pair is in contact on the mean.

    References
    ----------
    ISO 21771:2007, transverse contact ratio.

    Examples
    --------
    >>> round(contact_ratio((21, 23), math.radians(20.0)), 3)
    1.58
    """
    sine, cosine = math.sin(pressure_angle), math.cos(pressure_angle)
    longest = 0.5 * sum(teeth) * (sine if working_angle is None else cosine * math.tan(working_angle))
    heights = addendum if isinstance(addendum, tuple) else (addendum, addendum)
    reaches = [
        math.sqrt(max((0.5 * z + height) ** 2 - (0.5 * z * cosine) ** 2, 0.0))
        for z, height in zip(teeth, heights, strict=True)
    ]
    shown = f"teeth {teeth[0]} and {teeth[1]}, pressure angle {math.degrees(pressure_angle):.6g} deg"
    if not max(reaches) <= longest:
        raise InputError(
            f"gear pair, contact ratio: got {shown}, where a tip reaches below the other's base circle; allowed: more "
            "teeth, or a profile shift; or give the harmonics of the stiffness as a list"
        )
    ratio = (sum(reaches) - longest) / (math.pi * cosine)
    if ratio < 1.0:
        raise InputError(
            f"gear pair, contact ratio: got {shown}, which makes {ratio:.4g}; allowed: at least 1, or the teeth part"
        )
    return ratio


def involute(angle: float) -> float:
    """inv t = tan t - t of a pressure angle [rad]."""
    return math.tan(angle) - angle


def angle_of_involute(value: float) -> float:
    """Pressure angle of a value of `involute`, >= 0 [rad].

    Parameters
    ----------
    value : float
        tan t - t.

    Examples
    --------
    >>> round(math.degrees(angle_of_involute(0.034317)), 3)
    26.089
    """
    angle = min(math.cbrt(3.0 * value), 1.4)  # exact for small ones; Newton goes down from above
    for _ in range(_MOST_STEPS):
        step = (involute(angle) - value) / math.tan(angle) ** 2 if angle > 0.0 else 0.0
        angle -= step
        if abs(step) <= 1e-16:
            break
    return angle


_MOST_STEPS = 50


_SPECIFIC_LOAD = 1e5
"""Tangential force for each metre of face width from which on c' does not depend on it [N/m], ISO 6336-1, 9.3.2."""

STIFFNESS_ERROR = 0.1
"""Part by which an estimated stiffness may be off."""


def overlap_ratio(face_width: float, helix_angle: float, module: float) -> float:
    """Overlap ratio of helical gears, b sin(beta)/(pi m_n): by how many pitches the flanks lag along the face width.

    Parameters
    ----------
    face_width : float
        Face width b [m].
    helix_angle : float
        Helix angle beta [rad].
    module : float
        Module of the normal section m_n [m].

    References
    ----------
    ISO 21771:2007, overlap ratio.

    Examples
    --------
    >>> round(overlap_ratio(30e-3, math.radians(15.0), 3e-3), 3)
    0.824
    """
    return face_width * abs(math.sin(helix_angle)) / (math.pi * module)


def pair_harmonics(ratio: float, count: int, overlap: float = 0.0) -> tuple[float, ...]:
    """Harmonics of the length of the lines of contact, over its mean; of spur gears the number of tooth pairs.

    Each pair has the same stiffness along its path. So over the part f = ratio - floor(ratio) of a pitch there is one
    pair more than over the rest, and with the phase zero in the middle of that part

        k/k_mean = 1 + sum a_j cos(j phase),  a_j = 2 sin(pi j f)/(pi j ratio).

    The flanks of helical gears lag by the overlap e along the face width, so that the mean over it is

        a_j sin(pi j e)/(pi j e),

    with the phase of the middle of the face. A whole number of overlaps leaves no harmonics.

    Parameters
    ----------
    ratio : float
        Transverse contact ratio, at least 1.
    count : int
        How many harmonics.
    overlap : float
        Overlap ratio; 0 for spur gears.
    """
    part = ratio - math.floor(ratio)
    return tuple(
        2.0 * math.sin(math.pi * j * part) / (math.pi * j * ratio) * float(np.sinc(j * overlap))
        for j in range(1, count + 1)
    )


@dataclass(frozen=True)
class GearPair:
    """Data known of a pair of spur or helical gears before it is put into a system.

    Attributes
    ----------
    name : str
        Name for messages and results.
    on, against : str
        Places of the middles of both gears; a torque +x on the first drives the second by the driving flank.
    teeth : (int, int)
        Numbers of teeth of both gears.
    module : float
        Module of the normal section [m].
    pressure_angle : float
        Pressure angle of the normal section [rad].
    face_width : float
        [m].
    stiffness : float or None
        Mean mesh stiffness for each metre of face width [N/m2], of force and motion in the transverse section; None for
        that of `tooth_stiffness` and the contact ratio, c' (0.75 eps_alpha + 0.25) of ISO 6336-1.
    backlash : float
        Play between the flanks along the line of action [m].
    damping : float
        Damping along the line of action, while there is contact [N s/m].
    harmonics : int or tuple of float
        Harmonics of the varying stiffness: how many of `pair_harmonics`, or their amplitudes as parts of the mean.
    harmonic_phases : tuple of float
        Phases of the harmonics of the stiffness [rad]; zero if left out.
    transmission_error : tuple of float
        Amplitudes of its harmonics along the line of action [m].
    transmission_error_phases : tuple of float
        [rad]; zero if left out.
    phase : float
        Mesh phase at the beginning [rad].
    helix_angle : float
        Helix angle [rad]; positive where the first gear is right-handed, 0 for spur gears.
    profile_shift : tuple of float
        x1 and x2 in modules; or x1 alone, where the distance tells x2; none without shift.
    working_distance : float or None
        Working centre distance [m]; None: that of the profile shifts.
    tip_diameters : (float, float) or None
        Tip diameters of both gears [m]; None: with the usual clearance.
    tangential_force : float or None
        Force on the reference circle under which an estimated stiffness and a relief are told [N]; None: 100 N/mm.
    relief : Relief or None
        Relief of the tips; None: involutes up to the tips.

    Raises
    ------
    InputError
        With every value that no gear pair has.
    """

    name: str
    on: str
    against: str
    teeth: tuple[int, int]
    module: float
    pressure_angle: float
    face_width: float
    stiffness: float | None
    backlash: float
    damping: float = 0.0
    harmonics: int | tuple[float, ...] = 5
    harmonic_phases: tuple[float, ...] = ()
    transmission_error: tuple[float, ...] = ()
    transmission_error_phases: tuple[float, ...] = ()
    phase: float = 0.0
    helix_angle: float = 0.0
    profile_shift: tuple[float, ...] = ()
    working_distance: float | None = None
    tip_diameters: tuple[float, float] | None = None
    tangential_force: float | None = None
    relief: Relief | None = None

    def __post_init__(self) -> None:
        problems = Problems(self._number_problems())
        series = [
            ("transmission_error", self.transmission_error, "m"),
            ("harmonic_phases", self.harmonic_phases, "rad"),
            ("transmission_error_phases", self.transmission_error_phases, "rad"),
        ]
        count = self.harmonics
        if isinstance(count, int) and not 0 <= count <= MOST_HARMONICS:
            problems.append(f"gear pair, harmonics: got {count!r}; allowed: 0 to {MOST_HARMONICS}, or a list")
        if not isinstance(count, int):
            series.append(("harmonics", count, "of the mean"))
        for name, values, unit in series:
            if len(values) > MOST_HARMONICS or not all(math.isfinite(value) for value in values):
                problems.append(
                    f"gear pair, {name}: got {values!r:.60}; allowed: at most {MOST_HARMONICS} finite numbers ({unit})"
                )
        for name, phases, amplitudes in (
            ("harmonic_phases", len(self.harmonic_phases), count if isinstance(count, int) else len(count)),
            ("transmission_error_phases", len(self.transmission_error_phases), len(self.transmission_error)),
        ):
            if phases > amplitudes:
                problems.append(f"gear pair, {name}: got {phases} for {amplitudes} amplitudes; allowed: as many")
        if not problems:
            problems += self._shift_problems()
        if not problems:
            problems += self._stiffness_problems()
        problems.check()

    @property
    def transverse_module(self) -> float:
        """m_n/cos(beta) [m]."""
        return self.module / math.cos(self.helix_angle)

    @property
    def transverse_pressure_angle(self) -> float:
        """Pressure angle of the transverse section, tan(alpha_t) = tan(alpha_n)/cos(beta) [rad]."""
        return math.atan(math.tan(self.pressure_angle) / math.cos(self.helix_angle))

    @property
    def base_helix_angle(self) -> float:
        """Helix angle beta_b on the base cylinder, tan(beta_b) = tan(beta) cos(alpha_t) [rad]."""
        return math.atan(math.tan(self.helix_angle) * math.cos(self.transverse_pressure_angle))

    @property
    def reference_distance(self) -> float:
        """m_t (z1 + z2)/2, the centre distance without profile shift [m]."""
        return 0.5 * self.transverse_module * sum(self.teeth)

    @property
    def shifts(self) -> tuple[float, float]:
        """Profile shifts x1, x2; one that is not given by the working distance."""
        if len(self.profile_shift) == 2:
            return self.profile_shift[0], self.profile_shift[1]
        if not self.profile_shift:
            return 0.0, 0.0
        return self.profile_shift[0], self._sum_by_distance() - self.profile_shift[0]

    @property
    def working_pressure_angle(self) -> float:
        """Pressure angle of the transverse section at which the gears mesh [rad]."""
        total = sum(self.shifts)
        if total == 0.0:
            return self.transverse_pressure_angle
        more = 2.0 * math.tan(self.pressure_angle) * total / sum(self.teeth)
        return angle_of_involute(involute(self.transverse_pressure_angle) + more)

    @property
    def centre_distance(self) -> float:
        """Working centre distance, at which the gears mesh [m]."""
        return self.reference_distance * self._widened

    @property
    def pitch_radii(self) -> tuple[float, float]:
        """Radii of the working pitch circles of both gears, which touch [m]."""
        first, second = (0.5 * self.transverse_module * z * self._widened for z in self.teeth)
        return first, second

    @property
    def base_radii(self) -> tuple[float, float]:
        """Radii of the base circles of both gears [m]."""
        cosine = math.cos(self.transverse_pressure_angle)
        first, second = (0.5 * self.transverse_module * z * cosine for z in self.teeth)
        return first, second

    @property
    def tips(self) -> tuple[float, float]:
        """Tip diameters of both gears [m]."""
        if self.tip_diameters is not None:
            return self.tip_diameters
        total = sum(self.shifts)
        shortened = self.centre_distance - self.reference_distance - self.module * total if total else 0.0
        first, second = (
            self.transverse_module * z + 2.0 * (self.module * (1.0 + x) + shortened)
            for z, x in zip(self.teeth, self.shifts, strict=True)
        )
        return first, second

    @property
    def _widened(self) -> float:
        """Working centre distance over that without profile shift."""
        if sum(self.shifts) == 0.0:
            return 1.0
        return math.cos(self.transverse_pressure_angle) / math.cos(self.working_pressure_angle)

    def _sum_by_distance(self) -> float:
        """Sum of the profile shifts by the working distance."""
        assert self.working_distance is not None
        cosine = self.reference_distance * math.cos(self.transverse_pressure_angle) / self.working_distance
        more = involute(math.acos(cosine)) - involute(self.transverse_pressure_angle)
        return 0.5 * more * sum(self.teeth) / math.tan(self.pressure_angle)

    @property
    def contact_ratios(self) -> tuple[float, float]:
        """Transverse contact ratio and overlap ratio.

        Raises
        ------
        InputError
            Where `contact_ratio` does.
        """
        working, heights = None, (math.cos(self.helix_angle),) * 2
        if self.profile_shift or self.tip_diameters is not None:
            working, module = self.working_pressure_angle, self.transverse_module
            (tip1, tip2), (z1, z2) = self.tips, self.teeth
            heights = 0.5 * (tip1 / module - z1), 0.5 * (tip2 / module - z2)
        transverse = contact_ratio(self.teeth, self.transverse_pressure_angle, heights, working)
        return transverse, overlap_ratio(self.face_width, self.helix_angle, self.module)

    @property
    def mean_stiffness(self) -> float:
        """Mean mesh stiffness of the whole face width [N/m], under the load where tips are relieved."""
        relieved = 1.0 if self.relief is None else self._under_load[0][0]
        return relieved * self._unrelieved_stiffness

    @property
    def load(self) -> float:
        """Tangential force for each metre of face width under which an estimate is told [N/m]."""
        return _SPECIFIC_LOAD if self.tangential_force is None else self.tangential_force / self.face_width

    @cached_property
    def _under_load(self) -> tuple[tuple[float, FloatArray, FloatArray], tuple[float, FloatArray, FloatArray]]:
        """Mean, amplitudes and phases of stiffness, as parts of that without relief, and of the error by relief [m]."""
        from mbs.gears.relief import course_under_load, harmonics_of  # where tips are relieved

        assert self.relief is not None
        angle = self.transverse_pressure_angle
        pitch = math.pi * self.transverse_module * math.cos(angle)
        force = self.load * self.face_width / math.cos(angle)
        course = course_under_load(self.relief, self.contact_ratios, pitch, self._unrelieved_stiffness, force)
        count = self.harmonics if isinstance(self.harmonics, int) else len(self.harmonics)
        return harmonics_of(course.stiffness, count), harmonics_of(course.error, count)

    @property
    def _unrelieved_stiffness(self) -> float:
        """Mean stiffness of whole lines of contact [N/m]."""
        if self.stiffness is not None:
            return self.stiffness * self.face_width
        from mbs.gears.teeth import tooth_stiffness  # where it is estimated

        (z1, x1), (z2, x2) = sorted(zip(self.teeth, self.shifts, strict=True))
        single = tooth_stiffness((z1, z2), (x1, x2), self.helix_angle, self.pressure_angle)
        softer = math.pow(min(self.load / _SPECIFIC_LOAD, 1.0), 0.25)
        return softer * single * (0.75 * self.contact_ratios[0] + 0.25) * self.face_width

    @property
    def estimate(self) -> str:
        """Words on an estimated stiffness and its error; empty where it is given."""
        if self.stiffness is not None:
            return ""
        under = f"under {1e-3 * self.load:.3g} N/mm" if self.tangential_force else "less below 100 N/mm of load"
        return (
            f"{self.name}: mesh stiffness {1e-9 * self.mean_stiffness / self.face_width:.3g} N/(um mm) by ISO 6336-1, "
            f"+-{100 * STIFFNESS_ERROR:.0f} %, {under}"
        )

    @cached_property
    def stiffness_harmonics(self) -> tuple[float, ...]:
        """Amplitudes of the harmonics of the stiffness, as parts of the mean."""
        if not isinstance(self.harmonics, int):
            return self.harmonics
        if self.harmonics == 0:
            return ()
        transverse, overlap = self.contact_ratios
        return pair_harmonics(transverse, self.harmonics, overlap)

    @cached_property
    def series(self) -> FloatArray:
        """Amplitudes and phases for `mbs.gears.gear_kernel`, shape (4, harmonics)."""
        if self.relief is not None:
            return self._relieved_series
        parts = (
            self.stiffness_harmonics,
            self.harmonic_phases,
            self.transmission_error,
            self.transmission_error_phases,
        )
        rows = np.zeros((4, max(len(self.stiffness_harmonics), len(self.transmission_error))))
        for row, part in zip(rows, parts, strict=True):
            row[: len(part)] = part
        return rows

    @property
    def _relieved_series(self) -> FloatArray:
        """The same where tips are relieved: stiffness under the load, and the error by relief beside that stated."""
        (mean, amplitudes, phases), (_, errors, error_phases) = self._under_load
        given = np.zeros((2, len(self.transmission_error)))
        given[0], given[1, : len(self.transmission_error_phases)] = (
            self.transmission_error,
            self.transmission_error_phases,
        )
        rows = np.zeros((4, max(amplitudes.size, given.shape[1])))
        rows[0, : amplitudes.size], rows[1, : phases.size] = amplitudes / mean, phases
        whole = np.zeros(rows.shape[1], dtype=np.complex128)
        whole[: errors.size] = errors * np.exp(1j * error_phases)
        whole[: given.shape[1]] += given[0] * np.exp(1j * given[1])
        rows[2], rows[3] = np.abs(whole), np.angle(whole)
        return rows

    def _number_problems(self) -> list[str]:
        """List problems with single numbers."""
        problems = [
            f"gear pair, teeth: got {z!r}; allowed: whole numbers, {FEWEST_TEETH} to {MOST_TEETH}"
            for z in self.teeth
            if not (isinstance(z, int) and not isinstance(z, bool) and FEWEST_TEETH <= z <= MOST_TEETH)
        ]
        if len(self.teeth) != 2:
            problems.append(f"gear pair, teeth: got {len(self.teeth)} numbers; allowed: two")
        if not math.radians(1.0) <= self.pressure_angle <= math.radians(45.0):
            problems.append(f"gear pair, pressure_angle: got {self.pressure_angle!r} rad; allowed: 1 to 45 deg")
        if not abs(self.helix_angle) <= STEEPEST:
            problems.append(
                f"gear pair, helix_angle: got {self.helix_angle!r} rad; allowed: -45 to 45 deg, positive where the "
                "first gear is right-handed"
            )
        for name, unit, zero in (
            ("module", "m", False),
            ("face_width", "m", False),
            ("stiffness", "N/m^2", False),
            ("damping", "N s/m", True),
            ("backlash", "m", True),
            ("tangential_force", "N", False),
        ):
            value = getattr(self, name)
            if value is None and name in ("stiffness", "tangential_force"):
                continue
            if not (math.isfinite(value) and (value > 0.0 or (zero and value == 0.0))):
                problems.append(
                    f"gear pair, {name}: got {value!r} {unit}; allowed: finite and {'>=' if zero else '>'} 0"
                )
        if self.relief is not None and (self.tangential_force is None or not isinstance(self.harmonics, int)):
            problems.append(
                "gear pair, tip_relief: stands without the load; allowed: with tangential_force, and with a number of "
                "harmonics"
            )
        if not math.isfinite(self.phase):
            problems.append(f"gear pair, phase: got {self.phase!r} rad; allowed: finite")
        return problems

    def _shift_problems(self) -> list[str]:
        """List problems with profile shifts, working distance and tip diameters."""
        shown, where = f"{self.profile_shift!r:.60}", "gear pair, profile_shift"
        if len(self.profile_shift) > 2 or not all(abs(x) <= MOST_SHIFT for x in self.profile_shift):
            return [f"{where}: got {shown}; allowed: x1 and x2 from -{MOST_SHIFT:g} to {MOST_SHIFT:g}, or x1 alone"]
        distance = self.working_distance
        if distance is not None and not (
            self.reference_distance * math.cos(self.transverse_pressure_angle)
            < distance
            < 2.0 * self.reference_distance
        ):
            return [
                f"gear pair, working_distance: got {1e3 * distance:.7g} mm; allowed: above the sum of the base radii, "
                f"up to twice the distance without profile shift, {1e3 * self.reference_distance:.7g} mm"
            ]
        if len(self.profile_shift) == 1 and distance is None:
            return [f"{where}: got x1 = {shown} alone; allowed: x1 and x2, or x1 and the working distance"]
        if len(self.profile_shift) != 1 and distance is not None and not abs(distance - self.centre_distance) <= PLACED:
            return [
                f"gear pair, working_distance: got {1e3 * distance:.7g} mm; allowed with these profile shifts: "
                f"{1e3 * self.centre_distance:.7g} mm; or leave x2 out, which then follows"
            ]
        if self.tip_diameters is not None:
            base = [2.0 * radius for radius in self.base_radii]
            given = self.tip_diameters
            if len(given) != 2 or not all(low < tip < math.inf for low, tip in zip(base, given, strict=False)):
                return [
                    f"gear pair, tip_diameters: got {given!r:.60} m; allowed: two, above the base circles of "
                    f"{1e3 * base[0]:.5g} and {1e3 * base[1]:.5g} mm"
                ]
        more = 2.0 * math.tan(self.pressure_angle) * sum(self.shifts) / sum(self.teeth)
        if not (involute(self.transverse_pressure_angle) + more > 0.0 and sum(self.base_radii) < self.centre_distance):
            return [f"{where}: got {shown}, with which the teeth do not mesh; allowed: a larger sum"]
        return []

    def _stiffness_problems(self) -> list[str]:
        """List problems with the course of the stiffness: it must stay positive."""
        try:
            amplitudes, phases = self.series[:2]
        except InputError as error:
            return list(error.problems)
        orders = np.arange(1, amplitudes.size + 1)
        # 64 places in the shortest period miss the least by 0.12 % of the amplitudes at most.
        places = np.linspace(0.0, 2.0 * math.pi, 64 * amplitudes.size + 1)
        course = 1.0 + np.cos(places[:, None] * orders + phases) @ amplitudes
        least = float(np.min(course))
        if least >= LEAST_STIFFNESS:
            return []
        return [
            f"gear pair, harmonics: got amplitudes whose stiffness falls to {least:.4g} of the mean; allowed: at least "
            f"{LEAST_STIFFNESS} everywhere; teeth do not pull"
        ]
