"""Target `modelica` of `ehdmaps export`: the contact law at one speed and temperature as a Modelica package.

At one speed and temperature the law is a table of cubics: w^(1/3) and ln(c/w) over
s = asinh((approach - offset)/scale). The cells of s are evenly spaced. The package has these very cubics, so that it
differs from the law by round-off only. The derivative of the function in time is a function, too, and exact, so that no
tool has to take difference quotients for it.
"""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.exports.modelica_memory import memory_text
from ehdmaps.exports.target import Target, origin
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.law import LawAtPoint, LawKind
from ehdmaps.outputs import Kind, Output, check_outputs, has_mark, write_text
from ehdmaps.program import plain
from ehdmaps.units import SPEED, TEMPERATURE, Display, quantity

PACKAGE = Kind("a Modelica package of ehdmaps", (".mo",), has_mark)

_WORDS = """
    algorithm and annotation assert block break class connect connector constant constrainedby der
    discrete each else elseif elsewhen encapsulated end enumeration equation expandable extends external
    false final flow for function if import impure in initial inner input loop model not operator or
    outer output package parameter partial protected public pure record redeclare replaceable return
    stream then true type when while within
"""
"""Words of the language (Modelica Language Specification 3.5, section 2.3.3)."""

_OWN = ("Table", "atRest", "force", "forceDerivative", "Example", "Film", "cellOf", "loadAt", "film", "ExampleMemory")
"""Names inside the package."""

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,62}")

