"""Timoshenko beam element of a round section: stiffness, mass and gyroscopic matrix between two nodes along x.

Freedoms of the element: x y z theta_x theta_y theta_z of the first node, then of the second; rotations are small
rotations of the section, as in `mbs.model.body.lever_arm`, so that without shear theta_z = dy/dx and theta_y = -dz/dx.
The shape functions of bending solve the static problem exactly, so loads at the nodes bend the beam without error,
whatever the length of the elements. With mass, frequencies are too high by an error of fourth order in the length
where a beam bends, and of second order where it shears (see `element_length`).

References
----------
H. D. Nelson, A finite rotating shaft element using Timoshenko beam theory, J. Mech. Design 102, 1980, 793-803.
J. S. Przemieniecki, Theory of Matrix Structural Analysis, McGraw-Hill, 1968, chapters 5.6 and 11.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError

_X = (0, 6)
_THETA_X = (3, 9)
_XY = (1, 5, 7, 11)
_XZ = (2, 4, 8, 10)
_SIGN = np.array([1.0, -1.0, 1.0, -1.0])
"""In the plane x-z the slope dz/dx is -theta_y."""


@dataclass(frozen=True)
class CrossSection:
    """Properties of a beam per length; sections that are pressed together add up.

    Attributes
    ----------
    axial : float
        E A [N].
    bending : float
        E I [N m2].
    torsion : float
        G J [N m2].
    shear : float
        kappa G A [N]; infinite for a beam that does not shear.
    mass : float
        rho A [kg/m].
    rotary : float
        rho I, moment of inertia about y or z per length [kg m]; about x it is twice that.
    """

    axial: float
    bending: float
    torsion: float
    shear: float
    mass: float
    rotary: float

    def __add__(self, other: CrossSection) -> CrossSection:
        return CrossSection(
            self.axial + other.axial,
            self.bending + other.bending,
            self.torsion + other.torsion,
            self.shear + other.shear,
            self.mass + other.mass,
            self.rotary + other.rotary,
        )

    @classmethod
    def annulus(
        cls, diameter: float, bore: float, youngs_modulus: float, poisson_ratio: float, density: float
    ) -> CrossSection:
        """Hollow circle of outer diameter and bore [m], of E [Pa], nu and density [kg/m3].

        Parameters
        ----------
        diameter : float
            Outer diameter [m].
        bore : float
            Diameter of the bore [m].
        youngs_modulus : float
            E [Pa].
        poisson_ratio : float
            Poisson's ratio nu.
        density : float
            [kg/m3].
        """
        outer, inner = 0.5 * diameter, 0.5 * bore
        area = math.pi * (outer - inner) * (outer + inner)
        second_moment = 0.25 * area * (outer**2 + inner**2)
        shear_modulus = 0.5 * youngs_modulus / (1.0 + poisson_ratio)
        return cls(
            axial=youngs_modulus * area,
            bending=youngs_modulus * second_moment,
            torsion=2.0 * shear_modulus * second_moment,
            shear=shear_coefficient(bore / diameter, poisson_ratio) * shear_modulus * area,
            mass=density * area,
            rotary=density * second_moment,
        )


def shear_coefficient(bore_ratio: float, poisson_ratio: float) -> float:
    """Cowper's kappa of a hollow circle: mean shear stress over that on the axis.

    Parameters
    ----------
    bore_ratio : float
        Bore over outer diameter, 0 <= m < 1.
    poisson_ratio : float
        nu, -1 < nu < 0.5.

    Raises
    ------
    InputError
        Outside these ranges.

    References
    ----------
    G. R. Cowper, The shear coefficient in Timoshenko's beam theory, J. Appl. Mech. 33, 1966, 335-340.

    Examples
    --------
    >>> round(shear_coefficient(0.0, 0.3), 4)
    0.8864
    """
    if not (0.0 <= bore_ratio < 1.0 and -1.0 < poisson_ratio < 0.5):
        raise InputError(
            f"shear coefficient: got bore over diameter {bore_ratio!r}, nu {poisson_ratio!r}; allowed: 0 <= bore over "
            "diameter < 1, -1 < nu < 0.5"
        )
    square = bore_ratio**2
    solid = (1.0 + square) ** 2
    return (
        6.0
        * (1.0 + poisson_ratio)
        * solid
        / ((7.0 + 6.0 * poisson_ratio) * solid + (20.0 + 12.0 * poisson_ratio) * square)
    )


def element_stiffness(section: CrossSection, length: float) -> FloatArray:
    """Stiffness of an element, shape (12, 12) [N/m, N, N m/rad].

    Parameters
    ----------
    section : CrossSection
        The same all along the element.
    length : float
        [m].
    """
    matrix = np.zeros((12, 12))
    bar = np.array([[1.0, -1.0], [-1.0, 1.0]])
    matrix[np.ix_(_X, _X)] = section.axial / length * bar
    matrix[np.ix_(_THETA_X, _THETA_X)] = section.torsion / length * bar
    phi = _shear_ratio(section, length)
    side, near, far = 6.0 * length, (4.0 + phi) * length**2, (2.0 - phi) * length**2
    plane = (
        section.bending
        / ((1.0 + phi) * length**3)
        * np.array(
            [
                [12.0, side, -12.0, side],
                [side, near, -side, far],
                [-12.0, -side, 12.0, -side],
                [side, far, -side, near],
            ]
        )
    )
    matrix[np.ix_(_XY, _XY)] = plane
    matrix[np.ix_(_XZ, _XZ)] = plane * np.outer(_SIGN, _SIGN)
    return matrix


def element_mass(section: CrossSection, length: float) -> FloatArray:
    """Mass of an element, shape (12, 12) [kg, kg m, kg m2].

    Consistent with the shape functions in bending, rotary inertia included. Along and about x, where the shape
    functions are linear, it is the mean of the consistent and the lumped mass, whose errors cancel to fourth order.

    Parameters
    ----------
    section : CrossSection
        The same all along the element.
    length : float
        [m].

    References
    ----------
    G. L. Goudreau, R. L. Taylor, Evaluation of numerical integration methods in elastodynamics, Comput. Methods Appl.
    Mech. Eng. 2, 1973, 69-97.
    """
    matrix = np.zeros((12, 12))
    bar = length / 12.0 * np.array([[5.0, 1.0], [1.0, 5.0]])
    matrix[np.ix_(_X, _X)] = section.mass * bar
    matrix[np.ix_(_THETA_X, _THETA_X)] = 2.0 * section.rotary * bar
    deflection, rotation, weights = _shapes(section, length)
    plane = section.mass * (deflection.T * weights) @ deflection + section.rotary * (rotation.T * weights) @ rotation
    matrix[np.ix_(_XY, _XY)] = plane
    matrix[np.ix_(_XZ, _XZ)] = plane * np.outer(_SIGN, _SIGN)
    return matrix


def element_gyroscopic(section: CrossSection, length: float) -> FloatArray:
    """Gyroscopic matrix G of an element, skew, shape (12, 12) [kg, kg m, kg m2], with M q'' + speed G q' + K q.

    The angular momentum about x, 2 rho I speed per length, turns with the section, as in `mbs.model.body.rigid_body`.

    Parameters
    ----------
    section : CrossSection
        The same all along the element.
    length : float
        [m].
    """
    matrix = np.zeros((12, 12))
    _, rotation, weights = _shapes(section, length)
    half = 2.0 * section.rotary * ((-_SIGN * rotation).T * weights) @ rotation
    matrix[np.ix_(_XZ, _XY)] = half
    matrix[np.ix_(_XY, _XZ)] = -half.T
    return matrix


def over_both_planes(
    plane_mass: FloatArray,
    plane_rotary: tuple[FloatArray, FloatArray],
    plane_stiffness: FloatArray,
    bars: tuple[FloatArray, FloatArray],
    springs: tuple[FloatArray, FloatArray],
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Matrices of an element from those of one plane and of its axis; mass, gyroscopic, stiffness, (12, 12) each.

    Parameters
    ----------
    plane_mass : array, shape (4, 4)
        Mass of y1 theta1 y2 theta2 in the plane x-y.
    plane_rotary : (array, array), shapes (4, points) and (points, 4)
        Rotations times the moment of inertia about x that each point has, and rotations.
    plane_stiffness : array, shape (4, 4)
        Stiffness of the same.
    bars, springs : (array, array), shape (2, 2)
        Inertia and stiffness along x and about x.
    """
    mass, gyroscopic, stiffness = (np.zeros((12, 12)) for _ in range(3))
    for rows, bar, spring in zip((_X, _THETA_X), bars, springs, strict=True):
        mass[np.ix_(rows, rows)], stiffness[np.ix_(rows, rows)] = bar, spring
    for matrix, plane in ((mass, plane_mass), (stiffness, plane_stiffness)):
        matrix[np.ix_(_XY, _XY)] = plane
        matrix[np.ix_(_XZ, _XZ)] = plane * np.outer(_SIGN, _SIGN)
    weighted, rotation = plane_rotary
    half = -_SIGN[:, None] * (weighted @ rotation)
    gyroscopic[np.ix_(_XZ, _XY)], gyroscopic[np.ix_(_XY, _XZ)] = half, -half.T
    return mass, gyroscopic, stiffness


