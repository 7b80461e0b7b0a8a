"""Beams and shafts against closed forms, a transfer-matrix method written here, and published rotors.

The transfer matrix integrates the differential equations of a spinning Timoshenko beam from end to end, without
elements, so it shares nothing with the code but the theory.
"""

from __future__ import annotations

import dataclasses
import math
import tomllib
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eig, eigh, expm
from scipy.optimize import brentq

from mbs.flexible.beam import (
    CrossSection,
    element_gyroscopic,
    element_length,
    element_mass,
    element_stiffness,
    shear_coefficient,
    wave_length,
)
from mbs.flexible.shaft import flexible_shaft
from mbs.flexible.shaft_parts import WAVE_ERROR, Disc, Section
from mbs.flexible.taper import tapered_element
from mbs.linearised.modes import modes
from mbs.model.body import FREEDOMS, Inertia, lever_arm
from mbs.model.elements import ElementDefaults, Forces, Operation, Port, Spring
from mbs.model.equilibrium import equilibrium
from mbs.model.relaxation import relaxing
from mbs.model.system import System

E, NU, RHO = 210e9, 0.3, 7850.0
PLANE = ("y", "theta_z")
BENDING = ("y", "z", "theta_y", "theta_z")
ORIGIN = (0.0, 0.0, 0.0)
ROTORS = tomllib.loads((Path(__file__).parents[1] / "references" / "rotors.toml").read_text(encoding="utf-8"))


def shaft(sections, discs=(), freedoms=BENDING, frames=None, **settings):
    length = max(section.end for section in sections)
    frames = frames or {"left": 0.0, "right": length}
    return flexible_shaft("shaft", sections, discs, freedoms, ORIGIN, frames, spin=1.0, **settings)


def round_bar(diameter, length, density=RHO, bore=0.0):
    return Section(0.0, length, diameter, bore, E, NU, density)


def free_rows(body, held):
    return [index for index, name in enumerate(body.coordinates) if name not in held]


def frequencies(body, held=()):
    """Undamped angular frequencies at rest, rising."""
    rows = np.ix_(free_rows(body, held), free_rows(body, held))
    return np.sqrt(np.maximum(eigh(body.stiffness[rows], body.mass[rows], eigvals_only=True), 0.0))


def whirls(body, speed, held=()):
    """Angular frequencies at a speed: forward whirls positive, backward ones negative, rising."""
    rows = np.ix_(free_rows(body, held), free_rows(body, held))
    mass, gyroscopic, stiffness = body.mass[rows], body.gyroscopic[rows], body.stiffness[rows]
    zero, one = np.zeros_like(mass), np.eye(len(mass))
    values, vectors = eig(np.block([[zero, one], [-np.linalg.solve(mass, np.hstack([stiffness, speed * gyroscopic]))]]))
    # Forward: z follows y by a quarter turn, so y + i z turns with e^(i omega t) and its mirror image vanishes.
    names = [body.coordinates[index] for index in free_rows(body, held)]
    y = vectors[[index for index, name in enumerate(names) if name.endswith(".y")]]
    z = vectors[[index for index, name in enumerate(names) if name.endswith(".z")]]
    forward = np.linalg.norm(y + 1j * z, axis=0) > np.linalg.norm(y - 1j * z, axis=0)
    return np.sort(values.imag[forward])


def assembled(sections, places):
    """Mass, gyroscopic and stiffness matrix of elements in a row, six freedoms a node."""
    matrices = tuple(np.zeros((6 * len(places), 6 * len(places))) for _ in range(3))
    for index, (section, (begin, end)) in enumerate(zip(sections, pairwise(places), strict=True)):
        here = slice(6 * index, 6 * index + 12)
        for matrix, element in zip(matrices, (element_mass, element_gyroscopic, element_stiffness), strict=True):
            matrix[here, here] += element(section, end - begin)
    return matrices


def order(errors):
    return [math.log2(coarse / fine) for coarse, fine in pairwise(np.abs(errors))]


def transfer(section, length, omega, speed):
    """State (deflection, rotation, moment, shear force) at the end of a piece of beam by that at its beginning."""
    inertia = section.rotary * (omega**2 - 2.0 * speed * omega)
    rates = np.array(
        [
            [0.0, 1.0, 0.0, 1.0 / section.shear],
            [0.0, 0.0, 1.0 / section.bending, 0.0],
            [0.0, -inertia, 0.0, -1.0],
            [-section.mass * omega**2, 0.0, 0.0, 0.0],
        ]
    )
    # Units in which all entries of the state are of the same size.
    scale = np.array([1.0, 1.0 / length, section.bending / length**2, section.bending / length**3])
    return scale[:, None] * expm(length * rates * scale / scale[:, None]) / scale


def point(mass, transverse, polar, stiffness, omega, speed):
    """State behind a disc or spring by that before it."""
    matrix = np.eye(4)
    matrix[2, 1] = -(transverse * omega**2 - polar * speed * omega)
    matrix[3, 0] = stiffness - mass * omega**2
    return matrix


