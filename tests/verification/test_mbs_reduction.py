"""Reduced bodies against the full finite-element model, closed forms, second methods, and CalculiX itself."""

from __future__ import annotations

import subprocess

import numpy as np
import pytest
from scipy import linalg, sparse
from scipy.sparse.linalg import spsolve

from ehdmaps.errors import AnalysisError, InputError
from mbs.flexible import held_body
from mbs.flexible.finite_elements import FiniteElementModel, extent
from mbs.flexible.matrix_files import read_calculix
from mbs.flexible.mesh_files import read_mesh_nodes
from mbs.flexible.reduced_body import to_body
from mbs.flexible.reduction import Interface, nodes_in_plane, nodes_on_cylinder, reduce, spider
from mbs.linearised.reduction import undamped_part
from mbs.model.system import System
from tests.cases.flexible import DENSITY, SIZE, block, ends, rigid_motion
from tests.cases.programs import needed

ROUND_OFF = 1e-8
"""Of factors and eigenvalues of bodies whose stiffnesses span ten orders of magnitude."""

CUTOFF = 40e3


def frequencies(stiffness, mass):
    squares = linalg.eigh(stiffness, mass, eigvals_only=True)
    return np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi)


def full(model):
    return frequencies(model.stiffness.toarray(), model.mass.toarray())


def truncation(reduced, cutoff):
    """Bound of the relative error of the frequencies, to first order.

    A mode k that was left out would take lambda^2 (m_k q)^2/(lambda_k - lambda) from the stiffness that the interfaces
    feel, lambda_k > lambda_c. The masses m_k m_k' of all that were left out add up to no more than what the kept ones
    leave of the static shapes' mass. For a mode of unit modal mass half of that, over lambda, is the error.
    """
    squares, shapes = linalg.eigh(reduced.stiffness, reduced.mass)
    count = sum(unit != "1" for unit in reduced.units)
    coupling = reduced.mass[:count, count:]
    left = reduced.mass[:count, :count] - coupling @ coupling.T
    q = shapes[:count]
    share = np.einsum("ik,ij,jk->k", q, left, q)
    limit = (2.0 * np.pi * cutoff) ** 2
    below = squares < 0.5 * limit
    return 0.5 * squares[below] / (limit - squares[below]) * share[below]


@pytest.mark.parametrize("kind", ["rigid", "averaging"])
@pytest.mark.parametrize("fixed", [False, True])
def test_frequencies_below_half_the_cutoff_and_how_wrong_they_are_told_to_be(fixed, kind):
    model = block(fixed=fixed)
    interfaces = ends(model, kind)
    exact = full(model) if kind == "averaging" else full_with_rigid_ends(model, interfaces)
    reduced = reduce(model, interfaces, cutoff=CUTOFF)
    found = frequencies(reduced.stiffness, reduced.mass)
    rigid = 0 if fixed else 6
    below = int(np.sum(exact < 0.5 * CUTOFF))
    assert below >= rigid + 4
    error = found[rigid:below] / exact[rigid:below] - 1.0
    # Terms of second order are a part of the size of the error itself.
    bound = truncation(reduced, CUTOFF)[rigid:below] * (1.0 + 2.0 * np.max(error))
    assert np.all(error < bound + ROUND_OFF)
    assert np.max(bound) < 0.1  # a bound that says something
    # What is told with modes of a machine is the error itself, but for terms of second order.
    system = System([to_body(reduced, "block")])
    _, shapes = linalg.eigh(reduced.stiffness, reduced.mass)
    told = -undamped_part(system, found[rigid:below], shapes[:, rigid:below])
    assert np.max(told) > 1e-3
    np.testing.assert_allclose(told, error, rtol=0.4, atol=ROUND_OFF)
    # Rayleigh: a reduced body is never softer than the full one.
    assert np.all(found[rigid:] > exact[rigid : reduced.size] * (1.0 - ROUND_OFF))
    # What is free stays free: rounding of the highest frequency only.
    assert np.all(found[:rigid] < 1e-6 * found[-1])


