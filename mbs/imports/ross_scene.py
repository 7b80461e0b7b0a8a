"""The text of a scene from a rotor of ROSS: one shaft with its elements as they are, bearings by tables, supports.

Axes: x, y and z of ROSS are y, z and x of a scene. Weight acts against y of ROSS, as it does there.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Sequence

from ehdmaps.errors import InputError, Problems
from mbs.flexible.beam import CrossSection, wave_length
from mbs.imports.ross_file import TERMS, RossBearing, RossDisc, RossRotor

SHAFT = "rotor"
"""Name of the shaft in the scene."""

_AXES = {"x": "y", "y": "z", "z": "x"}
"""Our axis of each axis of ROSS."""

_CUTOFF, _DIAMETERS = 20e3, 1.5
"""Cut-off of the modes [Hz], so high that ROSS's elements are all that is left, and diameters of a wave there."""

_SEALS = ("SealElement", "LabyrinthSeal", "HolePatternSeal", "HybridSeal")


def ross_scene(rotor: RossRotor, name: str, title: str) -> str:
    """Text of the scene.

    Parameters
    ----------
    rotor : RossRotor
        The rotor.
    name : str
        Name of the scene's file, for its first lines.
    title : str
        Title of the scene.

    Raises
    ------
    InputError
        With all elements at nodes that are not there.
    """
    places = _places(rotor)
    names = _names([*rotor.discs, *rotor.masses, *rotor.bearings], {SHAFT})
    supports = _supports(rotor, places)
    freedoms = ["y", "z", "theta_y", "theta_z"]
    axial = any(any(table["zz"]) for one in rotor.bearings for table in (one.stiffness, one.damping))
    held = [mass for mass in rotor.masses if mass.node in supports]
    along = ["x"] * axial
    lines = [
        *_head(rotor, name, title, axial),
        "[[shafts]]",
        f'name = "{SHAFT}"',
        f"freedoms = {_list(along + freedoms)}",
    ]
    lines += ["spin = 1", f'cutoff = "{_number(_cutoff(rotor))} Hz"']
    longest = max(beam.length for beam in rotor.beams)
    lines.append(
        f'largest_element = "{_number(longest)} m"   # the elements of ROSS; left out: as the cut-off needs them'
    )
    lines += ["sections = [", *_sections(rotor, places), "]"]
    discs = [*rotor.discs, *(mass for mass in rotor.masses if mass.node not in supports)]
    if discs:
        lines += ["discs = [", *(f"    {_disc(disc, names, places)}," for disc in discs), "]"]
    for mass in held:
        lines += ["", "[[bodies]]", f"name = {_quoted(names[id(mass)])}", f"freedoms = {_list([*along, 'y', 'z'])}"]
        lines.append(f'position = ["{_number(supports[mass.node])} m", "0 m", "0 m"]')
        lines.append(f'mass = "{_number(mass.mass)} kg"')
    bodies = {mass.node: names[id(mass)] for mass in held}
    for bearing in rotor.bearings:
        lines += _bearing(bearing, names[id(bearing)], places, bodies)
    return "\n".join([*lines, *_analyses(rotor, names, discs), ""])


def summary(rotor: RossRotor) -> str:
    """Counts of what a scene has of a rotor, in a line.

    Parameters
    ----------
    rotor : RossRotor
        The rotor.
    """
    seals = sum(bearing.kind in _SEALS for bearing in rotor.bearings)
    counts = (
        (len(rotor.beams), "elements"),
        (len(rotor.discs), "discs"),
        (len(rotor.masses), "point masses"),
        (len(rotor.bearings) - seals, "bearings"),
        (seals, "seals"),
    )
    return ", ".join(f"{count} {words}" for count, words in counts if count)


def _places(rotor: RossRotor) -> list[float]:
    """Places of the nodes of the shaft along its axis [m]."""
    places = [0.0]
    for beam in rotor.beams:
        if beam.node == len(places) - 1:
            places.append(places[-1] + beam.length)
    return places


def _supports(rotor: RossRotor, places: Sequence[float]) -> dict[int, float]:
    """Places of nodes beyond the shaft, by the bearings that lead to them [m]; every node that is named is there."""
    problems = Problems()
    found: dict[int, float] = {}
    beyond = {mass.node for mass in rotor.masses if mass.node >= len(places)}
    waiting = [bearing for bearing in rotor.bearings if bearing.link is not None and bearing.link >= len(places)]
    while waiting:
        ready = [one for one in waiting if one.node < len(places) or one.node in found]
        for one in ready:
            assert one.link is not None
            found[one.link] = places[one.node] if one.node < len(places) else found[one.node]
        if not ready:
            break
        waiting = [one for one in waiting if one not in ready]
    entries: list[RossDisc | RossBearing] = [*rotor.discs, *rotor.masses, *rotor.bearings]
    for entry in entries:
        nodes = [entry.node]
        if isinstance(entry, RossBearing) and entry.link is not None:
            nodes.append(entry.link)
        for node in nodes:
            if node < len(places) or (node in beyond and node in found and entry not in rotor.discs):
                continue
            problems.append(
                f"{entry.tag!r:.60}: got node {node}; allowed: 0 to {len(places) - 1} on the shaft, or that of a "
                "PointMass to which a bearing with n_link leads"
            )
    problems.check()
    return found


