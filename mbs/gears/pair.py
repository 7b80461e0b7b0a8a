"""A pair of gears as it is described: geometry, contact ratio, varying mesh stiffness, transmission error.

Spur gears are helical gears of helix angle zero. Module and pressure angle are those of the normal section, which the
tool has; stiffness, damping, backlash and transmission error are those along the line of action in the transverse
section, as of ISO 6336 and ISO 21771.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError

FEWEST_TEETH, MOST_TEETH = 5, 10_000
MOST_HARMONICS = 50
STEEPEST = math.radians(45.0)
"""Largest helix angle, either hand [rad]."""

LEAST_STIFFNESS = 0.01
"""Least of the varying stiffness, as a part of the mean."""


def contact_ratio(teeth: tuple[int, int], pressure_angle: float, addendum: float = 1.0) -> float:
    """Transverse contact ratio of a pair of gears without profile shift.

    Parameters
    ----------
    teeth : (int, int)
        Numbers of teeth of both gears.
    pressure_angle : float
        Pressure angle of the transverse section [rad].
    addendum : float
        Addendum in modules of the transverse section: the cosine of the helix angle for usual tools.

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
    longest = 0.5 * sum(teeth) * sine
    reaches = [math.sqrt((0.5 * z + addendum) ** 2 - (0.5 * z * cosine) ** 2) for z in teeth]
    shown = f"teeth {teeth[0]} and {teeth[1]}, pressure angle {math.degrees(pressure_angle):.6g} deg"
    if not max(reaches) <= longest:
        raise InputError(
            f"gear pair, contact ratio: got {shown}, where a tip reaches below the other's base circle; allowed: more "
            "teeth; or give the harmonics of the stiffness as a list"
        )
    ratio = (sum(reaches) - longest) / (math.pi * cosine)
    if ratio < 1.0:
        raise InputError(
            f"gear pair, contact ratio: got {shown}, which makes {ratio:.4g}; allowed: at least 1, or the teeth part"
        )
    return ratio


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
    stiffness : float
        Mean mesh stiffness for each metre of face width [N/m2], of force and motion in the transverse section.
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
    stiffness: float
    backlash: float
    damping: float = 0.0
    harmonics: int | tuple[float, ...] = 5
    harmonic_phases: tuple[float, ...] = ()
    transmission_error: tuple[float, ...] = ()
    transmission_error_phases: tuple[float, ...] = ()
    phase: float = 0.0
    helix_angle: float = 0.0

    def __post_init__(self) -> None:
        problems = self._number_problems()
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
            problems += self._stiffness_problems()
        if problems:
            raise InputError(problems)

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
    def centre_distance(self) -> float:
        """m_t (z1 + z2)/2 [m]."""
        return 0.5 * self.transverse_module * sum(self.teeth)

    @property
    def pitch_radii(self) -> tuple[float, float]:
        """Radii of the pitch circles of both gears [m]."""
        first, second = (0.5 * self.transverse_module * z for z in self.teeth)
        return first, second

    @property
    def base_radii(self) -> tuple[float, float]:
        """Radii of the base circles of both gears [m]."""
        first, second = (radius * math.cos(self.transverse_pressure_angle) for radius in self.pitch_radii)
        return first, second

    @property
    def contact_ratios(self) -> tuple[float, float]:
        """Transverse contact ratio and overlap ratio.

        Raises
        ------
        InputError
            Where `contact_ratio` does.
        """
        transverse = contact_ratio(self.teeth, self.transverse_pressure_angle, math.cos(self.helix_angle))
        return transverse, overlap_ratio(self.face_width, self.helix_angle, self.module)

    @property
    def mean_stiffness(self) -> float:
        """Mean mesh stiffness of the whole face width [N/m]."""
        return self.stiffness * self.face_width

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
        ):
            value = getattr(self, name)
            if not (math.isfinite(value) and (value > 0.0 or (zero and value == 0.0))):
                problems.append(
                    f"gear pair, {name}: got {value!r} {unit}; allowed: finite and {'>=' if zero else '>'} 0"
                )
        if not math.isfinite(self.phase):
            problems.append(f"gear pair, phase: got {self.phase!r} rad; allowed: finite")
        return problems

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
