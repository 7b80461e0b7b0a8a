"""Files that `Rotor.save` of ROSS 2.x writes, TOML or JSON: read to plain values, in SI as they are there.

ROSS has x and y radial and z along the axis, and stations (nodes) instead of places. It looks its tables of bearings
and seals up at the speed of the rotor, though their axis is called frequency. What a scene has no place for is refused;
what changes no motion (colours, the size of a symbol in drawings, what a table was once computed from) is passed over.

`Rotor.load` of ROSS would read them too, but it makes the class that a file names without a look at the values, and
takes plotly, control and ccp-performance along.

References
----------
ROSS 2.3.0, modules shaft_element, disk_element, bearing_seal_element, point_mass and rotor_assembly.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.inputs import read_text
from ehdmaps.jobs import table as toml
from ehdmaps.jobs.table import Table
from ehdmaps.units import short

LONGEST = 10_000_000
"""Bytes of a file; ROSS writes some 0.7 kB for an element of the shaft."""

TERMS = ("xx", "xy", "yx", "yy", "zz")
"""Entries of the matrices of a bearing, in the axes of ROSS."""

_ALLOWED = "a rotor as Rotor.save of ROSS 2 writes it, .toml or .json"
_VERSION = re.compile(r"2(\.[0-9A-Za-z]{1,12}){0,3}")
_LARGEST, _LONGEST_TABLE, _MOST_NODES = 1e15, 1000, 100_000
_SPEEDS = ("min_w", "max_w", "rated_w")

BEARINGS = (
    *("BearingElement", "SealElement", "BallBearingElement", "RollerBearingElement", "MagneticBearingElement"),
    *("BearingFluidFlow", "CylindricalBearing", "PlainJournal", "TiltingPad", "ThrustPad", "SqueezeFilmDamper"),
    *("LabyrinthSeal", "HolePatternSeal", "HybridSeal"),
)
"""Elements of ROSS that are saved with tables of stiffness and damping, which alone it reads back."""


@dataclass(frozen=True)
class RossBeam:
    """An element of the shaft, from one node to the next.

    Attributes
    ----------
    tag : str
        Name in ROSS.
    node : int
        Node at its left end.
    length : float
        [m].
    left, right : (float, float)
        Outer and inner diameter at both ends [m].
    youngs_modulus, poisson_ratio, density : float
        [Pa], 1, [kg/m3].
    """

    tag: str
    node: int
    length: float
    left: tuple[float, float]
    right: tuple[float, float]
    youngs_modulus: float
    poisson_ratio: float
    density: float


@dataclass(frozen=True)
class RossDisc:
    """A disc, or a mass at a node without moments of inertia.

    Attributes
    ----------
    tag : str
        Name in ROSS.
    node : int
        Node at which it is; beyond those of the shaft for the mass of a support.
    mass, polar, transverse : float
        [kg], [kg m2].
    """

    tag: str
    node: int
    mass: float
    polar: float = 0.0
    transverse: float = 0.0


@dataclass(frozen=True)
class RossBearing:
    """A bearing or seal.

    Attributes
    ----------
    tag : str
        Name in ROSS.
    kind : str
        Class in ROSS, one of `BEARINGS`.
    node : int
        Node that it holds.
    link : int or None
        Node against which it does; None for the ground.
    speeds : tuple of float
        Speeds of its tables, rising [rad/s]; none for the same at any speed.
    stiffness, damping : mapping of str to tuple of float
        Values by the names of `TERMS`, as many as there are speeds, else one [N/m], [N s/m].
    """

    tag: str
    kind: str
    node: int
    link: int | None
    speeds: tuple[float, ...]
    stiffness: Mapping[str, tuple[float, ...]]
    damping: Mapping[str, tuple[float, ...]]


@dataclass(frozen=True)
class RossRotor:
    """A rotor of ROSS.

    Attributes
    ----------
    version : str
        Version of ROSS that wrote it; empty where the file says none.
    beams : tuple of RossBeam
        Elements of the shaft by their nodes.
    discs : tuple of RossDisc
        Discs of the shaft.
    masses : tuple of RossDisc
        Point masses.
    bearings : tuple of RossBearing
        Bearings and seals.
    slowest, fastest, rated : float or None
        Speeds that the file states [rad/s].
    passed_over : tuple of str
        Keys that have no part in the motion.
    """

    version: str
    beams: tuple[RossBeam, ...]
    discs: tuple[RossDisc, ...] = ()
    masses: tuple[RossDisc, ...] = ()
    bearings: tuple[RossBearing, ...] = ()
    slowest: float | None = None
    fastest: float | None = None
    rated: float | None = None
    passed_over: tuple[str, ...] = field(default=())


def read_ross(path: Path) -> RossRotor:
    """Read a rotor.

    Parameters
    ----------
    path : Path
        The file; its ending says whether it is TOML or JSON.

    Raises
    ------
    InputError
        With every problem: no such file, another version, elements and keys that are not taken.
    """
    text = read_text(path, LONGEST, _ALLOWED)
    problems: list[str] = []
    if path.suffix.lower() == ".json":
        values = _json(text, str(path))
    elif path.suffix.lower() == ".toml":
        values = toml.parse(text, str(path))
    else:
        raise InputError(f"{path}: got the ending {path.suffix!r:.40}; allowed: {_ALLOWED}")
    if not isinstance(values, dict):
        raise InputError(f"{path}: got {short(values)}; allowed: {_ALLOWED}")
    rotor = _Reader(problems).rotor(values)
    if problems or rotor is None:
        raise InputError([f"{path}: {problem}" for problem in problems])
    return rotor


def _json(text: str, where: str) -> Any:
    """Values of a text in JSON."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{where}: is not JSON: {error!s:.200}; allowed: {_ALLOWED}") from error


