"""Poles that are modes: those that come back from order to order, with the same frequency, damping and shape.

A fit of high order has poles for the noise as well; they wander when the order changes. Poles are followed over the
orders in chains; a chain that is long enough is a mode, its pole the median of the chain.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import InputError
from mbs.modal.residues import assurance

_GAP = 2
"""Orders in which a pole may be missing without ending its chain."""


@dataclass(frozen=True)
class Criteria:
    """Criteria by which a pole is stable.

    Attributes
    ----------
    frequency : float
        Largest relative change of |pole| from order to order.
    damping : float
        Largest relative change of the decay.
    assurance : float
        Smallest modal assurance criterion between the residues of both orders; says nothing for a single response.
    most_damped : float
        Largest damping ratio: poles beyond it shape the background.
    orders : int
        Least number of poles in a chain, its first one included.

    Raises
    ------
    InputError
        With every value that is not possible.
    """

    frequency: float = 0.005
    damping: float = 0.1
    assurance: float = 0.9
    most_damped: float = 0.3
    orders: int = 6

    def __post_init__(self) -> None:
        problems = [
            f"stabilisation, {name}: got {value!r}; allowed: above 0, up to 1"
            for name, value in (
                ("frequency", self.frequency),
                ("damping", self.damping),
                ("most_damped", self.most_damped),
            )
            if not 0.0 < value <= 1.0
        ]
        if not 0.0 <= self.assurance <= 1.0:
            problems.append(f"stabilisation, assurance: got {self.assurance!r}; allowed: 0 to 1")
        if self.orders < 1:
            problems.append(f"stabilisation, orders: got {self.orders!r}; allowed: 1 or more")
        if problems:
            raise InputError(problems)


@dataclass(frozen=True)
class Candidate:
    """A pole of the stabilisation diagram.

    Attributes
    ----------
    order : int
        Pole pairs of the fit.
    pole : complex
        Pole as found, with what an exponential window added [1/s].
    stable : bool
        Whether it continues one of the orders before.
    """

    order: int
    pole: complex
    stable: bool


@dataclass(frozen=True, eq=False)
class Stabilisation:
    """Modes, and the diagram that they were taken from.

    Attributes
    ----------
    poles : array of complex, shape (modes,)
        Medians of the chains, rising in frequency [1/s].
    scatter : array, shape (modes, 2)
        Standard deviations of real and imaginary part over the orders [1/s].
    counts : tuple of int
        Stable poles in the chain of each mode.
    candidates : tuple of Candidate
        All poles in the band.
    """

    poles: ComplexArray
    scatter: FloatArray
    counts: tuple[int, ...]
    candidates: tuple[Candidate, ...]


@dataclass(eq=False)
class _Chain:
    """A pole followed over the orders."""

    order: int
    shape: ComplexArray
    poles: list[complex] = field(default_factory=list)


def stabilise(
    poles: Sequence[ComplexArray],
    orders: Sequence[int],
    band: tuple[float, float],
    shapes: Callable[[ComplexArray], ComplexArray],
    criteria: Criteria | None = None,
) -> Stabilisation:
    """Follow poles over the orders.

    Parameters
    ----------
    poles : sequence of array of complex
        All poles of each order [1/s].
    orders : sequence of int
        Rising numbers of pole pairs.
    band : (float, float)
        Band in which a mode may be [Hz].
    shapes : callable
        Residues (poles, rows) of given poles.
    criteria : Criteria, optional
        What makes a pole stable.
    """
    criteria = criteria or Criteria()
    chains: list[_Chain] = []
    candidates: list[Candidate] = []
    for position, (order, of_order) in enumerate(zip(orders, poles, strict=True)):
        here = _physical(of_order, band, criteria)
        residues = shapes(here) if here.size else np.zeros((0, 1), dtype=np.complex128)
        stable = _extend(chains, position, here, residues, criteria)
        candidates += [Candidate(order, complex(p), bool(s)) for p, s in zip(here, stable, strict=True)]
    # A chain that ends early is what low orders make of several modes.
    lasting = [chain for chain in chains if chain.order >= len(orders) // 2]
    kept = _merged([chain for chain in lasting if len(chain.poles) >= criteria.orders])
    kept.sort(key=lambda values: abs(np.median(np.imag(values))))
    medians = [complex(np.median(np.real(values)), np.median(np.imag(values))) for values in kept]
    scatter = [(float(np.std(np.real(values))), float(np.std(np.imag(values)))) for values in kept]
    return Stabilisation(
        np.array(medians, dtype=np.complex128),
        np.array(scatter, dtype=np.float64).reshape(-1, 2),
        tuple(len(values) for values in kept),
        tuple(candidates),
    )


def _physical(poles: ComplexArray, band: tuple[float, float], criteria: Criteria) -> ComplexArray:
    """Poles that may be modes: oscillating, decaying, in the band."""
    frequency = np.abs(poles) / (2.0 * np.pi)
    kept = (poles.imag > 0.0) & (poles.real < 0.0) & (frequency >= band[0]) & (frequency <= band[1])
    kept &= -poles.real <= criteria.most_damped * np.abs(poles)
    chosen = poles[kept]
    return np.asarray(chosen[np.argsort(np.abs(chosen))], dtype=np.complex128)


def _extend(
    chains: list[_Chain], position: int, poles: ComplexArray, residues: ComplexArray, criteria: Criteria
) -> list[bool]:
    """Add the poles of an order to the chains they continue, nearest first; the others begin new ones."""
    open_chains = [chain for chain in chains if position - chain.order <= 1 + _GAP]
    near = sorted(
        (
            (abs(pole - chain.poles[-1]), i, k)
            for i, pole in enumerate(poles)
            for k, chain in enumerate(open_chains)
            if _continues(chain, complex(pole), residues[i], criteria)
        ),
        key=lambda entry: entry[0],
    )
    stable = [False] * poles.size
    taken: set[int] = set()
    for _, i, k in near:
        if not stable[i] and k not in taken:
            stable[i] = True
            taken.add(k)
            chain = open_chains[k]
            chain.poles.append(complex(poles[i]))
            chain.order, chain.shape = position, residues[i]
    chains += [_Chain(position, residues[i], [complex(poles[i])]) for i in range(poles.size) if not stable[i]]
    return stable


def _continues(chain: _Chain, pole: complex, shape: ComplexArray, criteria: Criteria) -> bool:
    """Tell whether a pole continues a chain."""
    last = chain.poles[-1]
    return (
        abs(abs(pole) - abs(last)) <= criteria.frequency * abs(last)
        and abs(pole.real - last.real) <= criteria.damping * abs(last.real)
        and assurance(chain.shape, shape) >= criteria.assurance
    )


def _merged(chains: list[_Chain]) -> list[list[complex]]:
    """Chains that are pieces of one, broken by an order or two, put together."""
    merged: list[list[complex]] = []
    spans: list[complex] = []
    for chain in sorted(chains, key=lambda entry: -len(entry.poles)):
        middle = complex(np.median(np.real(chain.poles)), np.median(np.imag(chain.poles)))
        for k, other in enumerate(spans):
            # Nearer than half their widths, two poles are one to any of these methods.
            if abs(middle - other) <= 0.5 * min(abs(middle.real), abs(other.real)):
                merged[k] += chain.poles
                break
        else:
            merged.append(list(chain.poles))
            spans.append(middle)
    return merged
