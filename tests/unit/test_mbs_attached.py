"""Rigid parts on the frames of a flexible body."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.jobs.table import Table
from mbs.flexible.plan import Attached, attach
from mbs.model.body import Inertia, rigid_body
from mbs.scene.flexible import read_attached

FREEDOMS = ("x", "y", "z", "theta_x", "theta_y", "theta_z")
PART = Inertia.cylinder(-0.01, 0.02, 0.09, 0.08)


def beam(parts=()):
    """A rigid body; to attach a part to its frame is to have it among its parts."""
    own = [Inertia(2.0, 1e-3, 2e-3)]
    return rigid_body("beam", [*own, *parts], FREEDOMS, (0.0, 0.0, 0.0), {"end": (0.3, 0.0, 0.0)})


def test_a_part_on_a_frame_is_a_part_of_the_body():
    found = attach(beam(), [Attached("end", PART)])
    moved = Inertia(PART.mass, PART.polar, PART.transverse, 0.3 + PART.offset)
    wanted = beam([moved])
    # sums of a few terms
    np.testing.assert_allclose(found.mass, wanted.mass, rtol=1e-13, atol=1e-15)
    np.testing.assert_allclose(found.gyroscopic, wanted.gyroscopic, rtol=1e-13, atol=1e-15)
    assert np.all(found.stiffness == 0.0)


def test_a_frame_that_is_not_there_is_named():
    with pytest.raises(InputError, match=r"got the frame 'ned'; allowed: centre, end"):
        attach(beam(), [Attached("ned", PART)])


def read(given):
    problems = []
    values = {} if given is None else {"attached": given}
    return read_attached(Table(values, "[[flexible]] beam", problems)), problems


def test_reading():
    assert read(None) == ((), [])
    table = {"at": "end", "from": "-10 mm", "to": "20 mm", "diameter": "90 mm", "bore": "80 mm"}
    parts, problems = read([table, table])
    assert problems == []
    found = attach(beam(), parts)
    np.testing.assert_allclose(found.mass[0, 0], 2.0 + 2.0 * PART.mass, rtol=1e-13)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("end", "allowed: a list of tables with at, from, to, diameter"),
        ([{"from": "0 mm", "to": "1 mm", "diameter": "9 mm"}], "attached[0] at: missing; allowed: the name of a frame"),
        ([{"at": 3, "from": "0 mm", "to": "1 mm", "diameter": "9 mm"}], "at: got 3; allowed: the name of a frame"),
        ([{"at": "end", "from": "2 mm", "to": "1 mm", "diameter": "9 mm"}], "allowed: from < to"),
        ([{"at": "end", "from": "0 mm", "to": "1 mm", "diameter": "9 mm", "weight": 1}], "weight: unknown key"),
    ],
)
def test_bad_input_is_noted(given, message):
    found, problems = read(given)
    assert found is None
    assert any(message in problem for problem in problems), problems