def free_shaft(pieces, omega, speed):
    """What vanishes at a natural frequency of a shaft with free ends: its pieces are matrices of (omega, speed)."""
    whole = np.eye(4)
    for piece in pieces:
        whole = piece(omega, speed) @ whole
    return float(np.linalg.det(whole[2:, :2]))


def root_near(function, guess, width=5e-3):
    """Zero within a small part of a guess; fails where there is none."""
    return brentq(function, guess * (1.0 - width), guess * (1.0 + width), xtol=1e-12 * abs(guess), rtol=1e-13)


# ---- closed forms


def numbers_of(equation, brackets):
    return np.array([brentq(equation, *bracket, xtol=1e-14) for bracket in brackets])


@pytest.mark.parametrize(
    ("held", "numbers"),
    [
        ((), numbers_of(lambda x: math.cos(x) - 1.0 / math.cosh(x), [(4.0, 5.5), (7.0, 8.6), (10.2, 11.8)])),
        (
            ("left.y", "left.theta_z"),
            numbers_of(lambda x: math.cos(x) + 1.0 / math.cosh(x), [(1.0, 3.0), (4.0, 5.5), (7.0, 8.6)]),
        ),
        (
            ("left.y", "left.theta_z", "right.y", "right.theta_z"),
            numbers_of(lambda x: math.cos(x) - 1.0 / math.cosh(x), [(4.0, 5.5), (7.0, 8.6), (10.2, 11.8)]),
        ),
        (("left.y", "right.y"), math.pi * np.array([1.0, 2.0, 3.0])),
    ],
    ids=["free", "clamped", "clamped at both ends", "simply supported"],
)
def test_a_slender_beam_is_eulers(held, numbers):
    diameter, length = 0.01, 5.0
    beam = shaft([round_bar(diameter, length)], freedoms=PLANE, largest_element=length / 40.0)
    found = frequencies(beam, held)
    rigid = 2 if not held else 0
    closed = numbers**2 / length**2 * math.sqrt(E / RHO) * diameter / 4.0
    # Shear and rotary inertia lower the third mode by about (11 d/4 L)^2 (1 + E/kappa G)/2 = 6e-5; elements 1e-6.
    np.testing.assert_allclose(found[rigid : rigid + 3], closed, rtol=1e-4)
    assert np.all(found[rigid : rigid + 3] < closed)


def timoshenko(section, wave_number, speed=0.0):
    """Whirl frequencies of one wave on a simply supported spinning beam: roots of a polynomial of fourth degree.

    (kGA k^2 - rho A w^2) (E I k^2 + kGA - rho I (w^2 - 2 speed w)) = (kGA k)^2; without speed a quadratic in w^2.
    """
    k, s = wave_number, section
    across = np.poly1d([-s.mass, 0.0, s.shear * k**2])
    about = np.poly1d([-s.rotary, 2.0 * s.rotary * speed, s.bending * k**2 + s.shear])
    roots = np.roots(across * about - np.poly1d([(s.shear * k) ** 2]))
    assert np.max(np.abs(roots.imag)) < 1e-6 * np.max(np.abs(roots.real))
    return np.sort(roots.real)


@pytest.mark.parametrize("bore", [0.0, 0.03])
def test_a_thick_simply_supported_beam_converges_to_the_closed_form(bore):
    length, section = 0.2, CrossSection.annulus(0.05, bore, E, NU, RHO)
    numbers = np.array([1, 2, 3])
    closed = np.array([timoshenko(section, n * math.pi / length)[2] for n in numbers])
    errors = []
    for count in (16, 32, 64):
        beam = shaft([round_bar(0.05, length, bore=bore)], freedoms=PLANE, largest_element=length / count)
        errors.append(frequencies(beam, ("left.y", "right.y"))[:3] / closed - 1.0)
    for column in np.array(errors).T:
        # Elements shorter than the diameter shear more than they bend: second order.
        assert 1.95 < order(column)[-1] < 2.05, column
    # The estimate that the default length of elements is made from holds, on the safe side by up to a quarter.
    for n, frequency, error in zip(numbers, closed, errors[-1], strict=True):
        wanted = element_length(section, frequency / (2.0 * math.pi), error)
        assert 0.85 * length / 64 < wanted < length / 64, n
    # Shear and rotary inertia matter here: this is no beam of Euler's.
    assert closed[0] < 0.95 * (math.pi / length) ** 2 * math.sqrt(section.bending / section.mass)