_BODY = """package {name} "{title}"
  // {lines}
  package Table
    constant Integer cells = {cells};
    constant Real offset(unit = "m") = {offset};
    constant Real inverseScale(unit = "1/m") = {inverse_scale};
    constant Real start = {start};
    constant Real step = {step};
    constant Real highestApproach(unit = "m") = {highest} "from here on the load is above the map";
    constant Real cubic[{cells}, 8] = {{
      {rows}}} "cubics over the part of a cell: four numbers of w^(1/3), four of ln(c/w)";
  end Table;

  function atRest "Load at rest and ln(c/w) of a contact, with two derivatives by the approach"
    input Real approach(unit = "m", nominal = {nominal}) "positive together";
    output Real rest(unit = "N/m", nominal = {load});
    output Real drest(unit = "N/m2");
    output Real ddrest(unit = "N/m3");
    output Real ratio(unit = "s/m") "c/w";
    output Real slope(unit = "1/m") "of ln(c/w)";
    output Real bend(unit = "1/m2") "of ln(c/w)";
  protected
    Real z;
    Real root;
    Real s;
    Real x;
    Integer cell;
    Real t;
    Real scale;
    Real dscale;
    Real g;
    Real dg;
    Real ddg;
    Real logRatio;
  algorithm
    assert(approach <= Table.highestApproach, "approach is above the map");
    z := (approach - Table.offset) * Table.inverseScale;
    root := sqrt(1.0 + z * z);
    s := if z >= 0.0 then log(z + root) else -log(root - z);
    x := max(0.0, min((s - Table.start) * Table.step, Table.cells));
    cell := integer(min(floor(x), Table.cells - 1)) + 1;
    t := x - (cell - 1);
    scale := Table.step * Table.inverseScale / root;
    dscale := -scale * Table.inverseScale * z / (root * root);
    g := max(0.0, Table.cubic[cell, 1] + t * (Table.cubic[cell, 2] + t * (Table.cubic[cell, 3]
      + t * Table.cubic[cell, 4])));
    dg := Table.cubic[cell, 2] + t * (2.0 * Table.cubic[cell, 3] + 3.0 * t * Table.cubic[cell, 4]);
    ddg := 2.0 * Table.cubic[cell, 3] + 6.0 * t * Table.cubic[cell, 4];
    ddg := ddg * scale * scale + dg * dscale;
    dg := dg * scale;
    logRatio := Table.cubic[cell, 5] + t * (Table.cubic[cell, 6] + t * (Table.cubic[cell, 7]
      + t * Table.cubic[cell, 8]));
    slope := Table.cubic[cell, 6] + t * (2.0 * Table.cubic[cell, 7] + 3.0 * t * Table.cubic[cell, 8]);
    bend := 2.0 * Table.cubic[cell, 7] + 6.0 * t * Table.cubic[cell, 8];
    bend := bend * scale * scale + slope * dscale;
    slope := slope * scale;
    rest := g ^ 3;
    drest := 3.0 * g * g * dg;
    ddrest := 3.0 * g * (2.0 * dg * dg + g * ddg);
    ratio := exp(max(-700.0, min(logRatio, 700.0)));
  end atRest;

  function force "Load of a contact, its stiffness and damping, per unit length"
    input Real approach(unit = "m", nominal = {nominal}) "positive together";
    input Real rate(unit = "m/s", nominal = 1e-3) "of the approach";
    output Real w(unit = "N/m", nominal = {load}) "presses the bodies together";
    output Real k(unit = "N/m2", nominal = {stiffness}) "dw/dapproach";
    output Real c(unit = "N.s/m2", nominal = {damping}) "dw/drate";
  protected
    Real rest;
    Real drest;
    Real ddrest;
    Real ratio;
    Real slope;
    Real bend;
    Real drag;
    Real ddrag;
    Real part;
    Real share;
  algorithm
    (rest, drest, ddrest, ratio, slope, bend) := atRest(approach);
    drag := rest * ratio;
    ddrag := ratio * (drest + rest * slope);
    part := drag * rate;
    if rest <= 0.0 then
      w := 0.0;
      k := 0.0;
      c := 0.0;
    elseif part >= -0.5 * rest then
      w := rest + part;
      k := drest + ddrag * rate;
      c := drag;
    else
      share := rest / part;
      w := -0.25 * rest * share;
      k := 0.25 * share * (share * ddrag * rate - 2.0 * drest);
      c := 0.25 * share * share * drag;
    end if;
    annotation(derivative = forceDerivative, smoothOrder = 1);
  end force;

  function forceDerivative "Rates of load, stiffness and damping in time: the derivative of force"
    input Real approach(unit = "m", nominal = {nominal}) "positive together";
    input Real rate(unit = "m/s", nominal = 1e-3) "of the approach";
    input Real der_approach(unit = "m/s") "of the approach, as force has it";
    input Real der_rate(unit = "m/s2") "of the rate, as force has it";
    output Real der_w(unit = "N/(m.s)");
    output Real der_k(unit = "N/(m2.s)");
    output Real der_c(unit = "N/m2");
  protected
    Real rest;
    Real drest;
    Real ddrest;
    Real ratio;
    Real slope;
    Real bend;
    Real q;
    Real dq;
    Real ddq;
    Real mixed;
  algorithm
    (rest, drest, ddrest, ratio, slope, bend) := atRest(approach);
    if rest <= 0.0 then
      der_w := 0.0;
      der_k := 0.0;
      der_c := 0.0;
    elseif ratio * rate >= -0.5 then
      // w = rest + q * rate
      q := rest * ratio;
      dq := ratio * (drest + rest * slope);
      ddq := ratio * (ddrest + 2.0 * drest * slope + rest * (bend + slope * slope));
      der_w := (drest + dq * rate) * der_approach + q * der_rate;
      der_k := (ddrest + ddq * rate) * der_approach + dq * der_rate;
      der_c := dq * der_approach;
    else
      // w = -q / (4 * rate)
      q := rest / ratio;
      dq := (drest - rest * slope) / ratio;
      ddq := (ddrest - 2.0 * drest * slope + rest * (slope * slope - bend)) / ratio;
      mixed := 0.25 * dq / (rate * rate);
      der_w := -0.25 * dq / rate * der_approach + 0.25 * q / (rate * rate) * der_rate;
      der_k := -0.25 * ddq / rate * der_approach + mixed * der_rate;
      der_c := mixed * der_approach - 0.5 * q / (rate * rate * rate) * der_rate;
    end if;
  end forceDerivative;

  model Example "A mass on the contact, under a constant load"
    parameter Real mass(unit = "kg/m") = {mass} "per unit length of contact";
    parameter Real load(unit = "N/m") = {load};
    Real approach(unit = "m", start = {begin}, fixed = true, nominal = {nominal});
    Real rate(unit = "m/s", start = 0.0, fixed = true, nominal = 1e-3);
    Real w(unit = "N/m", nominal = {load});
    Real k(unit = "N/m2", nominal = {stiffness});
    Real c(unit = "N.s/m2", nominal = {damping});
  equation
    (w, k, c) = force(approach, rate);
    der(approach) = rate;
    mass * der(rate) = load - w;
  end Example;
end {name};
"""


