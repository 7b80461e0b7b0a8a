"""Force of a gear mesh along its line of action, in compiled code, without allocation.

Each flank feels one compression and its rate. k and c act while it is compressed, by the rule of
`ehdmaps.physics.contact` that knows no tension.

Within `TOUCH` of first contact the stiffness rises from zero in a straight line and the damping by 3 s^2 - 2 s^3, so
that the force is C1 in compression and rate, at any rate. A compressed flank is thereby offset by TOUCH/2, which is
far below the roughness of a ground flank.
"""

from __future__ import annotations

import math

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.physics.contact import Force, unilateral_force

_unilateral_force = njit(error_model="numpy")(unilateral_force)

TOUCH = 1e-7
"""Compression over which contact becomes whole [m]."""

STIFFNESS, DAMPING, BACKLASH, TEETH, PHASE = range(5)
"""Places in the array `constants` of a mesh: mean stiffness [N/m], damping [N s/m], backlash [m], mesh phase for each
angle of the system, and its beginning [rad]."""

BY_STIFFNESS, STIFFNESS_PHASE, BY_ERROR, ERROR_PHASE = range(4)
"""Rows of the array `series` of a mesh: amplitudes and phases of the harmonics of stiffness and transmission error."""

FORCE, SLOPE, BY_RATE = range(3)
"""Columns of what a flank returns."""


@njit(error_model="numpy")
def flank_force(compression: float, rate: float, stiffness: float, damping: float) -> Force:
    """Force of a flank, and its derivatives by compression and by rate.

    Parameters
    ----------
    compression : float
        Compression of the mesh spring [m]; no force below 0.
    rate : float
        Rate of the compression [m/s].
    stiffness : float
        [N/m].
    damping : float
        [N s/m].
    """
    if compression <= 0.0:
        return 0.0, 0.0, 0.0
    if compression < TOUCH:
        s = compression / TOUCH
        w, k = 0.5 * stiffness * compression * s, stiffness * s
        c, bend = damping * s * s * (3.0 - 2.0 * s), 6.0 * damping * s * (1.0 - s) / TOUCH
    else:
        w, k = stiffness * (compression - 0.5 * TOUCH), stiffness
        c, bend = damping, 0.0
    force: Force = _unilateral_force(w, k, c, bend, rate)
    return force


@njit(error_model="numpy")
def mesh_course(constants: FloatArray, series: FloatArray, angle: float, speed: float) -> tuple[float, float, float]:
    """Stiffness [N/m], transmission error [m] and its rate [m/s] at an angle and speed of the system.

    Parameters
    ----------
    constants : ndarray
        Constants of the mesh, see `GearMesh.arrays`.
    series : ndarray
        Fourier series of stiffness and error, see there.
    angle : float
        Angle of the system [rad].
    speed : float
        Speed of the system [rad/s].
    """
    phase = constants[TEETH] * angle + constants[PHASE]
    pace = constants[TEETH] * speed
    part, error, error_rate = 1.0, 0.0, 0.0
    for j in range(series.shape[1]):
        order = j + 1.0
        part += series[BY_STIFFNESS, j] * math.cos(order * phase + series[STIFFNESS_PHASE, j])
        place = order * phase + series[ERROR_PHASE, j]
        error += series[BY_ERROR, j] * math.cos(place)
        error_rate -= series[BY_ERROR, j] * order * pace * math.sin(place)
    return constants[STIFFNESS] * part, error, error_rate


@njit(error_model="numpy")
def mesh_force(
    constants: FloatArray,
    series: FloatArray,
    angle: float,
    speed: float,
    motion: FloatArray,
    rate: FloatArray,
    out: FloatArray,
) -> None:
    """Force of both flanks.

    Parameters
    ----------
    constants, series : array (5,), (4, harmonics)
        Constants and series of the mesh; see the names of the places above.
    angle, speed : float
        Angle and speed of the system [rad], [rad/s].
    motion, rate : array (2,)
        Compression of the driving and of the other flank without error and backlash [m], and its rate [m/s].
    out : array (2, 3)
        Force, derivative by compression, derivative by rate, for each flank: [N], [N/m], [N s/m].
    """
    stiffness, error, error_rate = mesh_course(constants, series, angle, speed)
    damping, backlash = constants[DAMPING], constants[BACKLASH]
    for flank in range(2):
        side = 1.0 if flank == 0 else -1.0
        gap = error if flank == 0 else backlash - error
        force, slope, by_rate = flank_force(motion[flank] - gap, rate[flank] - side * error_rate, stiffness, damping)
        out[flank, FORCE], out[flank, SLOPE], out[flank, BY_RATE] = force, slope, by_rate


@njit(error_model="numpy")
def flank_energy(compression: float) -> float:
    """Energy of a flank at rest for each stiffness [m2]: the integral of its load over the compression [m]."""
    if compression <= 0.0:
        return 0.0
    if compression < TOUCH:
        return compression * compression * compression / (6.0 * TOUCH)
    middle = compression - 0.5 * TOUCH
    return TOUCH * TOUCH / 6.0 + 0.5 * (middle * middle - 0.25 * TOUCH * TOUCH)


@njit(error_model="numpy")
def mesh_powers(
    constants: FloatArray, series: FloatArray, angle: float, speed: float, motion: FloatArray, rate: FloatArray
) -> tuple[float, float]:
    """Power that both flanks dissipate, and that stiffness and transmission error bring in as they turn [W].

    With the compression p, its rate and the energy k(t) G(p) the force F does -F dp/dt - F de/dt on the gears, and
    stores F_rest dp/dt + G dk/dt: dissipated is (F - F_rest) dp/dt, brought in G dk/dt - F de/dt.

    Parameters
    ----------
    constants, series, angle, speed, motion, rate
        What `mesh_force` takes.
    """
    stiffness, error, error_rate = mesh_course(constants, series, angle, speed)
    phase, pace, change = constants[TEETH] * angle + constants[PHASE], constants[TEETH] * speed, 0.0
    for j in range(series.shape[1]):
        order = j + 1.0
        change -= order * pace * series[BY_STIFFNESS, j] * math.sin(order * phase + series[STIFFNESS_PHASE, j])
    change *= constants[STIFFNESS]
    damping, backlash = constants[DAMPING], constants[BACKLASH]
    dissipated = driven = 0.0
    for flank in range(2):
        side = 1.0 if flank == 0 else -1.0
        compression = motion[flank] - (error if flank == 0 else backlash - error)
        moving = rate[flank] - side * error_rate
        force = flank_force(compression, moving, stiffness, damping)[0]
        rest = flank_force(compression, 0.0, stiffness, damping)[0]
        dissipated += (force - rest) * moving
        driven += change * flank_energy(compression) - force * side * error_rate
    return dissipated, driven


@njit(error_model="numpy")
def mesh_energy(constants: FloatArray, series: FloatArray, angle: float, motion: FloatArray) -> float:
    """Energy that both flanks store [J].

    Parameters
    ----------
    constants, series, angle, motion
        What `mesh_force` takes.
    """
    stiffness, error, _ = mesh_course(constants, series, angle, 0.0)
    stored: float = stiffness * (
        flank_energy(motion[0] - error) + flank_energy(motion[1] - (constants[BACKLASH] - error))
    )
    return stored
