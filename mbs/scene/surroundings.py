"""Surroundings that a machine element of a scene is built into, and what it becomes there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from mbs.model.body import Body
from mbs.model.elements import Element
from mbs.model.system import Places

if TYPE_CHECKING:
    from mbs.scene.contact_laws import ContactLaws


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Surroundings that an element is built into.

    Attributes
    ----------
    places : Places
        Places on the bodies of the scene.
    laws : ContactLaws
        Contact laws in force.
    temperature : float
        Temperature of the raceways [K].
    """

    places: Places
    laws: ContactLaws
    temperature: float


@dataclass(frozen=True, eq=False)
class Built:
    """Machine element as it is in a system.

    Attributes
    ----------
    element : Element
        What makes the force.
    shown : Element
        What results show of it; a bearing is shown with massless rollers.
    bodies : tuple of Body
        Bodies that it brings, such as rollers.
    """

    element: Element
    shown: Element
    bodies: tuple[Body, ...] = ()
