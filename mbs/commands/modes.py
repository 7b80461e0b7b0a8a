"""`mbs modes`: complex modes at the operating speed."""

from __future__ import annotations

import argparse

import numpy as np

from mbs.commands.cases import load_model
from mbs.commands.common import film_limits, film_warnings, heading, outside_at, write
from mbs.linearised.modes import Modes, modes
from mbs.linearised.steady import steady_system
from mbs.output.plot import modes_figure
from mbs.output.results import modes_dataset
from mbs.statics import equilibrium

_LEAST_SHARE = 0.05


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Find the modes."""
    model = load_model(arguments)
    balance = equilibrium(steady_system(model.system), model.operation)
    found = modes(balance)
    figure = modes_figure(model, found) if arguments.plot else None
    outside = outside_at(model, balance)
    lines = [
        *heading(model, model.scene.speed),
        *_table(found),
        *film_warnings(film_limits(model, balance.displacement, balance.operation), found.frequency),
        *outside,
        *write(arguments, model, modes_dataset(found, balance), figure),
    ]
    return "\n".join(lines), 1 if outside else 0


def _table(found: Modes) -> list[str]:
    """Lines of the modes: frequency, damping ratio, and the parts that have most of the strain energy."""
    lines = ["  mode   frequency/Hz   damping ratio   strain energy        (frequency: |eigenvalue|/(2 pi))"]
    for k in range(found.eigenvalues.size):
        order = np.argsort(-found.shares[:, k], kind="stable")
        shares = [
            f"{found.parts[i]} {100.0 * found.shares[i, k]:.3g} %" for i in order if found.shares[i, k] >= _LEAST_SHARE
        ]
        lines.append(
            f"  {k + 1:4d} {found.frequency[k]:14.6g} {found.damping_ratio[k]:15.4g}   {', '.join(shares) or 'none'}"
        )
    return lines
