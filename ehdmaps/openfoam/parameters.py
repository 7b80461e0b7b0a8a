"""The file `constant/ehlProperties`: all that a case of `ehlFoam` is told about its point, its oil over temperature.

OpenFOAM dictionaries can execute code. So nothing is written but finite numbers, by `repr`, and words of fixed tables.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from numbers import Real
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
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

HEADER = """FoamFile
{
    version     2.0;
    format      ascii;
    class       dictionary;
    object      ehlProperties;
}

// All values in SI"""

NOTES: Mapping[str, str] = {
    "reducedRadius": "R [m]",
    "reducedModulus": "E' [Pa]",
    "load": "per length [N/m]",
    "lowerSpeed": "of the surfaces, in +x [m/s]",
    "upperSpeed": "[m/s]",
    "viscosity": "at ambient pressure [Pa s]",
    "pressureViscosity": "there [1/Pa]",
    "pressureScale": "[Pa]",
    "density": "at ambient pressure [kg/m^3]",
    "stress": "[Pa]",
    "pressureRange": "from full film to no liquid [Pa]",
    "columns": "cells along the film",
    "rows": "and across it",
    "film": "expected film, h R/b^2",
    "inletLength": "in sqrt(2 h R), from the Hertz zone",
    "outletLength": "in widths of the exit zone",
    "spikePosition": "in half-widths b from the centre",
    "spikeWidth": "[b], 0: no spike",
    "temperature": "of the surfaces, and of the oil that comes in [K]",
    "oilConductivity": "[W/(m K)]",
    "oilHeatCapacity": "[J/(kg K)]",
    "solidConductivity": "[W/(m K)]",
    "solidHeatCapacity": "[J/(kg K)]",
    "solidDensity": "[kg/m^3]",
    "first": "[K]",
    "step": "[K]",
    "x": "from the contact centre [m]",
    "pressure": "[Pa]",
    "centralFilm": "[m]",
    "frequencies": "[Hz], 0 is the low-frequency limit",
    "frequency": "[Hz]",
    "amplitude": "of the load",
}
"""What is said behind an entry of the file."""

NUMBERS_A_LINE = 5
"""Of a long list."""


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
    """

    x: FloatArray
    pressure: FloatArray
    central_film: float


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
        yield _entry("reducedRadius", self.reduced_radius)
        yield _entry("reducedModulus", self.reduced_modulus)
        yield _entry("load", self.load)
        yield _entry("lowerSpeed", self.lower_speed)
        yield _entry("upperSpeed", self.upper_speed)
        isotherm = [_entry(key, value) for key, value in _numbers(self.oil).items()]
        yield from _block("viscosity", [_line("type", self.oil.pressure_viscosity.case_name), *isotherm])
        yield from _block("density", [_line("type", _density(self.oil)), _entry("density", self.oil.density)])
        yield from _block("shear", _shear(self.shear))
        yield from _block("cavitation", [_entry("pressureRange", self.cavitation_range)])
        yield _line("flow", _word("flow", self.flow, FLOWS))
        yield _count("columns", self.columns)
        yield _count("rows", self.rows)
        mesh = [
            _entry("film", self.mesh.film),
            _entry("inletLength", self.mesh.inlet_length),
            _entry("outletLength", self.mesh.outlet_length),
            _entry("spikePosition", self.mesh.spike_position),
            _entry("spikeWidth", self.mesh.spike_width),
        ]
        yield from _block("mesh", mesh)
        if self.heat is not None:
            yield from _block("heat", _heat(self.heat))
        if self.start is not None:
            start = [
                _list("x", self.start.x),
                _list("pressure", self.start.pressure),
                _entry("centralFilm", self.start.central_film),
            ]
            yield from _block("start", start)
        yield from _block("response", [_list("frequencies", self.frequencies)])
        if self.oscillation is not None:
            oscillation = [
                _entry("frequency", self.oscillation.frequency),
                _entry("amplitude", self.oscillation.amplitude),
                _count("stepsPerCycle", self.oscillation.steps_per_cycle),
                _count("cycles", self.oscillation.cycles),
            ]
            yield from _block("oscillation", oscillation)
        yield _count("maxIterations", self.max_iterations)
        yield _entry("tolerance", self.tolerance)
        yield _switch("writeFields", self.write_fields)


def _heat(heat: Heat) -> list[str]:
    """Data of the heat, and the isotherms of the oil, their numbers as lists."""
    states = heat.oil.states
    numbers = [_numbers(state) for state in states]
    lists = [_list(key, [each[key] for each in numbers]) for key in numbers[0]]
    viscosity = [_line("type", states[0].pressure_viscosity.case_name), *lists]
    density = [_line("type", _density(states[0])), _list("density", [state.density for state in states])]
    oil = [_entry("first", heat.oil.first), _entry("step", STEP)]
    oil += [*_block("viscosity", viscosity), *_block("density", density)]
    data = {_camel(field.name): getattr(heat.data, field.name) for field in fields(heat.data)}
    return [
        _entry("temperature", heat.temperature),
        *(_entry(key, value) for key, value in data.items()),
        *_block("isotherms", oil),
    ]


def _numbers(oil: LubricantState) -> dict[str, float]:
    """Numbers of an isotherm, in the dictionary's spelling."""
    try:
        numbers = oil.pressure_viscosity.case_numbers()
    except InputError as error:
        raise InputError([f"ehlProperties, {problem}" for problem in error.problems]) from None
    return {"viscosity": oil.viscosity} | {_camel(key): value for key, value in numbers.items()}


