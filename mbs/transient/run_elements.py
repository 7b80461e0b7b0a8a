"""The elements of a run as blocks for `mbs.transient.compiled_run`, one of each kind."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import scipy.linalg

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from mbs.model.blocks import Block, Kind, Member, StatefulBlock
from mbs.model.system import Connected
from mbs.transient.block_functions import BlockFunctions
from mbs.transient.kinds import KINDS, WITH_MEMORY, kind_of


def in_python(connected: Sequence[Connected]) -> list[str]:
    """Names of the elements that no kind takes, each with its class: they are called from Python."""
    return [
        f"{entry.element.name} ({type(entry.element).__name__})"
        for entry in connected
        if kind_of(entry.element) is None
    ]


def _placed(entry: Connected) -> Connected:
    """An element as it stands between its bodies."""
    kind = kind_of(entry.element)
    if kind is None or kind.placed is None:
        return entry
    return dataclasses.replace(entry, element=kind.placed(entry.element, entry.transform))


@dataclass(frozen=True, eq=False)
class RunElements:
    """All elements of a run.

    Attributes
    ----------
    blocks : tuple of Block
        Blocks of the kinds that are needed.
    functions : tuple of BlockFunctions
        The functions of each.
    expand : array, shape (felt, ports)
        What elements feel of their ports, and, on the other side, forces in the ports by those that the elements make.
    alone : int
        How many rows at the beginning of `expand` are of coordinates that nothing else touches.
    outside : array of int, shape (elements,)
        How often each was evaluated outside its map so far.
    owners : array of int, shape (felt,)
        Place of the element of each row of `expand`.
    told : array of bool, shape (elements,)
        Whether compiled code has the powers of each element.
    raised : list of BaseException
        What Python functions of blocks raised.
    stateful : tuple of (StatefulBlock, tuple of int)
        Blocks of elements with states of their own, each with the places of its members among all elements.
    """

    blocks: tuple[Block, ...]
    functions: tuple[BlockFunctions, ...]
    expand: FloatArray
    alone: int
    outside: IntArray
    owners: IntArray
    told: BoolArray
    raised: list[BaseException]
    stateful: tuple[tuple[StatefulBlock, tuple[int, ...]], ...]

    @classmethod
    def of(cls, connected: Sequence[Connected]) -> RunElements:
        """Elements that all have a kind, each as it stands between its bodies.

        Parameters
        ----------
        connected : sequence of Connected
            The elements.
        """
        connected = [_placed(entry) for entry in connected]
        members: dict[Kind, list[Member]] = {kind: [] for kind in (*KINDS.values(), *WITH_MEMORY.values())}
        of_connected = [kind_of(entry.element) for entry in connected]
        alone, felt = [], []
        for kind, entry in zip(of_connected, connected, strict=True):
            assert kind is not None
            none = np.zeros((0, entry.transform.shape[0]))
            alone.append(none if kind.alone is None else kind.alone(entry.element))
            felt.append(kind.feels(entry.element))
        among = sum(rows.shape[0] for rows in (*alone, *felt))
        own, first = 0, sum(rows.shape[0] for rows in alone)
        count = first
        for place, (kind, entry) in enumerate(zip(of_connected, connected, strict=True)):
            assert kind is not None
            members[kind].append(Member(entry.element, place, first, own, among))
            own, first = own + alone[place].shape[0], first + felt[place].shape[0]
        owners = [place for rows in (alone, felt) for place, part in enumerate(rows) for _ in range(part.shape[0])]
        used = [kind for kind, of_kind in members.items() if of_kind]
        raised: list[BaseException] = []
        parts = [scipy.linalg.block_diag(*rows) if rows else np.zeros((0, 0)) for rows in (alone, felt)]
        blocks = tuple(kind.gather(members[kind]) for kind in used)
        return cls(
            blocks=blocks,
            functions=tuple(BlockFunctions(kind, len(connected), raised) for kind in used),
            expand=np.asarray(np.concatenate(parts), dtype=np.float64),
            alone=count,
            outside=np.zeros(len(connected), dtype=np.int64),
            owners=np.array(owners, dtype=np.int64),
            told=np.array([kind is not None and kind.powers is not None for kind in of_connected], dtype=np.bool_),
            raised=raised,
            stateful=tuple(
                (cast(StatefulBlock, block), tuple(member.place for member in members[kind]))
                for kind, block in zip(used, blocks, strict=True)
                if kind.accept is not None
            ),
        )

    def begin(self, speeds: FloatArray) -> None:
        """Tell all blocks the speeds [rad/s] at the ends of the steps to come."""
        for block in self.blocks:
            block.begin(speeds)

    def prepare(self, first: int, last: int) -> tuple[tuple[Any, ...], BoolArray]:
        """Data of all blocks, and which of the steps from `first` on compiled code has, as far as all are prepared.

        Parameters
        ----------
        first, last : int
            Steps of those that `begin` was told.
        """
        parts = [block.prepare(first, last) for block in self.blocks]
        count = min((marks.size for _, marks in parts), default=last - first)
        sound = np.ones(count, dtype=np.bool_)
        for _, marks in parts:
            sound &= marks[:count]
        return tuple(data for data, _ in parts), sound

    def states(self, given: Sequence[Any]) -> list[Any]:
        """States of all elements as Python has them: those given, but for elements whose states are in compiled code.

        Parameters
        ----------
        given : sequence
            One for each element.
        """
        all_states = list(given)
        for block, places in self.stateful:
            for place, states in zip(places, block.states(), strict=True):
                all_states[place] = states
        return all_states

    def resume(self, states: Sequence[Any]) -> None:
        """Go on from states of all elements that Python has.

        Parameters
        ----------
        states : sequence
            One for each element.
        """
        for block, places in self.stateful:
            block.resume([states[place] for place in places])
