"""Oils that are known by their class alone: their viscosity at 40 degC, and by their index that at 100 degC.

ISO 3448 gives the viscosity at 40 degC to 10 %, and the viscosity index that at 100 degC: the relation of ISO 2909,
index over both viscosities, is inverted here.

References
----------
ISO 3448, Industrial liquid lubricants - ISO viscosity classification. ISO 2909 (= ASTM D2270), Petroleum products -
Calculation of viscosity index from kinematic viscosity; the quadratics are those of ASTM D2270, appendix X2.
"""

from __future__ import annotations

import math
import re
from bisect import bisect_right
from dataclasses import dataclass

from ehdmaps.errors import InputError

CLASSES = {
    2: 2.2, 3: 3.2, 5: 4.6, 7: 6.8, 10: 10.0, 15: 15.0, 22: 22.0, 32: 32.0, 46: 46.0, 68: 68.0, 100: 100.0, 150: 150.0,
    220: 220.0, 320: 320.0, 460: 460.0, 680: 680.0, 1000: 1000.0, 1500: 1500.0, 2200: 2200.0, 3200: 3200.0,
}  # fmt: skip
"""Classes of ISO 3448 with their mid-point viscosities at 40 degC [mm2/s]."""

INDEX = 95.0
"""Viscosity index where none is said: that of usual mineral oils."""
INDICES = (0.0, 400.0)

DENSITY, DENSITY_SLOPE = 880.0, -0.6
"""Density at 15 degC [kg/m3] and its slope [kg/(m3 K)], assumed: mineral oils have 850 to 910."""

CONDUCTIVITY = 0.13
"""Thermal conductivity [W/(m K)], assumed: mineral oils have 0.12 to 0.15."""

LEAST = 2.0
"""Viscosity at 100 degC [mm2/s] from which ISO 2909 has an index."""

# from which viscosity at 100 degC [mm2/s], then L = a Y^2 + b Y + c, H = d Y^2 + e Y + f
_LIMITS = (2.0, 3.8, 4.4, 5.0, 6.4, 7.0, 7.7, 9.0, 12.0, 15.0, 18.0, 22.0, 28.0, 40.0, 55.0, 70.0)
_QUADRATICS = (
    (1.14673, 1.7576, -0.109, 0.84155, 1.5521, -0.077),
    (3.38095, -15.4952, 33.196, 0.78571, 1.7929, -0.183),
    (2.5, -7.2143, 13.812, 0.82143, 1.5679, 0.119),
    (0.101, 16.635, -45.469, 0.04985, 9.1613, -18.557),
    (3.35714, -23.5643, 78.466, 0.22619, 7.7369, -16.656),
    (0.01191, 21.475, -72.870, 0.79762, -0.7321, 14.610),
    (0.41858, 16.1558, -56.040, 0.05794, 10.5156, -28.240),
    (0.88779, 7.5527, -16.600, 0.26665, 6.7015, -10.810),
    (0.7672, 10.7972, -38.180, 0.20073, 8.4658, -22.490),
    (0.97305, 5.3135, -2.200, 0.28889, 5.9741, -4.930),
    (0.97256, 5.2500, -0.980, 0.24504, 7.4160, -16.730),
    (0.91413, 7.4759, -21.820, 0.20323, 9.1267, -34.230),
    (0.87031, 9.7157, -50.770, 0.18411, 10.1015, -46.750),
    (0.84703, 12.6752, -133.310, 0.17029, 11.4866, -80.620),
    (0.85921, 11.1009, -83.190, 0.17130, 11.3680, -76.940),
    (0.83531, 14.6731, -216.246, 0.16841, 11.8493, -96.947),
)

_TEXT = re.compile(
    r"(?:ISO)?[ _-]*VG(?: *|[_-])(\d{1,5})(?:[ ,;_-]+VI(?: *=? *|[_-])(\d{1,4}(?:\.\d{1,3})?))?", re.IGNORECASE
)
"""A hyphen joins, as in "ISO-VG-46"; behind a blank it is a sign, and no class is negative."""


