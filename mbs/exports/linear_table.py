"""Stiffness and damping of a bearing at a load, over speed and frequency: what linear programs are given.

The ring rests under its load as in `mbs bearing`; around this place the bearing is linear, in all six displacements
of the inner ring. At a frequency above zero it is the dynamic stiffness Z(i omega), K = Re Z and C = Im Z / omega, with
films that relax where `films` is "memory"; at zero it is K and C of slow motion.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.exports.target import BEARING_AXES, Target, origin
from ehdmaps.maps.emap import EHDMap
from ehdmaps.outputs import Output, check_outputs, write_text
from ehdmaps.units import RPM, TEMPERATURE, Display, quantity
from mbs.analyses.bearing_point import RING, ring_at_rest
from mbs.analyses.film_errors import film_error
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.contact_report import axes_left
from mbs.exports.linear_bearing import Format, LinearBearing
from mbs.linearised.bands import law_bands
from mbs.linearised.dynamic import element_dynamic_stiffness
from mbs.linearised.validity import FilmError
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium
from mbs.model.relaxation import DEFAULT_FILMS, Films
from mbs.one_bearing.cylindrical import CYLINDERS
from mbs.one_bearing.family import Request
from mbs.one_bearing.request import read_request
from mbs.one_bearing.shared import read_values
from mbs.scene.fields import FORCE, MICROMETRE

HERTZ = Display("Hz")

FREQUENCIES = (0.0, 1e5)
"""Frequencies that may be asked for [Hz]."""

SHOWN = np.array([100.0, 1e3, 2e3, 4e3])
"""Frequencies at which a table of slow motion says how films answer [Hz]."""

_FILMS: tuple[Films, ...] = ("slow", "memory")

_BEYOND = "the export refuses points"
"""What happens outside of the map; what a program does outside of the table is its own note."""


@dataclass(frozen=True, eq=False)
class LinearTable(LinearBearing):
    """A bearing of a map, linear around its rest under a load.

    Attributes
    ----------
    request : Request
        What was asked: bearing, map, load, temperature.
    cage_angle : float
        Angle of the first roller from y towards z [rad].
    films : {"slow", "memory"}
        Whether the films relax.
    displacement : array, shape (n, 2)
        Place of the inner ring at rest, y and z [m].
    bands : array, shape (n, 2)
        Errors of k and c of slow motion along the load that the map states, as parts of k and c; NaN where it states
        none.
    film_errors : tuple of FilmError
        Answer of the films over frequency along the load at each speed, and its error; empty at rest.
    """

    request: Request
    cage_angle: float
    films: Films
    displacement: FloatArray
    bands: FloatArray
    film_errors: tuple[FilmError, ...]

    def header(self, path: Path) -> tuple[str, ...]:
        """Lines that tell map, axes, signs and the point at which the bearing is linear.

        Parameters
        ----------
        path : Path
            File of the map.
        """
        request, told = self.request, self.request.description
        bearing, emap = request.force.bearing, request.asked.emap
        point = (
            f"bearing: {self.name}, {bearing.slices} slices",
            f"linear around: load {FORCE.text(request.operating.loads[0])} on the inner ring, "
            f"{told.direction:.6g} deg from y towards z; "
            f"diametral clearance {MICROMETRE.text(bearing.geometry.diametral_clearance)}; "
            f"cage angle {math.degrees(self.cage_angle):.6g} deg; raceways at {TEMPERATURE.text(told.temperature)}",
            f"speeds of the inner ring: {', '.join(RPM.text(speed) for speed in self.speeds)}; the outer ring stands",
            f"frequencies: {', '.join(HERTZ.text(value) for value in self.frequencies)}; {self._motion}",
        )
        return (*(() if emap is None else origin(emap, path.name, _BEYOND)), *BEARING_AXES, *point, *self._accuracy)

    def dynamic_error(self) -> FloatArray:
        """Estimated |dZ/Z| along the load at each frequency, shape (n, m); 0 where no film is."""
        if not self.film_errors:
            return np.zeros((self.speeds.size, self.frequencies.size))
        return np.array([error.error(self.frequencies) for error in self.film_errors])

    @property
    def _accuracy(self) -> tuple[str, ...]:
        """Lines on errors, and on the frequencies that the table does not have."""
        known = self.bands[np.all(np.isfinite(self.bands), axis=1)]
        stated = "not stated by the map"
        if known.size:
            stiffness, damping = 100.0 * known.max(axis=0)
            stated = f"up to {stiffness:.2g} % of K and {damping:.2g} % of C"
        lines = [f"estimated error along the load, of the law in slow motion: {stated}"]
        if not self.film_errors:
            return (*lines, "at rest: no film, no damping")
        if self.frequencies.any():
            return (*lines, f"and of the films over frequency: |dZ/Z| up to {100.0 * self.dynamic_error().max():.2g} %")
        shown = ", ".join(HERTZ.text(value) for value in SHOWN)
        ends = {0: self.film_errors[0], self.speeds.size - 1: self.film_errors[-1]}
        return (
            *lines,
            f"slow motion is not all: at {shown} films are stiffer and damp less; --frequency asks for that. Along the "
            "load:",
            *(f"  {RPM.text(self.speeds[index])}: {_over_frequency(error)}" for index, error in ends.items()),
        )

    @property
    def _motion(self) -> str:
        """Motion for which K and C hold at the frequencies, in words."""
        relax = "films with memory" if self.films == "memory" else "slow films at any frequency"
        if self.frequencies.all():
            return relax
        slow = "slow motion, K and C of films that follow at once"
        return f"0 Hz: {slow}; above: {relax}" if self.frequencies.any() else slow


def _over_frequency(error: FilmError) -> str:
    """K and C along the load as multiples of those of slow motion, and what these are wrong by, in words."""
    dynamic = error.dynamic_stiffness(SHOWN)
    stiffness, damping = dynamic.real / error.stiffness, dynamic.imag / (2.0 * np.pi * SHOWN) / error.damping
    wrong = 100.0 * dataclasses.replace(error, films="slow").error(SHOWN)
    k, c, off = (", ".join(f"{value:.3g}" for value in values) for values in (stiffness, damping, wrong))
    return f"K {k} times, C {c} times that of slow motion, which is off by |dZ/Z| = {off} %"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options that say at which point the bearing is linear."""
    point = parser.add_argument_group("where the bearing is linear")
    point.add_argument("--load", metavar="FORCE", help='on the inner ring, such as "5 kN"; required')
    point.add_argument(
        "--speed",
        nargs="+",
        action="append",
        metavar="VALUE",
        help='of the inner ring, such as "1500 rpm", or FROM TO POINTS; more than once for a list; required',
    )
    point.add_argument(
        "--frequency",
        nargs="+",
        action="append",
        metavar="VALUE",
        help='of the oscillation, such as "1 kHz", or FROM TO POINTS; more than once for a list (0 Hz, slow motion)',
    )
    point.add_argument(
        "--films", metavar="NAME", default=DEFAULT_FILMS, help=f"above 0 Hz: slow | memory ({DEFAULT_FILMS})"
    )
    point.add_argument("--direction", nargs="+", metavar="ANGLE", help="of the load from y towards z (0 deg)")
    point.add_argument("--temperature", metavar="TEMPERATURE", help='of the raceways, such as "60 degC" (40 degC)')
    point.add_argument("--clearance", metavar="LENGTH", help='diametral, such as "20 um"; default: the map\'s, none')
    point.add_argument("--start-angle", metavar="ANGLE", help='of the first roller from y, such as "5 deg" (0 deg)')
    point.add_argument("--profile", metavar="PROFILE", default="iso", help="of the rollers, as of `mbs bearing` (iso)")
    point.add_argument("--slices", metavar="N", default="41", help="of a roller (41)")