def full_with_rigid_ends(model, interfaces):
    """Frequencies of the full model with rigid end faces, by a dense transform."""
    spiders = [spider(model, name, entry) for name, entry in interfaces.items()]
    others = np.setdiff1d(np.arange(model.size), np.concatenate([entry.rows for entry in spiders]))
    transform = np.zeros((model.size, others.size + 6 * len(spiders)))
    transform[others, np.arange(others.size)] = 1.0
    for k, entry in enumerate(spiders):
        transform[entry.rows, others.size + 6 * k : others.size + 6 * k + 6] = entry.rigid
    return frequencies(transform.T @ (model.stiffness @ transform), transform.T @ (model.mass @ transform))


def test_more_modes_come_closer_to_the_full_model():
    model = block()
    exact = full(model)[6:12]
    errors = []
    for cutoff in (20e3, 40e3, 80e3):
        reduced = reduce(model, ends(model), cutoff=cutoff)
        errors.append(np.max(frequencies(reduced.stiffness, reduced.mass)[6:12] / exact - 1.0))
    # lambda/lambda_c falls by 4 where the cut-off doubles, and the mass that is left falls too.
    assert errors[1] < errors[0] / 4.0
    assert errors[2] < errors[1] / 4.0


@pytest.mark.parametrize("kind", ["rigid", "averaging"])
def test_static_loads_on_interfaces_are_exact(kind):
    model = block(fixed=True)
    right = ends(model, kind)["right"]
    place = spider(model, "right", right)
    reduced = reduce(model, {"right": right}, {"tip": (SIZE[0], SIZE[1], SIZE[2])}, cutoff=1000.0)
    assert reduced.size == 6
    for load in np.eye(6):
        if kind == "averaging":
            force = np.zeros(model.size)
            force[place.rows] = place.mean.T @ load
            u = spsolve(model.stiffness, force)
            displacement, tip = place.mean @ u[place.rows], u
        else:
            others = np.setdiff1d(np.arange(model.size), place.rows)
            transform = np.zeros((model.size, others.size + 6))
            transform[others, np.arange(others.size)] = 1.0
            transform[place.rows, others.size :] = place.rigid
            q = np.linalg.solve(transform.T @ (model.stiffness @ transform), np.r_[np.zeros(others.size), load])
            displacement, tip = q[others.size :], transform @ q
        found = np.linalg.solve(reduced.stiffness, load)
        assert found == pytest.approx(displacement, rel=ROUND_OFF, abs=ROUND_OFF * np.max(np.abs(displacement)))
        node = int(model.numbers[np.argmin(np.linalg.norm(model.positions - np.array(SIZE), axis=1))])
        there = [tip[model.row(node, d)] for d in range(3)]
        assert (reduced.frames["tip"].transform @ found)[:3] == pytest.approx(there, rel=ROUND_OFF, abs=1e-17)