def test_a_beam_that_does_not_shear_converges_with_fourth_order():
    length = 0.2
    section = dataclasses.replace(CrossSection.annulus(0.05, 0.02, E, NU, RHO), shear=math.inf)
    wave_numbers = np.array([1, 2, 3]) * math.pi / length
    closed = wave_numbers**2 * np.sqrt(section.bending / (section.mass + section.rotary * wave_numbers**2))
    errors = []
    for count in (4, 8, 16):
        mass, _, stiffness = assembled([section] * count, np.linspace(0.0, length, count + 1))
        rows = [6 * node + row for node in range(count + 1) for row in (1, 5) if row == 5 or 0 < node < count]
        pick = np.ix_(rows, rows)
        errors.append(np.sqrt(eigh(stiffness[pick], mass[pick], eigvals_only=True)[:3]) / closed - 1.0)
    for column in np.array(errors).T:
        assert 3.8 < order(column)[-1] < 4.2, column
    for frequency, error in zip(closed, errors[-1], strict=True):
        # The estimate, to what is left of higher order.
        wanted = element_length(section, frequency / (2.0 * math.pi), error)
        assert wanted == pytest.approx(length / 16, rel=0.1)


def test_a_thick_spinning_beam_splits_as_in_closed_form():
    length, speed, section = 0.2, 5e3, CrossSection.annulus(0.05, 0.02, E, NU, RHO)
    errors = []
    for count in (16, 32, 64):
        beam = shaft([round_bar(0.05, length, bore=0.02)], largest_element=length / count)
        held = ("left.y", "right.y", "left.z", "right.z")
        found = whirls(beam, speed, held)
        row = []
        for n in (1, 2):
            roots = timoshenko(section, n * math.pi / length, speed)
            for slow in (roots[1], roots[2]):
                row.append(found[np.argmin(np.abs(found - slow))] / slow - 1.0)
            # Backward and forward differ by much more than the error: the test sees the gyroscopic matrix.
            assert abs(roots[2] + roots[1]) > 1e-2 * roots[2]
        errors.append(row)
    for column in np.array(errors).T:
        assert 1.95 < order(column)[-1] < 2.05, column
    # Discretisation: (k h)^2/24 times the part of shearing, with 64 elements a wave.
    assert np.max(np.abs(errors[-1])) < 2e-4


@pytest.mark.parametrize(("freedom", "modulus"), [("x", E), ("theta_x", E / (2.0 * (1.0 + NU)))])
@pytest.mark.parametrize("held", [False, True])
def test_axial_and_torsional_bars_converge_with_fourth_order(freedom, modulus, held):
    length, errors = 0.7, []
    closed = (np.array([1.0, 2.0]) - (0.5 if held else 0.0)) * math.pi * math.sqrt(modulus / RHO) / length
    for count in (4, 8, 16):
        bar = shaft([round_bar(0.05, length, bore=0.02)], freedoms=(freedom,), largest_element=length / count)
        found = frequencies(bar, (f"left.{freedom}",) if held else ())
        errors.append(found[0 if held else 1 :][:2] / closed - 1.0)
    for column in np.array(errors).T:
        assert 3.8 < order(column)[-1] < 4.2, column
    # (omega h/c)^4/480 with 8 elements a wave.
    assert np.max(np.abs(errors[-1])) < 1e-4


def test_three_point_bending_of_the_reduced_shaft_is_exact():
    length, force = 0.3, 1000.0
    beam = shaft([round_bar(0.06, length)], frames={"left": 0.0, "middle": 0.15, "right": 0.3}, cutoff=5e3)
    section = CrossSection.annulus(0.06, 0.0, E, NU, RHO)
    rows = free_rows(beam, ("left.y", "right.y", "left.z", "right.z"))
    load = force * beam.frames["middle"].transform[2]
    deflection = beam.frames["middle"].transform[2][rows] @ np.linalg.solve(
        beam.stiffness[np.ix_(rows, rows)], load[rows]
    )
    closed = force * (length**3 / (48.0 * section.bending) + length / (4.0 * section.shear))
    # Round-off of the static condensation.
    assert deflection == pytest.approx(closed, rel=1e-9)


# ---- rigid discs on shafts without mass

LIGHT = 1e-3
"""Density of a shaft without mass [kg/m3]: 1e-7 and less of the disc's mass."""


def test_a_jeffcott_rotor_tilts_as_in_closed_form():
    length, mass, polar, transverse, speed = 0.4, 5.0, 0.06, 0.03, 800.0
    section = CrossSection.annulus(0.02, 0.0, E, NU, LIGHT)
    rotor = shaft([round_bar(0.02, length, LIGHT)], [Disc(0.5 * length, Inertia(mass, polar, transverse))])
    found = whirls(rotor, speed, ("left.y", "right.y", "left.z", "right.z"))
    half = 0.5 * length
    side = half**3 / (3.0 * section.bending) + half / section.shear
    sway = math.sqrt(2.0 / side / mass)
    tilt = 2.0 * half**2 / side
    root = math.sqrt((polar * speed) ** 2 + 4.0 * transverse * tilt)
    closed = [
        -sway,
        sway,
        (polar * speed - root) / (2.0 * transverse),
        (polar * speed + root) / (2.0 * transverse),
    ]
    for value in closed:
        # The mass of the shaft, and round-off beside its own modes, which lie far higher.
        assert np.min(np.abs(found / value - 1.0)) < 1e-6


