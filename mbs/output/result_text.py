"""Results of analyses in words: modes, the energy of a run, signals of sensors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ehdmaps.arrays import IntArray
from ehdmaps.units import MOTIONS, RPM, Display
from mbs.linearised.modes import Modes
from mbs.model.drive import DriveAccount
from mbs.model.system import System
from mbs.output.model_text import free_words
from mbs.scene.fields import HERTZ
from mbs.timedata.records import TimeRecord
from mbs.transient.energy import ElementEnergy, EnergyBalance

NOTABLE = 0.01
"""Residual, and energy that the method took, as a part of what went through, from which a line warns."""


def energy_lines(energy: EnergyBalance) -> list[str]:
    """Lines on where the energy of a run came from and went to.

    Parameters
    ----------
    energy : EnergyBalance
        The balance.
    """
    sources = [("loads", energy.loads), *(pair for entry in energy.elements for pair in _sources(entry))]
    sinks = [*energy.parts.items(), *((e.name, e.dissipated) for e in energy.elements if e.dissipated is not None)]
    stores = [("kinetic", energy.kinetic), ("bodies and springs", energy.elastic)]
    stores += [(e.name, e.change) for e in energy.elements if e.told and e.change is not None]
    return [
        f"energy: {energy.put_in:.4g} J put in ({_named(sources)})",
        f"  {energy.dissipated:.4g} J dissipated ({_named(sinks)})",
        f"  {energy.stored:.4g} J stored more at the end ({_named(stores)})",
        *_method_lines(energy),
    ]


def drive_lines(account: DriveAccount | None) -> list[str]:
    """A line on the energy of the drive of a run; none where the speed is prescribed.

    Parameters
    ----------
    account : DriveAccount or None
        Energies of the drive.
    """
    if account is None:
        return []
    return [
        f"drive: the motor gave {account.motor:.4g} J; {account.stored:.4g} J into turning, {account.load:.4g} J to "
        f"the load and to rolling, {account.taken:.4g} J into the moving system; residual {account.residual:.2g} J"
    ]


def _sources(entry: ElementEnergy) -> list[tuple[str, float]]:
    """Energy that came in through an element."""
    if not entry.told:
        return [(f"{entry.name}, which does not say what it stores", entry.work)]
    turning = [(f"turning of {entry.name}", entry.driven or 0.0)]
    return [*turning, (f"speed on {entry.name}, estimated", entry.by_speed)] if entry.by_speed else turning


def _named(terms: list[tuple[str, float]]) -> str:
    """Terms with their names."""
    return ", ".join(f"{name} {value:.3g} J" for name, value in terms) or "nothing"


def _method_lines(energy: EnergyBalance) -> list[str]:
    """Energy that the method took, and what is left."""
    through = energy.through
    if through == 0.0:
        return ["  no energy went through"]
    share, left = energy.numerical / through, energy.relative_residual
    took = f"the method of integration {'took' if share >= 0.0 else 'gave'} {abs(energy.numerical):.3g} J"
    took += f", {_percent(abs(share))} of the {through:.4g} J that went through"
    rest = f"residual {energy.residual:.3g} J, {_percent(left)}"
    return [
        f"  warning: {took}; take smaller steps, or a spectral radius nearer to 1"
        if abs(share) > NOTABLE
        else f"  {took}",
        f"  warning: {rest}; it falls with the square of the step" if left > NOTABLE else f"  {rest}",
    ]


def _percent(part: float) -> str:
    """A part in percent."""
    return f"{100.0 * part:.2g} %"


def kinds(found: Modes) -> tuple[IntArray, IntArray, IntArray]:
    """Return which modes are free, which creep back without oscillating, and which oscillate.

    Parameters
    ----------
    found : Modes
        The modes.
    """
    free = found.free
    creeping = (found.eigenvalues.imag <= 0.0) & ~free
    return np.flatnonzero(free), np.flatnonzero(creeping), np.flatnonzero(~free & ~creeping)


def signal_lines(records: Sequence[TimeRecord]) -> list[str]:
    """A short table, a line a sensor and run; none without sensors.

    Parameters
    ----------
    records : sequence of TimeRecord
        Runs of the same channels, with their speed where it is known.
    """
    named = len(records) > 1
    columns = [channel.name for channel in records[0].sensors], [record.label for record in records]
    widths = [max(map(len, [*texts, "sensor"])) for texts in columns]
    if not records[0].sensors:
        return []
    run = f"  {'run':<{widths[1]}}" if named else ""
    lines = [f"  {'sensor':<{widths[0]}}{run}         mean   rms about it    largest, at             unit"]
    for channel in records[0].sensors:
        for record in records:
            shown = MOTIONS.get(channel.unit, Display(channel.unit))
            values = shown.factor * record.column(channel)
            mean = float(values.mean())
            at = int(np.argmax(np.abs(values)))
            where = f"{record.time[at]:.4g} s"
            if record.speed is not None:
                where += f", {RPM.text(abs(float(record.speed[at])))}"
            of = f"  {record.label:<{widths[1]}}" if named else ""
            lines.append(
                f"  {channel.name:<{widths[0]}}{of} {mean:12.4g} {np.sqrt(np.mean((values - mean) ** 2)):14.4g} "
                f"{values[at]:10.4g}, {where:<18} {shown.unit}"
            )
    return lines


def free_lines(which: IntArray, system: System) -> list[str]:
    """A line for all free motions; none without.

    Parameters
    ----------
    which : array of int
        Which modes are free.
    system : System
        Whose modes they are.
    """
    return [free_words(which.size, system)] if which.size else []


def above_lines(found: Modes, which: IntArray, highest: float) -> list[str]:
    """A line on modes that are not shown; none without.

    Parameters
    ----------
    found : Modes
        All modes.
    which : array of int
        Those that are not shown.
    highest : float
        Highest frequency that is shown [Hz].
    """
    if not which.size:
        return []
    last = HERTZ.text(float(found.frequency[which].max()), 5)
    return [f"{which.size} more modes above {HERTZ.text(highest, 5)}, up to {last}, not shown (--highest)"]