@pytest.mark.parametrize("kind", ["rigid", "averaging"])
def test_mass_and_inertia_of_a_block(kind):
    model = block()
    reduced = reduce(model, ends(model, kind), cutoff=5000.0)
    centre = np.array(SIZE) / 2.0
    motion = np.zeros((reduced.size, 6))
    for k, name in enumerate(("left", "right")):
        x, y, z = reduced.frames[name].position - centre
        motion[6 * k : 6 * k + 6] = np.eye(6)
        motion[6 * k : 6 * k + 3, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
    mass = DENSITY * np.prod(SIZE)
    a, b, c = SIZE
    inertia = mass / 12.0 * np.array([b**2 + c**2, a**2 + c**2, a**2 + b**2])
    # Trilinear bricks hold rigid motion exactly, and so does every spider.
    assert motion.T @ reduced.mass @ motion == pytest.approx(
        np.diag([mass, mass, mass, *inertia]), rel=ROUND_OFF, abs=ROUND_OFF * mass * a
    )
    assert np.max(np.abs(reduced.stiffness @ motion)) < ROUND_OFF * np.max(reduced.stiffness[:12, :12])


def test_rigid_interfaces_stiffen_and_averaging_ones_do_not():
    model = block(fixed=True)
    exact = full(model)
    soft, hard = (reduce(model, {"right": ends(model, kind)["right"]}, cutoff=200e3) for kind in ("averaging", "rigid"))
    # With all modes that matter the averaging interface leaves the body as it is; the bound is that of the truncation.
    found = frequencies(soft.stiffness, soft.mass)[:6]
    assert np.all(found / exact[:6] - 1.0 < 1.1 * truncation(soft, 200e3)[:6] + ROUND_OFF)
    # Constraints raise every frequency, and every static stiffness.
    assert np.all(frequencies(hard.stiffness, hard.mass)[:6] > found * (1.0 + ROUND_OFF))
    assert np.linalg.eigvalsh(hard.stiffness[:6, :6] - soft.stiffness[:6, :6])[0] > 0.0


def test_averaging_against_a_null_space():
    """The same reduction by another road: conditions eliminated by a dense basis of their null space."""
    model = block(elements=(3, 2, 1))
    interfaces = ends(model)
    reduced = reduce(model, interfaces, cutoff=30e3)
    stiffness, mass = model.stiffness.toarray(), model.mass.toarray()
    rows = np.zeros((12, model.size))
    for k, (name, entry) in enumerate(interfaces.items()):
        place = spider(model, name, entry)
        rows[6 * k : 6 * k + 6, place.rows] = place.mean
    inside = linalg.null_space(rows)
    squares, shapes = linalg.eigh(inside.T @ stiffness @ inside, inside.T @ mass @ inside)
    kept = squares < (2.0 * np.pi * 30e3) ** 2
    particular = np.linalg.pinv(rows)
    static = particular - inside @ np.linalg.solve(inside.T @ stiffness @ inside, inside.T @ stiffness @ particular)
    assert reduced.size == 12 + int(kept.sum())
    assert np.diag(reduced.stiffness)[12:] == pytest.approx(squares[kept], rel=ROUND_OFF)
    scale = np.sqrt(np.outer(*(2 * [np.diag(static.T @ stiffness @ static)])))
    assert reduced.stiffness[:12, :12] / scale == pytest.approx(static.T @ stiffness @ static / scale, abs=ROUND_OFF)
    assert reduced.mass[:12, :12] == pytest.approx(static.T @ mass @ static, rel=1e-7, abs=ROUND_OFF)
    # Signs of modes are free.
    coupling = np.abs(static.T @ mass @ inside @ shapes[:, kept])
    assert np.abs(reduced.mass[:12, 12:]) == pytest.approx(coupling, abs=1e-7)


def test_lanczos_finds_what_the_dense_solver_finds(monkeypatch):
    model = block(elements=(5, 2, 2), size=(0.2, 0.05, 0.05))  # square: every bending mode is there twice
    bodies = []
    for largest in (0, 10**6):
        monkeypatch.setattr(held_body, "_DENSE", largest)
        bodies.append(reduce(model, ends(model), {"top": (0.12, 0.05, 0.025)}, cutoff=60e3))
    sparse_way, dense_way = bodies
    assert sparse_way.coordinates == dense_way.coordinates
    assert sparse_way.size > 32  # more modes than were asked for at first
    assert np.diag(sparse_way.stiffness)[12:] == pytest.approx(np.diag(dense_way.stiffness)[12:], rel=ROUND_OFF)
    found, expected = (frequencies(body.stiffness, body.mass)[6:] for body in bodies)
    assert found == pytest.approx(expected, rel=ROUND_OFF)


@pytest.fixture
def by_lanczos(monkeypatch):
    """A held block whose modes are not computed all at once, with interfaces held in the mean."""
    monkeypatch.setattr(held_body, "_DENSE", 0)
    model = block(elements=(5, 2, 2), size=(0.2, 0.05, 0.05))
    averages = np.zeros((12, model.size))
    for k, (name, interface) in enumerate(ends(model).items()):
        place = spider(model, name, interface)
        averages[6 * k : 6 * k + 6, place.rows] = place.mean
    return held_body.HeldBody(model.stiffness, model.mass, averages, model.nodes, 40e3)


def test_a_mode_that_was_passed_over_is_seen(by_lanczos):
    """Each one, of a square section, whose bending modes are pairs of one frequency."""
    shapes = by_lanczos.shapes
    assert shapes.shape[1] > 10 and np.any(np.diff(by_lanczos.squares) < 1e-6 * by_lanczos.squares[1:])
    assert not by_lanczos._passed_over(shapes)
    for k in range(shapes.shape[1]):
        assert by_lanczos._passed_over(np.delete(shapes, k, axis=1))


@pytest.mark.parametrize("times", [1, 9])
def test_a_mode_that_lanczos_hides_is_missed(monkeypatch, times):
    """Hidden once, it is found by a search for more modes; hidden always, it is said."""
    model = block(elements=(5, 2, 2), size=(0.2, 0.05, 0.05))
    monkeypatch.setattr(held_body, "_DENSE", 0)
    whole = reduce(model, ends(model), cutoff=10e3)
    search, hidden = held_body.eigsh, []

    def forgetful(stiffness, wanted, **keywords):
        squares, shapes = search(stiffness, wanted, **keywords)
        first = int(wanted > 1 and len(hidden) < times)
        hidden.extend([0] * first)
        return squares[first:], shapes[:, first:]

    monkeypatch.setattr(held_body, "eigsh", forgetful)
    if times > 1:
        with pytest.raises(AnalysisError, match="modes of the held body were passed over"):
            reduce(model, ends(model), cutoff=10e3)
        return
    found = reduce(model, ends(model), cutoff=10e3)
    assert np.diag(found.stiffness)[12:] == pytest.approx(np.diag(whole.stiffness)[12:], rel=ROUND_OFF)


def test_a_large_body_is_reduced_as_a_small_one(monkeypatch):
    """By Cholesky's factor of CHOLMOD as by L and U of SuperLU, to the round-off of both."""
    model = block(elements=(6, 3, 2))
    monkeypatch.setattr(held_body, "_DENSE", 0)
    small = reduce(model, ends(model), cutoff=60e3)
    monkeypatch.setattr(held_body, "MOST_BY_LU", 0)
    large = reduce(model, ends(model), cutoff=60e3)
    assert large.coordinates == small.coordinates
    squares = np.diag(small.stiffness)[12:]
    assert np.diag(large.stiffness)[12:] == pytest.approx(squares, rel=ROUND_OFF)
    found, expected = (frequencies(body.stiffness, body.mass)[6:] for body in (large, small))
    assert found == pytest.approx(expected, rel=ROUND_OFF)


@pytest.mark.parametrize("most", [0, 9])
def test_what_is_not_positive_definite_is_no_body(monkeypatch, most):
    monkeypatch.setattr(held_body, "MOST_BY_LU", most)
    matrix = sparse.csc_array([[2.0, 1.0], [1.0, 2.0]])
    assert held_body.factors(matrix, np.array([1, 0])).solve(np.array([[3.0], [0.0]])) == pytest.approx(
        np.array([[2.0], [-1.0]]), rel=ROUND_OFF
    )
    with pytest.raises(InputError, match="stiffness and mass are not those of a body"):
        held_body.factors(sparse.csc_array([[1.0, 2.0], [2.0, 1.0]]), np.array([1, 0]))


def test_a_bore_seat_turns_as_its_ring_does():
    """A plate with a rigid rotation: the mean of the nodes on a circle is that rotation, wherever the place is."""
    model = block()
    nodes = nodes_on_cylinder(model, (0.0, 0.025, 0.02), (1.0, 0.0, 0.0), np.hypot(0.025, 0.02), 0.0, 0.2, 1e-9)
    assert nodes.size == 4 * 5  # the four long edges
    place = spider(model, "seat", Interface(np.array([0.1, 0.5, -0.3]), nodes))
    moved = rigid_motion(model, about=(0.1, 0.5, -0.3))[place.rows]
    assert place.mean @ moved == pytest.approx(np.eye(6), abs=1e-10)  # lengths of 0.5 m over a spread of 0.05 m


def test_damped_body_in_a_system():
    model = block()
    reduced = reduce(model, ends(model), cutoff=CUTOFF)
    body = to_body(reduced, "block", (1.0, 2.0, 3.0), damping_ratio=0.02)
    squares, shapes = linalg.eigh(body.stiffness, body.mass)
    modal = np.einsum("ik,ij,jk->k", shapes, body.damping, shapes)[6:]
    assert modal == pytest.approx(2.0 * 0.02 * np.sqrt(squares[6:]), rel=1e-6)  # rounding, times the span of the modes
    assert body.frames["right"].position == pytest.approx([1.2, 2.025, 3.02])
    assert not body.gyroscopic.any()


DECK = """*NODE, NSET=NALL
{nodes}
*ELEMENT, TYPE=C3D8, ELSET=EALL
{elements}
*MATERIAL, NAME=STEEL
*ELASTIC
2.1E11, 0.3
*DENSITY
7850.
*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL
*BOUNDARY
{fixed}
*STEP
*FREQUENCY{matrices}
8
*END STEP
"""


def deck(matrices):
    """A block of 6 x 2 x 2 bricks, clamped at x = 0; node numbers with gaps."""
    counts, size = (6, 2, 2), (0.2, 0.05, 0.04)

    def number(i, j, k):
        return 10 * (1 + i + (counts[0] + 1) * (j + (counts[1] + 1) * k))

    points = [(i, j, k) for k in range(counts[2] + 1) for j in range(counts[1] + 1) for i in range(counts[0] + 1)]
    cells = [(i, j, k) for k in range(counts[2]) for j in range(counts[1]) for i in range(counts[0])]
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    return DECK.format(
        nodes="\n".join(
            f"{number(*p)}, " + ", ".join(f"{p[d] * size[d] / counts[d]:.9g}" for d in range(3)) for p in points
        ),
        elements="\n".join(
            f"{n}, " + ", ".join(str(number(c[0] + a, c[1] + b, c[2] + e)) for a, b, e in corners)
            for n, c in enumerate(cells, start=1)
        ),
        fixed="\n".join(f"{number(*p)}, 1, 3" for p in points if p[0] == 0),
        matrices=", SOLVER=MATRIXSTORAGE" if matrices else "",
    )


def test_matrices_of_calculix_have_its_frequencies(tmp_path):
    ccx = needed("ccx")
    for name, matrices in (("stored", True), ("solved", False)):
        (tmp_path / f"{name}.inp").write_text(deck(matrices))
        subprocess.run([ccx, name], cwd=tmp_path, check=True, capture_output=True, timeout=60)
    lines = [line.split() for line in (tmp_path / "solved.dat").read_text().splitlines()]
    own = np.array([float(words[3]) for words in lines if len(words) == 5 and words[0].isdigit()])[:8]
    mesh = tmp_path / "stored.inp"
    model = read_calculix(*(tmp_path / f"stored.{end}" for end in ("sti", "mas", "dof")), read_mesh_nodes(mesh))
    assert model.size == 3 * 6 * 9  # without the clamped nodes
    # Their neighbours' shapes, squared, are a third in the mean over the first of six rows; eight digits again.
    assert extent(model).mass == pytest.approx(7850.0 * 0.2 * 0.05 * 0.04 * (1.0 - 2.0 / 3.0 / 6.0), rel=1e-6)
    # CalculiX prints eight digits.
    assert full(model)[:8] == pytest.approx(own, rel=1e-6)
    tip = Interface(np.array([0.2, 0.025, 0.02]), nodes_in_plane(model, (0.2, 0.0, 0.0), (1.0, 0.0, 0.0), 1e-6))
    reduced = reduce(model, {"tip": tip}, cutoff=40e3)
    below = own[own < 20e3]
    error = frequencies(reduced.stiffness, reduced.mass)[: below.size] / below - 1.0
    assert below.size >= 6
    assert np.all(np.abs(error) < 1.1 * truncation(reduced, 40e3)[: below.size] + 1e-6)


def test_kept_freedoms_leave_the_others_to_the_body():
    """A rigid end whose rotations are no coordinates: they are condensed, which changes no frequency."""
    model = block(fixed=True)
    right = ends(model, "rigid")["right"]
    few = Interface(right.position, right.nodes, "rigid", ("z", "y"))
    all_six, two = (reduce(model, {"right": entry}, cutoff=400e3) for entry in (right, few))
    assert two.coordinates[:3] == ("right.y", "right.z", "mode 1")
    found, expected = (frequencies(body.stiffness, body.mass)[:5] for body in (two, all_six))
    assert found == pytest.approx(expected, rel=1e-4)  # truncation at 400 kHz of modes below 25 kHz: (1/16)^4
    # The rotations are still seen at the place.
    tilt = two.frames["right"].transform[3:] @ np.linalg.solve(two.stiffness, np.eye(two.size)[0])
    expected = np.linalg.solve(all_six.stiffness, np.eye(all_six.size)[1])[3:6]
    assert tilt == pytest.approx(expected, abs=1e-4 * np.max(np.abs(expected)))


def test_one_row_for_each_degree_of_freedom_of_a_beam_node():
    """Two nodes with rotations, joined by an exact beam: a rigid interface of one node is that node."""
    length, area, inertia = 0.3, 1e-3, 1e-7
    e, g, rho = 2.1e11, 8e10, 7850.0
    k = np.zeros((12, 12))
    for (a, b), value in {(0, 0): e * area / length, (3, 3): g * 2 * inertia / length}.items():
        for s, t, sign in ((0, 0, 1), (6, 6, 1), (0, 6, -1), (6, 0, -1)):
            k[a + s, b + t] += sign * value
    for w, th, sign in ((1, 5, 1.0), (2, 4, -1.0)):
        index = [w, th, w + 6, th + 6]
        flip = np.diag([1.0, sign, 1.0, sign])
        one = np.array([[12, 6 * length, -12, 6 * length], [0, 4 * length**2, -6 * length, 2 * length**2]])
        bend = np.zeros((4, 4))
        bend[:2] = one
        bend[1, 0] = 6 * length
        bend[2] = -bend[0]
        bend[3] = [6 * length, 2 * length**2, -6 * length, 4 * length**2]
        k[np.ix_(index, index)] += e * inertia / length**3 * flip @ bend @ flip
    m = np.diag(np.tile([*3 * [rho * area * length / 2], *3 * [1e-5]], 2))
    model = FiniteElementModel(
        sparse.csc_array(k),
        sparse.csc_array(m),
        np.repeat([1, 2], 6),
        np.tile(np.arange(6), 2),
        np.array([1, 2]),
        np.array([[0.0, 0.0, 0.0], [length, 0.0, 0.0]]),
    )
    ends_of_it = {
        name: Interface(np.array([x, 0.0, 0.0]), np.array([node]), "rigid")
        for name, node, x in (("a", 1, 0.0), ("b", 2, length))
    }
    reduced = reduce(model, ends_of_it, {"end": 2}, cutoff=1000.0)
    assert reduced.size == 12
    # Entries that cancel to zero are rounding of the largest.
    assert reduced.stiffness == pytest.approx(k, rel=ROUND_OFF, abs=1e-14 * np.max(k))
    assert reduced.mass == pytest.approx(m, rel=ROUND_OFF)
    assert reduced.frames["end"].transform == pytest.approx(np.eye(12)[6:], abs=1e-12)
