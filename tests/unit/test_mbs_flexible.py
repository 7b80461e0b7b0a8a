"""Finite-element bodies: the model, and the spiders of its interfaces."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from ehdmaps.errors import InputError
from mbs.flexible.finite_elements import FiniteElementModel
from mbs.flexible.reduction import Interface, nearest_node, nodes_in_plane, nodes_on_cylinder, reduce, spider
from mbs.model.body import FREEDOMS
from tests.cases.flexible import SIZE, block, ends, rigid_motion, spring


class TestModel:
    @pytest.mark.parametrize(
        ("changes", "message"),
        [
            ({"nodes": np.array([])}, "nodes: got shape .0,., one a degree of freedom; allowed: at most"),
            ({"directions": np.array([0])}, "directions: got shape"),
            ({"mass": sparse.csc_array((5, 6))}, r"mass: got shape \(5, 6\); allowed: \(6, 6\)"),
            ({"positions": np.zeros((2, 2))}, "positions: got shape"),
            ({"stiffness": sparse.csc_array(np.full((6, 6), np.nan))}, "stiffness: got entries that are no finite"),
            (
                {"stiffness": sparse.csc_array(np.triu(np.ones((6, 6))))},
                "stiffness: is not symmetric: entries differ by 1",
            ),
            (
                {"directions": np.array([0, 1, 7, 0, 1, 2])},
                "directions: node 1 direction 7: got a direction that is none",
            ),
            ({"directions": np.array([0, 1, 1, 0, 1, 2])}, "nodes: node 1 direction 1: is there twice"),
            ({"numbers": np.array([1, 1])}, "numbers: a node has two positions"),
            ({"positions": np.full((2, 3), np.inf)}, "that are no finite numbers, or too large ones, at nodes 1, 2"),
            ({"stiffness": sparse.csc_array(-np.eye(6))}, "stiffness: has a negative diagonal"),
            ({"stiffness": sparse.csc_array(np.fliplr(np.eye(6)))}, "or entries larger than their diagonals allow"),
            (
                {"stiffness": sparse.csc_array(np.diag([1.0, 1, 1, 1, 1, 0]))},
                "stiffness: node 2 direction 2: no stiffness",
            ),
            (
                {"mass": sparse.csc_array(np.diag([1.0, 1, 1, 1, 1, 0]))},
                "mass: node 2 direction 2: no mass.*condense it",
            ),
            (
                {"stiffness": sparse.csc_array(np.diag([1.0, 1, 1, 0, 0, 0]))},
                "node 2 direction 2: no stiffness; .* a lumped mass is joined to nothing",
            ),
            (
                {"mass": sparse.csc_array(np.diag([1.0, 1, 1, 1, 0, 0])), "directions": np.array([0, 1, 2, 0, 4, 5])},
                "node 2 direction 4, node 2 direction 5: no mass.* rotations of shells, beams and lumped masses",
            ),
            (
                {
                    "stiffness": sparse.csc_array(np.diag([1.0, 1, 1, 1, 1, 0])),
                    "directions": np.array([0, 1, 2, 0, 1, 5]),
                },
                "node 2 direction 5: no stiffness; .* shells have none about their normal",
            ),
        ],
    )
    def test_slips(self, changes, message):
        with pytest.raises(InputError, match=message):
            FiniteElementModel(**(spring() | changes))

    def test_knows_its_rows(self):
        model = FiniteElementModel(**spring())
        assert (model.size, model.row(2, 1), model.row(2, 3), model.row(9, 0)) == (6, 4, None, None)
        assert model.position(2) == pytest.approx([0.1, 0.0, 0.0])


class TestSpiders:
    @pytest.mark.parametrize(
        ("changes", "message"),
        [
            ({"position": np.zeros(2)}, "position: got"),
            ({"position": np.array([0.0, np.nan, 0.0])}, "position: got"),
            ({"nodes": np.zeros(0)}, "allowed: a list of at least one node"),
            ({"nodes": np.array([1, 1])}, "a node is there twice"),
            ({"kind": "loose"}, "kind: got 'loose'; allowed: rigid, averaging"),
            ({"freedoms": ()}, "freedoms: got"),
            ({"freedoms": ("x", "x")}, "freedoms: got"),
            ({"freedoms": ("q",)}, "freedoms: got"),
            ({"weights": np.array([1.0])}, "weights: got shape"),
            ({"weights": np.array([1.0, -1.0, 1.0])}, "weights: got shape"),
        ],
    )
    def test_slips(self, changes, message):
        given = {"position": np.zeros(3), "nodes": np.array([1, 2, 3])}
        with pytest.raises(InputError, match=message):
            Interface(**(given | changes))

    @pytest.mark.parametrize(
        ("nodes", "kind", "message"),
        [
            ([1, 999], "averaging", "nodes: node 999 without a position"),
            ([1], "averaging", "got one, which does not say how the place turns"),
            ([1, 2, 3, 4, 5], "averaging", "got 5 on a line"),
            ([1, 2], "rigid", "got 2 on a line"),
        ],
    )
    def test_nodes_that_do_not_say_how_a_place_turns(self, nodes, kind, message):
        model = block(elements=(4, 2, 2))
        line = np.sort(model.numbers[(model.positions[:, 1:] == 0.0).all(axis=1)])
        chosen = [int(line[n - 1]) if n < 999 else n for n in nodes]
        with pytest.raises(InputError, match=message):
            spider(model, "seat", Interface(np.zeros(3), np.array(chosen), kind))

    def test_fixed_nodes_are_none(self):
        model = block(fixed=True)
        node = int(model.numbers[np.argmin(np.abs(model.positions).sum(axis=1))])
        with pytest.raises(
            InputError, match=f"'seat', nodes: node {node} without displacements in the matrices: fixed"
        ):
            spider(model, "seat", Interface(np.zeros(3), np.array([node])))

    @pytest.mark.parametrize("kind", ["rigid", "averaging"])
    def test_weights_draw_the_mean(self, kind):
        model = block()
        nodes = ends(model)["right"].nodes
        weights = np.linspace(1.0, 5.0, nodes.size)
        place = spider(model, "seat", Interface(np.array([0.2, 0.0, 0.0]), nodes, kind, FREEDOMS, weights))
        # Rigid motion is found whatever the weights.
        assert place.mean @ rigid_motion(model, (0.2, 0.0, 0.0))[place.rows] == pytest.approx(np.eye(6), abs=1e-10)
        # The weighted sum of the nodes' displacements that are not rigid vanishes: normal equations.
        u = np.random.default_rng(1).standard_normal(place.rows.size)
        rest = u - place.rigid @ (place.mean @ u)
        assert place.rigid.T @ (np.repeat(weights, 3) * rest) == pytest.approx(np.zeros(6), abs=1e-10)

    def test_a_single_node_of_a_solid_has_translations(self):
        model = block()
        reduced = reduce(
            model,
            {
                **ends(model),
                "pin": Interface(model.position(20), np.array([20]), "rigid", ("x", "y", "z")),
            },
            cutoff=10e3,
        )
        assert [name for name in reduced.coordinates if name.startswith("pin")] == ["pin.x", "pin.y", "pin.z"]
        assert not reduced.frames["pin"].transform[3:].any()

    def test_nodes_are_found(self):
        model = block()
        assert nodes_in_plane(model, (0.2, 0, 0), (-2.0, 0, 0), 1e-9).size == 9
        assert nodes_in_plane(model, (0.2, 0.025, 0.02), (1, 0, 0), 1e-9, radius=0.021).size == 3
        assert nodes_on_cylinder(model, (0, 0.025, 0.02), (5, 0, 0), 0.02, 0.0, 0.1, 1e-9).size == 6
        node = nearest_node(model, (0.19, 0.05, 0.05))
        assert model.position(node) == pytest.approx(SIZE)
        with pytest.raises(InputError, match="no node of the mesh has displacements"):
            nearest_node(FiniteElementModel(**(spring() | {"numbers": np.array([7, 8])})), (0, 0, 0))
