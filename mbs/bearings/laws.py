"""Contact laws for bearings: Hertz, constant ones, the film formula; and as arrays for compiled code.

A law here means a roller between both raceways, over the total approach of both contacts. `single` makes the law of
one of its two contacts, which are alike.

The damping of all laws acts by the rule of `ehdmaps.physics.contact`, which knows no tension. Laws with a constant c
have a jump of the force at lift-off, while bodies approach. A map's law is taken as it is.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems, SolverError
from ehdmaps.kernel.record import at
from ehdmaps.physics.approach import ISO_LINE_CONSTANT, STEEL_REDUCED_MODULUS, StructuralLaw
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.solids import Material, reduced_modulus
from ehdmaps.physics.surface import SMOOTH, Surface
from mbs.bearings.bearing import Bearing
from mbs.bearings.cylinder import POWER, LawNumbers, functions

if TYPE_CHECKING:
    from ehdmaps.maps.kernels.law_in_c import LawRecord
    from ehdmaps.maps.law import ContactLaw, LawKind, OutsidePolicy
    from ehdmaps.physics.closed_form import DampingFormula, FilmFormula, FormulaSolver


class Formula(NamedTuple):
    """A law of the film formula of Moes.

    Attributes
    ----------
    damping : {"rigid", "dietl"}
        What gives its damping, as in `ehdmaps.physics.closed_form.FormulaSolver`.
    label, words : str
        The law in two words, and in a few.
    remark : str
        What is to be known of it.
    """

    damping: DampingFormula
    label: str
    words: str
    remark: str = ""


_TOO_LOW = " (its damping is far too low for loaded contacts)"

FORMULAS: Mapping[str, Formula] = {
    "formula": Formula("rigid", "film formula", "film formula moes", _TOO_LOW),
    "dietl": Formula("dietl", "Dietl's damping", "film formula moes, damping by Dietl's regression"),
}
"""Laws of the film formula by their names in commands."""

_EXPONENT = 10.0 / 9.0


class DryLaw(ABC):
    """A law without a film, the same at all speeds and temperatures.

    Attributes
    ----------
    name : str
        Name for messages and provenance.
    kind : {"series", "single"}
        A roller between both raceways, or one contact.
    outside : {"error", "clamp", "asymptote"}
        What happens above the highest load, as for a map.
    """

    name: str
    kind: Literal["series", "single"]
    outside: OutsidePolicy = "clamp"

    @property
    def highest_load(self) -> float:
        """Load per unit length up to which the law is known [N/m]; infinite without points."""
        return math.inf

    @abstractmethod
    def single(self) -> DryLaw:
        """Law of one of the two contacts of the roller, which takes half of the approach at the same load."""

    @abstractmethod
    def load(self, delta: npt.ArrayLike) -> FloatArray:
        """Load of the roller at rest [N] at the approach delta [m]."""

    @abstractmethod
    def evaluate(self, delta: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Load [N], stiffness [N/m] and damping [N s/m] of the roller by approach [m] and rate [m/s]."""

    @abstractmethod
    def energy(self, delta: FloatArray) -> FloatArray:
        """Energy of the roller at rest [J] at the approach delta [m]."""

    @abstractmethod
    def prepared(self, length: float) -> tuple[LawNumbers, FloatArray | None]:
        """Numbers and cells per unit length for compiled code, for a roller of a length [m]; None without cells.

        Cells are those of ``ehd_cylinder_law`` in `cylinder_law.h` of `ehdmaps.kernel`, shape (2 ROWS, 4, 2).
        """

    def is_above(self, delta: FloatArray) -> bool:
        """Tell whether an approach [m] lies above the highest load of the law."""
        return False