def _names(entries: Sequence[RossDisc | RossBearing], taken: set[str]) -> dict[int, str]:
    """A name of its own for each element, of its tag."""
    names, used = {}, set(taken)
    for entry in entries:
        plain = re.sub(r"[^A-Za-z0-9 _+-]+", "_", entry.tag)[:60].strip(" _") or "element"
        name, number = plain, 2
        while name in used:
            name, number = f"{plain} {number}", number + 1
        used.add(name)
        names[id(entry)] = name
    return names


def _head(rotor: RossRotor, name: str, title: str, axial: bool) -> list[str]:
    """First lines, and the point of operation."""
    speed = _speed(rotor)
    about = "none in the file: the middle of its tables, or 0" if rotor.rated is None else "rated_w"
    passed = [f"# Passed over, without part in the motion: {', '.join(_plain(rotor.passed_over))}."] * bool(
        rotor.passed_over
    )
    return [
        f"# A rotor of ROSS {rotor.version or '2'}: {summary(rotor)}. x, y, z of ROSS are y, z, x here.",
        "# Held: turning about the axis"
        + (" alone." if axial else ", and motion along it, which no bearing stiffens."),
        *passed,
        "#",
        f"#   mbs check {name}",
        f'#   mbs critical {name} --speed "0 rpm" "10000 rpm" 50',
        "",
        "schema = 1",
        f"title = {_quoted(title)}",
        "",
        "[operation]",
        f'speed = "{_number(speed)} rad/s"   # {about}',
        'temperature = "40 degC"   # of oil; plays no part here',
        'gravity = ["0 m/s^2", "0 m/s^2", "-9.80665 m/s^2"]   # against y of ROSS',
        "",
    ]


def _range(rotor: RossRotor) -> tuple[float, float] | None:
    """Speeds that the file states, or that all of its tables cover [rad/s]; None where there are none."""
    tables = [bearing.speeds for bearing in rotor.bearings if bearing.speeds]
    low, high = rotor.slowest, rotor.fastest
    if low is None and tables:
        low = max(speeds[0] for speeds in tables)
    if high is None and tables:
        high = min(speeds[-1] for speeds in tables)
    return None if high is None or not (low or 0.0) < high else (max(low or 0.0, 0.0), high)


def _speed(rotor: RossRotor) -> float:
    """Speed of operation [rad/s]."""
    if rotor.rated is not None:
        return rotor.rated
    covered = _range(rotor)
    return 0.0 if covered is None else 0.5 * sum(covered)


def _cutoff(rotor: RossRotor) -> float:
    """Cut-off at which bending waves are longer than the diameter where the shaft is most slender [Hz]."""
    stiff = [beam for beam in rotor.beams if beam.youngs_modulus > 1e-3 * max(b.youngs_modulus for b in rotor.beams)]
    cutoff = _CUTOFF
    while cutoff > 1.0 and not any(
        wave_length(CrossSection.annulus(*beam.left, beam.youngs_modulus, beam.poisson_ratio, beam.density), cutoff)
        > _DIAMETERS * beam.left[0]
        for beam in stiff
    ):
        cutoff *= 0.5
    return cutoff


def _sections(rotor: RossRotor, places: Sequence[float]) -> Iterator[str]:
    """Rows of the shaft."""
    for beam in rotor.beams:
        begin, end = places[beam.node], places[beam.node + 1]
        keys = [f'from = "{_number(begin)} m", to = "{_number(end)} m", diameter = "{_number(beam.left[0])} m"']
        if beam.left[1]:
            keys.append(f'bore = "{_number(beam.left[1])} m"')
        keys += [
            f'{key} = "{_number(last)} m"'
            for key, first, last in zip(("end_diameter", "end_bore"), beam.left, beam.right, strict=True)
            if last != first
        ]
        keys.append(
            f'youngs_modulus = "{_number(beam.youngs_modulus)} Pa", poisson_ratio = {_number(beam.poisson_ratio)}'
        )
        yield f'    {{ {", ".join(keys)}, density = "{_number(beam.density)} kg/m^3" }},'


