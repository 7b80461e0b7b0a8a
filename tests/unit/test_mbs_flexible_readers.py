"""Matrices and meshes of other programs, and the command that reduces them."""

from __future__ import annotations

import meshio
import numpy as np
import pytest
from scipy import io, sparse

from ehdmaps.errors import DependencyError, InputError
from mbs.flexible.apart import run_apart
from mbs.flexible.finite_elements import NodePositions
from mbs.flexible.matrix_files import (
    Labelled,
    assemble_model,
    check_deck,
    read_abaqus_matrix,
    read_calculix,
    read_dof_table,
    read_dofs,
    read_matrix_market,
    read_triplets,
    without_fixed,
)
from mbs.flexible.mesh_files import read_mesh_nodes
from tests.cases.flexible import written

ROUND_OFF = 1e-12


@pytest.fixture
def files(tmp_path):
    return written(tmp_path)


def same(found, model):
    order = np.lexsort((model.directions, model.nodes))
    assert np.array_equal(found.nodes, 10 * model.nodes[order])
    for name in ("stiffness", "mass"):
        expected = getattr(model, name).toarray()[np.ix_(order, order)]
        # Two texts of 17 digits, and factors of 1000.
        assert getattr(found, name).toarray() == pytest.approx(expected, rel=1e-14)
    assert found.positions == pytest.approx(model.positions, rel=1e-14)