class _Reader:
    """Reads the elements of one file; problems are noted."""

    def __init__(self, problems: list[str]) -> None:
        self._problems = problems
        self._passed: dict[str, None] = {}
        self._alike: dict[str, list[str]] = {}

    def rotor(self, values: dict[str, Any]) -> RossRotor | None:
        """Read everything; None where a problem was noted."""
        given = values.get("ross_version", "")
        version = given if isinstance(given, str) else ""
        if "ross_version" in values and not _VERSION.fullmatch(version):
            self._problems.append(f"ross_version: got {short(given)}; allowed: 2, such as '2.3.0'")
            return None
        speeds = self._parameters(values.get("parameters"))
        beams, discs, masses, bearings = [], [], [], []
        for key, entry in values.items():
            if key in ("ross_version", "parameters") or key.startswith("_"):
                continue
            kind, _, tag = key.partition("_")
            table = Table(entry, key, self._problems)
            if not isinstance(entry, dict):
                continue
            if kind == "ShaftElement":
                beams.append(self._beam(table, tag))
            elif kind == "DiskElement":
                discs.append(self._disc(table, tag))
            elif kind == "PointMass":
                masses.append(self._mass(table, tag))
            elif kind in BEARINGS:
                bearings.append(self._bearing(table, kind, tag))
            else:
                allowed = ", ".join(("ShaftElement", "DiskElement", "PointMass", *BEARINGS))
                self._problems.append(f"{key!r:.80}: got the element {kind!r:.60}; allowed: {allowed}")
        for words, owners in self._alike.items():
            others = f" and {len(owners) - 1} more" if owners[1:] else ""
            self._problems.append(f"{owners[0]}{others}, {words}")
        if not beams and not self._problems:
            self._problems.append(f"got no ShaftElement; allowed: {_ALLOWED}")
        if self._problems:
            return None
        # Python's sorting keeps layers of a node in the order of the file.
        shaft = tuple(sorted((beam for beam in beams if beam), key=lambda beam: beam.node))
        self._problems += _chain_problems(shaft)
        return RossRotor(
            version,
            shaft,
            tuple(disc for disc in discs if disc),
            tuple(mass for mass in masses if mass),
            tuple(bearing for bearing in bearings if bearing),
            speeds["min_w"],
            speeds["max_w"],
            speeds["rated_w"],
            tuple(self._passed),
        )

    def _parameters(self, values: object) -> dict[str, float | None]:
        """Read min_w, max_w and rated_w; None for each that is not there."""
        if values is None:
            return dict.fromkeys(_SPEEDS)
        table = Table(values, "parameters", self._problems)
        return {key: None if _missing(table, key) else table.number(key, 0.0, 1e5) for key in _SPEEDS}

    def _beam(self, table: Table, tag: str) -> RossBeam | None:
        """Read an element of the shaft."""
        node = _node(table, "n")
        length = table.number("L", 1e-6, 100.0, required=True)
        outer = table.number("odl", 1e-5, 100.0, required=True)
        inner = table.number("idl", 0.0, 100.0, required=True)
        last_outer = outer if _missing(table, "odr") else table.number("odr", 1e-5, 100.0)
        last_inner = inner if _missing(table, "idr") else table.number("idr", 0.0, 100.0)
        for key in ("shear_effects", "rotary_inertia", "gyroscopic"):
            if table.get(key) not in (None, True):
                self._of_all(table, key, "allowed: true, as all beams of mbs have it")
        if table.get("shear_method_calc") not in (None, "cowper"):
            self._of_all(table, "shear_method_calc", "allowed: 'cowper'")
        for key, what in (
            ("axial_force", "no shaft of mbs is tightened by it"),
            ("torque", "no shaft of mbs is twisted by it"),
            ("alpha", "state the damping of the shaft as damping_ratio in the scene"),
            ("beta", "state the damping of the shaft as damping_ratio in the scene"),
        ):
            if not _missing(table, key) and table.number(key, -_LARGEST, _LARGEST) not in (None, 0.0):
                self._of_all(table, key, f"allowed: 0; {what}")
        material = table.table("material", f"{table.where} material", required="a table with rho, E and G_s")
        modulus = shear = density = None
        if material is not None:
            density = material.number("rho", 100.0, 25000.0, required=True)
            modulus = material.number("E", 1.0, 2e12, required=True)
            shear = material.number("G_s", 1.0, 2e12, required=True)
            if modulus is not None and shear is not None and not 0.001 < modulus / (2.0 * shear) <= 1.499:
                material.note(
                    "G_s", f"got {shear:g} Pa with E = {modulus:g} Pa; allowed: E/2.998 and more, up to 500 E"
                )
            # Of later versions heat, too; nothing in a material moves a rotor but these three.
            self._pass(material, ("name", "color", "specific_heat", "thermal_conductivity"))
        table.get("tag")
        table.close()
        values = (node, length, outer, inner, last_outer, last_inner, modulus, shear, density)
        if any(value is None for value in values):
            return None
        assert node is not None and length is not None and outer is not None and inner is not None
        assert last_outer is not None and last_inner is not None
        assert modulus is not None and shear is not None and density is not None
        poisson = 0.5 * modulus / shear - 1.0
        return RossBeam(tag, node, length, (outer, inner), (last_outer, last_inner), modulus, poisson, density)

    def _disc(self, table: Table, tag: str) -> RossDisc | None:
        """Read a disc."""
        node = _node(table, "n")
        mass = table.number("m", 1e-6, 1e6, required=True)
        polar, transverse = (table.number(key, 0.0, 1e6, required=True) for key in ("Ip", "Id"))
        self._pass(table, ("tag", "scale_factor", "color"))
        table.close()
        if node is None or mass is None or polar is None or transverse is None:
            return None
        return RossDisc(tag, node, mass, polar, transverse)

    def _mass(self, table: Table, tag: str) -> RossDisc | None:
        """Read a point mass, the same along both radial directions."""
        node = _node(table, "n")
        keys = [key for key in ("m", "mx", "my") if not _missing(table, key)]
        found = [table.number(key, 1e-6, 1e6) for key in keys]
        if not keys:
            table.note("m", "missing; allowed: a mass in kg")
        if None not in found and len(set(found)) > 1:
            table.note("mx", f"got {', '.join(f'{value:g}' for value in found)} kg; allowed: the same along x and y")
        self._pass(table, ("mz", "tag", "scale_factor", "color"))
        table.close()
        if node is None or not found or found[0] is None:
            return None
        return RossDisc(tag, node, found[0])

    def _bearing(self, table: Table, kind: str, tag: str) -> RossBearing | None:
        """Read a bearing or seal."""
        node = _node(table, "n")
        link = None if _missing(table, "n_link") else _node(table, "n_link")
        speeds = () if _missing(table, "frequency") else _numbers(table, "frequency", 1e5)
        before = len(table.problems)
        if len(speeds) > 1 and any(after <= this for this, after in pairwise(speeds)):
            table.note("frequency", f"got {short(list(speeds))}; allowed: each above the last")
        count = max(len(speeds), 1)
        values = {
            letter: {term: _numbers(table, f"{letter}{term}", _LARGEST, count, required=term == "xx") for term in TERMS}
            for letter in "kcm"
        }
        for letter in "kc":
            if _missing(table, f"{letter}yy"):
                values[letter]["yy"] = values[letter]["xx"]
        for term in TERMS:
            if any(values["m"][term]):
                table.note(f"m{term}", "got a mass; allowed: 0; add a PointMass or a disc of that mass in ROSS")
        # What a table was computed from is saved beside it; ROSS reads the table back.
        self._pass(table, table.entries())
        if node is None or len(table.problems) > before:
            return None
        return RossBearing(tag, kind, node, link, speeds if count > 1 else (), values["k"], values["c"])

    def _of_all(self, table: Table, key: str, allowed: str) -> None:
        """Note a problem that elements of a shaft mostly have together, once."""
        self._alike.setdefault(f"{key}: got {short(table.get(key))}; {allowed}", []).append(table.where)

    def _pass(self, table: Table, keys: tuple[str, ...]) -> None:
        """Pass over keys that have no part in the motion, and keep their names."""
        known = set(table._known)
        for key in keys:
            if key in table and key not in known:
                table.get(key)
                if key not in ("tag", "name", "color"):
                    self._passed[key] = None


