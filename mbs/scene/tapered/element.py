"""Bearings of tapered rollers, or of rollers between ribs, in a scene: their law, what is wrong, the element."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ehdmaps.errors import InputError
from ehdmaps.physics.rollers.ribbed_geometry import RibbedGeometry
from mbs.scene.specs import TaperedSpec

if TYPE_CHECKING:
    from mbs.scene.contact_laws import ContactLaws
    from mbs.scene.surroundings import Built, Surroundings

_FILMS = ("table", "map")
"""Laws with films, beside which tapered rollers stay dry."""


def tapered_problems(spec: TaperedSpec, surroundings: Surroundings) -> list[str]:
    """Problems with such a bearing: it has one body only, or no law of its own is in force.

    Parameters
    ----------
    spec : TaperedSpec
        The bearing.
    surroundings : Surroundings
        What it is built into.
    """
    from mbs.scene.contact_laws import HERTZ_FORMS, hertz_damper

    problems = []
    if spec.inner.partition(":")[0] == spec.outer.partition(":")[0]:
        problems.append(f"bearing {spec.name!r}: got {spec.inner} and {spec.outer}; allowed: rings on two bodies")
    laws = surroundings.laws
    try:
        if hertz_damper(laws.chosen) is not None:
            return problems
    except InputError:
        return problems  # said of the law itself
    others = laws.scene.bearings or laws.scene.balls
    if not (laws.chosen in _FILMS and others):
        problems.append(
            f"bearing {spec.name!r}: got the law {laws.chosen!r:.60} for a {_kind(spec)}; allowed: hertz, "
            f"{HERTZ_FORMS}; table and map beside other bearings, whose films they are"
        )
    return problems


def tapered_law_words(laws: ContactLaws) -> str:
    """Law of the bearings of tapered rollers, or of rollers between ribs, of a scene, for people.

    Parameters
    ----------
    laws : ContactLaws
        Laws in force, without problems.
    """
    from mbs.scene.contact_laws import hertz_damper

    kinds = " and ".join(dict.fromkeys(f"{_kind(spec)}s" for spec in laws.scene.tapered))
    if laws.chosen in _FILMS:
        return f"{kinds} dry and without damping: they have no films"
    damper = hertz_damper(laws.chosen)
    words = f", {damper.words} of each contact" if damper is not None and damper.words else ""
    return f"{kinds} dry Hertz{words}"


def _kind(spec: TaperedSpec) -> str:
    """Kind of a bearing, in words."""
    return "ribbed roller bearing" if isinstance(spec.geometry, RibbedGeometry) else "tapered roller bearing"


def build_tapered(spec: TaperedSpec, surroundings: Surroundings) -> Built:
    """The element of a bearing of tapered rollers, or of rollers between ribs.

    Parameters
    ----------
    spec : TaperedSpec
        The bearing; its places exist.
    surroundings : Surroundings
        What it is built into.
    """
    from mbs.bearings.tapered.tapered_bearing import TaperedElement, TaperedForce
    from mbs.scene.contact_laws import Damper, hertz_damper
    from mbs.scene.surroundings import Built

    chosen = surroundings.laws.chosen
    damper = (None if chosen in _FILMS else hertz_damper(chosen)) or Damper()
    element = TaperedElement(
        name=spec.name,
        inner=spec.inner,
        outer=spec.outer,
        force=TaperedForce(
            spec.geometry, damper.constant, damper.time, profile=spec.profile, slices=max(spec.slices, 2)
        ),
        inner_spin=surroundings.places.spin(spec.inner),
        outer_spin=surroundings.places.spin(spec.outer),
        start_angle=spec.start_angle,
        axial_offset=spec.axial_offset,
    )
    return Built(element, element)