def test_an_overhung_disc_whirls_as_in_closed_form():
    length, mass, polar, transverse, offset, speed = 0.25, 4.0, 0.05, 0.03, 0.02, 900.0
    section = CrossSection.annulus(0.025, 0.0, E, NU, LIGHT)
    rotor = shaft([round_bar(0.025, length, LIGHT)], [Disc(length, Inertia(mass, polar, transverse, offset))])
    found = whirls(rotor, speed, tuple(f"left.{freedom}" for freedom in BENDING))
    compliance = np.array(
        [
            [length**3 / (3.0 * section.bending) + length / section.shear, length**2 / (2.0 * section.bending)],
            [length**2 / (2.0 * section.bending), length / section.bending],
        ]
    )
    (k11, k12), (_, k22) = np.linalg.inv(compliance)
    across = np.poly1d([-mass, 0.0, k11])
    both = np.poly1d([-mass * offset, 0.0, k12])
    about = np.poly1d([-(transverse + mass * offset**2), polar * speed, k22])
    for value in np.roots(across * about - both * both).real:
        # The mass of the shaft, and round-off.
        assert np.min(np.abs(found / value - 1.0)) < 1e-6


# ---- stepped shafts against the transfer matrix

STEPS = [
    Section(0.0, 0.06, 0.030),
    Section(0.06, 0.20, 0.045, 0.015),
    Section(0.20, 0.32, 0.038),
    Section(0.09, 0.13, 0.070, 0.045, 205e9, 0.28, 7700.0),
]
STEP_DISC = Disc(0.26, Inertia(2.2, 6e-3, 3.4e-3))
SUPPORT = 8e7
SUPPORTS = {"left": 0.03, "right": 0.29}


def stepped_pieces():
    """The shaft of STEPS from left to right, on springs at both supports."""
    marks = [0.0, 0.03, 0.06, 0.09, 0.13, 0.20, 0.26, 0.29, 0.32]
    points = {0.03: (0.0, 0.0, 0.0, SUPPORT), 0.26: (2.2, 3.4e-3, 6e-3, 0.0), 0.29: (0.0, 0.0, 0.0, SUPPORT)}
    pieces = []
    for begin, end in pairwise(marks):
        here = [section for section in STEPS if section.begin < 0.5 * (begin + end) < section.end]
        total = here[0].at(begin)
        for section in here[1:]:
            total += section.at(begin)
        pieces.append(lambda omega, speed, s=total, d=end - begin: transfer(s, d, omega, speed))
        if end in points:
            pieces.append(lambda omega, speed, values=points[end]: point(*values, omega, speed))
    return pieces


def supported(**settings):
    body = shaft(STEPS, [STEP_DISC], frames=SUPPORTS, **settings)
    stiffness = body.stiffness.copy()
    for frame in body.frames.values():
        for row in frame.transform[1:3]:
            stiffness += SUPPORT * np.outer(row, row)
    return dataclasses.replace(body, stiffness=stiffness)


@pytest.mark.parametrize("speed", [20.0, 2000.0])
def test_a_stepped_shaft_is_that_of_the_transfer_matrix(speed):
    pieces = stepped_pieces()
    meshes = [whirls(supported(largest_element=size), speed) for size in (0.01, 0.005)]
    # Forward and backward, up to the fifth bending mode at 6 kHz.
    coarse, fine = (found[np.argsort(np.abs(found))][:10] for found in meshes)
    coarse, fine = np.sort(coarse), np.sort(fine)
    exact = np.array([root_near(lambda omega: free_shaft(pieces, omega, speed), guess) for guess in fine])
    # Bending waves of 0.1 m and more at a diameter of 40 mm: (k h)^2/24 times the part of shearing.
    np.testing.assert_allclose(fine, exact, rtol=3e-4)
    # Second order, so the extrapolated value has none of it; what is left is of fourth order.
    np.testing.assert_allclose((4.0 * fine - coarse) / 3.0, exact, rtol=1e-6)
    # Forward and backward differ by far more than these errors.
    assert np.all(np.abs(exact[5:] / -exact[4::-1] - 1.0) > 5e-6 * speed)


# ---- reduction


def magnitudes(body, speed):
    """Magnitudes of the angular frequencies, rising."""
    zero, one = np.zeros_like(body.mass), np.eye(len(body.mass))
    values = np.linalg.eigvals(
        np.block([[zero, one], [-np.linalg.solve(body.mass, np.hstack([body.stiffness, speed * body.gyroscopic]))]])
    )
    return np.sort(values.imag[values.imag > 0.0])