def linear_table(path: Path, arguments: argparse.Namespace) -> LinearTable:
    """Stiffness and damping at the point that the options name.

    Parameters
    ----------
    path : Path
        File of the map.
    arguments : argparse.Namespace
        Options of `add_arguments`, and `structure` and `roughness`.

    Raises
    ------
    InputError
        With every problem of the options; and for points that lie outside of the map, or whose bearing has no
        stiffness across the load.
    AnalysisError
        Where no equilibrium is found.
    """
    request, frequencies, cage_angle = _read(path, arguments)
    films: Films = arguments.films
    force, temperature, speeds = request.force, request.description.temperature, request.operating.speeds
    element = BearingElement(
        "bearing", RING, "ground", force.bearing, force, temperature, start_angle=cage_angle, films=films
    )
    load = [request.operating.loads[0] * part for part in request.operating.way]
    omega = 2.0 * np.pi * np.array(frequencies)
    s = np.asarray(1j * omega, dtype=np.complex128)
    displacement, stiffness, damping, outside, bands = [], [], [], [], []
    film_errors: list[FilmError] = []
    for speed in speeds:
        operation = Operation(speed)
        balance = ring_at_rest(element, load, operation)
        place = np.array([0.0, *balance.displacement, 0.0, 0.0, 0.0])
        highest = float(element.loads(place, operation).load_per_length.max())
        outside += axes_left(force.law, highest, element.entrainment_speed(operation), temperature)
        slow = omega == 0.0
        dynamic = element_dynamic_stiffness(balance, 0, s)
        rate = dynamic.imag / np.where(slow, 1.0, omega)[:, None, None]
        displacement.append(balance.displacement)
        stiffness.append(dynamic.real)
        damping.append(np.where(slow[:, None, None], balance.element_damping[0], rate))
        error = film_error(element, place, operation, films) if speed else None
        film_errors += [] if error is None else [error]
        bands.append(_relative_bands(balance, error))
    if outside:
        raise InputError(
            [
                f"outside of the map: {axis}; allowed: points inside; make a map that reaches there"
                for axis in dict.fromkeys(outside)
            ]
        )
    return LinearTable(
        name=force.bearing.geometry.name,
        request=request,
        cage_angle=cage_angle,
        films=films,
        speeds=np.array(speeds),
        frequencies=np.array(frequencies),
        displacement=np.array(displacement),
        stiffness=np.array(stiffness),
        damping=np.array(damping),
        bands=np.array(bands),
        film_errors=tuple(film_errors) if len(film_errors) == len(speeds) else (),
    )


