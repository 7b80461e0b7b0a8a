"""The kinds of elements that runs in time have in C.

An element whose class is not here, or which its kind does not take, is called from Python at every step; the run says
so. A new kind is a row here, and a `mbs.model.blocks.Kind` in the folder of its element, with functions in C.

A kind from elsewhere brings functions of its own: addresses of compiled ones, from C or by the user's `numba.cfunc`, of
the types in `ehdmaps/kernel/c/run/block.h`; or Python functions, which are called in every iteration of a step and hold
Python's lock, but leave the rest of the step to C.
"""

from __future__ import annotations

from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_block import BALLS
from mbs.bearings.bearing_block import BEARINGS, ROLLERS
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.memory_block import MEMORY_BEARINGS, MEMORY_ROLLERS
from mbs.bearings.roller_element import RollerElement
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.bearings.tapered.tapered_block import TAPERED
from mbs.gears.gear import GearMesh
from mbs.gears.gear_block import GEAR_MESHES
from mbs.model.blocks import Kind
from mbs.model.elements import Element
from mbs.model.matrices import MatrixElement
from mbs.model.matrix_block import MATRICES

KINDS: dict[type, Kind] = {
    BearingElement: BEARINGS,
    RollerElement: ROLLERS,
    BallForce: BALLS,
    TaperedForce: TAPERED,
    GearMesh: GEAR_MESHES,
    MatrixElement: MATRICES,
}
"""Kind by the class of its elements, or by what they name as their `kind`: a `LocatingElement` the class of its force.

``KINDS[Coupling] = COUPLINGS`` adds one.
"""


WITH_MEMORY: dict[type, Kind] = {BearingElement: MEMORY_BEARINGS, RollerElement: MEMORY_ROLLERS}
"""The same where films relax, of bearings whose blocks do not have both."""


def kind_of(element: Element) -> Kind | None:
    """Kind of an element in compiled code; None if it has none. A class that inherits from a known one is another."""
    of = getattr(element, "kind", type(element))
    kind = (WITH_MEMORY if getattr(element, "relaxes", False) and of in WITH_MEMORY else KINDS).get(of)
    return kind if kind is not None and kind.takes(element) else None
