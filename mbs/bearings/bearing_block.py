"""Bearings in compiled runs with films of slow motion or dry: they read tables of their law over the speed.

Massless rollers are answered all at once, rollers that are bodies contact by contact. Their functions are in
`cylinder_block.c` of `ehdmaps.kernel`.
"""

from __future__ import annotations

from collections.abc import Sequence
from ctypes import addressof, c_int64, c_void_p
from typing import Any, ClassVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked, function
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.bearings import cylinder as table
from mbs.bearings.cylinder import CylinderLaw
from mbs.bearings.rings import (
    Rings,
    alike_contacts,
    alone,
    feels,
    gather_rings,
    placed,
    strict,
)
from mbs.bearings.speed_tables import NODES, Course, CourseBlock, CourseOfFilms, SpeedTables, course_of
from mbs.model.blocks import Kind, Member


class CourseLaw(Record):
    """Tables of a law at nodes over the speed, and the table in use, ``ehd_course_law``."""

    _fields_: ClassVar = [
        ("law", CylinderLaw),
        ("slots", c_int64),
        ("rows", c_int64),
        ("numbers", numbers),
        ("tables", numbers),
        ("in_use", numbers),
    ]


class Films:
    """Tables of some laws over the speed, as C takes them; dry laws have one for all speeds, and power laws none.

    Parameters
    ----------
    tables : sequence of SpeedTables
        What makes them.

    Attributes
    ----------
    laws : list of CourseLaw
        The laws.
    numbers, tables : array (films, nodes, NUMBERS), (films, nodes, rows, 8)
        Laws prepared at nodes over the speed, the last one of a faded film.
    in_use : array (films, 2)
        Node and weight of the tables in use.
    """

    def __init__(self, tables: Sequence[SpeedTables]) -> None:
        films, nodes = len(tables), NODES + 1 if any(one.varies for one in tables) else 1
        rows = 2 * table.ROWS if any(one.has_cells for one in tables) else 1
        self.tables, self.numbers = np.zeros((films, nodes, rows, 8)), np.zeros((films, nodes, table.NUMBERS))
        self.in_use = np.full((films, 2), -1.0)
        self.laws = [
            checked(CourseLaw, "ehd_course_law")(
                law=_in_use(rows),
                slots=NODES,
                rows=rows,
                numbers=self.numbers[film],
                tables=self.tables[film],
                in_use=self.in_use[film],
            )
            for film in range(films)
        ]
        for film, one in enumerate(tables):
            one.cells, one.numbers = self.tables[film], self.numbers[film]
        self.course = CourseOfFilms(tables)

    def blend(self, film: int, node: int, weight: float) -> tuple[FloatArray, FloatArray]:
        """Bring a table in use to a place between two nodes; its numbers (NUMBERS,) and cells (rows, 4, 2).

        Parameters
        ----------
        film, node : int
            Index of the film, and the lower node.
        weight : float
            Weight of the upper node, or the part of a faded film that is there, 0 to 1.
        """
        law = self.laws[film]
        function("ehd_course_law_blend", c_void_p, c_int64, numbers._type_, result=None)(law.address, node, weight)
        used = law.given("law")
        return used.given("numbers"), used.given("cells")


def _in_use(rows: int) -> CylinderLaw:
    """Room for a table in use."""
    law = CylinderLaw(numbers=np.zeros(table.NUMBERS))
    if rows > 1:
        law.put(cells=np.zeros((rows, 4, 2)), knots=np.zeros(rows))
    return law


class Bearings(Record):
    """Bearings without states as C takes them, ``ehd_cylinder_block``.

    Attributes
    ----------
    rings, course : Rings, Course
        Constants of the bearings; places of the steps on the tables.
    laws : address
        Array of `CourseLaw`.
    profiles : array (bearings, n)
        Profiles of one contact, or of both in series [m].
    strict : array (bearings,), of int
        Whether a law refuses loads above its map.
    states : array (bearings, sides, room)
        Slices of each bearing at rest at the last answer, as of `mbs.bearings.cylinder.Arrays`.
    place, row : array (n + 1,)
        Work space for the slices of a roller.
    """

    _fields_: ClassVar = [
        ("rings", Rings),
        ("course", Course),
        ("laws", c_void_p),
        ("profiles", numbers),
        ("strict", integers),
        ("states", numbers),
        ("room", c_int64),
        ("place", numbers),
        ("row", integers),
    ]


class BearingBlock(CourseBlock):
    """The bearings of a run; contacts with the same law at the same conditions share their tables.

    Parameters
    ----------
    members : sequence of Member
        Elements of the class `BearingElement`, or of the class `RollerElement`.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        films_of, alike = alike_contacts(members)
        films = Films([SpeedTables(one.bearing, one.law, one.temperature, one.rates) for one in alike])
        super().__init__(films.course, films.in_use)
        self._kept = films, (CourseLaw * len(alike))(*films.laws)
        rings = gather_rings(members, films_of)
        room, slices = 4 * rings.most, rings.most_slices
        # a roller that is a body has half of the profile in each of its contacts
        profiles = rings.given("profiles") * (1.0 if rings.sides == 1 else 0.5)
        self.data = checked(Bearings, "ehd_cylinder_block")(
            rings=rings,
            course=course_of(0, len(alike)),
            laws=addressof(self._kept[1]),
            profiles=profiles,
            strict=strict(members).astype(np.int64),
            states=np.zeros((*films_of.shape, room)),
            room=room,
            place=np.zeros(slices + 1),
            row=np.zeros(slices + 1, dtype=np.int64),
        )


def _takes(element: Any) -> bool:
    """Tell whether C has the force of a bearing."""
    return not element.bearing.coupled


BEARINGS = Kind(
    answer="ehd_cylinder_block_answer",
    feels=feels,
    gather=BearingBlock,
    takes=_takes,
    placed=placed,
    powers="ehd_cylinder_block_powers",
)
"""For `mbs.transient.kinds`."""


ROLLERS = Kind(
    answer="ehd_cylinder_block_answer",
    feels=feels,
    gather=BearingBlock,
    alone=alone,
    powers="ehd_cylinder_block_powers",
)
"""For `mbs.transient.kinds`: the same with rollers as bodies."""