class TestReaders:
    def test_the_same_body_from_every_format(self, files):
        folder, model = files
        mesh = read_mesh_nodes(folder / "m.inp")
        same(read_calculix(folder / "b.sti", folder / "b.mas", folder / "b.dof", mesh), model)
        labelled = [read_matrix_market(folder / f"{name}.mtx", folder / "dofs.txt") for name in "km"]
        same(assemble_model(*labelled, mesh), model)
        labelled = [read_abaqus_matrix(folder / f"{name}_abaqus.mtx") for name in "km"]
        same(assemble_model(*without_fixed(*labelled), read_mesh_nodes(folder / "mm.inp"), "mm-t-s"), model)
        labelled = [read_abaqus_matrix(folder / name, folder / "dofs.txt") for name in ("b.sti", "b.mas")]
        same(assemble_model(*labelled, mesh), model)

    def test_a_whole_matrix_is_taken_as_it_is(self, tmp_path):
        path = tmp_path / "a.sti"
        path.write_text("1 1 2.0\n1 2 -1.0\n2 1 -1.0\n2 2 2.0\n")
        found = read_triplets(path, np.array([1, 1]), np.array([0, 1]))
        assert found.matrix.toarray().tolist() == [[2.0, -1.0], [-1.0, 2.0]]

    def test_shells_of_calculix(self, files):
        """CalculiX makes solids of them, whose nodes the deck does not have."""
        folder, _ = files
        (folder / "b.dof").write_text((folder / "b.dof").read_text().replace("120.", "125."))
        with pytest.raises(
            InputError, match=r"b.dof: got node 125, which the mesh has not; .* shells, beams and plane"
        ):
            read_calculix(folder / "b.sti", folder / "b.mas", folder / "b.dof", read_mesh_nodes(folder / "m.inp"))

    def test_fixed_degrees_of_freedom_of_abaqus_are_left_out(self):
        labels = np.array([1, 1, 2]), np.array([0, 1, 0])
        stiffness = Labelled(sparse.csc_array(np.diag([1e36, 2.0, 3.0])), *labels)
        kept, mass = without_fixed(stiffness, Labelled(sparse.csc_array(np.eye(3)), *labels))
        assert kept.matrix.toarray().tolist() == [[2.0, 0.0], [0.0, 3.0]]
        assert (mass.nodes.tolist(), mass.directions.tolist()) == ([1, 2], [1, 0])

    def test_rotations_in_millimetres(self):
        one = sparse.csc_array(np.ones((2, 2)) + np.eye(2))
        entry = Labelled(one, np.array([1, 1]), np.array([0, 3]))
        model = assemble_model(entry, entry, NodePositions(np.array([1]), np.array([[1.0, 2.0, 3.0]])), "mm-t-s")
        # N/mm, N/rad, N mm/rad; tonne, tonne mm, tonne mm2.
        assert model.stiffness.toarray() == pytest.approx(np.array([[2e3, 1.0], [1.0, 2e-3]]), rel=ROUND_OFF)
        assert model.positions == pytest.approx(np.array([[1e-3, 2e-3, 3e-3]]), rel=ROUND_OFF)
        with pytest.raises(InputError, match="units: got 'inch'; allowed: SI, mm-t-s"):
            assemble_model(entry, entry, NodePositions(np.array([1]), np.zeros((1, 3))), "inch")
        other = Labelled(one, np.array([1, 2]), np.array([0, 0]))
        with pytest.raises(
            InputError, match="node 1 direction 4, node 2 direction 1 in only one of stiffness and mass"
        ):
            assemble_model(entry, other, NodePositions(np.array([1]), np.zeros((1, 3))))

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("", "has no numbers"),
            ("1 1\n", "line 1: got '1 1'; allowed: 3 numbers a line"),
            ("1 1 2.0\n1 2\n", "line 2: got '1 2'; allowed: 3 numbers a line"),
            ("1 1 2.0\n\nx 2 1.0\n", "line 3: got 'x 2 1.0'"),
            ("1 1 nan\n", "line 1: got '1 1 nan'; allowed: finite numbers"),
            ("1 1 1\n1 1e30 1\n", "line 2: got '1 1e30 1'; allowed: whole numbers"),
            ("1 1.5 1\n", "line 1: got '1 1.5 1'; allowed: whole numbers"),
            ("1 1 1\n1 3 1\n", "line 2: got '1 3 1'; allowed: rows and columns from 1 to 2"),
            ("0 1 1\n", "allowed: rows and columns from 1 to 2"),
            ("1 1 1\n1 1 1\n", "line 2: got '1 1 1'; an entry that is there twice"),
            ("1 1 1\n2 1 1\n1 2 1\n2 2 1\n1 3 1\n", "allowed: rows and columns"),
            ("1 1 1\n1 2 5\n2 1 5\n2 2 1\n\x00\n", "line 5"),
        ],
    )
    def test_triplets_that_are_none(self, tmp_path, text, message):
        path = tmp_path / "a.sti"
        path.write_text(text)
        with pytest.raises(InputError, match=message):
            read_triplets(path, np.array([1, 1]), np.array([0, 1]))

    def test_halves_that_are_mixed(self, tmp_path):
        path = tmp_path / "a.sti"
        path.write_text("1 1 1\n1 2 5\n2 1 5\n1 3 4\n")
        with pytest.raises(InputError, match="line 4: got '1 3 4'; an entry without its mirror image"):
            read_triplets(path, np.array([1, 1, 1]), np.array([0, 1, 2]))

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("1,1,1,1\n", "allowed: 5 numbers a line"),
            ("-3,1,1,1,5.0\n", "line 1: got '-3,1,1,1,5.0'; allowed: node numbers from 1; Abaqus gives"),
            ("1,1,1,1,5.0\n1,8,1,1,5.0\n", "line 2: got '1,8,1,1,5.0'; allowed: directions 1 to 3"),
        ],
    )
    def test_abaqus_slips(self, tmp_path, text, message):
        path = tmp_path / "a.mtx"
        path.write_text(text)
        with pytest.raises(InputError, match=message):
            read_abaqus_matrix(path)

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("1.1\n1.9\n", "line 2: got '1.9'; allowed: a node from 1 and a direction from 1 to 6"),
            ("1.1\n1.1\n", "line 2: got '1.1'; which is there twice"),
            ("12\n", "line 1: got '12'; allowed: \"node.direction\""),
            ("1e1\n", 'allowed: "node.direction"'),
            ("99999999999999999999.1\n", "allowed: a node from 1"),
            ("a.1\n", "allowed: 1 numbers a line"),
        ],
    )
    def test_dof_files_that_are_none(self, tmp_path, text, message):
        path = tmp_path / "a.dof"
        path.write_text(text)
        with pytest.raises(InputError, match=message):
            read_dofs(path)

    def test_dof_files(self, tmp_path, monkeypatch):
        path = tmp_path / "a.dof"
        path.write_text("120.1\n7.3\n")
        assert [entry.tolist() for entry in read_dofs(path)] == [[120, 7], [0, 2]]
        path.write_text("7 4\n")
        assert [entry.tolist() for entry in read_dof_table(path)] == [[7], [3]]
        monkeypatch.setattr("mbs.flexible.finite_elements.MOST_FREEDOMS", 0)
        with pytest.raises(InputError, match="got 1 degrees of freedom; allowed: at most"):
            read_dof_table(path)

    def test_matrix_market_slips(self, files):
        folder, _ = files
        dofs, path = folder / "dofs.txt", folder / "x.mtx"
        text = (folder / "k.mtx").read_text()
        size = next(line for line in text.splitlines() if not line.startswith("%"))
        for content, message in (
            ("nothing", "is no Matrix Market file"),
            ("%%MatrixMarket matrix coordinate complex general\n36 36 1\n1 1 1 0\n", "got 'complex' entries"),
            ("%%MatrixMarket matrix coordinate real general\n5 5 1\n1 1 1\n", "got 5 rows and 5 columns"),
            (text.replace(size, "36 36 999999999"), "promises 999999999 entries"),
            (text[: len(text) // 2], "promises|its last line has no end"),
            (text[:-5], "its last line has no end"),
            (text.rstrip().rpartition("\n")[0] + "\n36 36 x\n", "got '36 36 x'; allowed: 3 numbers a line"),
            (text.replace("general", "skew-symmetric").replace("symmetric", "hermitian", 1), "got 'coordinate herm"),
        ):
            path.write_text(content)
            with pytest.raises(InputError, match=message):
                read_matrix_market(path, dofs)
        with pytest.raises(InputError, match=r"gone.mtx: cannot be read .*No such file"):
            read_matrix_market(folder / "gone.mtx", dofs)

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("symmetric\n2 2 3\n1 1 2\n2 2 2\n1 1 5\n", "line 5: got '1 1 5'; an entry that is there twice"),
            ("symmetric\n2 2 2\n1 1 2.0D+01\n2 2 2\n", "line 3: got '1 1 2.0D.01'; allowed: 3 numbers"),
            ("symmetric\n2 2 1\n1 1 2 2 2 2\n", "line 3: got '1 1 2 2 2 2'; allowed: 3 numbers a line"),
            ("symmetric\n2 2 1\n1 1 2\n2 2 2\n", "promises 1 entries, and the file has 2"),
            ("symmetric\n2 2 2\n1 1 2\n3 2 2\n", "line 4: got '3 2 2'; allowed: rows and columns from 1 to 2"),
        ],
    )
    def test_entries_that_a_lenient_reader_takes_otherwise(self, tmp_path, text, message):
        """Summed, cut off at a letter, or passed over; the entries of both halves are those of one matrix."""
        (tmp_path / "d").write_text("1 1\n1 2\n")
        path = tmp_path / "a.mtx"
        path.write_text("%%MatrixMarket matrix coordinate real " + text)
        with pytest.raises(InputError, match=message):
            read_matrix_market(path, tmp_path / "d")
        path.write_text("%%MatrixMarket matrix coordinate real symmetric\n% a\n2 2 4\n1 1 2\n1 2 1\n2 1 1\n2 2 2\n")
        assert read_matrix_market(path, tmp_path / "d").matrix.toarray().tolist() == [[2.0, 1.0], [1.0, 2.0]]

    def test_matrices_that_are_written_whole(self, tmp_path):
        (tmp_path / "d").write_text("1 1\n1 2\n1 3\n")
        path = tmp_path / "a.mtx"
        whole = np.array([[4.0, 1.0, 2.0], [1.0, 5.0, 3.0], [2.0, 3.0, 6.0]])
        for symmetry in ("symmetric", "general"):
            io.mmwrite(path, whole, symmetry=symmetry)
            assert read_matrix_market(path, tmp_path / "d").matrix.toarray().tolist() == whole.tolist()
        text = path.read_text()
        for content, message in (
            (text + "7\n", "got 10 entries; allowed: 9"),
            (text.replace("3 3", "3 2"), "got 3 rows and 2 columns"),
            (text.rstrip() + "D\n", "cannot be read .*; allowed: numbers"),
        ):
            path.write_text(content)
            with pytest.raises(InputError, match=message):
                read_matrix_market(path, tmp_path / "d")

    def test_files_that_are_too_long(self, files, monkeypatch):
        monkeypatch.setattr("mbs.flexible.number_table.LONGEST_FILE", 10)
        with pytest.raises(
            InputError, match=r"longer than 10 bytes \(got \d+\); allowed: a file of the body; take a coarser mesh"
        ):
            read_dof_table(files[0] / "dofs.txt")

    def test_files_that_fill_the_memory(self, tmp_path, monkeypatch):
        def fail(*arguments, **keywords):
            raise MemoryError

        path = tmp_path / "a.dof"
        path.write_text("1 1\n")
        monkeypatch.setattr(np, "loadtxt", fail)
        with pytest.raises(InputError, match="does not fit into the memory"):
            read_dof_table(path)

    def test_decks_that_are_refused(self, tmp_path):
        path = tmp_path / "a.inp"
        path.write_text("*NODE\n1,0,0,0\n*RIGID BODY, NSET=END, REF NODE=1\n*Mpc\n**RIGID BODY\n")
        with pytest.raises(InputError) as caught:
            check_deck(path)
        assert len(caught.value.problems) == 2
        assert "line 3: got *RIGID BODY; allowed" in caught.value.problems[0]

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("*ELEMENT\n1,2\n", r"has no \*NODE block"),
            ("*NODE\n1,0,x,0\n", "line 2: got '1,0,x,0'; allowed: a node from 1"),
            ("*NODE\n1\n", "line 2: got '1'"),
            ("*NODE\n1,nan,0,0\n", "line 2"),
            ("*INCLUDE, INPUT=b.inp\n", "line 1: got '.INCLUDE, INPUT=b.inp'; allowed: a deck with its nodes in it"),
            ("*NODE, SYSTEM=C\n1,0,0,0\n", "allowed: rectangular coordinates"),
        ],
    )
    def test_decks_without_nodes(self, tmp_path, text, message):
        path = tmp_path / "a.inp"
        path.write_text(text)
        with pytest.raises(InputError, match=message):
            read_mesh_nodes(path)

    @pytest.mark.slow
    def test_meshes_of_other_programs(self, tmp_path, monkeypatch):
        points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 2]])
        path = tmp_path / "a.vtk"
        meshio.write(path, meshio.Mesh(points, [("tetra", np.array([[0, 1, 2, 3]]))]))
        found = read_mesh_nodes(path)
        assert found.numbers.tolist() == [1, 2, 3, 4]
        assert found.positions == pytest.approx(points)
        (tmp_path / "b.vtk").write_text("nonsense")
        with pytest.raises(InputError, match="cannot be read as a mesh"):
            read_mesh_nodes(tmp_path / "b.vtk")
        meshio.write(path, meshio.Mesh(np.full((2, 3), np.nan), [("line", np.array([[0, 1]]))]))
        with pytest.raises(InputError, match=r"got positions that are no finite numbers; allowed: finite ones"):
            read_mesh_nodes(path)

    @pytest.mark.slow
    def test_a_reader_that_never_ends(self, monkeypatch):
        monkeypatch.setattr("mbs.flexible.apart.SHORTEST_READ", 1.0)
        content, words = run_apart("import time; time.sleep(60)", [], 0, "flexible", "meshio", "a.vtk")
        assert (content, words) == (b"", "it did not end within 1 s")

    def test_without_meshio(self, tmp_path, monkeypatch):
        (tmp_path / "meshio.py").write_text("raise ImportError('none here')")
        monkeypatch.setenv("PYTHONPATH", str(tmp_path))
        (tmp_path / "a.vtk").write_text("nothing")
        message = r'a\.vtk: reading this format: the package meshio .*\(none here\).*"ehdmaps\[flexible\]"'
        with pytest.raises(DependencyError, match=message):
            read_mesh_nodes(tmp_path / "a.vtk")
        (tmp_path / "a.inp").write_text("*NODE\n1,0,0,0\n")
        assert read_mesh_nodes(tmp_path / "a.inp").numbers.tolist() == [1]


