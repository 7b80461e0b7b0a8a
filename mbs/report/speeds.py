"""Speeds of a report: critical ones with their margin to operation, and what loads that turn do."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import COLOURS
from ehdmaps.report.axis import linear_axis, log_axis
from ehdmaps.report.chart import WIDE, Chart, Curve, Shade, figure, number, shown
from ehdmaps.report.page import Markup, joined, table, tag
from ehdmaps.units import MOTIONS, RPM
from mbs.analyses.sweep import CriticalResult
from mbs.linearised.critical import CLOSE, CriticalSpeed, OrderResponse, orbit
from mbs.linearised.linear import sensor_unit
from mbs.linearised.mode_names import IN_A_PLANE
from mbs.output.sweep_data import sensed
from mbs.scene.fields import FORCE

_BAND = "90 % of what is not known"

MOST_ASKED = 0.27
"""Largest margin above operation that API 617 asks for."""

SHARP = 2.5
"""Amplification factor, 1/(2 zeta), below which API 617 asks for no margin."""


def asked_margin(damping_ratio: float, above: bool) -> float:
    """Margin that API 617 asks for between a critical speed and the operating range, as a part of the nearer end.

    Parameters
    ----------
    damping_ratio : float
        Damping ratio of the mode at its critical speed.
    above : bool
        Whether the critical speed lies above the range.

    References
    ----------
    API 617, 7th edition, 2002, equations 1.2-4 and 1.2-5: 17 (1 - 1/(AF - 1.5)) % below, 10 % more above the range.

    Examples
    --------
    >>> round(asked_margin(0.05, above=True), 3), asked_margin(0.3, above=True)
    (0.25, 0.0)
    """
    factor = 1.0 / (2.0 * damping_ratio) if damping_ratio > 0.0 else math.inf
    if factor < SHARP:
        return 0.0
    return (0.1 if above else 0.0) + 0.17 * (1.0 - 1.0 / (factor - 1.5))


def critical_table(found: CriticalResult, names: Sequence[str], banded: bool = False) -> Markup:
    """Return the critical speeds with their margins to operation.

    Parameters
    ----------
    found : CriticalResult
        Critical speeds.
    names : sequence of str
        Names of the modes of the critical speeds, by where their energy is; empty where that is not known.
    banded : bool
        Whether bands of what is not known stand beside the speeds.
    """
    low, high = found.model.scene.operating_range
    end = float(np.abs(found.sweep.speeds).max())
    span = f"{_rpm(low)} to {_rpm(high)}" if high > low else _rpm(high)
    looked = f"Speeds up to {_rpm(end)} were looked at; operation is {span}."
    if end < (1.0 + MOST_ASKED) * high * (1.0 - CLOSE):
        looked += (
            f" What lies in the margin above, up to {_rpm((1.0 + MOST_ASKED) * high)}, was not: let [sweep] reach it."
        )
    if not found.model.system.turning:
        looked += " No load that turns is stated: orders are the spins of the bodies."
    if not found.found:
        return tag("p", f"There is no critical speed. {looked}")
    rows, near = [], list[str]()
    bounds = RPM.value(1.0) * found.bounds[:, :2] if banded else np.zeros((len(found.found), 0))
    for entry, name, reach in zip(found.found, names, bounds, strict=True):
        margin, above = _margin(entry, low, high)
        asked = asked_margin(entry.damping_ratio, above)
        words = "inside" if margin is None else f"{100.0 * margin:.3g} % {'above' if above else 'below'}"
        short = (margin is None or margin < asked) and asked > 0.0
        ask = f"{100.0 * asked:.2g} %" if asked else "none"
        factor = 1.0 / (2.0 * entry.damping_ratio) if entry.damping_ratio > 0.0 else math.inf
        rows.append(
            (
                f"{name or f'mode {entry.mode + 1}'}{_turning(entry.whirl)}",
                number(entry.order, 4),
                number(RPM.value(entry.speed), 5),
                *([_reach(*reach)] if banded else []),
                number(entry.eigenvalue.imag / (2.0 * math.pi), 4),
                number(max(entry.damping_ratio, 0.0), 2),
                number(factor, 3) if math.isfinite(factor) else "-",
                words,
                ask + (", not kept" if short else ""),
            )
        )
        if short:
            near.append(f"{_rpm(entry.speed)} ({name or f'mode {entry.mode + 1}'}, order {number(entry.order, 4)})")
    heads = (
        "mode", "order", "speed, rpm", *((_BAND,) if banded else ()), "frequency, Hz", "damping ratio", "amplification",
        "from operation", "asked by API 617",
    )  # fmt: skip
    said = f"Too near to operation: {'; '.join(near)}." if near else "All keep the margin that API 617 asks for."
    return joined(
        table(heads, rows, "Critical speeds", (0, len(heads) - 2, len(heads) - 1)),
        tag("p", f"{looked} {said}", class_="warning" if near else "says"),
    )


def _reach(low: float, high: float) -> str:
    """A band in words; a dash where it is not known."""
    return f"{number(low)} to {number(high)}" if math.isfinite(low) and math.isfinite(high) else "-"


def _turning(whirl: float) -> str:
    """Direction of whirl in words; none of a motion along or about the axis."""
    if not math.isfinite(whirl):
        return ""
    return ", in a plane" if abs(whirl) < IN_A_PLANE else f", {'forward' if whirl > 0.0 else 'backward'}"


def _margin(entry: CriticalSpeed, low: float, high: float) -> tuple[float | None, bool]:
    """Distance of a critical speed from operation, as a part of the nearer end, and whether it lies above."""
    if entry.speed > high * (1.0 + CLOSE):
        return (entry.speed / high - 1.0 if high > 0.0 else math.inf), True
    return (None, False) if entry.speed >= low * (1.0 - CLOSE) else (1.0 - entry.speed / low, False)


def unbalance_parts(found: CriticalResult, banded: bool = False) -> Markup:
    """Return what loads that turn do: sensors and forces at operation, and the largest in its range, with a chart.

    Parameters
    ----------
    found : CriticalResult
        Responses to loads that turn.
    banded : bool
        Whether bands of what is not known stand beside the largest ones.
    """
    system, sensors, speeds = found.model.system, found.model.scene.sensors, np.abs(found.speeds)
    if not found.responses:
        return tag("p", "The scene has no unbalance and no load that turns.")
    low, high = found.model.scene.operating_range
    speed = abs(found.model.scene.speed)
    inside = np.flatnonzero((speeds >= low) & (speeds <= high))
    parts: list[Markup] = []
    largest = found.largest if banded else {}
    for row, response in enumerate(found.responses):
        seen = np.abs(sensed(system, sensors, found.speeds, response))
        forces = found.dataset["element_force"].values[row]
        curves = [
            (f"sensor {sensor.name}", MOTIONS[sensor_unit(sensor)], seen[:, k]) for k, sensor in enumerate(sensors)
        ]
        bands = [largest["response_largest"].of((row, k)) for k in range(len(sensors))] if banded else []
        for k, connected in enumerate(system.elements):
            if forces[:, k].max(initial=0.0) > 0.0:
                curves.append((f"force on {connected.element.name}", FORCE, forces[:, k]))
                bands += [largest["element_force_largest"].of((row, k))] if banded else []
        rows = []
        for index, (name, display, values) in enumerate(curves):
            most = int(np.argmax(values))
            cells = [shown(display, float(np.interp(speed, speeds, values))) if _within(speed, speeds) else "-"]
            if high > low:
                worst = int(inside[np.argmax(values[inside])]) if inside.size else most
                cells.append(f"{shown(display, float(values[worst]))} at {_rpm(speeds[worst])}" if inside.size else "-")
            cells.append(f"{shown(display, float(values[most]))} at {_rpm(speeds[most])}")
            if banded:
                cells.append(_reach(*(display.value(float(end)) for end in (bands[index].low, bands[index].high))))
            rows.append((name, *cells))
        heads = (
            "", f"at {_rpm(speed)}", *(("largest in operation",) if high > low else ()), "largest of all",
            *((_BAND,) if banded else ()),
        )  # fmt: skip
        words = f"Order {number(response.order, 4)}: {', '.join(response.names)}; amplitudes"
        parts += [
            table(heads, rows, words, tuple(range(len(heads)))),
            _chart(row, response, found),
        ]
    return joined(*parts)


def _within(speed: float, speeds: FloatArray) -> bool:
    """Tell whether a speed lies among others."""
    return bool(speeds[0] <= speed <= speeds[-1])


def _chart(row: int, response: OrderResponse, found: CriticalResult) -> Markup:
    """Forces over speed."""
    speeds, every = response.drawn_speeds, orbit(response.drawn_forces[..., 0], response.drawn_forces[..., 1])[0]
    forces = [
        (f"force on {connected.element.name}", every[:, k])
        for k, connected in enumerate(found.model.system.elements)
        if every[:, k].max(initial=0.0) > 0.0
    ][: len(COLOURS)]
    low, high = found.model.scene.operating_range
    order = response.order
    everything = np.concatenate([values for _, values in forces]) if forces else np.ones(1)
    chart = Chart(
        f"unbalance-{row + 1}",
        f"Forces on the seats by order {number(order, 4)} over speed",
        "Amplitudes of the radial force of each bearing.",
        linear_axis("speed", "rpm", RPM.factor * speeds, from_zero=False),
        log_axis("force", "N", everything, floor=1e-5, room=1.2),
        RPM.factor * speeds,
        [Curve(name, values, COLOURS[k % len(COLOURS)]) for k, (name, values) in enumerate(forces)],
        shades=[Shade("operation", RPM.value(low), RPM.value(high))],
        frame=WIDE,
    )
    return tag("div", figure(chart), class_="single")


def _rpm(speed: float) -> str:
    """A speed in words."""
    return f"{number(RPM.value(abs(float(speed))), 5)} rpm"