@dataclass(frozen=True)
class PowerLaw(DryLaw):
    """w = coefficient delta^exponent and c = damping + damping_time dw/d delta while delta > 0; nothing else.

    The two dampers are the usual ones of dry contacts: a constant, which jumps at lift-off, and one in proportion to
    the stiffness, which is zero there. Contacts in series with the same damping time have it as a pair too.

    Attributes
    ----------
    name : str
        Name for messages and provenance.
    kind : {"series", "single"}
        A roller between both raceways, or one contact.
    coefficient : float
        Load of a roller (not per unit length) at delta = 1 m [N/m^exponent].
    exponent : float
        10/9 for Hertz after ISO 16281, 1 for a spring.
    damping : float
        Constant part of c of a roller [N s/m].
    damping_time : float
        Part of c in proportion to the stiffness dw/d delta: their ratio [s].
    """

    name: str
    kind: Literal["series", "single"]
    coefficient: float
    exponent: float
    damping: float
    damping_time: float = 0.0

    def __post_init__(self) -> None:
        problems = Problems()
        limits = (("coefficient", "N/m^exponent", False), ("damping", "N s/m", True), ("damping_time", "s", True))
        for key, unit, zero in limits:
            value = getattr(self, key)
            if not (math.isfinite(value) and (value > 0.0 or (zero and value == 0.0))):
                problems.append(
                    f"law {self.name!r}, {key}: got {value!r} {unit}; allowed: finite and {'>=' if zero else '>'} 0"
                )
        if not 1.0 <= self.exponent <= 3.0:
            problems.append(f"law {self.name!r}, exponent: got {self.exponent!r}; allowed: 1 to 3")
        problems.check()

    def single(self) -> PowerLaw:
        """Law of one of the two contacts of the roller, which takes half of the approach at the same load."""
        if self.kind == "single":
            return self
        return replace(
            self, kind="single", coefficient=self.coefficient * 2.0**self.exponent, damping=2.0 * self.damping
        )

    def load(self, delta: npt.ArrayLike) -> FloatArray:
        """Load of the roller at rest [N] at the approach delta [m]."""
        return np.asarray(self.coefficient * np.maximum(np.asarray(delta, dtype=np.float64), 0.0) ** self.exponent)

    def evaluate(self, delta: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Load of the roller and its derivatives, as a `ContactLaw` gives them, but not per unit length.

        Parameters
        ----------
        delta, rate : array
            Approach [m] and its rate [m/s], of one shape.

        Returns
        -------
        load, stiffness, damping : array
            [N], [N/m], [N s/m].
        """
        loaded = delta > 0.0
        positive = np.where(loaded, delta, 1.0)
        slope = np.where(loaded, self.coefficient * self.exponent * positive ** (self.exponent - 1.0), 0.0)
        at_rest = slope * positive / self.exponent
        damping = np.where(loaded, self.damping + self.damping_time * slope, 0.0)
        change = self.damping_time * (self.exponent - 1.0) * slope / positive
        return unilateral_forces(at_rest, slope, damping, change, rate)

    def energy(self, delta: FloatArray) -> FloatArray:
        """Energy of the roller at rest [J] at the approach delta [m]."""
        b = self.exponent + 1.0
        return np.asarray(self.coefficient / b * np.maximum(delta, 0.0) ** b)

    def prepared(self, length: float) -> tuple[LawNumbers, None]:
        """Numbers per unit length for compiled code, for a roller of a length [m]."""
        return LawNumbers(
            kind=POWER, coefficient=self.coefficient / length, exponent=self.exponent, damping=self.damping / length,
            damping_time=self.damping_time, centre=0.0, inverse_scale=0.0, highest=math.inf, safe_approach=math.inf,
            lift_off=0.0, slope=1.0, held_approach=math.inf, held_load=math.inf, held_stiffness=0.0, held_damping=0.0,
        ), None  # fmt: skip


Law: TypeAlias = "DryLaw | ContactLaw"
"""What is no `DryLaw` is the law of a map or of the film formula, whose module is loaded with the first of them."""


def unilateral_forces(
    w: FloatArray, dw: FloatArray, c: FloatArray, dc: FloatArray, rate: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Loads of many contacts in motion, never a tension, and their derivatives.

    Parameters
    ----------
    w, dw : array
        Loads at rest, >= 0, and their derivatives by the approach, per unit length [N/m], [N/m2] or of whole bodies.
    c, dc : array
        Damping, >= 0, and its derivative by the approach [N s/m2], [N s/m3]; zero where w is.
    rate : array
        Rates of the approach [m/s]. All have one shape.

    Returns
    -------
    load, stiffness, damping : array
        F [N/m], dF/d delta [N/m2], dF/d rate [N s/m2], of the same shape.
    """
    states, forces = (
        np.stack([np.ravel(part) for part in (w, dw, c, dc, rate)], dtype=np.float64),
        np.empty((3, w.size)),
    )
    functions().forces(w.size, at(states), at(forces))
    load, stiffness, damping = forces.reshape(3, *w.shape)
    return load, stiffness, damping


def hertz(bearing: Bearing, damping: float = 0.0, damping_time: float = 0.0) -> PowerLaw:
    """Dry roller after ISO 16281: Q = c_L delta^(10/9), c_L = 35948 L^(8/9) (N, mm), delta of both contacts.

    Parameters
    ----------
    bearing : Bearing
        Bearing, of which roller length and material are taken; other materials than steel scale the load by
        E'/E'_steel.
    damping : float
        Constant c of each contact of a roller [N s/m]; both are in series, so that c/2 acts between the rings.
    damping_time : float
        Ratio of damping and stiffness of each contact [s], and so of both in series. Rules of thumb for rolling
        bearings lie between 0.25e-5 and 2.5e-5 s (Kraemer).

    References
    ----------
    ISO/TS 16281:2008. E. Kraemer, Dynamics of Rotors and Foundations, Springer, 1993.

    Examples
    --------
    >>> law = hertz(Bearing.named("NU308"))
    >>> round(float(law.load(10e-6)), 1)
    2392.6
    """
    coefficient = roller_coefficient(bearing.geometry.roller_length, bearing.material)
    c, time = _number("hertz", "damping", damping), _number("hertz", "damping_time", damping_time)
    return PowerLaw("hertz", "series", coefficient, _EXPONENT, 0.5 * c, time)


def roller_coefficient(length: float, material: Material) -> float:
    """Load of a dry roller at a total approach of 1 m after ISO 16281 [N/m^(10/9)], see `hertz`.

    Parameters
    ----------
    length : float
        Effective length of the roller [m].
    material : Material
        Material of rollers and rings.
    """
    stiffer = reduced_modulus(material, material) / STEEL_REDUCED_MODULUS
    return float(ISO_LINE_CONSTANT * (1e3 * length) ** (8.0 / 9.0) * 1e3**_EXPONENT * stiffer)


def constant(stiffness: float, damping: float = 0.0) -> PowerLaw:
    """Constant stiffness and damping while there is contact; two contacts in series, so k/2 and c/2.

    Parameters
    ----------
    stiffness : float
        k of each contact of a roller [N/m].
    damping : float
        c of each contact of a roller [N s/m].
    """
    k, c = _number("constant", "stiffness", stiffness), _number("constant", "damping", damping)
    return PowerLaw("constant", "series", 0.5 * k, 1.0, 0.5 * c)


def formula(
    bearing: Bearing,
    lubricant: Lubricant,
    *,
    load: tuple[float, float] = (100.0, 1e6),
    entrainment_speed: tuple[float, float] = (0.05, 10.0),
    temperature: tuple[float, float] = (293.15, 393.15),
    film_formula: FilmFormula = "moes",
    damping: DampingFormula = "rigid",
    structural_law: StructuralLaw = "iso16281",
    kind: LawKind = "series",
    outside: OutsidePolicy = "error",
    supply: OilSupply | None = None,
    surface: Surface | None = None,
) -> ContactLaw:
    """Law of a film formula over a range of loads, speeds and temperatures; takes some seconds.

    Parameters
    ----------
    bearing : Bearing
        Geometry and material.
    lubricant : Lubricant
        The oil.
    load, entrainment_speed, temperature : (float, float)
        Lowest and highest [N/m], [m/s], [K], as of a map.
    film_formula, damping, structural_law
        See `ehdmaps.physics.closed_form.FormulaSolver` and `ehdmaps.physics.approach`.
    kind, outside
        See `ContactLaw`.
    supply : OilSupply, optional
        Oil before each contact; flooded if left out.
    surface : Surface, optional
        Roughness of the surfaces; smooth if left out.

    Raises
    ------
    InputError
        For empty ranges.
    SolverError
        Where the formula gives no film.
    """
    from ehdmaps.maps.grid_field import GridField  # dry laws need nothing of a map
    from ehdmaps.maps.law import ContactLaw
    from ehdmaps.physics.closed_form import FormulaSolver

    problems = Problems(
        f"law 'formula', {name}: got {given!r}; allowed: (lowest, highest), finite, 0 < lowest < highest"
        for name, given in (("load", load), ("entrainment_speed", entrainment_speed), ("temperature", temperature))
        if not (len(given) == 2 and 0.0 < given[0] < given[1] < math.inf)
    )
    problems.check()
    contacts = bearing.geometry.contacts(bearing.material, structural_law)
    chosen = tuple(contact for contact in contacts if kind in ("series", contact.name))
    if not chosen:
        raise InputError(f"law 'formula', kind: got {kind!r}; allowed: series, inner, outer")
    loads = _axis(load, 0.25)
    speeds = _axis(entrainment_speed, 0.25)
    temperatures = np.linspace(*temperature, max(4, math.ceil((temperature[1] - temperature[0]) / 8.0) + 1))
    # a law has corners of cold oil and light loads that no bearing comes to: its films fade there
    solver = FormulaSolver(film_formula, math.inf, damping)
    films = [_films(contact, lubricant, solver, loads, speeds, temperatures) for contact in chosen]
    offset, compliance, loss = (np.stack(part) for part in zip(*films, strict=True))
    field = GridField(chosen, lubricant, loads, speeds, temperatures, offset, compliance, loss)
    title, oil = bearing.geometry.title, supply or FLOODED
    return ContactLaw(kind, chosen, lubricant, field, outside, supply=oil, surface=surface or SMOOTH, title=title)


def _films(
    contact: LineContact,
    lubricant: Lubricant,
    solver: FormulaSolver,
    loads: FloatArray,
    speeds: FloatArray,
    temperatures: FloatArray,
) -> tuple[FloatArray, ...]:
    """Film offset, film compliance and loss compliance of one contact on the grid."""
    out = np.empty((3, loads.size, speeds.size, temperatures.size))
    for j, speed in enumerate(speeds):
        for k, kelvin in enumerate(temperatures):
            films = solver.solve_line(contact, lubricant, tuple(loads.tolist()), float(speed), float(kelvin))
            for i, film in enumerate(films):
                out[:, i, j, k] = film.film_offset, film.film_compliance, film.loss_compliance
                if not np.all(np.isfinite(out[:, i, j, k])):
                    raise SolverError(
                        f"law 'formula': no film at {loads[i]:.6g} N/m, {speed:.6g} m/s, {kelvin:.6g} K "
                        f"({film.reason}); choose narrower ranges, or the formula moes"
                    )
    return out[0], out[1], out[2]


def _axis(ends: tuple[float, float], step: float) -> FloatArray:
    """Nodes evenly spaced in the logarithm, at least four."""
    return np.asarray(np.geomspace(*ends, max(4, math.ceil(math.log(ends[1] / ends[0]) / step) + 1)))


def _number(law: str, key: str, value: float) -> float:
    """A number, or a typed error."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.floating | np.integer):
        raise InputError(f"law {law!r}, {key}: got {value!r}; allowed: a finite number")
    return float(value)


_ALIKE = 1e-6
"""Part by which lengths of a law may differ from those of its bearing."""


def law_problems(where: str, law: Law, bearing: Bearing, kind: LawKind) -> list[str]:
    """List why a law is not that of the contacts of a bearing.

    Parameters
    ----------
    where : str
        What takes the law; begins the messages.
    law : Law
        The law.
    bearing : Bearing
        The bearing.
    kind : {"series", "inner", "outer"}
        Both contacts of a roller, or one.
    """
    if isinstance(law, DryLaw):
        wanted = "series" if kind == "series" else "single"
        got = {
            "series": "got the law of a single contact; allowed: that of a roller between both raceways; leave out "
            "`single()`",
            "single": f"got the law {law.name!r} of a whole roller; allowed: that of one contact; use `single()`",
        }[wanted]
        return [] if law.kind == wanted else [f"{where}: {got}"]
    from ehdmaps.maps.law import ContactLaw  # it is loaded already, if the law is one

    if not isinstance(law, ContactLaw):
        return [f"{where}: got {type(law).__name__}; allowed: a law of mbs.bearings.laws, or the law {kind!r} of a map"]
    if law.kind != kind:
        return [f"{where}: got the law {law.kind!r}; allowed: {kind!r}"]
    geometry = bearing.geometry
    radii = {"inner": geometry.inner_radius, "outer": geometry.outer_radius}
    pairs = (
        (contact.name, name, got, wanted)
        for contact in law.contacts
        for name, got, wanted in (
            ("radius", contact.radius, radii[contact.name]),
            ("roller_length", contact.roller_length, geometry.roller_length),
        )
    )
    return [
        f"{where}, contact {contact!r}, {name}: got {got:.6g} m; the bearing {geometry.name!r} has {wanted:.6g} m; "
        "take a map made for it"
        for contact, name, got, wanted in pairs
        if got is not None and abs(got - wanted) > _ALIKE * wanted
    ]


class FlatLaw:
    """A law, and its data for C.

    Parameters
    ----------
    law : Law
        Law of a roller between both raceways.
    """

    def __init__(self, law: Law) -> None:
        self.law = law
        self._data: dict[bool, LawRecord] = {}

    def __reduce__(self) -> tuple[Any, ...]:
        """For other processes: the law alone."""
        return FlatLaw, (self.law,)

    def data(self, law: ContactLaw, centrifugal: bool) -> LawRecord:
        """Data of `law` for C, with the single contacts where they are needed.

        Parameters
        ----------
        law : ContactLaw
            The law, of a map.
        centrifugal : bool
            Whether there are centrifugal loads.
        """
        if centrifugal not in self._data:
            from ehdmaps.maps.kernels.law_in_c import LawRecord  # it is loaded already, with the law

            self._data[centrifugal] = LawRecord.of(law.table if centrifugal else law.plain_table, centrifugal)
        return self._data[centrifugal]

    def film_part(self, law: ContactLaw, entrainment_speed: float) -> float:
        """Part of the film of `law` that is there at a speed [m/s]."""
        return functions().film_part(self.data(law, False).address, entrainment_speed)
