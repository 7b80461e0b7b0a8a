"""The file `constant/ehlProperties`: all that a case of `ehlFoam` is told about its point, its oil over temperature.

Its entries are those of `dictionary`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from typing import Literal

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.openfoam.dictionary import (
    HEADER,
    block,
    camel,
    count,
    density_law,
    entry,
    line,
    number_list,
    oil_blocks,
    oil_numbers,
    switch,
    word,
)
from ehdmaps.physics.heat import HeatData
from ehdmaps.physics.lubricant import Lubricant, LubricantState
from ehdmaps.physics.rheology import CARREAU, EYRING, LIMITING, NEWTONIAN, ShearLaw

STEP = 4.0
"""From one isotherm to the next [K].

The cubic through four of them errs in ln(eta) by at most 1e-5 at ambient pressure and 1e-4 at 1 GPa from 20 degC up
with any law, by 5e-4 at 1 GPa near -10 degC, where the law of FVA 3 ends.
"""

BELOW, ABOVE = 60.0, 400.0
"""How far the isotherms reach below and above the temperature of the surfaces, where the laws of the oil do [K]."""

FEWEST = 4
"""Isotherms of one cubic."""


@dataclass(frozen=True)
class Isotherms:
    """States of an oil at equal steps of temperature.

    Attributes
    ----------
    first : float
        Temperature of the first [K].
    states : tuple of LubricantState
        All with the same law over pressure; at least `FEWEST`.
    """

    first: float
    states: tuple[LubricantState, ...]


def isotherms(lubricant: Lubricant, temperature: float) -> Isotherms:
    """Isotherms of an oil about a temperature [K], which is one of them, as far as its laws hold.

    Raises
    ------
    InputError
        If the laws break down at the temperature itself, or hold over too few kelvin about it.
    """
    middle = lubricant.at(temperature)
    kind = middle.pressure_viscosity.case_name

    def outwards(direction: float, reach: float) -> Iterator[LubricantState]:
        """States away from the temperature until the laws end."""
        for k in range(1, int(reach / STEP) + 1):
            try:
                state = lubricant.at(temperature + direction * k * STEP)
            except InputError:
                return
            if state.pressure_viscosity.case_name != kind:
                return
            yield state

    colder, hotter = list(outwards(-1.0, BELOW)), list(outwards(1.0, ABOVE))
    states = (*reversed(colder), middle, *hotter)
    if len(states) < FEWEST or not hotter:
        raise InputError(
            f"lubricant {lubricant.name!r}, temperature: got {temperature:.6g} K, about which its laws hold over "
            f"{STEP * (len(states) - 1):g} K; allowed with heat: at least {STEP * (FEWEST - 1):g} K, and some above it"
        )
    return Isotherms(temperature - STEP * len(colder), states)


Flow = Literal["thin_film", "full_stress"]

FLOWS: Mapping[Flow, str] = {"thin_film": "thinFilm", "full_stress": "fullStress"}
"""Words of a job file and those of the dictionary."""

SHEAR_FORMS: Mapping[int, str] = {NEWTONIAN: "Newtonian", EYRING: "Eyring", CARREAU: "Carreau", LIMITING: "limiting"}
"""Forms of the laws of shear and their words in the dictionary."""

NEWTON = ShearLaw()
"""The law of an oil that does not care about shear."""


@dataclass(frozen=True)
class Temperatures:
    """Temperatures of a film.

    Attributes
    ----------
    levels : ndarray, shape (k,)
        Heights across the film, from 0 at the lower surface to 1 at the upper one.
    values : ndarray, shape (k, n)
        Temperatures there, over the places along the film [K].
    """

    levels: FloatArray
    values: FloatArray


@dataclass(frozen=True)
class Start:
    """A film to start from.

    Attributes
    ----------
    x : ndarray, shape (n,)
        Positions from the contact centre, increasing [m].
    pressure : ndarray, shape (n,)
        [Pa].
    central_film : float
        [m].
    temperatures : Temperatures, optional
        Those at the positions: the run begins with all of its heat, and ends where that leads nowhere. Without them it
        begins with an isothermal film.
    """

    x: FloatArray
    pressure: FloatArray
    central_film: float
    temperatures: Temperatures | None = None


@dataclass(frozen=True)
class Mesh:
    """Places of the columns of cells.

    Attributes
    ----------
    film : float
        Expected film H = h R/b^2.
    inlet_length : float
        Length of the inlet in units of sqrt(2 h R).
    outlet_length : float
        Length beyond the exit in widths of the exit zone.
    spike_position, spike_width : float
        Pressure spike from the contact centre, and width of the finest columns around it [b]; width 0: no spike.
    """

    film: float
    inlet_length: float = 20.0
    outlet_length: float = 3.0
    spike_position: float = 0.0
    spike_width: float = 0.0


@dataclass(frozen=True)
class Heat:
    """Data that the energy of a film is solved with.

    Attributes
    ----------
    temperature : float
        Temperature of the surfaces far from the contact and of the oil that comes in [K].
    data : HeatData
        How oil and surfaces take and lead heat.
    oil : Isotherms
        The oil over temperature.
    """

    temperature: float
    data: HeatData
    oil: Isotherms


@dataclass(frozen=True)
class Oscillation:
    """A small oscillation of the load, integrated in time.

    Attributes
    ----------
    frequency : float
        [Hz].
    amplitude : float
        Amplitude as a share of the load.
    steps_per_cycle, cycles : int
        Steps and cycles of the time integration.
    """

    frequency: float
    amplitude: float = 1e-3
    steps_per_cycle: int = 200
    cycles: int = 3


@dataclass(frozen=True)
class Parameters:
    """One run of `ehlFoam`.

    Attributes
    ----------
    reduced_radius : float
        R [m].
    reduced_modulus : float
        E' = 2/(...) [Pa].
    load : float
        w [N/m].
    lower_speed, upper_speed : float
        Speeds of the surfaces [m/s].
    oil : LubricantState
        State of the oil at the temperature of the point.
    cavitation_range : float
        Range of pressure over which liquid turns into the cavitated mixture [Pa].
    mesh : Mesh
        Positions of the columns.
    columns, rows : int
        Cells along and across the film.
    flow : {"thin_film", "full_stress"}
        Stress of thin films, or all of it with the pressure across the film.
    shear : ShearLaw
        Law of the shear stress, in Pa.
    heat : Heat, optional
        None for an isothermal film.
    start : Start, optional
        None starts from the dry contact.
    frequencies : tuple of float
        Frequencies of the linear response [Hz]; 0 is the low-frequency limit.
    oscillation : Oscillation, optional
        Oscillation in time, a check of the linear response by the same equations.
    max_iterations : int
        Number of iterations after which a run counts as stagnated.
    tolerance : float
        Relative, of the balances.
    write_fields : bool
        Whether the fields are written when the run is done.
    """

    reduced_radius: float
    reduced_modulus: float
    load: float
    lower_speed: float
    upper_speed: float
    oil: LubricantState
    cavitation_range: float
    mesh: Mesh
    columns: int
    rows: int
    flow: Flow = "thin_film"
    shear: ShearLaw = NEWTON
    heat: Heat | None = None
    start: Start | None = None
    frequencies: tuple[float, ...] = (0.0,)
    oscillation: Oscillation | None = None
    max_iterations: int = 60
    tolerance: float = 1e-9
    write_fields: bool = False

    def text(self) -> str:
        """Return the dictionary.

        Raises
        ------
        InputError
            For anything but a finite number where a number belongs, or an unknown word.
        """
        return "\n".join([HEADER, "", *self._lines(), ""])

    def _lines(self) -> Iterator[str]:
        yield entry("reducedRadius", self.reduced_radius)
        yield entry("reducedModulus", self.reduced_modulus)
        yield entry("load", self.load)
        yield entry("lowerSpeed", self.lower_speed)
        yield entry("upperSpeed", self.upper_speed)
        yield from oil_blocks(self.oil)
        yield from block("shear", _shear(self.shear))
        yield from block("cavitation", [entry("pressureRange", self.cavitation_range)])
        yield line("flow", word("flow", self.flow, FLOWS))
        yield count("columns", self.columns)
        yield count("rows", self.rows)
        mesh = [
            entry("film", self.mesh.film),
            entry("inletLength", self.mesh.inlet_length),
            entry("outletLength", self.mesh.outlet_length),
            entry("spikePosition", self.mesh.spike_position),
            entry("spikeWidth", self.mesh.spike_width),
        ]
        yield from block("mesh", mesh)
        if self.heat is not None:
            yield from block("heat", _heat(self.heat))
        if self.start is not None:
            start = [
                number_list("x", self.start.x),
                number_list("pressure", self.start.pressure),
                entry("centralFilm", self.start.central_film),
            ]
            if self.start.temperatures is not None:
                start.append(number_list("levels", self.start.temperatures.levels))
                start.append(number_list("temperatures", self.start.temperatures.values.ravel()))
            yield from block("start", start)
        yield from block("response", [number_list("frequencies", self.frequencies)])
        if self.oscillation is not None:
            oscillation = [
                entry("frequency", self.oscillation.frequency),
                entry("amplitude", self.oscillation.amplitude),
                count("stepsPerCycle", self.oscillation.steps_per_cycle),
                count("cycles", self.oscillation.cycles),
            ]
            yield from block("oscillation", oscillation)
        yield count("maxIterations", self.max_iterations)
        yield entry("tolerance", self.tolerance)
        yield switch("writeFields", self.write_fields)


def _heat(heat: Heat) -> list[str]:
    """Data of the heat, and the isotherms of the oil, their numbers as lists."""
    states = heat.oil.states
    numbers = [oil_numbers(state) for state in states]
    lists = [number_list(key, [each[key] for each in numbers]) for key in numbers[0]]
    viscosity = [line("type", states[0].pressure_viscosity.case_name), *lists]
    density = [line("type", density_law(states[0])), number_list("density", [state.density for state in states])]
    oil = [entry("first", heat.oil.first), entry("step", STEP)]
    oil += [*block("viscosity", viscosity), *block("density", density)]
    data = {camel(field.name): getattr(heat.data, field.name) for field in fields(heat.data)}
    return [
        entry("temperature", heat.temperature),
        *(entry(key, value) for key, value in data.items()),
        *block("isotherms", oil),
    ]


def _shear(law: ShearLaw) -> list[str]:
    """The law of shear under its name, with the numbers that it has."""
    entries = [line("type", word("shear", law.form, SHEAR_FORMS))]
    if law.form != NEWTONIAN:
        entries.append(entry("stress", law.stress))
    if law.form == LIMITING:
        entries.append(entry("ratio", law.ratio))
    if law.form == CARREAU:
        entries.append(entry("exponent", law.exponent))
    return entries