@pytest.mark.parametrize("speed", [0.0, 2000.0])
def test_a_reduced_shaft_tells_how_far_it_is_from_the_whole(speed):
    whole = magnitudes(supported(largest_element=0.004), speed)
    for cutoff in (10e3, 20e3):
        small = supported(largest_element=0.004, cutoff=cutoff)
        assert len(small.coordinates) < 30
        reduced = magnitudes(small, speed)
        wanted = whole[whole < math.pi * cutoff]
        assert len(wanted) >= 6
        error = reduced[: len(wanted)] / wanted - 1.0
        found = modes(equilibrium(System([dataclasses.replace(small, spin=1.0)]), Operation(speed)))
        told = (-found.reduction.frequency / found.frequency)[: len(wanted)]
        assert np.max(error) > 1e-4
        # the first order, in which all that is left out resonates just above the cut-off: 1/(1 - 1/4) at half of it
        np.testing.assert_allclose(told, error, rtol=0.4, atol=1e-7)


def test_the_default_elements_are_fine_enough_at_the_cutoff():
    cutoff = 12e3
    coarse = shaft(STEPS, [STEP_DISC], frames=SUPPORTS, cutoff=cutoff)
    fine = shaft(STEPS, [STEP_DISC], frames=SUPPORTS, cutoff=cutoff, largest_element=0.001)
    assert coarse.coordinates == fine.coordinates
    own = slice(8, None)
    # What the default length is made for; the fine model has less than a tenth of it.
    np.testing.assert_allclose(
        np.sqrt(np.diag(coarse.stiffness)[own]), np.sqrt(np.diag(fine.stiffness)[own]), rtol=WAVE_ERROR
    )


def test_the_wave_length_is_that_of_the_closed_form():
    section = CrossSection.annulus(0.05, 0.02, E, NU, RHO)
    for wave in (0.06, 0.2, 2.0):
        omega = timoshenko(section, 2.0 * math.pi / wave)[2]
        # Round-off of the roots of the polynomial.
        assert wave_length(section, omega / (2.0 * math.pi)) == pytest.approx(wave, rel=1e-6)


# ---- conservation


@pytest.mark.parametrize("cutoff", [None, 6e3])
def test_a_free_shaft_has_its_mass_its_rigid_motions_and_no_power_by_gyroscopic_forces(cutoff):
    body = shaft(
        STEPS,
        [STEP_DISC, Disc(0.02, Inertia(0.5, 2e-4, 2e-4, 0.01))],
        freedoms=("x", "y", "z", "theta_x", "theta_y", "theta_z"),
        frames=SUPPORTS,
        cutoff=cutoff,
        largest_element=0.01,
    )
    assert np.array_equal(body.gyroscopic, -body.gyroscopic.T)
    squares, shapes = eigh(body.stiffness, body.mass)
    # Round-off of the highest frequency of the model.
    assert np.all(np.abs(squares[:6]) < 1e-10 * squares[-1])
    assert squares[6] > (2.0 * math.pi * 500.0) ** 2
    # Momentum and moments of inertia of the rigid motions, from the parts: cylinders and discs as rigid bodies.
    rigid = np.linalg.lstsq(
        np.vstack([frame.transform for frame in body.frames.values()]) @ shapes[:, :6],
        np.vstack([lever_arm((place, 0.0, 0.0)) for place in SUPPORTS.values()]),
        rcond=None,
    )[0]
    motion = shapes[:, :6] @ rigid
    mass, momentum = np.zeros((6, 6)), 0.0
    for part in [
        *(Inertia.cylinder(s.begin, s.end, s.diameter, s.bore, s.density) for s in STEPS),
        dataclasses.replace(STEP_DISC.inertia, offset=STEP_DISC.position),
        Inertia(0.5, 2e-4, 2e-4, 0.03),
    ]:
        lever = lever_arm((part.offset, 0.0, 0.0))
        mass += lever.T @ np.diag([*(3 * [part.mass]), part.polar, part.transverse, part.transverse]) @ lever
        momentum += part.polar
    # Round-off of the eigenvectors.
    np.testing.assert_allclose(motion.T @ body.mass @ motion, mass, rtol=1e-7, atol=1e-7 * np.max(mass))
    gyroscopic = motion.T @ body.gyroscopic @ motion
    assert gyroscopic[4, 5] == pytest.approx(momentum, rel=1e-7)
    gyroscopic[4:, 4:] = 0.0
    assert np.max(np.abs(gyroscopic)) < 1e-7 * momentum


# ---- published rotors

FRISWELL = ROTORS["friswell"]


