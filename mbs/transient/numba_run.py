"""Runs of systems in which some kind of elements has functions by numba and none in C yet: steps by `numba_kernel`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from mbs.model.blocks import Kind
from mbs.model.system import System
from mbs.transient.compiled_run import CompiledRun
from mbs.transient.kinds import is_numba, kind_of
from mbs.transient.numba_arrays import Course, Energies, Linear, Numbers, Records, State
from mbs.transient.numba_kernel import Native, advance
from mbs.transient.run_elements import RunElements


def compiled_run(system: System, *arguments: Any) -> CompiledRun:
    """Return the run of a system, by C where all its kinds have functions in C.

    Parameters
    ----------
    system, *arguments
        What `CompiledRun` takes.
    """
    kinds = [kind_of(entry.element) for entry in system.elements]
    numba = any(kind is not None and is_numba(kind) for kind in kinds)
    return (NumbaRun if numba else CompiledRun)(system, *arguments)


class NumbaRun(CompiledRun):
    """Steps of a system by `numba_kernel`."""

    def _elements_of(self, system: System) -> RunElements:
        """The elements, with the common kinds besides, so that compiled code is the same for most systems."""
        return RunElements.of(system.elements, _is_common)

    def _make(self, linear: Any, numbers: Any, data: Sequence[Any], course: Any) -> tuple[int, int, float]:
        """Make steps."""
        run, elements, at = self._run, self._elements, np.zeros(6)
        given = list(zip(elements.kinds, elements.functions, data, strict=True))
        rows = [functions.row(part) for kind, functions, part in given if not is_numba(kind)]
        addresses = [[row.answer, row.accept or 0, row.powers or 0, row.data or 0] for row in rows]
        blocks = np.array(addresses, dtype=np.int64).reshape(-1, 4)
        native = Native(blocks, at, at[:1].view(np.int64), np.zeros(4, dtype=np.int64))
        made, status, error = advance(
            Linear(*(_field(linear, name) for name in Linear._fields))._replace(turning=bool(linear.turning)),
            Numbers(*(getattr(numbers, name) for name in Numbers._fields)),
            (*(part for kind, _, part in given if is_numba(kind)), native),
            Course(*(_field(course, name) for name in Course._fields)),
            State(self._motion, self._forces),
            Records(
                run.given("seen"), run.given("orders"), self._outputs, self._sampled, self._motions, int(run.stride)
            ),
            Energies(*(run.given(name) for name in Energies._fields)),
            elements.outside,
            self._counter,
        )
        if elements.raised:
            raise elements.raised.pop(0)
        return made, status, error


def _is_common(kind: Kind) -> bool:
    """True for kinds that compiled code has even where there are none: neither states nor coordinates of their own."""
    return is_numba(kind) and kind.accept is None and kind.alone is None and not kind.rare


def _field(record: Any, name: str) -> Any:
    """An array or number of a record."""
    array = record.given(name)
    return getattr(record, name) if array is None else array