def viscosity_index(viscosity_40: float, viscosity_100: float) -> float:
    """Viscosity index of ISO 2909.

    Parameters
    ----------
    viscosity_40, viscosity_100 : float
        Kinematic viscosities at 40 and 100 degC [mm2/s]; the latter `LEAST` or more.

    Raises
    ------
    InputError
        If there is no index, as the oil is too thin.

    Examples
    --------
    Both examples of ASTM D2270, whose indices are 92 and 156:

    >>> round(viscosity_index(73.30, 8.86)), round(viscosity_index(22.83, 5.05))
    (92, 156)
    """
    if not viscosity_100 >= LEAST:
        raise InputError(
            f"viscosity index: got {viscosity_100:.4g} mm2/s at 100 degC; allowed: {LEAST:g} mm2/s and above, where "
            "ISO 2909 has one; give viscosity_40 and viscosity_100"
        )
    row = _QUADRATICS[bisect_right(_LIMITS, viscosity_100) - 1]
    low, high = ((a * viscosity_100 + b) * viscosity_100 + c for a, b, c in (row[:3], row[3:]))
    if viscosity_40 >= high:
        return 100.0 * (low - viscosity_40) / (low - high)
    power = math.log(high / viscosity_40) / math.log(viscosity_100)
    return (math.pow(10.0, power) - 1.0) / 0.00715 + 100.0


def viscosity_100(viscosity_40: float, index: float) -> float:
    """Kinematic viscosity at 100 degC [mm2/s] of an oil with a viscosity index: ISO 2909 inverted.

    Parameters
    ----------
    viscosity_40 : float
        Kinematic viscosity at 40 degC [mm2/s].
    index : float
        Viscosity index.

    Raises
    ------
    InputError
        If no oil of 2 mm2/s or more at 100 degC has this index.

    Examples
    --------
    >>> round(viscosity_100(46.0, 95.0), 2), round(viscosity_100(100.0, 95.0), 1)
    (6.64, 11.1)
    """
    low, high = LEAST, viscosity_40
    if not (high > low and viscosity_index(viscosity_40, low) <= index <= viscosity_index(viscosity_40, high)):
        raise InputError(
            f"viscosity index: got {index:g} for {viscosity_40:g} mm2/s at 40 degC; allowed: what gives {LEAST:g} "
            "mm2/s or more at 100 degC, where ISO 2909 begins; give viscosity_40 and viscosity_100"
        )
    while high - low > 1e-12 * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if viscosity_index(viscosity_40, middle) < index else (low, middle)
    return 0.5 * (low + high)


@dataclass(frozen=True)
class OilClass:
    """A viscosity class with an index.

    Attributes
    ----------
    grade : int
        One of `CLASSES`.
    index : float
        Viscosity index.
    index_stated : bool
        Whether somebody said it.
    """

    grade: int
    index: float = INDEX
    index_stated: bool = False

    @classmethod
    def of(cls, text: str) -> OilClass | None:
        """The class that a text names; None where it names none.

        Parameters
        ----------
        text : str
            Such as "ISO VG 46", "VG46" or "ISO VG 46, VI 120".

        Raises
        ------
        InputError
            If ISO 3448 has no such class, or the index is out of its limits.

        Examples
        --------
        >>> OilClass.of("vg46 VI 120").name, OilClass.of("FVA3")
        ('ISO VG 46, VI 120', None)
        """
        match = _TEXT.fullmatch(text.strip())
        if match is None:
            return None
        grade, index = int(match.group(1)), match.group(2)
        if grade not in CLASSES:
            near = min(CLASSES, key=lambda known: abs(math.log(known / max(grade, 1))))
            raise InputError(
                f"viscosity class: got {text.strip()!r:.40} (did you mean 'ISO VG {near}'?); allowed: ISO VG "
                f"{', '.join(map(str, CLASSES))} (ISO 3448)"
            )
        if index is not None and not INDICES[0] <= float(index) <= INDICES[1]:
            raise InputError(
                f"viscosity index: got {index}; allowed: {INDICES[0]:g} to {INDICES[1]:g}; mineral oils have about 95"
            )
        return cls(grade) if index is None else cls(grade, float(index), True)

    @property
    def name(self) -> str:
        """Name of the oil, which `of` reads again."""
        return f"ISO VG {self.grade}" + (f", VI {self.index:g}" if self.index_stated else "")

    @property
    def viscosities(self) -> tuple[float, float]:
        """Kinematic viscosities at 40 and 100 degC [m2/s].

        Raises
        ------
        InputError
            For an index that no such oil has; ISO 2909 has none for the thinnest classes.
        """
        cold = CLASSES[self.grade]
        return 1e-6 * cold, 1e-6 * viscosity_100(cold, self.index)

    @property
    def correlation(self) -> str:
        """Correlation of the pressure-viscosity: that of So and Klaus, and above VG 1500, where it falls, Gold's."""
        return "so-klaus" if self.grade <= 1500 else "gold-mineral"

    @property
    def sentence(self) -> str:
        """Sentence that a map says of what is assumed."""
        index = f"viscosity index {self.index:g}" + ("" if self.index_stated else " (assumed)")
        return (
            f"viscosity of {self.name.split(',')[0]} by its class (10 % either way at 40 degC) and {index}, density "
            f"{DENSITY:g} kg/m3 (assumed)"
        )