@pytest.mark.parametrize("case", FRISWELL["case"], ids=lambda case: f"{case['name']}, {case['speed']:g} rpm")
def test_rotors_of_friswell_penny_garvey_lees(case):
    width, density = FRISWELL["disc_width"], FRISWELL["density"]
    nu = FRISWELL["youngs_modulus"] / (2.0 * FRISWELL["shear_modulus"]) - 1.0
    body = flexible_shaft(
        "rotor",
        [Section(0.0, FRISWELL["length"], FRISWELL["diameter"], 0.0, FRISWELL["youngs_modulus"], nu, density)],
        [
            Disc(place, Inertia.cylinder(-0.5 * width, 0.5 * width, diameter, FRISWELL["diameter"], density))
            for place, diameter in case["discs"]
        ],
        BENDING,
        ORIGIN,
        {f"bearing {index}": place for index, (place, *_) in enumerate(case["bearings"])},
        spin=1.0,
        largest_element=FRISWELL["element"],
    )
    springs = [
        Spring(
            f"spring {index}",
            f"rotor:bearing {index}",
            "ground",
            np.diag([0.0, along, across, 0.0, 0.0, 0.0]),
            np.diag([0.0, damping, damping, 0.0, 0.0, 0.0]),
        )
        for index, (_, along, across, damping) in enumerate(case["bearings"])
    ]
    balance = equilibrium(System([body], springs), Operation(case["speed"] * math.pi / 30.0))
    values = modes(balance).eigenvalues[:6]
    # The elements are those of the book, so only its rounding remains: one in the last digit printed.
    if "magnitude" in case:
        for value, printed in zip(np.sort(np.abs(values)), case["magnitude"], strict=True):
            assert value == pytest.approx(printed, abs=0.11 if printed > 1000.0 else 0.011)
        # Nothing dissipates: round-off of the eigenvalues.
        assert np.max(np.abs(values.real)) < 1e-8 * np.max(np.abs(values))
    else:
        hertz = values / (2.0 * math.pi)
        np.testing.assert_allclose(np.sort(np.abs(hertz)), case["magnitude_hertz"], rtol=0.0, atol=0.011)
        np.testing.assert_allclose(np.sort(hertz.imag), case["damped_hertz"], rtol=0.0, atol=0.011)


class RelaxingFilm(ElementDefaults):
    """Two films that relax, along and across, between a place and the ground."""

    def __init__(self, name, on, stiffness, damping, springs):
        self.name, self.ports = name, (Port(on),)
        self.k, self.c = (np.diag([0.0, *values, 0.0, 0.0, 0.0]) for values in (stiffness, damping))
        self.films = relaxing(np.eye(6)[1:3], np.array(damping), np.array(damping) / np.array(springs))

    def evaluate(self, displacement, velocity, operation):
        return Forces(-self.k @ displacement - self.c @ velocity, self.k, self.c)

    def relaxation(self, displacement, operation):
        return self.films


def rotor_on_films():
    width, density, films = FRISWELL["disc_width"], FRISWELL["density"], ROTORS["films"]
    modulus, diameter = FRISWELL["youngs_modulus"], FRISWELL["diameter"]
    nu = modulus / (2.0 * FRISWELL["shear_modulus"]) - 1.0
    body = flexible_shaft(
        "rotor",
        [Section(0.0, FRISWELL["length"], diameter, 0.0, modulus, nu, density)],
        [Disc(x, Inertia.cylinder(-0.5 * width, 0.5 * width, outer, diameter, density)) for x, outer in films["discs"]],
        BENDING,
        ORIGIN,
        {f"bearing {index}": place for index, place in enumerate(films["bearings"])},
        spin=1.0,
        largest_element=FRISWELL["element"],
    )
    data = films["stiffness"], films["damping"], films["springs"]
    elements = [RelaxingFilm(f"film {index}", f"rotor:bearing {index}", *data) for index in (0, 1)]
    return equilibrium(System([body], elements=elements), Operation(films["speed"] * math.pi / 30.0))


def test_films_that_relax_beside_ross():
    """Each mode at its own complex frequency; ROSS has the films as springs and dampers with nodes between them."""
    films = ROTORS["films"]
    expected = np.array(films["real"]) + 1j * np.array(films["imaginary"])
    found = modes(rotor_on_films()).eigenvalues
    found = found[found.imag > 1.0][: expected.size]
    # The masses of the nodes in ROSS, and its round-off at the lowest modes.
    np.testing.assert_allclose(np.abs(found), np.abs(expected), rtol=1e-7)
    np.testing.assert_allclose(found.real / np.abs(found), expected.real / np.abs(expected), rtol=1e-6)
    # Films of the frequency that is seen, not of the complex one: what that leaves out grows with the damping.
    matched = np.array(films["matched_real"]) + 1j * np.array(films["matched_imaginary"])
    apart, ratio = np.abs(matched - found) / np.abs(found), -found.real / np.abs(found)
    assert np.all(apart < 0.1 * ratio)
    assert apart.max() > 3e-3


def nelson_sections():
    data = ROTORS["nelson"]
    for outer, inner in zip(data["outer_radius"], data["inner_radius"], strict=True):
        section = CrossSection.annulus(0.02 * outer, 0.02 * inner, data["youngs_modulus"], 0.3, data["density"])
        yield dataclasses.replace(section, shear=math.inf)


