"""The contact law: load, stiffness and damping of a contact, or of a roller between its two contacts."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError, MapError
from ehdmaps.maps.compilation import (
    Resolution,
    compile_table,
    highest_structural_load,
    structural_parameters,
)
from ehdmaps.maps.film_field import DryField, FilmField, LowLoads
from ehdmaps.maps.kernels.ends import ends_of
from ehdmaps.maps.kernels.film_response import FilmResponse
from ehdmaps.maps.kernels.kept_tables import keeping, kept_table, key_of
from ehdmaps.maps.kernels.law_in_c import LawAddress, LawInC
from ehdmaps.maps.kernels.locked_film import LockedFactors
from ehdmaps.maps.kernels.memory import FilmState
from ehdmaps.maps.kernels.tables import LOAD_TOLERANCE, ApproachTable, LawTable
from ehdmaps.maps.law_errors import LawChange, LawErrors, changed_table
from ehdmaps.maps.law_films import LawAtPoint, LawFilms
from ehdmaps.maps.outside_calls import Axis, Excursion, OutsideCalls, Range, broadcast, check_finite, floats
from ehdmaps.maps.rolling_film import RollingFilm
from ehdmaps.maps.rough_layer import GONE_BELOW
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.surface import SMOOTH, Surface
from ehdmaps.units import TEMPERATURE

if TYPE_CHECKING:
    from ehdmaps.maps.edges.continued import ContinuedField

LawKind = Literal["series", "inner", "outer", "line"]
OutsidePolicy = Literal["error", "clamp", "asymptote"]

LOAD_REACH, SPEED_REACH = 100.0, 10.0
"""How far the policy `asymptote` goes, as multiples of the highest load and speed; it holds the edge beyond."""

_SHARES = 1.0, 0.5, 0.25, 0.0
"""Shares of the reach in speed and temperature that are tried: without films out there the edge is held nearer by."""


class ContactLaw:
    """Load per unit length of a contact over approach, rate, entrainment speed and temperature.

    C1 in all arguments (below a tenth of the lowest mapped speed the film fades, with a kink there), rising with the
    approach at rest, never a tension, passive, with exact derivatives. Make one by `EHDMap.law`.

    Calls are for arrays of any shape that broadcast, and cost about 0.1 us a point; `at` gives the law of one
    speed and temperature, five times faster. One place costs 1.3 us. Other programs call it in C by `address`, without
    any Python.

    Parameters
    ----------
    kind : {"series", "inner", "outer", "line"}
        A roller between both raceways, or one contact.
    contacts : sequence of LineContact
        Inner and outer for `series`, else one.
    lubricant : Lubricant
        The oil of the map.
    field : FilmField
        Film of each contact.
    outside : {"error", "clamp", "asymptote"}
        What happens outside the map, also where points of it are missing, see `known_load`; counted always. `error`:
        OutsideMapError. `clamp`: load, speed and temperature are held at the edge, with the dry tangent above the
        highest load. `asymptote`: film offset and c go on with their end exponents, in speed at constant Moes number M,
        up to `LOAD_REACH` times the highest load and `SPEED_REACH` times the highest speed, and as `clamp` beyond;
        films go on over temperature too, see `continued`. Where there are no films so far away, speed and temperature
        are held nearer to the map.
    resolution : Resolution, optional
        Spacing of the nodes of the table.
    rolling : RollingFilm, optional
        Rolling force and mass flow of the contacts, where the map holds them.
    supply : OilSupply, optional
        Oil before each contact; flooded if left out. See `ehdmaps.maps.oil_layer`.
    surface : Surface
        Roughness of the surfaces: film and asperities share the load, see `ehdmaps.maps.rough_layer`. The law then
        has a table down to a speed without a film, and goes over into the rough dry contact at standstill. Where a film
        is so thin that the mean planes overlap, its share and its damping are a guess, see `ehdmaps.maps.rough_layer`.
    errors : LawErrors, optional
        How wrong the law may be, where its map says so; see `LawAtPoint.bounds`.
    continued : ContinuedField, optional
        The films below the lowest speed and outside the temperatures of the map. Without them smooth films fade from
        the lowest mapped speed on, and the temperature is held at the edge with any policy.
    title : str
        What has the contacts, for people: a bearing.

    Raises
    ------
    InputError
        For a policy that does not exist.
    MapError
        If the map cannot make a law.

    Notes
    -----
    The error of the table against the field, NU308 with FVA 3: 4e-6 of w and k in the median, 3e-5 at 95 % of random
    points, 2e-4 of w, 5e-4 of k and 1e-3 of c at the worst of 400; more where a damping is solved negative and the law
    takes zero. In the tail it is larger where the film at its beginning is near 0.005 R, because the beginning of the
    fade has a kink over speed and temperature there: at most 1 % of the lowest mapped load.
    """

    def __init__(
        self,
        kind: LawKind,
        contacts: Sequence[LineContact],
        lubricant: Lubricant,
        field: FilmField,
        outside: OutsidePolicy = "error",
        resolution: Resolution | None = None,
        rolling: RollingFilm | None = None,
        supply: OilSupply = FLOODED,
        surface: Surface = SMOOTH,
        errors: LawErrors | None = None,
        continued: ContinuedField | None = None,
        title: str = "",
    ) -> None:
        if outside not in get_args(OutsidePolicy):
            raise InputError(f"contact law, outside: got {outside!r}; allowed: {', '.join(get_args(OutsidePolicy))}")
        self.kind: LawKind = kind
        self.title = title
        self.outside: OutsidePolicy = outside
        self.contacts = tuple(contacts)
        self.load_range = field.load_range
        self.speed_range = field.speed_range
        self.temperature_range = field.temperature_range
        ends: dict[Axis, tuple[float, float]] = {
            "load": (-np.inf, self.load_range[1]),
            "entrainment_speed": (-np.inf, self.speed_range[1]),
            "temperature": self.temperature_range,
        }
        self._outside = OutsideCalls(kind, outside == "error", ends)
        self.surface = surface
        self.continued = None if field.dry else continued
        films = DryField(field, not surface.smooth) if field.dry else continued or field
        self._films = LawFilms(self.contacts, lubricant, films, field.dry, supply, rolling)
        self._resolution = resolution
        self.rolling = rolling
        self.supply = supply
        self.errors = errors
        self._plain = self._farthest_table()
        self._parts: list[tuple[ApproachTable, ApproachTable]] = []
        self._latest: LawAtPoint | None = None

    def __repr__(self) -> str:
        """Kind, bearing, oil and range."""
        (cold, hot), of = self.temperature_range, f" of {self.title}" if self.title else ""
        oil = "dry" if self._films.dry else self._films.lubricant.title
        loads, speeds = (f"{low:.4g} to {high:.4g}" for low, high in (self.load_range, self.speed_range))
        return (
            f"<ContactLaw {self.kind}{of}, {oil}: {loads} N/m, {speeds} m/s, {TEMPERATURE.value(cold):.4g} to "
            f"{TEMPERATURE.text(hot)}; outside: {self.outside}>"
        )

    @cached_property
    def table(self) -> LawTable:
        """Arrays of the law, ready for a centrifugal load where it takes one."""
        if self.kind != "series":
            return self._plain
        if not self._parts:
            inner, outer = (self._approach_table((contact,)) for contact in self.contacts)
            self._parts.append((inner, outer))
        ((inner, outer),) = self._parts
        return self._plain._replace(inner=inner, outer=outer)

    @property
    def plain_table(self) -> LawTable:
        """`table` without the single contacts of a series: all that is needed without a centrifugal load."""
        return self._plain

    @cached_property
    def _plain_in_c(self) -> LawInC:
        """The law in C without centrifugal loads."""
        return LawInC(self._plain, centrifugal=False)

    @cached_property
    def _thrown_in_c(self) -> LawInC:
        """The law in C with centrifugal loads."""
        return LawInC(self.table, centrifugal=True)

    def _in_c(self, centrifugal: bool) -> LawInC:
        """The law in C, with or without centrifugal loads."""
        return self._thrown_in_c if centrifugal else self._plain_in_c

    @cached_property
    def _told_below(self) -> float:
        """Speed below which calls are noted as excursions [m/s]; 0 where none are."""
        return 0.0 if self.continued is None else self.speed_range[0]

    @cached_property
    def _guessed_somewhere(self) -> float:
        """Load from which on the film is no guess at any speed and temperature [N/m]; 0 where it is none."""
        low = self._films.low_loads
        return low.begins[1] if low is not None and low.guessed else 0.0

    @property
    def address(self) -> LawAddress:
        """The law for programs that call C: a function, its data, and the bytes of memory that a thread needs.

        Centrifugal loads are taken where the law takes them. Addresses are good as long as the law is.

        Examples
        --------
        >>> import ctypes, numpy as np
        >>> from ehdmaps.maps.kernels.law_in_c import LawAddress
        >>> def load(law, approach):  # at rest, at 1 m/s and 40 degC; any language that calls C does it likewise
        ...     at, force = law.address, np.empty(3)
        ...     room = np.empty(at.room // 8)
        ...     call = LawAddress.PROTOTYPE(at.function)
        ...     status = call(at.data, approach, 0.0, 1.0, 313.15, 0.0, room.ctypes.data, force.ctypes.data)
        ...     return force[0]
        """
        return self._in_c(self.kind == "series").door

    def again(self, errors: LawErrors | None = None) -> ContactLaw:
        """The same law with counts of its own, all zero; films that were read, and its tables, are shared.

        Parameters
        ----------
        errors : LawErrors, optional
            Other bounds of its errors.
        """
        other = copy.copy(self)
        other.errors = errors or self.errors
        other._outside, other._latest = self._outside.emptied(), None
        return other

    def changed(self, change: LawChange) -> ContactLaw:
        """The law with another stiffness, damping and film, for samples of what its errors do.

        Parameters
        ----------
        change : LawChange
            What is changed.
        """
        other = self.again()
        # Of the copy nothing is kept that follows from the table.
        for name in ("table", "_plain_in_c", "_thrown_in_c"):
            other.__dict__.pop(name, None)
        own = changed_table(self._plain.own, change)
        other._plain = self._plain._replace(own=own, inner=own, outer=own)
        if self.kind == "series":
            half = change._replace(film=0.5 * change.film)
            other.table = self.table._replace(
                own=own,
                inner=changed_table(self.table.inner, half),
                outer=changed_table(self.table.outer, half),
            )
        return other

    @property
    def low_loads(self) -> LowLoads | None:
        """Loads where the film goes over into that of a rigid contact, and whether that is right; None of a dry law."""
        return self._films.low_loads

    def known_load(self, entrainment_speed: float, temperature: float) -> float:
        """Load [N/m] up to which the films are known: that of `load_range`, less where points of the map are missing.

        Parameters
        ----------
        entrainment_speed, temperature : float
            u [m/s], of either sign, and T [K]; held at the edges of the map.
        """
        return float(self._known_loads(np.array([float(entrainment_speed)]), np.array([float(temperature)]))[0])

    def _known_loads(self, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """Loads [N/m] up to which the films are known, (n,)."""
        table = self._plain
        held = np.clip(np.abs(speeds), table.lowest_speed, table.highest_speed)
        return ends_of(table.ends, held, temperatures)

    def guessed_below(self, entrainment_speed: float, temperature: float) -> float:
        """Load [N/m] below which the film is a guess, see `low_loads`; 0 where it is none.

        Parameters
        ----------
        entrainment_speed, temperature : float
            u [m/s], of either sign, and T [K]; held at the edges of the map.
        """
        return self._films.guessed_below(entrainment_speed, temperature)

    @property
    def counts(self) -> IntArray:
        """Points outside the map so far by cause, and those that are no numbers, as C counts them."""
        return self._outside.counts

    @property
    def outside_counts(self) -> dict[str, int]:
        """Number of points that were outside the map so far, by cause."""
        return self._outside.by_cause

    @property
    def excursions(self) -> tuple[Excursion, ...]:
        """Excursions of points outside the map so far: axis, side, number, the farthest one, and where the map ends.

        Of calls of the law and of `LawAtPoint`. Loads below the
        map are told where the film there is a guess, see `low_loads`, and speeds below it where films are continued;
        they are no error with any policy.
        """
        return self._outside.excursions

    def reset_counts(self) -> None:
        """Start counting again from zero."""
        self._outside.reset()

    def __call__(
        self,
        delta: npt.ArrayLike,
        rate: npt.ArrayLike,
        entrainment_speed: npt.ArrayLike,
        temperature: npt.ArrayLike,
        centrifugal_load: npt.ArrayLike = 0.0,
    ) -> tuple[Any, Any, Any]:
        """Load and its derivatives.

        Parameters
        ----------
        delta, rate : float or array
            Approach [m] and its rate [m/s]; for `series` of both contacts together.
        entrainment_speed, temperature : float or array
            u [m/s], of either sign, and T [K].
        centrifugal_load : float or array
            q >= 0 [N/m], what the outer contact carries besides; for `series` only. The roller is then brought
            into equilibrium between its contacts at each point, which costs some microseconds.

        Returns
        -------
        w, dw_ddelta, dw_drate : float or array
            Load on the inner contact [N/m], [N/m2], [N s/m2], in the shape to which the arguments broadcast.

        Raises
        ------
        InputError
            For arguments that are no finite numbers or do not broadcast, and for a centrifugal load that is
            negative, above the highest load, or given to a single contact.
        OutsideMapError
            Outside the map, with the policy `error`.
        """
        if (
            isinstance(delta, float)
            and isinstance(rate, float)
            and isinstance(entrainment_speed, float)
            and isinstance(temperature, float)
            and isinstance(centrifugal_load, float)
            and centrifugal_load == 0.0
            and abs(entrainment_speed) >= self._told_below
        ):
            force = self._plain_in_c.force(delta, rate, entrainment_speed, temperature, 0.0)
            if force is not None and (self._guessed_somewhere == 0.0 or not 0.0 < force[0] < self._guessed_somewhere):
                return force
        named = floats(
            delta=delta,
            rate=rate,
            entrainment_speed=entrainment_speed,
            temperature=temperature,
            centrifugal_load=centrifugal_load,
        )
        self._check_centrifugal(named["centrifugal_load"])
        shape, flat = broadcast(named)
        forces, counts = self._in_c(bool(np.any(named["centrifugal_load"]))).forces(flat)
        self._settle(counts, named, flat)
        self._outside.keep(self._films.guesses(forces[0], flat[2], flat[3]))
        self._note_slow(flat[2])
        w, dw_ddelta, dw_drate = (force.reshape(shape)[()] for force in forces)
        return w, dw_ddelta, dw_drate

    def at(self, entrainment_speed: float, temperature: float, centrifugal_load: float = 0.0) -> LawAtPoint:
        """Law at one speed [m/s], temperature [K] and centrifugal load [N/m]: equal values, faster.

        Parameters
        ----------
        entrainment_speed : float
            u [m/s].
        temperature : float
            T [K].
        centrifugal_load : float
            Centrifugal load of the roller, per unit length [N/m]. That of the last call is given again where all three
            are the same.

        Raises
        ------
        InputError, OutsideMapError
            As calling the law does.
        """
        # One that lies outside the map is made again, to be counted again.
        latest = self._latest
        if (
            latest is not None
            and not latest.outside
            and isinstance(entrainment_speed, float)
            and isinstance(temperature, float)
            and isinstance(centrifugal_load, float)
            and latest.conditions == (entrainment_speed, temperature, centrifugal_load)
        ):
            return latest
        named = floats(entrainment_speed=entrainment_speed, temperature=temperature, centrifugal_load=centrifugal_load)
        for name, value in named.items():
            if value.ndim:
                raise InputError(f"contact law, {name}: got an array; allowed: one number in `at`")
        check_finite(named)
        self._check_centrifugal(named["centrifugal_load"])
        u, T, q = (float(value) for value in named.values())
        if latest is not None and not latest.outside and latest.conditions == (u, T, q):
            return latest
        made = self._in_c(q > 0.0).point(u, T, q)
        self._settle(made.counts, named, [])
        self._note_slow(np.array([u]))
        self._latest = LawAtPoint(u, T, q, made, self, bool(made.counts.any()))
        return self._latest

    def advance(
        self, state: FilmState | None, delta: npt.ArrayLike, dt: float, entrainment_speed: float, temperature: float
    ) -> tuple[Any, Any, FilmState]:
        """A step in time with films that need time to follow; see `ehdmaps.maps.kernels.memory`.

        Parameters
        ----------
        state : FilmState or None
            State at the beginning of the step; None for films in equilibrium at `delta`.
        delta : float or array
            Approach at its end [m].
        dt : float
            Length of the step [s], > 0.
        entrainment_speed, temperature : float
            u [m/s] and T [K] at its end; a change from call to call costs some tenths of a millisecond.

        Returns
        -------
        w, dw_ddelta : float or array
            Load [N/m] and its exact derivative by the approach at the end of the step [N/m2].
        state : FilmState
            State at the end of the step.

        Raises
        ------
        InputError, OutsideMapError
            As `at` and `FilmMemory.advance` do.
        """
        latest = self._latest
        if latest is None or latest.conditions != (entrainment_speed, temperature, 0.0):
            latest = self.at(entrainment_speed, temperature)
        memory = latest.memory
        return memory.advance(memory.settled(delta) if state is None else state, delta, dt)

    def locked_factors(self, entrainment_speed: float, temperature: float) -> LockedFactors:
        """Locked film of the map, as factors of its closed formula; ones where the map says nothing.

        Several contacts in series have the sum of their locked compliances. Speed and temperature are held at the edges
        of the map.

        Parameters
        ----------
        entrainment_speed, temperature : float
            u [m/s], of either sign, and T [K].
        """
        return self._films.locked_factors(entrainment_speed, temperature)

    def make_locked_factors(self, entrainment_speeds: FloatArray, temperature: float) -> None:
        """Make `locked_factors` of many speeds at once, which costs a sixth of one after the other.

        Parameters
        ----------
        entrainment_speeds : array (n,)
            u [m/s], of either sign.
        temperature : float
            T [K].
        """
        self._films.make_locked_factors(entrainment_speeds, temperature)

    def film_response(self, loads: npt.ArrayLike, entrainment_speed: float, temperature: float) -> FilmResponse | None:
        """Part of the complex stiffness that the law with memory leaves out, see `ehdmaps.maps.kernels.film_response`.

        Parameters
        ----------
        loads : array (n,)
            Loads at rest [N/m].
        entrainment_speed, temperature : float
            u [m/s], of either sign, and T [K]; held at the edges of the map.

        Returns
        -------
        FilmResponse or None
            None where nothing is known of films that oscillate.
        """
        return self._films.response(np.asarray(loads, dtype=np.float64), entrainment_speed, temperature)

    def _farthest_table(self) -> LawTable:
        """Everything but the single contacts of a series, with as much of the reach beyond the map as has films."""
        shares = _SHARES if self.outside == "asymptote" else _SHARES[:1]
        for share in shares:
            self.continued = self.continued and replace(self.continued, share=share)
            try:
                return self._law_table(share)
            except (InputError, MapError) as error:
                refused = error
        raise refused

    def _law_table(self, share: float) -> LawTable:
        """Everything but the single contacts of a series, with a share of the reach beyond the map."""
        highest = self.load_range[1]
        low, high = self.speed_range if self.speed_range[0] > 0.0 else (1.0, 1.0)
        # The policy `error` lets the error of the table pass without a kink.
        held = highest if self.outside == "clamp" else highest * (1.0 + LOAD_TOLERANCE)
        if self.outside == "asymptote":
            high = SPEED_REACH**share * high if high > low else high
            most = min(highest_structural_load(contact) for contact in self.contacts)
            held = max(held, min(LOAD_REACH * highest, most))
        rough = not self.surface.smooth
        slowest, (cold, hot) = low, self.temperature_range
        if rough and not self._films.dry:
            slowest = low = low / GONE_BELOW
        elif self.continued is not None:
            slowest = self.continued.slowest
        if self.continued is not None and self.outside == "asymptote":
            cold, hot = self.continued.reach
        self._speeds, self._held_load = (low, high), held
        self._slowest, self._temperatures = slowest, (cold, hot)
        own = self._approach_table(self.contacts)
        ends = self._films.field.ends
        known = float(np.min(ends[1:, 1:]))
        return LawTable(
            own=own,
            inner=own,
            outer=own,
            structure=np.array([structural_parameters(contact) for contact in self.contacts]),
            ends=ends,
            film_speed=0.0 if rough else np.inf if self._films.dry else slowest,
            lowest_speed=slowest,
            highest_speed=high,
            lowest_temperature=cold,
            highest_temperature=hot,
            highest_load=highest,
            known_load=known,
            known_root=float(np.cbrt(known)),
            held_load=held,
            counted_speed=self.speed_range[1],
            counted_cold=self.temperature_range[0],
            counted_hot=self.temperature_range[1],
        )

    def _approach_table(self, contacts: Sequence[LineContact]) -> ApproachTable:
        """Table of some contacts in series."""
        made_from = (
            self._films.field,
            contacts,
            self._films.lubricant,
            self._speeds,
            self._held_load,
            self._resolution,
            FLOODED if self._films.dry else self.supply,
            self.rolling,
            self.surface,
            self._slowest,
            self._temperatures,
        )
        key = key_of(*made_from) if keeping() else ""
        return kept_table(key, lambda: compile_table(*made_from))

    def _check_centrifugal(self, values: FloatArray) -> None:
        """Refuse centrifugal loads that this law does not take."""
        if not np.any(values):
            return
        if self.kind != "series":
            raise InputError(
                f"contact law {self.kind!r}, centrifugal_load: got {float(np.max(np.abs(values))):.6g} N/m; "
                "allowed: 0; only the law 'series' brings a roller into equilibrium"
            )
        highest = self.load_range[1]
        wrong = values[(values < 0.0) | (values >= highest)]
        if wrong.size:
            raise InputError(
                f"contact law {self.kind!r}, centrifugal_load: got {wrong.flat[0]:.6g} N/m; "
                f"allowed: 0 to below the highest mapped load {highest:.6g} N/m; check its sign and unit"
            )

    def _settle(self, counts: IntArray, named: Mapping[str, FloatArray], flat: Sequence[FloatArray]) -> None:
        """Add up the counts of a call, and raise what they ask for."""
        self._outside.settle(counts, named, flat, self._loads_at_rest, self._known_loads)

    def _note_slow(self, speeds: FloatArray) -> None:
        """Keep speeds below the map, where films are continued; they are no error with any policy."""
        if self.continued is not None:
            self._outside.keep(Range("entrainment_speed", self.speed_range[0], np.inf).excursions(speeds))

    def _loads_at_rest(self, flat: Sequence[FloatArray]) -> FloatArray:
        """Loads on the inner contact of flat arguments, as if nothing moved [N/m]."""
        forces, _ = self._in_c(bool(np.any(flat[4]))).forces((flat[0], np.zeros_like(flat[0]), *flat[2:]))
        loads: FloatArray = forces[0]
        return loads
