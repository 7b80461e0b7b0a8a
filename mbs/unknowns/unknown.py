"""An unknown of a machine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ehdmaps.errors import InputError

if TYPE_CHECKING:
    from mbs.scene.scene import Scene


@dataclass(frozen=True, eq=False)
class Unknown:
    """Unknown of a machine: how far it may be off, why, and the machines at its ends.

    Attributes
    ----------
    name : str
        What is not known, such as "clearance of drive".
    group : str
        Key of [tolerances] that states it, see `ehdmaps.units.TOLERATED`.
    held : str
        How far it may be off, such as "5 to 50 um" or "+-5 K".
    why : str
        Why it is open, with the source of its spread.
    looks : tuple of Scene
        The machine at the ends of the spread, or its further members; the scene itself is its middle, or one of the
        members. Of one that is `reflected` a single one. Empty for what is held at its value, and only said.
    reflected : bool
        Whether the difference of the single look stands, with the other sign, for the other end, too.
    frozen_cage : bool
        Whether the looks are of one cage angle each, that of their bearings, and not of the mean over a pitch.
    beside : bool
        Whether it is an alternative that no band holds: what it changes is a line of its own.
    """

    name: str
    group: str
    held: str
    why: str
    looks: tuple[Scene, ...] = ()
    reflected: bool = False
    frozen_cage: bool = False
    beside: bool = False

    @property
    def is_member(self) -> bool:
        """True where the machine is one of two, such as with one profile or another, and no spread around a middle."""
        return len(self.looks) == 1 and not self.reflected and not self.frozen_cage

    @property
    def text(self) -> str:
        """The unknown in a line."""
        return f"{self.name} {self.held} ({self.why})"


def looks_of(makers: Sequence[Callable[[], Scene]]) -> tuple[tuple[Scene, ...], bool]:
    """Scenes at the ends of a spread, and whether a single one is left, which is reflected.

    Parameters
    ----------
    makers : sequence of callable
        Each makes a scene; one that no machine can be raises an `InputError` and is left out.
    """
    looks = []
    for make in makers:
        try:
            looks.append(make())
        except InputError:
            continue
    return tuple(looks), len(looks) == 1
