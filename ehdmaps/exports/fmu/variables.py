"""Variables of the unit, in the order of `variables.h`, and what it says of itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Causality = Literal["independent", "input", "parameter", "output", "local"]


@dataclass(frozen=True)
class Variable:
    """A variable of the unit; its value reference is its place in the list.

    Attributes
    ----------
    name : str
        Name, with its parts by points.
    causality : {"independent", "input", "parameter", "output", "local"}
        What it is.
    unit : str
        Unit of `UNITS`.
    words : str
        Description for people.
    """

    name: str
    causality: Causality
    unit: str
    words: str


_RING = "of the inner ring in the frame of the outer one"

VARIABLES = (
    Variable("time", "independent", "s", "Time"),
    Variable("pose.y", "input", "m", f"Displacement {_RING}, radial"),
    Variable("pose.z", "input", "m", f"Displacement {_RING}, radial"),
    Variable("pose.theta_y", "input", "rad", f"Tilt {_RING} about y"),
    Variable("pose.theta_z", "input", "rad", f"Tilt {_RING} about z"),
    Variable("velocity.y", "input", "m/s", "Rate of pose.y"),
    Variable("velocity.z", "input", "m/s", "Rate of pose.z"),
    Variable("velocity.theta_y", "input", "rad/s", "Rate of pose.theta_y"),
    Variable("velocity.theta_z", "input", "rad/s", "Rate of pose.theta_z"),
    Variable("spin.inner", "input", "rad", "Spin of the inner ring about x, through full turns"),
    Variable("spin.outer", "input", "rad", "Spin of the outer ring about x, through full turns"),
    Variable("speed.inner", "input", "rad/s", "Rate of spin.inner"),
    Variable("speed.outer", "input", "rad/s", "Rate of spin.outer"),
    Variable("temperature", "input", "K", "Temperature of oil and raceways"),
    Variable("clearance", "parameter", "m", "Diametral clearance in force, negative for a preloaded bearing"),
    Variable("force.y", "output", "N", "Force on the inner ring; the outer one gets the opposite"),
    Variable("force.z", "output", "N", "Force on the inner ring; the outer one gets the opposite"),
    Variable("moment.y", "output", "N.m", "Moment on the inner ring about y, about its centre"),
    Variable("moment.z", "output", "N.m", "Moment on the inner ring about z, about its centre"),
)

UNITS: dict[str, dict[str, int]] = {
    "1": {},
    "s": {"s": 1},
    "m": {"m": 1},
    "rad": {"rad": 1},
    "m/s": {"m": 1, "s": -1},
    "rad/s": {"rad": 1, "s": -1},
    "K": {"K": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
}
"""Units with their exponents of the base units."""

LAG = (
    "Model Exchange is to be preferred. In Co-Simulation the master holds the force over a step h, so that it lags by "
    "half a step in the mean: of a motion at the frequency f it is wrong by pi f h, 10 percent at 320 Hz and 100 us, "
    "and the damping loses h/2 times the stiffness, so that long steps excite. Take steps that are short beside the "
    "damping over the stiffness, or let the master extrapolate the force."
)
"""The warning about Co-Simulation."""

MOTION = (
    "x is the axis of the bearing; the frame is that of the outer ring and does not spin. There is no force along x "
    "and no moment about it: what holds a ring axially is another element.",
    "pose, velocity and force are those of the inner ring, right-handed. The derivatives of the outputs by the pose "
    "are -K, by the velocity -C, exactly; those by the others are quotients of differences.",
    "The rollers stand where the spins bring them, without slip; the first one stands on the y axis at spins of zero.",
)
"""Axes, signs and what is left out, for people."""

DEVIATING = (
    "Waves, spalls and sizes of rolling elements add to the approaches of the contacts, by the spins and speeds of the "
    "rings and with elements that roll without slip."
)
"""What units of bearings with deviations from the form say."""

SLOW = "Films follow the motion at once: there are no states."
"""What units without memory say."""

MEMORY = (
    "Films need time to follow: each slice of each roller has a state film.xi, the approach at which its film would be "
    "in equilibrium. Velocities have no part in the force. The states begin in equilibrium. Model Exchange wants a "
    "solver for stiff equations, with an absolute tolerance of some 1e-11 m for them. In Co-Simulation the inputs that "
    "are set before a step are those of its end: the ring moves there from the inputs of the last step (of the "
    "initialization at first), along a cubic by the velocities, or straight where they are not given, and the unit "
    "takes steps of up to 5 us of its own. The derivatives by pose are those with the states held fixed."
)
"""What units with memory say."""

NOMINAL_STATE = 1e-7
"""Size of what films follow [m], as in `variables.h`."""


def film_names(rollers: int, slices: int) -> tuple[str, ...]:
    """Names of the states of films, roller by roller.

    Parameters
    ----------
    rollers, slices : int
        Numbers of rollers and of slices of each.
    """
    return tuple(f"film.xi[{j + 1},{i + 1}]" for j in range(rollers) for i in range(slices))