def test_rotor_of_nelson_and_mcvaugh():
    data = ROTORS["nelson"]
    stations = 0.01 * np.array(data["station"])
    mass, gyroscopic, stiffness = assembled(list(nelson_sections()), stations)
    disc, polar, transverse = data["disc"]
    node = 6 * data["disc_station"]
    for row, value in zip((1, 2, 4, 5), (disc, disc, transverse, transverse), strict=True):
        mass[node + row, node + row] += value
    gyroscopic[node + 4, node + 5] += polar
    gyroscopic[node + 5, node + 4] -= polar
    for station in data["bearing_stations"]:
        for row in (1, 2):
            stiffness[6 * station + row, 6 * station + row] += data["bearing_stiffness"]
    rows = [6 * index + row for index in range(len(stations)) for row in (1, 2, 4, 5)]
    pick = np.ix_(rows, rows)
    # Whirl at the speed itself, e^(i s t): K - s^2 (M - i G), forward and backward as G has both signs.
    squares = eig(stiffness[pick], mass[pick] - 1j * gyroscopic[pick], right=False)
    squares = np.sort(squares.real[(squares.real > 0.0) & (np.abs(squares.imag) < 1e-6 * np.abs(squares))])
    found = np.sqrt(squares[:6])
    # Dimensions of three digits and fewer: 0.3 % in a diameter is 0.3 % and more in a frequency.
    np.testing.assert_allclose(found * 30.0 / math.pi, data["critical_speeds"], rtol=5e-3)

    points = {data["disc_station"]: (disc, transverse, polar, 0.0)}
    points |= {station: (0.0, 0.0, 0.0, data["bearing_stiffness"]) for station in data["bearing_stations"]}
    pieces = []
    for index, (section, (begin, end)) in enumerate(zip(nelson_sections(), pairwise(stations), strict=True)):
        if index in points:
            pieces.append(lambda omega, speed, values=points[index]: point(*values, omega, speed))
        pieces.append(lambda omega, speed, s=section, d=end - begin: transfer(s, d, omega, speed))
    exact = [
        root_near(lambda omega, way=way: free_shaft(pieces, way * omega, omega), value)
        for value, way in zip(found, (-1.0, 1.0, -1.0, 1.0, -1.0, 1.0), strict=True)
    ]
    # The elements of the paper, of up to 38 mm, at the sixth critical speed of 1600 Hz.
    np.testing.assert_allclose(found, exact, rtol=2e-4)


# ---- cones, and layers without stiffness

CONE = Section(0.0, 0.4, 0.03, 0.01, E, NU, RHO, 0.06, 0.02)


def cone_pieces(section, count):
    """A cone as so many short cylinders of its diameters in their middle."""
    marks = np.linspace(section.begin, section.end, count + 1).tolist()
    return [
        Section(begin, end, *section.diameters(0.5 * (begin + end)), E, NU, section.density)
        for begin, end in pairwise(marks)
    ]


def test_an_element_of_one_section_is_the_same_by_either_way():
    section, length = CrossSection.annulus(0.05, 0.02, E, NU, RHO), 0.07
    matrices = tapered_element(lambda part: section, length)
    plain = (element_mass(section, length), element_gyroscopic(section, length), element_stiffness(section, length))
    for found, wanted in zip(matrices, plain, strict=True):
        # Round-off of products and quotients of nearly equal size.
        np.testing.assert_allclose(found, wanted, rtol=1e-11, atol=1e-12 * np.max(np.abs(wanted)))


@pytest.mark.parametrize("first", [0.02, 1e-4])
def test_a_cone_bends_under_loads_at_its_end_as_the_closed_form_says(first):
    # A solid cone, by its flexibility: the integrals of x^2/d^4, of 1/d^2 and of 1/d^4 in closed form.
    last, length, force = 0.05, 0.3, 100.0
    body = shaft([Section(0.0, length, first, 0.0, E, NU, RHO, last)], largest_element=1.0)
    rows = free_rows(body, [f"right.{freedom}" for freedom in BENDING])
    load = np.zeros(len(rows))
    load[0] = force
    moved = np.linalg.solve(body.stiffness[np.ix_(rows, rows)], load)
    slope = (last - first) / length

    def root(power):
        """Integral of the diameter to the power of -power along the cone."""
        return (first ** (1 - power) - last ** (1 - power)) / ((power - 1) * slope)

    moment = (root(2) - 2.0 * first * root(3) + first**2 * root(4)) / slope**2
    bending = 64.0 / (math.pi * E) * moment
    shear = 4.0 / (math.pi * shear_coefficient(0.0, NU) * E / (2.0 * (1.0 + NU))) * root(2)
    # One element: quadrature over ratios of diameters of 2.5 and 500.
    assert moved[0] == pytest.approx(force * (bending + shear), rel=1e-8)
    turned = -64.0 / (math.pi * E) * (root(3) - first * root(4)) / slope
    assert moved[body.coordinates.index("left.theta_z")] == pytest.approx(force * turned, rel=1e-8)