def package(law: LawAtPoint, name: str, lines: Iterable[str], memory: bool = False) -> str:
    """Return a law at one speed and temperature as a Modelica package.

    Parameters
    ----------
    law : LawAtPoint
        The law; with its whole film, and without a centrifugal load.
    name : str
        Name of the package.
    lines : iterable of str
        Lines of its header; the first carries our mark.
    memory : bool
        Whether it has films with memory, too.

    Raises
    ------
    InputError
        If the name is not allowed in Modelica, or if the speed is below the mapped ones, where films fade.
    """
    if not _NAME.fullmatch(name) or name in _WORDS.split() or name in _OWN:
        raise InputError(
            f"--name: got {name!r:.60}; allowed: up to 63 letters, digits and _, a letter first, no word of Modelica"
        )
    point = law.point
    if point.film < 1.0 or point.centrifugal_load > 0.0:
        raise InputError("--speed: below the lowest speed of the map the film fades; allowed: speeds of the map")
    line = point.own
    highest = law.approach(point.highest_load)
    load = point.highest_load * 0.1
    begin = law.approach(load)
    _, stiffness, damping = law(begin, 0.0)
    # The mass oscillates at 1 kHz, and begins 1 % of its approach off its place.
    mass = float(stiffness) / (2.0e3 * math.pi) ** 2
    rows = ",\n      ".join("{" + ", ".join(_number(value) for value in row) + "}" for row in line.coefficients)
    text = _BODY.format(
        name=name,
        title="EHD contact law at one speed and temperature",
        lines="\n  // ".join(_comment(one) for one in lines),
        cells=len(line.coefficients),
        offset=_number(line.offset),
        inverse_scale=_number(line.inverse_scale),
        start=_number(line.start),
        step=_number(line.step),
        highest=_number(highest),
        rows=rows,
        nominal=f"{1.0 / line.inverse_scale:.1g}",
        load=_number(load),
        stiffness=f"{float(stiffness):.1g}",
        damping=f"{max(float(damping), 1.0):.1g}",
        mass=_number(mass),
        begin=_number(1.01 * begin),
    )
    if memory:
        words = {"nominal": f"{1.0 / line.inverse_scale:.1g}", "nominal_load": _number(load), "mass": _number(mass)}
        end = text.rindex(f"end {name};")
        text = f"{text[:end]}\n{memory_text(law, {**words, 'begin': _number(1.01 * begin)})}{text[end:]}"
    return text


def _number(value: float) -> str:
    """Return a number with all digits."""
    return repr(float(value))


def _comment(text: str) -> str:
    """Return a text for a comment of one line, in ASCII."""
    return plain(text).encode("ascii", "backslashreplace").decode("ascii")


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add where the law is taken."""
    parser.add_argument("--speed", required=False, help='entrainment speed, such as "1.7 m/s"; a map of one has it')
    parser.add_argument("--temperature", help='of the raceways, such as "40 degC"; a map of one has it')
    parser.add_argument("--contact", metavar="NAME", help="series | inner | outer | line; default: series, of a line")
    parser.add_argument(
        "--films", choices=("slow", "memory"), default="slow",
        help="films follow at once (the default), or also relax: function film, model ExampleMemory",
    )  # fmt: skip
    parser.add_argument("--name", default="EhdContact", help="name of the package; EhdContact if left out")


def _write(emap: EHDMap, path: Path, output: Path | None, arguments: argparse.Namespace) -> str:
    """Write the package; by default beside the map."""
    output = output or path.with_suffix(".mo")
    check_outputs([Output("-o", output, PACKAGE)], [path])
    problems: list[str] = []
    names = [contact.name for contact in emap.contacts]
    kinds: list[Any] = ["series", *names] if "inner" in names else names
    kind: LawKind = arguments.contact or kinds[0]
    if kind not in kinds:
        problems.append(f"--contact: got {kind!r:.60}; allowed in this map: {', '.join(kinds)}")
    speed = _chosen("--speed", arguments.speed, "m/s", emap, "entrainment_speed", SPEED, problems)
    temperature = _chosen("--temperature", arguments.temperature, "K", emap, "temperature", TEMPERATURE, problems)
    if problems:
        raise InputError(problems)
    law = emap.law(kind).at(speed, temperature)
    header = (
        *origin(emap, path.name),
        f"contact: {kind}, entrainment speed {SPEED.text(speed)}, temperature {TEMPERATURE.text(temperature)}",
        "units: SI, per unit length of contact; approach and load are positive together",
        "above the highest load of the map an assertion fails; function force: stiffness and damping of slow motion",
    )
    write_text(output, package(law, arguments.name, header, arguments.films == "memory"), PACKAGE)
    return f"{output}: written"


def _chosen(
    option: str, text: str | None, unit: str, emap: EHDMap, axis: str, display: Display, problems: list[str]
) -> float:
    """Read a speed or temperature within the map."""
    values = emap.dataset[axis].values.astype(float)
    low, high = float(min(values[values > 0.0], default=0.0)), float(values[-1])
    if text is None:
        if values.size > 1:
            problems.append(f"{option}: missing; allowed in this map: {display.text(low)} to {display.text(high)}")
        return high
    try:
        value = quantity(text, unit)
    except InputError as error:
        problems.append(f"{option}: {error.problems[0]}")
        return high
    if not low <= value <= high:
        problems.append(f"{option}: got {text!r:.60}; allowed in this map: {display.text(low)} to {display.text(high)}")
    return value


TARGET = Target(
    summary="the contact law at one speed and temperature as pure functions, with an example",
    writes="MAP.mo",
    read_back_by="rumoca",
    add_arguments=_add_arguments,
    write=_write,
)