def _density(oil: LubricantState) -> str:
    """Name of the law of density."""
    return "DowsonHigginson" if oil.compressible else "incompressible"


def _shear(law: ShearLaw) -> list[str]:
    """The law of shear under its name, with the numbers that it has."""
    entries = [_line("type", _word("shear", law.form, SHEAR_FORMS))]
    if law.form != NEWTONIAN:
        entries.append(_entry("stress", law.stress))
    if law.form == LIMITING:
        entries.append(_entry("ratio", law.ratio))
    if law.form == CARREAU:
        entries.append(_entry("exponent", law.exponent))
    return entries


def _camel(name: str) -> str:
    """A name in the dictionary's spelling: pressure_scale is pressureScale."""
    first, *others = name.split("_")
    return first + "".join(map(str.capitalize, others))


def _block(name: str, entries: Sequence[str]) -> Iterator[str]:
    """A sub-dictionary, a line at a time."""
    yield from (name, "{", *(f"    {line}" for entry in entries for line in entry.split("\n")), "}")


def _line(key: str, value: str) -> str:
    """An entry with its note."""
    note = NOTES.get(key, "")
    entry = f"{key:<20}{value};"
    return f"{entry:<45}// {note}" if note else entry


def _entry(key: str, value: object) -> str:
    """A key and its number."""
    # repr of a float is exact and has no character that a dictionary could take for anything else
    if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
        raise InputError(f"ehlProperties, {key}: got {value!r:.60}; allowed: a finite number")
    return _line(key, repr(float(value)))


def _count(key: str, value: object) -> str:
    """A key and its whole number."""
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise InputError(f"ehlProperties, {key}: got {value!r:.60}; allowed: a whole number >= 1")
    return _line(key, repr(int(value)))


def _switch(key: str, value: object) -> str:
    """A key and true or false."""
    if not isinstance(value, bool):
        raise InputError(f"ehlProperties, {key}: got {value!r:.60}; allowed: true or false")
    return _line(key, "true" if value else "false")


def _list(key: str, values: ArrayLike) -> str:
    """A key and its list of numbers, a long one over many lines."""
    array = np.asarray(values)
    if array.ndim != 1 or (array.size and array.dtype.kind not in "iuf") or not np.isfinite(array.astype(float)).all():
        raise InputError(f"ehlProperties, {key}: got {array.ravel()[:3]!r:.60}; allowed: a list of finite numbers")
    numbers = [repr(number) for number in array.astype(float).tolist()]
    if len(numbers) <= NUMBERS_A_LINE:
        return _line(key, f"({' '.join(numbers)})")
    starts = range(0, len(numbers), NUMBERS_A_LINE)
    lines = (f"    {' '.join(numbers[start : start + NUMBERS_A_LINE])}" for start in starts)
    return "\n".join((f"{key:<45}// {NOTES[key]}" if key in NOTES else key, "(", *lines, ");"))


def _word(key: str, value: object, table: Mapping[Any, str]) -> str:
    """The dictionary's word for a word of the job file."""
    if not isinstance(value, str | int) or isinstance(value, bool) or value not in table:
        raise InputError(f"ehlProperties, {key}: got {value!r:.60}; allowed: {', '.join(map(str, table))}")
    return table[value]
