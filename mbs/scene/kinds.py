"""The machine elements that a scene may have: one row each, from its table in the file to its element in the system.

Whoever adds an element adds a row here. Reading a scene calls `read`; putting the system together calls `places`,
`problems` and `build`, which load what they need by themselves, so that reading stays quick.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from ehdmaps.jobs.table import Table
from mbs.gears.pair import GearPair
from mbs.scene import bearings, gears
from mbs.scene.matrices import MatrixSpec, build_matrices, matrix_problems, read_spring
from mbs.scene.specs import BallSpec, BearingSpec, TaperedSpec
from mbs.scene.surroundings import Built, Surroundings


@dataclass(frozen=True)
class ElementKind:
    """One kind of machine element.

    Attributes
    ----------
    key : str
        Key of its tables in a scene file, which begin with [[key]]; empty of a kind that is read under other keys.
    word : str
        How messages call one of them.
    spec : type
        Class of what a scene holds of it: a frozen value with a `name`.
    read : callable
        (table, name) -> spec, or None where a problem was noted in the table; whoever calls closes the table.
    places : callable
        spec -> places that must exist.
    problems : callable
        (spec, surroundings) -> what is wrong about it, in words; its places need not exist.
    build : callable
        (spec, surroundings) -> `Built`; called where there are no problems. It may raise an InputError.
    """

    key: str
    word: str
    spec: type
    read: Callable[[Table, str], Any]
    places: Callable[[Any], tuple[str, ...]]
    problems: Callable[[Any, Surroundings], list[str]]
    build: Callable[[Any, Surroundings], Built]


def _later(module: str, name: str) -> Callable[[Any, Surroundings], Any]:
    """A function whose module is loaded when a scene has such an element."""

    def called(spec: Any, surroundings: Surroundings) -> Any:
        return getattr(import_module(module), name)(spec, surroundings)

    return called


KINDS = (
    ElementKind(
        key="bearings",
        word="bearing",
        spec=BearingSpec,
        read=bearings.read_bearing,
        places=lambda spec: (spec.inner, spec.outer),
        problems=bearings.bearing_problems,
        build=bearings.build_bearing,
    ),
    ElementKind(
        key="gears",
        word="gear pair",
        spec=GearPair,
        read=gears.read_gears,
        places=lambda spec: (spec.on, spec.against),
        problems=gears.gear_problems,
        build=gears.build_gears,
    ),
    ElementKind(
        key="",
        word="spring or bearing by matrices",
        spec=MatrixSpec,
        read=read_spring,
        places=lambda spec: (spec.on, spec.against),
        problems=matrix_problems,
        build=build_matrices,
    ),
    *(
        ElementKind(
            key="",
            word=word,
            spec=spec,
            read=bearings.read_bearing,
            places=lambda spec: (spec.inner, spec.outer),
            problems=_later("mbs.scene.locating.element", "located_problems"),
            build=_later("mbs.scene.locating.element", "build_located"),
        )
        for word, spec in (("ball bearing", BallSpec), ("tapered roller bearing", TaperedSpec))
    ),
)
"""All kinds, in the order of the elements of a system."""


def kind_of(spec: object) -> ElementKind | None:
    """The kind to which a spec belongs; None if no kind has its class."""
    return next((kind for kind in KINDS if type(spec) is kind.spec), None)
