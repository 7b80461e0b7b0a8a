"""Parts that a kind of elements brings to runs in C: functions in C, and the data that they take.

A run in time puts all elements of a kind into one block. Its function writes what they answer to a motion; the block
itself, in Python, holds their data and prepares what changes with the speed. `mbs.transient.kinds` lists the kinds;
`mbs.gears.gear_block` is a short one to look at, and `ehdmaps/kernel/c/run/block.h` has the types of the functions.
This module knows nothing of compiled code.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from mbs.model.elements import Element

FOUND, NO_SOLUTION, IN_PYTHON, TOO_LARGE, STOPPED = range(5)
"""What the function of a block returns, as `block.h` has it: all is written; there is no answer to such a motion, so
that the step is halved; compiled code has none, and the step is made in Python. Of runs besides: the error of a step is
above the tolerance; a Python function raised."""

Function = str | int | Callable[..., Any] | None
"""A function of a kind: the name of one in the C library; its address, or an object that has it as `address`, such as
`numba.cfunc` makes, or a ctypes function; or a Python function, which costs some 10 us a call. None: there is none."""


class Moment(NamedTuple):
    """Moment at which elements are asked.

    Attributes
    ----------
    step : int
        Index among the steps that were prepared.
    time, speed, angle : float
        Time, speed and angle at the end of the step [s], [rad/s], [rad].
    by_q, by_v : float
        Slopes are by_q K + by_v C.
    """

    step: int
    time: float
    speed: float
    angle: float
    by_q: float
    by_v: float


class Answers(NamedTuple):
    """Answers of elements, each in its own places.

    Attributes
    ----------
    force : array (m,)
        Forces in what the elements feel [N or N m].
    slopes : array (m, m)
        by_q K + by_v C, on the blocks of the diagonal.
    outside : array (elements,), of int
        Counted up for an element outside its map.
    """

    force: FloatArray
    slopes: FloatArray
    outside: IntArray


class Member(NamedTuple):
    """An element of a block.

    Attributes
    ----------
    element : Element
        The element itself.
    place : int
        Place among all elements of the system: where `Answers.outside` counts.
    first : int
        First of what it feels.
    alone : int
        First of what it feels of coordinates that are its alone, see `Kind.alone`.
    among : int
        How much all elements feel together: the m of `Answers`, for functions that cannot look there.
    """

    element: Any
    place: int
    first: int
    alone: int = 0
    among: int = 0


class Block(Protocol):
    """All elements of one kind during a run."""

    def begin(self, speeds: FloatArray) -> None:
        """Take note of the speeds [rad/s] at the ends of the steps to come."""
        ...

    def prepare(self, first: int, last: int) -> tuple[Any, BoolArray]:
        """Prepare the steps from `first` on, as many as can be held, at most up to `last`.

        Returns
        -------
        data : ehdmaps.kernel.record.Record, ctypes.Structure, array, int or None
            What the functions of the kind take: C has the address of a struct or of the numbers of an array, or an
            address as an integer; a Python function has it as it is, whatever it is.
        sound : array of bool, shape (prepared steps,)
            Whether compiled code has an answer at the speed of each; the others are made in Python.
        """
        ...


class StatefulBlock(Block, Protocol):
    """All elements of a kind with states of their own, which follow a run from Python to compiled code and back."""

    def states(self) -> Sequence[Any]:
        """States of each member after the last step that was made, as its `Element.advance` has them."""
        ...

    def resume(self, states: Sequence[Any]) -> None:
        """Go on from states that `Element.advance` of each member gave: at the beginning, and after steps in Python."""
        ...


@dataclass(frozen=True, eq=False)
class SteadyBlock:
    """A block whose data hold at every speed.

    Attributes
    ----------
    arrays : Record or anything
        What the functions take, see `Block.prepare`.
    """

    arrays: Any

    def begin(self, speeds: FloatArray) -> None:
        """Nothing depends on them."""

    def prepare(self, first: int, last: int) -> tuple[Any, BoolArray]:
        """All steps at once."""
        return self.arrays, np.ones(last - first, dtype=np.bool_)


def _always(element: Any) -> bool:
    """Every element of the class."""
    return True


@dataclass(frozen=True, eq=False)
class Kind:
    """Way in which elements of one class run in compiled code.

    Attributes
    ----------
    answer : Function
        Function (data, Moment, motion, Answers) -> one of `FOUND`, `NO_SOLUTION`, `IN_PYTHON`. `motion` is an array
        (2, m): what the elements feel, and its rate. Slopes between what one element feels are written at every call;
        all other ones are zero and stay so.
    feels : callable
        Rows (felt, ports) of what an element feels of the displacements of its ports. What it does not feel makes no
        force; fewer rows are fewer unknowns.
    gather : callable
        Makes the block of some members; there may be none.
    takes : callable
        Whether compiled code has this element of the class.
    alone : callable or None
        Rows (felt, ports) of coordinates that the element feels and nothing else touches, such as its rollers. They
        come before what all elements feel of others, so that elimination, which begins with them, costs little.
    powers : Function
        Function (data, Moment, motion, Answers, out) that writes the numbers of `mbs.model.elements.Powers` of each of
        its elements into the row of `out` (elements, 3) that is its place; called when a step is made, after `accept`.
        None where the elements do not say.
    accept : Function
        Function (data, Moment) that is called when a step is made, for elements with states of their own; the last
        answer was then that of the step. Their block is a `StatefulBlock`.
    placed : callable or None
        Gives an element as it stands in a system, from the rows (ports, coordinates) by which its ports move: one that
        feels less, where the bodies cannot do all that it could feel. What is not felt costs nothing.
    """

    answer: Function
    feels: Callable[[Any], FloatArray]
    gather: Callable[[Sequence[Member]], Block]
    takes: Callable[[Element], bool] = _always
    alone: Callable[[Any], FloatArray] | None = None
    accept: Function = None
    powers: Function = None
    placed: Callable[[Any, FloatArray], Any] | None = None