def wave_length(section: CrossSection, frequency: float) -> float:
    """Length of the shortest bending wave that travels along a Timoshenko beam at a frequency [Hz], [m].

    Examples
    --------
    >>> round(wave_length(CrossSection.annulus(0.04, 0.0, 210e9, 0.3, 7850.0), 8000.0), 3)
    0.184
    """
    square = (2.0 * math.pi * frequency) ** 2
    # E I k^4 - first k^2 - last = 0 with both roots real; the larger one is the shorter wave.
    first = square * (section.rotary + section.bending * section.mass / section.shear)
    last = square * section.mass * (1.0 - section.rotary * square / section.shear)
    wave_number = (first + math.sqrt(first**2 + 4.0 * section.bending * last)) / (2.0 * section.bending)
    return 2.0 * math.pi / math.sqrt(wave_number)


def element_length(section: CrossSection, frequency: float, error: float) -> float:
    """Length of elements [m] that makes bending waves at a frequency faster by a small part, `error`, at most.

    The error of the frequency of a wave with the wave number k is estimated as (k h)^4/1440 + (k h)^2/24 g/(1 + g),
    where g = E I k^2/(kappa G A) is how much the wave shears against how much it bends.

    Parameters
    ----------
    section : CrossSection
        Cross section of the beam.
    frequency : float
        [Hz].
    error : float
        Relative error of a frequency.
    """
    wave_number = 2.0 * math.pi / wave_length(section, frequency)
    shearing = section.bending * wave_number**2 / section.shear
    second, fourth = shearing / (1.0 + shearing) / 24.0, 1.0 / 1440.0
    square = 2.0 * error / (second + math.sqrt(second**2 + 4.0 * fourth * error))
    return math.sqrt(square) / wave_number