class TestFilesOfAnotherKind:
    @pytest.mark.parametrize("end", [".xdmf", ".XML", ".node", ".ele", ".gz"])
    def test_meshes_in_several_files(self, tmp_path, end):
        path = tmp_path / f"m{end}"
        path.write_text("1\n")
        with pytest.raises(
            InputError, match=r"of a mesh whose numbers of nodes are not read; allowed: a mesh in one file"
        ):
            read_mesh_nodes(path)

    def test_tables_that_are_no_text_in_lines(self, tmp_path):
        path = tmp_path / "a.sti"
        path.write_text("1 " * 5001)
        with pytest.raises(InputError, match=r"which is no text in lines; allowed: 3 numbers a line"):
            read_triplets(path, np.array([1]), np.array([0]))

    def test_tables_and_decks_that_were_cut_off(self, files):
        """What is left of a number is a number, too: a mass of 5.8 for 5.8e-2, a node at z = 0."""
        folder, _ = files
        for name in ("b.sti", "m_abaqus.mtx", "b.dof", "dofs.txt"):
            path = folder / name
            path.write_text(path.read_text()[:-4])
        for read in (
            lambda: read_triplets(folder / "b.sti", np.arange(1, 13), np.zeros(12, dtype=int)),
            lambda: read_abaqus_matrix(folder / "m_abaqus.mtx"),
            lambda: read_dofs(folder / "b.dof"),
            lambda: read_dof_table(folder / "dofs.txt"),
        ):
            with pytest.raises(InputError, match=r"its last line has no end; allowed: a table that is whole"):
                read()
        deck = folder / "m.inp"
        nodes = deck.read_text().partition("** a comment")[0]
        deck.write_text(nodes)
        assert len(read_mesh_nodes(deck).numbers) == 12
        deck.write_text(nodes.rpartition(",")[0])
        with pytest.raises(
            InputError, match=r"m.inp, line 14: got .*, which has no end; allowed: a deck that is whole"
        ):
            read_mesh_nodes(deck)

    def test_a_large_file_of_nothing(self, tmp_path):
        path = tmp_path / "a.dof"
        with path.open("wb") as file:
            file.truncate(3_000_000_000)  # takes no space on the disk
        with pytest.raises(InputError, match="which is no text in lines"):
            read_dofs(path)

    def test_rows_with_a_comment_in_any_language(self, tmp_path):
        path = tmp_path / "a.dof"
        path.write_text("# d\u00e9placements\n1.1\n", encoding="utf-8")
        assert [entry.tolist() for entry in read_dofs(path)] == [[1], [0]]