def test_a_long_sharp_cone_has_the_frequency_that_kirchhoff_found():
    # Held at its base: omega = 8.719 sqrt(E I/(rho A))/L^2 with the values of the base (Timoshenko, Vibration Problems
    # in Engineering, 3rd ed., 1955, chapter V.66). The tip is cut at 1e-5, which lowers the
    # frequency by twice that; shear and rotary inertia are small, and the number has four digits.
    diameter, length = 0.1, 10.0
    body = shaft([Section(0.0, length, 1e-6, 0.0, E, NU, RHO, diameter)], freedoms=PLANE, largest_element=0.2)
    found = frequencies(body, ["right.y", "right.theta_z"])[0]
    assert found == pytest.approx(8.719 * math.sqrt(E / RHO) * 0.25 * diameter / length**2, rel=2e-4)


PINNED = tuple(f"{end}.{freedom}" for end in ("left", "right") for freedom in ("y", "z"))


@pytest.mark.slow
def test_a_cone_is_the_limit_of_many_short_cylinders():
    speed, disc = 3000.0, Disc(0.3, Inertia(1.0, 1e-3, 6e-4))
    found = whirls(shaft([CONE], [disc], largest_element=0.01), speed, PINNED)
    found = np.sort(found[np.argsort(np.abs(found))][:6])
    errors = []
    for count in (20, 40):
        values = whirls(shaft(cone_pieces(CONE, count), [disc], largest_element=0.01), speed, PINNED)
        errors.append(np.abs(np.sort(values[np.argsort(np.abs(values))][:6]) / found - 1.0))
    coarse, fine = errors
    # Steps have an error of second order in their length; both have the elements of the cone.
    assert np.all(fine < 2e-4)
    assert np.all(fine < 0.3 * coarse)


def test_a_cone_has_its_mass_and_its_moments_of_inertia():
    body = shaft([CONE], freedoms=("x", *BENDING, "theta_x"), frames={"base": 0.0}, largest_element=0.05)
    order = [FREEDOMS.index(name.partition(".")[2]) for name in body.coordinates[:6]]
    motion = np.vstack([lever_arm((frame.position[0], 0.0, 0.0))[order] for frame in body.line])
    whole = motion.T @ body.mass @ motion
    pieces = [Inertia.cylinder(s.begin, s.end, s.diameter, s.bore, s.density) for s in cone_pieces(CONE, 2000)]
    mass = sum(piece.mass for piece in pieces)
    # Error of second order in the length of 2000 steps.
    assert whole[0, 0] == pytest.approx(mass, rel=1e-6)
    assert CONE.mass == pytest.approx(mass, rel=1e-6)
    assert whole[3, 3] == pytest.approx(sum(piece.polar for piece in pieces), rel=1e-6)
    about = sum(piece.transverse + piece.mass * piece.offset**2 for piece in pieces)
    assert whole[4, 4] == pytest.approx(about, rel=1e-6)
    turning = motion.T @ body.gyroscopic @ motion
    assert turning[4, 5] == pytest.approx(sum(piece.polar for piece in pieces), rel=1e-6)


def test_a_layer_without_stiffness_is_mass_alone():
    bar = round_bar(0.04, 0.5)
    layer = Section(0.2, 0.3, 0.1, 0.04, 0.0, NU, RHO)
    loaded, bare = (shaft(parts, largest_element=0.01) for parts in ([bar, layer], [bar]))
    # Nodes at the ends of the layer are at 0.2 m but for round-off.
    np.testing.assert_allclose(loaded.stiffness, bare.stiffness, rtol=1e-12, atol=1e-12 * np.max(bare.stiffness))
    rings = [Disc(0.2 + 0.005 * (2 * k + 1), Inertia.cylinder(-0.005, 0.005, 0.1, 0.04, RHO)) for k in range(10)]
    discs = shaft([bar], rings, largest_element=0.005)
    for speed in (0.0, 2000.0):
        found, wanted, light = (np.sort(np.abs(whirls(body, speed, PINNED)))[:6] for body in (loaded, discs, bare))
        # Ten discs in place of a layer: second order in their width against waves of 0.3 m and more.
        np.testing.assert_allclose(found, wanted, rtol=1e-3)
        assert np.all(np.abs(found / light - 1.0) > 1e-2)


def test_a_disc_without_moments_of_inertia_is_a_point_mass():
    # A light shaft with a mass in its middle: the frequency of a spring of 48 E I/L^3 with shear.
    length, section = 1.0, CrossSection.annulus(0.02, 0.0, E, NU, LIGHT)
    body = shaft([round_bar(0.02, length, LIGHT)], [Disc(0.5 * length, Inertia(5.0, 0.0, 0.0))], largest_element=0.5)
    found = frequencies(body, PINNED)[0]
    softness = length**3 / (48.0 * section.bending) + length / (4.0 * section.shear)
    # The mass of the shaft.
    assert found == pytest.approx(1.0 / math.sqrt(5.0 * softness), rel=1e-5)