def _shear_ratio(section: CrossSection, length: float) -> float:
    """Phi: how much softer by shear than by bending an element is."""
    return 12.0 * section.bending / (section.shear * length**2)


def _shapes(section: CrossSection, length: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Deflection and rotation in the plane x-y by y1 theta1 y2 theta2, at Gauss points (4, 4), and weights (4,) [m]."""
    phi = _shear_ratio(section, length)
    points, weights = np.polynomial.legendre.leggauss(4)
    s = 0.5 * (1.0 + points)
    deflection = np.stack(
        [
            1.0 - 3.0 * s**2 + 2.0 * s**3 + phi * (1.0 - s),
            length * (s - 2.0 * s**2 + s**3 + 0.5 * phi * (s - s**2)),
            3.0 * s**2 - 2.0 * s**3 + phi * s,
            length * (s**3 - s**2 + 0.5 * phi * (s**2 - s)),
        ],
        axis=1,
    )
    rotation = np.stack(
        [
            6.0 / length * (s**2 - s),
            1.0 - 4.0 * s + 3.0 * s**2 + phi * (1.0 - s),
            6.0 / length * (s - s**2),
            3.0 * s**2 - 2.0 * s + phi * s,
        ],
        axis=1,
    )
    # Four points integrate the products, of sixth degree, exactly.
    return deflection / (1.0 + phi), rotation / (1.0 + phi), 0.5 * length * weights