def _relative_bands(balance: Equilibrium, error: FilmError | None) -> FloatArray:
    """Errors of k and c along the load that the map states, as parts of them, shape (2,); NaN where it states none."""
    bands = law_bands(balance) if error is not None else None
    if error is None or bands is None:
        return np.full(2, np.nan)
    return np.asarray(bands.of_bearings()[:, 0] / np.array([error.stiffness, error.damping]))


def _read(path: Path, arguments: argparse.Namespace) -> tuple[Request, tuple[float, ...], float]:
    """Read the options with every problem: the request of `mbs bearing`, frequencies [Hz], cage angle [rad]."""
    problems = Problems()
    frequencies = read_values("--frequency", arguments.frequency or [["0 Hz"]], "Hz", FREQUENCIES, HERTZ, problems)
    angle = 0.0
    if arguments.start_angle is not None:
        with problems.after("--start-angle: "):
            angle = quantity(arguments.start_angle, "rad")
    if arguments.films not in _FILMS:
        problems.append(f"--films: got {arguments.films!r:.60}; allowed: {', '.join(_FILMS)}")
    problems += [
        f"{option}: it is missing; {what}"
        for option, what, given in (
            ("--load", 'give the load on the inner ring, such as "5 kN"', arguments.load),
            ("--speed", 'give one speed or more of the inner ring, such as "1500 rpm"', arguments.speed),
        )
        if not given
    ]
    bearing_arguments = argparse.Namespace(
        **{
            **_UNASKED,
            **{name: getattr(arguments, name) for name in _TAKEN},
            "bearing": str(path),
            "map": str(path),
            "load": [[arguments.load]] if arguments.load else [],
            "speed": arguments.speed or [],
        }
    )
    with problems:
        request = read_request(bearing_arguments, CYLINDERS)
    problems.check()
    return request, frequencies, angle


_TAKEN = ("direction", "temperature", "clearance", "profile", "slices", "structural_law", "roughness")
_UNASKED = {
    "law": "map",
    "oil": None,
    "supply": None,
    "ring_temperatures": None,
    "permittivity": None,
    "coupled": False,
    "output": None,
    "plot": None,
}
"""Options of `mbs bearing` that this table has not."""


def target(format_: Format) -> Target:
    """Make the target of `ehdmaps export` for a format.

    Parameters
    ----------
    format_ : Format
        The format.
    """

    def add(parser: argparse.ArgumentParser) -> None:
        format_.add_arguments(parser)
        add_arguments(parser)

    def write(emap: EHDMap, path: Path, output: Path | None, arguments: argparse.Namespace) -> str:
        output = output or path.with_suffix(format_.kind.endings[0])
        check_outputs([Output("-o", output, format_.kind)], [path])
        table = linear_table(path, arguments)
        write_text(output, format_.text(table, table.header(path), arguments), format_.kind)
        return f"{output}: written"

    return Target(format_.summary, f"MAP{format_.kind.endings[0]}", format_.read_back_by, add, write)
