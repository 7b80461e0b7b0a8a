"""Heat of a contact: its data, the film's reduction by shear in the inlet, and `physics = "inlet-heat"`.

Heat in the inlet as a layer over isothermal films: `physics = "inlet-heat"`.

The oil that turns back in the inlet shears itself warm, and what enters the contact is thinner. Laid over an isothermal
film that is a factor phi of the film, with three rules:

- central and smallest film, flow and rolling force times phi, film offset times phi^0.9,
- film compliance minus the derivative of that film offset by load, so that laws can be made of both,
- loss compliance times phi^n, n = 2.2 M/(M + 0.7).

    phi = 1/(1 + 0.215 QL^0.73 M^0.064 M/(M + 0.23)),    QL = -(d eta0/dT) u^2/k_f

with Moes' M of the isothermal contact, which is kept, as L is: a hotter oil, or a lower speed, in place of the factors
has the film and not the damping. Factors from the literature are for loaded contacts: that of Wilson and Sheu,
1/(1 + 0.241 QL^0.64), is this one at high M, and 5 to 12 % too low below M = 0.5. A solve with temperatures
(`physics = "thermal"`) has none of these limits. Point contacts have the same rule, see
`ehdmaps.physics.point.inlet_heat`.

References
----------
W. R. D. Wilson, S. Sheu, Effect of inlet shear heating due to sliding on elastohydrodynamic film thickness, Journal of
Lubrication Technology 105, 1983, 187-188.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, Values, as_given
from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.lubricant import HEAT_CAPACITY, Lubricant
from ehdmaps.physics.moes import moes_groups, valley_load_number
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.solution import FilmSolution, FilmSpectrum, Status, no_spectrum

_KELVIN = 0.01
"""Step of the difference quotient by temperature."""


def viscosity_slope(lubricant: Lubricant, temperature: float) -> float:
    """d eta0/dT [Pa s/K], <= 0, of an oil at a temperature [K].

    Parameters
    ----------
    lubricant : Lubricant
        The oil.
    temperature : float
        T [K].

    Examples
    --------
    >>> round(1e3 * viscosity_slope(Lubricant.named("FVA3"), 313.15), 2)
    -4.31
    """
    at, above = (lubricant.at(temperature + more).viscosity for more in (0.0, _KELVIN))
    return min((above - at) / _KELVIN, 0.0)


HOTTEST_SURFACE = 473.15
"""Temperature of a surface up to which a film with temperatures is told without a remark [K]: 200 degC, at which common
bearing steels have lost hardness, and to which no viscosity of an oil is measured."""

THINNEST_HOT_FILM = 5e-9
"""Central film down to which it is [m]: some molecules of an oil, whose viscosity is no longer that of much oil."""


def extreme_note(surface_temperature: float, central_film: float) -> str:
    """Remark on a film with temperatures that no oil and no steel would have; empty where there is none.

    Parameters
    ----------
    surface_temperature : float
        Highest temperature of the surfaces [K]; NaN of an isothermal film, of which nothing is said.
    central_film : float
        [m].

    Examples
    --------
    >>> extreme_note(520.0, 15e-9)
    'surfaces at 247 degC: above 200 degC neither steel nor oil are what they were'
    """
    notes = []
    if surface_temperature > HOTTEST_SURFACE:
        notes.append(
            f"surfaces at {surface_temperature - 273.15:.0f} degC: above {HOTTEST_SURFACE - 273.15:.0f} degC neither "
            "steel nor oil are what they were"
        )
    if central_film < THINNEST_HOT_FILM and not math.isnan(surface_temperature):
        notes.append(f"film of {1e9 * central_film:.2g} nm: some molecules, below {1e9 * THINNEST_HOT_FILM:g} nm")
    return "; ".join(notes)


ISOTHERMAL, INLET_HEAT, THERMAL = "isothermal", "inlet-heat", "thermal"
PHYSICS = (ISOTHERMAL, INLET_HEAT, THERMAL)
"""Words for what a solver knows of heat, in jobs and on command lines: nothing, heat in the inlet by a formula laid
over isothermal films, or temperatures in the film."""


@dataclass(frozen=True)
class HeatData:
    """Thermal data of oil and surfaces; constant over temperature and pressure.

    Attributes
    ----------
    oil_conductivity : float
        k_f [W/(m K)].
    oil_heat_capacity : float
        c_p of the oil [J/(kg K)].
    solid_conductivity : float
        k_s of both bodies [W/(m K)].
    solid_heat_capacity : float
        c_s [J/(kg K)].
    solid_density : float
        rho_s [kg/m3].

    Raises
    ------
    InputError
        With every value that is not finite and above zero.
    """

    oil_conductivity: float = 0.134
    oil_heat_capacity: float = HEAT_CAPACITY
    solid_conductivity: float = STEEL.conductivity
    solid_heat_capacity: float = STEEL.heat_capacity
    solid_density: float = STEEL.density

    def __post_init__(self) -> None:
        values = ((entry.name, getattr(self, entry.name)) for entry in fields(self))
        problems = Problems(
            f"heat, {name}: got {value!r}; allowed: finite and > 0"
            for name, value in values
            if not (math.isfinite(value) and value > 0)
        )
        problems.check()


def heat_data(lubricant: Lubricant, material: Material) -> HeatData:
    """Heat data of a contact.

    Parameters
    ----------
    lubricant : Lubricant
        The oil.
    material : Material
        Material of both bodies.

    Raises
    ------
    InputError
        If nobody stated the conductivity of the oil.

    Examples
    --------
    >>> heat_data(Lubricant.named("FVA3"), STEEL) == HeatData()
    True
    """
    if lubricant.thermal_conductivity is None:
        raise InputError(
            f"lubricant {lubricant.name!r}, thermal_conductivity: got none; films with heat need it; give it in "
            "[lubricant], mineral oils have about 0.13 W/(m K), or choose physics isothermal"
        )
    return HeatData(
        oil_conductivity=lubricant.thermal_conductivity,
        oil_heat_capacity=lubricant.heat_capacity,
        solid_conductivity=material.conductivity,
        solid_heat_capacity=material.heat_capacity,
        solid_density=material.density,
    )


def heat_in_force(asked: bool | None, lubricant: Lubricant | None) -> bool:
    """Tell whether heat in the inlet thins films of the film table.

    Parameters
    ----------
    asked : bool or None
        What was asked for; None for the default, which is on: its absence is a known error, and it costs a tenth.
    lubricant : Lubricant or None
        The oil; by default films of one whose conductivity nobody stated are isothermal, and say so.

    Examples
    --------
    >>> heat_in_force(None, Lubricant.named("FVA3")), heat_in_force(None, None)
    (True, False)
    """
    return (lubricant is not None and lubricant.thermal_conductivity is not None) if asked is None else asked


HEATING, BY_LOADING, BY_LOAD, LIGHTEST = 0.215, 0.73, 0.064, 0.23
"""Numbers of the factor; at M of the last one the heating is half of that of a loaded contact. Fitted to 82 lines
with temperatures of two oils, M 0.3 to 60, QL 0.15 to 3, L 10 to 20: films within 5.1 %, rms 1.5 %. 41 of a third oil,
FVA 3, were left out, and are within 1.1 % at M of 2 and more, 2.8 % below: `tests/references/warm_lines.toml`."""

OFFSET = 0.9
"""Exponent with which the film offset of a line goes with the factor of its film: within 2 % of the same lines."""

FITTED_LOADING = 3.0
"""QL up to which films with temperatures made the rule."""

LARGEST_LOADING = 8.0
"""QL above which no factor is given. Up to here the rule was compared with 18 lines that it has not seen, QL 5 and 8 of
three oils, M 2.5 to 30: films within 3.5 %, offsets within 5.2 %, losses 0.6 to 1.4 of the rule."""

BEYOND = 0.4
"""Growth of the error of film compliance and loss compliance with QL - 3, by 1 - phi: bounds all of these lines."""

LIGHT = 0.2
"""M below which none is given for loadings above `LIGHT_LOADING`: the inlet turns back so much oil there that
convection along the film counts."""

LIGHT_LOADING = 0.5

VALLEY = 0.35
"""Distance from the bottom of the damping valley, in ln M, within which film compliance and loss pass through zero or
nearly so, and no factor of theirs is right."""

VALLEY_OIL_NUMBER = 14.0
"""L above which the valley is that deep."""

UNNOTICED = 0.99
"""Factor above which nothing is refused: films change by less than what the rule is wrong by elsewhere."""


@dataclass(frozen=True)
class InletHeat:
    """Effect of heat in the inlet on one isothermal film, or on several: then numbers are arrays.

    Attributes
    ----------
    factor : float or array
        Factor phi of the film; 1 without heat.
    refused : str
        Why the rule does not hold for one film; empty where it does, and for several.
    slope : float or array
        Derivative of phi by load [m/N].
    exponent : float or array
        n: the loss compliance goes with phi^n.
    offset_exponent : float
        The film offset goes with phi to this.
    film_error, loss_error : float or array
        How far the film, and film compliance and loss compliance, may be from those of a film with temperatures,
        relative: bounds of the rule itself, beside the numerical errors of the isothermal film.
    """

    factor: Any
    refused: str
    slope: Any
    exponent: Any
    film_error: Any
    loss_error: Any
    offset_exponent: float = OFFSET

    @property
    def loss_factor(self) -> Any:
        """Factor of the loss compliance."""
        return self.factor**self.exponent

    @property
    def offset_factor(self) -> Any:
        """Factor of the film offset."""
        return self.factor**self.offset_exponent

    @property
    def numbers(self) -> dict[str, Any]:
        """Numbers that differ between several films, by name."""
        alike = ("refused", "offset_exponent")
        return {entry.name: getattr(self, entry.name) for entry in fields(self) if entry.name not in alike}

    def of(self, index: Any, refused: str = "") -> InletHeat:
        """Heat of some of several films, or of one.

        Parameters
        ----------
        index : int or index of arrays
            Place of the film, or of several.
        refused : str
            Reason why the rule does not hold for it.
        """
        numbers = {name: np.asarray(value)[index] for name, value in self.numbers.items()}
        return replace(self, refused=refused, **numbers)

    def compliance(self, film_compliance: Any, film_offset: Any) -> Any:
        """Film compliance with heat, of those of the isothermal film.

        Parameters
        ----------
        film_compliance, film_offset : float or array
            Numbers of the isothermal film [m2/N], [m].
        """
        return self.offset_factor * (film_compliance - film_offset * self.offset_exponent * self.slope / self.factor)

    @property
    def note(self) -> str:
        """Note on a film; nothing where heat changes it by less than a per cent."""
        if self.factor > UNNOTICED:
            return ""
        return (
            f"inlet heat by a formula: film x {self.factor:.3f} within {100.0 * self.film_error:.1f} %, loss x "
            f"{self.loss_factor:.3f}, loss and film compliance within {100.0 * self.loss_error:.0f} %"
        )


def inlet_heat_factor(load_number: Values, loading: Values) -> Values:
    """Factor phi of the film.

    Parameters
    ----------
    load_number : float or array
        Moes' M of the isothermal contact, > 0.
    loading : float or array
        QL, see `heat_loading`, >= 0.

    Notes
    -----
    A fit to films with temperatures: see `docs/evidence.md` for what it is worth on contacts that it was not made for.

    Examples
    --------
    >>> round(inlet_heat_factor(20.0, 0.5), 3)
    0.866
    """
    heating = HEATING * loading**BY_LOADING * load_number ** (1.0 + BY_LOAD) / (load_number + LIGHTEST)
    return as_given(1.0 / (1.0 + heating), load_number)


def inlet_heat(contact: LineContact, lubricant: Lubricant, point: OperatingPoint) -> InletHeat:
    """Effect of heat in the inlet on the isothermal film of a point.

    Parameters
    ----------
    contact : LineContact
        The contact.
    lubricant : Lubricant
        The oil; its conductivity has to be known.
    point : OperatingPoint
        Load, speed and temperature.

    Raises
    ------
    InputError
        Without the conductivity of the oil.
    """
    if point.entrainment_speed == 0.0:
        heat_data(lubricant, contact.material)
        return InletHeat(1.0, "", 0.0, 1.0, 0.0, 0.0)
    at = np.array([[point.load], [point.entrainment_speed], [point.temperature]])
    several, groups = _heats(contact, lubricant, *at)
    M, L, loading = (float(group[0]) for group in groups)
    return several.of(0, _refused(M, L, loading, float(several.factor[0])))


def inlet_heats(
    contact: LineContact, lubricant: Lubricant, load: FloatArray, speed: FloatArray, temperature: FloatArray
) -> InletHeat:
    """Effect of heat in the inlet on isothermal films; arrays of one shape.

    Nothing is refused: the factors go on smoothly where no factor is known, and the errors are as large as the effect.

    Parameters
    ----------
    contact, lubricant
        Contact and oil, whose conductivity has to be known.
    load, speed, temperature : array
        w [N/m] > 0, u [m/s] > 0 and T [K].

    Raises
    ------
    InputError
        Without the conductivity of the oil.
    """
    return _heats(contact, lubricant, load, speed, temperature)[0]


def _heats(
    contact: LineContact, lubricant: Lubricant, load: FloatArray, speed: FloatArray, temperature: FloatArray
) -> tuple[InletHeat, tuple[FloatArray, FloatArray, FloatArray]]:
    """The same, and M, L and QL."""
    loading, M, L = heat_loading(lubricant, speed, temperature), np.empty(load.shape), np.empty(load.shape)
    for kelvin in np.unique(temperature).tolist():
        here, state = temperature == kelvin, lubricant.at(kelvin)
        alpha = state.pressure_viscosity.pressure_viscosity
        one_M, one_L = moes_groups(1.0, 1.0, state.viscosity, alpha, contact.radius, contact.reduced_modulus)
        M[here], L[here] = one_M * load[here] / np.sqrt(speed[here]), one_L * speed[here] ** 0.25
    factor = inlet_heat_factor(M, loading)
    unknown = np.logical_or.reduce(_unknown(M, L, loading, factor))
    return heat_by_factor(M, factor, load, unknown, np.abs(_zeta(M, L)) <= 1.0, loading), (M, L, loading)


def heat_loading(lubricant: Lubricant, speed: FloatArray, temperature: FloatArray) -> FloatArray:
    """Thermal loading QL = -(d eta0/dT) u^2/k_f of an oil at speeds and temperatures; arrays of one shape.

    Parameters
    ----------
    lubricant : Lubricant
        The oil.
    speed, temperature : array
        u [m/s], T [K].

    Raises
    ------
    InputError
        Without the conductivity of the oil.
    """
    conductivity = heat_data(lubricant, STEEL).oil_conductivity
    loading = np.empty(speed.shape)
    for kelvin in np.unique(temperature).tolist():
        here = temperature == kelvin
        loading[here] = -viscosity_slope(lubricant, kelvin) / conductivity * speed[here] ** 2
    return loading


def beyond_rule(lubricant: Lubricant, speed: float, temperature: float) -> str:
    """Remark on films with more heat than any film that told the rule; empty within, where they go on smoothly.

    Parameters
    ----------
    lubricant : Lubricant
        The oil.
    speed, temperature : float
        u [m/s], T [K].

    Raises
    ------
    InputError
        Without the conductivity of the oil.
    """
    loading = float(heat_loading(lubricant, np.array([speed]), np.array([temperature]))[0])
    if not loading > LARGEST_LOADING:
        return ""
    return f"inlet heat beyond its rule: QL = {loading:.2g}, films with temperatures told it up to {LARGEST_LOADING:g}"


LOSS = 2.2
"""Exponent of the loss compliance of heavily loaded lines."""


def heat_by_factor(
    load_number: FloatArray,
    factor: FloatArray,
    load: FloatArray,
    unknown: BoolArray,
    valley: BoolArray,
    loading: FloatArray,
    power: float = 1.0,
    loss: float = LOSS,
    offset: float = OFFSET,
) -> InletHeat:
    """Heat of films whose factor is known.

    Parameters
    ----------
    load_number, factor, load : array
        M of the line, phi, and the load [N/m] or [N].
    unknown, valley : array of bool
        Films of which no factor is known, and those whose film compliance or loss is zero or nearly so.
    loading : array
        Thermal loading QL.
    power : float
        Exponent of the load in M.
    loss, offset : float
        Exponents of the loss compliance of high loads, and of the film offset.
    """
    thinner = 1.0 - factor
    by_load = power * (BY_LOAD + LIGHTEST / (load_number + LIGHTEST))
    light = 1.0 / (1.0 + load_number)
    beyond = BEYOND * np.clip(loading - FITTED_LOADING, 0.0, None)
    return InletHeat(
        factor=factor,
        refused="",
        slope=-thinner * factor * by_load / load,
        exponent=loss * load_number / (load_number + 0.7),
        film_error=np.where(unknown, 1.0, 0.3 + 0.4 * light) * thinner,
        loss_error=np.where(unknown | valley, 4.0, 0.5 + 0.5 * light + beyond) * thinner,
        offset_exponent=offset,
    )


def _zeta(M: FloatArray, L: FloatArray) -> FloatArray:
    """Distance from the bottom of the damping valley in ln M."""
    return np.log(M / valley_load_number(L))


def _unknown(M: FloatArray, L: FloatArray, loading: FloatArray, factor: FloatArray) -> tuple[BoolArray, ...]:
    """Tell where no factor is known: too much heat, a light contact with much heat, the damping valley."""
    noticed = factor <= UNNOTICED
    return (
        np.asarray(loading > LARGEST_LOADING),
        np.asarray(noticed & (M < LIGHT) & (loading > LIGHT_LOADING)),
        np.asarray(noticed & (np.abs(_zeta(M, L)) < VALLEY) & (L > VALLEY_OIL_NUMBER)),
    )


def _refused(M: float, L: float, loading: float, factor: float) -> str:
    """Reason why the rule does not hold for one film; empty where it does."""
    hot, light, valley = _unknown(*(np.array(value) for value in (M, L, loading, factor)))
    instead = "solve with physics thermal"
    if hot:
        return f"inlet heat: loading QL = {loading:.3g} above {LARGEST_LOADING:g}, where no factor is known; {instead}"
    if light:
        return (
            f"inlet heat: M = {M:.3g} below {LIGHT:g} at a loading QL = {loading:.3g} above {LIGHT_LOADING:g}, where "
            f"no factor is known; {instead}"
        )
    if valley:
        zeta = float(_zeta(np.array(M), np.array(L)))
        return (
            f"inlet heat: M = {M:.3g} is {abs(zeta):.2f} in ln M from the bottom of the damping valley, below "
            f"{VALLEY:g} at L = {L:.3g} above {VALLEY_OIL_NUMBER:g}, where no factor holds; {instead}"
        )
    return ""


THINNED = ("central_film", "minimum_film", "rolling_force", "mass_flow")
"""Numbers of a film that go with its factor."""


def heated(film: FilmSolution, heat: InletHeat) -> FilmSolution:
    """An isothermal film with heat in its inlet.

    Parameters
    ----------
    film : FilmSolution
        The isothermal film; one that is not usable stays what it is.
    heat : InletHeat
        The heat of the same point.
    """
    if not film.status.usable:
        return film
    if heat.refused:
        return FilmSolution(
            Status.OUTSIDE_VALIDITY, heat.refused, iterations=film.iterations, solve_seconds=film.solve_seconds
        )
    return replace(
        film,
        reason="; ".join(filter(None, (film.reason, heat.note))),
        film_offset=film.film_offset * heat.offset_factor,
        film_compliance=heat.compliance(film.film_compliance, film.film_offset),
        loss_compliance=film.loss_compliance * heat.loss_factor,
        **{name: getattr(film, name) * heat.factor for name in THINNED},
    )


def heated_spectrum(spectrum: FilmSpectrum, heat: InletHeat) -> FilmSpectrum:
    """An isothermal film over frequency with heat in its inlet.

    The real part of the film compliance goes as that of slow motion, the imaginary part as the loss compliance.

    Parameters
    ----------
    spectrum : FilmSpectrum
        The isothermal film over frequency.
    heat : InletHeat
        The heat of the same point.

    Notes
    -----
    Known in the limit of slow motion only; at high frequencies an assumption.
    """
    film = heated(spectrum.film, heat)
    if not film.status.usable:
        return no_spectrum(film, spectrum.frequencies)
    kept = heat.compliance(spectrum.compliance.real, spectrum.film.film_offset)
    return replace(
        spectrum,
        film=film,
        compliance=np.asarray(kept + 1j * heat.loss_factor * spectrum.compliance.imag),
        errors=np.asarray(heat.offset_factor * spectrum.errors.real + 1j * heat.loss_factor * spectrum.errors.imag),
    )
