"""A flexible body as a few coordinates: its matrices, its modal damping, and how the places on it move."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.linalg import eigh

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.units import quantity
from mbs.frozen import frozen
from mbs.model.body import Body, Frame, Skin


def modal_damping(mass: FloatArray, stiffness: FloatArray, ratio: float) -> FloatArray:
    """Damping matrix that gives every mode of M q'' + K q = 0 the same damping ratio.

    D = M Phi diag(2 zeta omega) Phi' M with the mass-normalised modes Phi. Rigid-body modes are not damped, so a free
    body moves without loss.

    Parameters
    ----------
    mass, stiffness : array, shape (n, n)
        Symmetric matrices; M positive definite, K positive semi-definite.
    ratio : float
        zeta, 0 <= zeta < 1.

    Returns
    -------
    array, shape (n, n)
        Symmetric, positive semi-definite.

    Raises
    ------
    InputError
        For another ratio, or where M is not positive definite.
    """
    if not (math.isfinite(ratio) and 0.0 <= ratio < 1.0):
        raise InputError(f"damping ratio: got {ratio!r}; allowed: 0 <= ratio < 1; steel structures have 0.001 to 0.02")
    if ratio == 0.0:
        return np.zeros_like(mass)
    try:
        squares, shapes = eigh(stiffness, mass)
    except (np.linalg.LinAlgError, ValueError) as error:
        raise InputError(
            f"modal damping: the modes cannot be computed ({error}); allowed: finite matrices, the mass positive "
            "definite"
        ) from error
    # The square of a rigid-body frequency is round-off of the highest one.
    noise = 1e3 * mass.shape[0] * np.finfo(np.float64).eps * abs(squares[-1])
    omega = np.sqrt(np.where(squares > noise, squares, 0.0))
    momentum = mass @ shapes
    damping = (momentum * (2.0 * ratio * omega)) @ momentum.T
    return np.asarray(0.5 * (damping + damping.T), dtype=np.float64)


UNITS = ("m", "rad", "1")
"""Of coordinates: displacements, rotations, and modal amplitudes."""

MOST_COORDINATES = 1000

_LARGEST_ENTRY, _LIGHTEST = 1e100, 1e-100
"""Largest entry of a matrix, and smallest mass of a coordinate, in their units; what is beyond is damage."""

_ROUNDING = 1e-8
"""Of the largest entry of a scaled matrix: what asymmetry or negative stiffness may be rounding of a file."""


@dataclass(frozen=True, eq=False)
class ReducedBody:
    """M q'' + K q = forces on the interfaces.

    Attributes
    ----------
    mass, stiffness : array, shape (n, n)
        Matrices in the units of the coordinates; symmetric, M positive definite, K positive semi-definite.
    coordinates : tuple of str
        Names, such as "left.y" and "mode 1".
    units : tuple of str
        "m", "rad" or "1".
    frames : mapping of str to Frame
        Places, from the origin of the finite-element body [m], and how they move. At an interface all six displacements
        are known; at a point that is a single node without rotations the three rotations are zero in the
        transform, so a moment has no effect there and a sensed rotation is zero.
    attributes : mapping of str to str
        Origin of the matrices.
    skin : Skin or None
        Surface of the finite-element body, with places from its origin, for pictures; None where it is not known.
    left_out : array, shape (n, n), or None
        What modes above the cut-off add, see `mbs.model.body.Body`; None where it is not known.

    Raises
    ------
    InputError
        With everything that does not fit together.
    """

    mass: FloatArray
    stiffness: FloatArray
    coordinates: tuple[str, ...]
    units: tuple[str, ...]
    frames: Mapping[str, Frame]
    attributes: Mapping[str, str] = field(default_factory=dict)
    skin: Skin | None = None
    left_out: FloatArray | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "coordinates", tuple(self.coordinates))
        object.__setattr__(self, "units", tuple(self.units))
        object.__setattr__(self, "frames", frozen(self.frames))
        object.__setattr__(self, "attributes", frozen(self.attributes))
        size = self.size
        problems = Problems()
        if not 1 <= size <= MOST_COORDINATES:
            problems.append(f"reduced body, coordinates: got {size}; allowed: 1 to {MOST_COORDINATES}")
        if len(set(self.coordinates)) < size:
            problems.append("reduced body, coordinates: a name is there twice; allowed: each once")
        if len(self.units) != size or not set(self.units) <= set(UNITS):
            problems.append(
                f"reduced body, units: got {self.units!r:.80}; allowed: one of {', '.join(UNITS)} for each of {size} "
                "coordinates"
            )
        for name in ("mass", "stiffness", *(("left_out",) if self.left_out is not None else ())):
            matrix = np.asarray(getattr(self, name), dtype=np.float64)
            object.__setattr__(self, name, matrix)
            if matrix.shape != (size, size):
                problems.append(f"reduced body, {name}: got shape {matrix.shape}; allowed: {(size, size)}")
            elif not np.all(np.isfinite(matrix)):
                problems.append(f"reduced body, {name}: got entries that are no finite numbers; allowed: finite ones")
            elif size and np.max(np.abs(matrix)) > _LARGEST_ENTRY:
                problems.append(
                    f"reduced body, {name}: got an entry of {np.max(np.abs(matrix)):.3g}; allowed: up to "
                    f"{_LARGEST_ENTRY:g} in the units of the coordinates; the file is damaged"
                )
        for name, frame in self.frames.items():
            shapes = (np.shape(frame.position), np.shape(frame.transform))
            if shapes != ((3,), (6, size)):
                problems.append(
                    f"reduced body, frame {name!r}: got shapes {shapes[0]} and {shapes[1]}; allowed: (3,) and "
                    f"{(6, size)}"
                )
            elif not (np.all(np.isfinite(frame.position)) and np.all(np.isfinite(frame.transform))):
                problems.append(
                    f"reduced body, frame {name!r}: got values that are no finite numbers; allowed: finite ones"
                )
        problems += [] if self.skin is None else _skin_problems(self.skin, size)
        problems += [] if problems else self._matrix_problems()
        problems.check()

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return len(self.coordinates)

    @property
    def cutoff(self) -> float:
        """Frequency above which modes are left out [Hz]: as stated, else that of the highest mode; 0 without any."""
        try:
            return quantity(self.attributes.get("cutoff", ""), "Hz")
        except InputError:
            return float(np.nanmax(mode_frequencies(self), initial=0.0))

    def _matrix_problems(self) -> list[str]:
        """List problems with matrices of the right shape."""
        diagonal = np.diag(self.mass)
        if np.any(diagonal <= _LIGHTEST):
            name = self.coordinates[int(np.argmin(diagonal))]
            return [f"reduced body, mass: got {diagonal.min():.4g} on the diagonal at {name}; allowed: > 0"]
        scale = 1.0 / np.sqrt(diagonal)
        problems = []
        for name in ("mass", "stiffness"):
            scaled = scale[:, None] * getattr(self, name) * scale
            largest = max(float(np.max(np.abs(scaled))), np.finfo(np.float64).tiny)
            apart = float(np.max(np.abs(scaled - scaled.T)))
            lowest = float(np.linalg.eigvalsh(0.5 * (scaled + scaled.T))[0]) if apart <= _ROUNDING * largest else 0.0
            if apart > _ROUNDING * largest:
                problems.append(
                    f"reduced body, {name}: is not symmetric: scaled entries differ by {apart:.3g} where the largest "
                    f"is {largest:.3g}; allowed: a symmetric matrix"
                )
            elif name == "mass" and lowest <= 0.0:
                problems.append(
                    f"reduced body, mass: the scaled matrix has the eigenvalue {lowest:.3g}; allowed: a positive "
                    "definite matrix; leave out coordinates that depend on others"
                )
            elif lowest < -_ROUNDING * largest:
                problems.append(
                    f"reduced body, stiffness: the scaled matrix has the eigenvalue {lowest:.3g} 1/s2; allowed: a "
                    "positive semi-definite matrix; a body does not push itself away from rest"
                )
        return problems


def _skin_problems(skin: Skin, size: int) -> list[str]:
    """List problems with the surface of a body of some coordinates."""
    count, corners = skin.positions.shape[0], skin.triangles
    if skin.positions.shape != (count, 3) or skin.transforms.shape != (count, 3, size) or corners.shape[1:] != (3,):
        return [
            f"reduced body, surface: got shapes {skin.positions.shape}, {skin.transforms.shape} and {corners.shape}; "
            f"allowed: (p, 3), (p, 3, {size}) and (t, 3)"
        ]
    if not (np.all(np.isfinite(skin.positions)) and np.all(np.isfinite(skin.transforms))):
        return ["reduced body, surface: got values that are no finite numbers; allowed: finite ones"]
    if corners.size and not (int(corners.min()) >= 0 and int(corners.max()) < count):
        return [
            f"reduced body, surface: got corners {int(corners.min())} to {int(corners.max())} of {count} places; "
            f"allowed: 0 to {count - 1}"
        ]
    return []


def mode_frequencies(reduced: ReducedBody) -> FloatArray:
    """Frequency of each modal coordinate alone, the others held [Hz], shape (n,); NaN for displacements and rotations.

    Parameters
    ----------
    reduced : ReducedBody
        The body.
    """
    modal = np.array([unit == "1" for unit in reduced.units])
    squares = np.maximum(np.diag(reduced.stiffness) / np.diag(reduced.mass), 0.0)
    return np.asarray(np.where(modal, np.sqrt(squares) / (2.0 * np.pi), np.nan), dtype=np.float64)


def up_to(reduced: ReducedBody, cutoff: float) -> ReducedBody:
    """The body with the modes up to a lower cut-off only, as if it had been reduced with that one.

    Parameters
    ----------
    reduced : ReducedBody
        A body reduced by static shapes and modes with held interfaces (Craig, Bampton), whose modes share stiffness and
        mass neither with each other, nor stiffness with the interfaces.
    cutoff : float
        Frequency up to which modes are kept [Hz].

    Raises
    ------
    InputError
        If the modes of the body are coupled, so that leaving one out would change the others.
    """
    frequencies = mode_frequencies(reduced)
    modal = np.flatnonzero(np.isfinite(frequencies))
    kept = np.flatnonzero(~(frequencies > cutoff))
    if kept.size == reduced.size:
        return reduced
    scale = 1.0 / np.sqrt(np.diag(reduced.mass))
    for name, others in (("stiffness", np.arange(reduced.size)), ("mass", modal)):
        scaled = scale[:, None] * getattr(reduced, name) * scale
        coupled = scaled[np.ix_(modal, others)]
        coupled[np.arange(modal.size), np.searchsorted(others, modal)] = 0.0
        if np.max(np.abs(coupled), initial=0.0) > _ROUNDING * float(np.max(np.abs(scaled))):
            raise InputError(
                f"reduced body, cut-off: got {cutoff:.6g} Hz for modes whose {name} is coupled, so that none may be "
                "left out; allowed: a body that was reduced by static shapes and modes with held interfaces, as "
                "`mbs reduce` does; reduce it again with the lower cut-off"
            )
    square = np.ix_(kept, kept)
    gone = np.setdiff1d(np.arange(reduced.size), kept)
    coupling = reduced.mass[np.ix_(kept, gone)]
    added = (coupling / np.diag(reduced.stiffness)[gone]) @ coupling.T
    return ReducedBody(
        reduced.mass[square],
        reduced.stiffness[square],
        tuple(reduced.coordinates[k] for k in kept),
        tuple(reduced.units[k] for k in kept),
        {name: replace(frame, transform=frame.transform[:, kept]) for name, frame in reduced.frames.items()},
        {**reduced.attributes, "cutoff": f"{cutoff:.6g} Hz"},
        None if reduced.skin is None else replace(reduced.skin, transforms=reduced.skin.transforms[:, :, kept]),
        None if reduced.left_out is None else reduced.left_out[square] + added,
    )


def to_body(
    reduced: ReducedBody,
    name: str,
    position: Sequence[float] = (0.0, 0.0, 0.0),
    damping_ratio: float = 0.0,
    spin: float = 0.0,
    rotation: FloatArray | None = None,
) -> Body:
    """Put a reduced body into a system.

    Parameters
    ----------
    reduced : ReducedBody
        Matrices and frames of the body.
    name : str
        Name in the system.
    position : sequence of float, shape (3,)
        Position of the origin of the finite-element body [m].
    damping_ratio : float
        Damping ratio of every mode of the free body.
    spin : float
        Speed about x as a multiple of the system's. The body has no gyroscopic terms: right for housings, which do not
        turn; shafts that turn are made of beams.
    rotation : array, shape (3, 3), optional
        How it is turned about its origin: from its axes to those of the system, which they are if left out. Frames lie
        and move along the axes of the system; the coordinates stay those of the body.

    Raises
    ------
    InputError
        For an invalid damping ratio.
    """
    here = np.asarray(position, dtype=np.float64)
    turn = np.eye(3) if rotation is None else rotation
    both = np.kron(np.eye(2), turn)
    return Body(
        name=name,
        coordinates=reduced.coordinates,
        units=reduced.units,
        mass=reduced.mass,
        gyroscopic=np.zeros_like(reduced.mass),
        damping=modal_damping(reduced.mass, reduced.stiffness, damping_ratio),
        stiffness=reduced.stiffness,
        frames={
            key: Frame(here + turn @ frame.position, both @ frame.transform) for key, frame in reduced.frames.items()
        },
        spin=spin,
        skin=None if reduced.skin is None else _placed(reduced.skin, here, turn),
        cutoff=reduced.cutoff,
        left_out=reduced.left_out,
    )


def _placed(skin: Skin, here: FloatArray, turn: FloatArray) -> Skin:
    """A surface in the system, from the origin of its body and turned about it."""
    return Skin(here + skin.positions @ turn.T, np.einsum("ab,pbn->pan", turn, skin.transforms), skin.triangles)
