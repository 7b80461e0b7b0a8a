"""Elements whose stiffness varies with the angle, such as gear meshes, and their mean for linear analyses."""

from __future__ import annotations

import copy
from typing import Protocol, runtime_checkable

from mbs.model.elements import Element
from mbs.model.system import Connected, System


@runtime_checkable
class Varying(Protocol):
    """An element whose stiffness varies with the angle."""

    def steady(self) -> Element:
        """The same element, on the same ports, with its mean stiffness."""
        ...


def steady_system(system: System) -> System:
    """The system with the mean stiffness of elements whose stiffness varies with the angle; else the same system."""
    if not any(isinstance(connected.element, Varying) for connected in system.elements):
        return system
    steady = copy.copy(system)
    steady.elements = tuple(
        Connected(connected.element.steady(), connected.transform)
        if isinstance(connected.element, Varying)
        else connected
        for connected in system.elements
    )
    return steady