def _disc(disc: RossDisc, names: dict[int, str], places: Sequence[float]) -> str:
    """Row of a disc."""
    keys = [
        f'name = {_quoted(names[id(disc)])}, at = "{_number(places[disc.node])} m", mass = "{_number(disc.mass)} kg"'
    ]
    if disc.polar or disc.transverse:
        keys.append(
            f'polar_inertia = "{_number(disc.polar)} kg m^2", transverse_inertia = "{_number(disc.transverse)} kg m^2"'
        )
    return f"{{ {', '.join(keys)} }}"


def _bearing(bearing: RossBearing, name: str, places: Sequence[float], bodies: dict[int, str]) -> list[str]:
    """Table of a bearing or seal."""
    lines = ["", f"[[bearings]]   # {bearing.kind}", 'kind = "table"', f"name = {_quoted(name)}"]
    if bearing.node < len(places):
        lines += [f'shaft = "{SHAFT}"', f'position = "{_number(places[bearing.node])} m"']
    else:
        lines.append(f"inner = {_quoted(bodies[bearing.node])}")
    if bearing.link is None:
        lines += ['outer = "ground"'] * (bearing.node >= len(places))
    elif bearing.link < len(places):
        raise InputError(
            f"{bearing.tag!r:.60}: got n_link = {bearing.link}, which is on the shaft; allowed: the ground, or a "
            "PointMass beyond the shaft"
        )
    else:
        lines.append(f"outer = {_quoted(bodies[bearing.link])}")
    if bearing.speeds:
        lines.append(f"speeds = {_list([f'{_number(speed)} rad/s' for speed in bearing.speeds])}")
        lines.append('between = "cubic"   # as ROSS has it, but for its smoothing; beyond the ends they hold')
    for key, values, unit in (("stiffness", bearing.stiffness, "N/m"), ("damping", bearing.damping, "N s/m")):
        entries = [f"{_term(term)} = {_values(values[term], unit)}" for term in TERMS if any(values[term])]
        if not entries and key == "stiffness":
            entries = ['y = "0 N/m"']
        if entries:
            lines.append(f"{key} = {{ {', '.join(entries)} }}")
    return lines


def _analyses(rotor: RossRotor, names: dict[int, str], discs: Sequence[RossDisc]) -> Iterator[str]:
    """Inputs and sensors, and the speeds of a sweep where the file says some."""
    heaviest = max(discs, key=lambda disc: disc.mass, default=None)
    own = [
        bearing for bearing in rotor.bearings if bearing.kind not in _SEALS and bearing.node <= rotor.beams[-1].node + 1
    ]
    where = names[id(heaviest)] if heaviest else names[id(own[0])] if own else None
    if where is not None:
        for axis in "yz":
            yield from ("", "[[inputs]]", f'name = "force {axis}"', f"on = {_quoted(f'{SHAFT}:{where}')}")
            yield f'direction = "{axis}"'
    for bearing in own[:4]:
        for axis in "yz":
            yield from ("", "[[sensors]]", f"name = {_quoted(f'{names[id(bearing)]} {axis}')}")
            yield f"on = {_quoted(f'{SHAFT}:{names[id(bearing)]}')}"
            yield from (f'direction = "{axis}"', 'quantity = "displacement"')
    covered = _range(rotor)
    if covered is not None:
        yield from ("", "[sweep]", f'from = "{_number(covered[0])} rad/s"', f'to = "{_number(covered[1])} rad/s"')
        yield "points = 30"
    yield from ("", "[linear]", 'frequencies = { from = "1 Hz", to = "500 Hz", points = 300, spacing = "linear" }')


def _term(term: str) -> str:
    """Name of an entry of a matrix."""
    first, second = (_AXES[letter] for letter in term)
    return first if first == second else f"{first}_{second}"


def _values(values: Sequence[float], unit: str) -> str:
    """One value, or a list of them."""
    return (
        _list([f"{_number(value)} {unit}" for value in values]) if len(values) > 1 else f'"{_number(values[0])} {unit}"'
    )


def _list(words: Sequence[str]) -> str:
    """List of texts."""
    return f"[{', '.join(_quoted(word) for word in words)}]"


def _number(value: float) -> str:
    """Number with the digits that a scene reads."""
    if not math.isfinite(value):
        raise InputError(f"got {value!r}; allowed: finite numbers")
    return f"{value:.15g}"


def _plain(words: Sequence[str]) -> list[str]:
    """Words that a comment holds."""
    return [re.sub(r"[^A-Za-z0-9_]", "_", word)[:40] for word in words[:40]]


def _quoted(text: str) -> str:
    """Text as a string of TOML."""
    return json.dumps("".join(letter if letter.isprintable() else "_" for letter in text), ensure_ascii=False)