def _missing(table: Table, key: str) -> bool:
    """Tell whether a key is not there, or null, as JSON has it; it is known from then on."""
    return table.get(key) is None


def _node(table: Table, key: str) -> int | None:
    """Read the number of a node; ROSS writes some as 3.0."""
    value = table.get(key)
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= _MOST_NODES:
        table.note(key, f"got {short(value)}; allowed: a node, 0 to {_MOST_NODES}")
        return None
    return value


def _numbers(
    table: Table, key: str, largest: float, count: int | None = None, required: bool = False
) -> tuple[float, ...]:
    """Read a number or a list of them; zeros where there are none."""
    value = table.get(key)
    zeros = (0.0,) * (count or 1)
    if value is None:
        # A mass is always optional.
        if required and not key.startswith("m"):
            table.note(key, "missing; allowed: a number, or a list of as many as there are frequencies")
        return zeros
    parts = value if isinstance(value, list) else [value] * (count or 1)
    if not 1 <= len(parts) <= _LONGEST_TABLE or (count is not None and len(parts) != count):
        allowed = f"1 to {_LONGEST_TABLE} numbers" if count is None else f"{count}, as many as there are frequencies"
        table.note(key, f"got {len(parts)} values; allowed: {allowed}")
        return zeros
    for part in parts:
        good = isinstance(part, (int, float)) and not isinstance(part, bool) and -largest <= part <= largest
        if not good:
            table.note(key, f"got {short(part)}; allowed: numbers of up to {largest:g}")
            return zeros
    return tuple(float(part) for part in parts)


def _chain_problems(beams: tuple[RossBeam, ...]) -> Iterator[str]:
    """Yield where the elements of a shaft do not follow each other."""
    reached, length = -1, 0.0
    for beam in beams:
        if beam.node == reached:
            if abs(beam.length - length) > 1e-6:
                yield (
                    f"ShaftElement {beam.tag!r:.60}: got L = {beam.length:g} m upon an element of {length:g} m; "
                    "allowed: layers of one length between two nodes"
                )
            continue
        if beam.node != reached + 1:
            yield (
                f"ShaftElement {beam.tag!r:.60}: got n = {beam.node} after {reached}; allowed: one shaft whose nodes "
                "follow each other from 0; of two shafts (CoAxialRotor, MultiRotor) the file says no places"
            )
        reached, length = beam.node, beam.length
