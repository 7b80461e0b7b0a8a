"""Bodies as Nastran writes them: DMIG entries and GRIDs, read by pyNastran."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest
from scipy import linalg

from ehdmaps.errors import DependencyError, InputError
from mbs.flexible import finite_elements, nastran_files
from mbs.flexible.carry_out import read_model, reduce_model
from mbs.flexible.finite_elements import extent
from mbs.flexible.nastran_files import read_nastran
from mbs.scene.flexible import read_body_file
from tests.cases.flexible import written

WITH_PACKAGE = pytest.mark.skipif(importlib.util.find_spec("pyNastran") is None, reason="needs pyNastran")

DIGITS = 5.1e-11
"""Half of the last of 11 digits, which a field of 16 places has beside sign and exponent."""

BODY = """
{}
cutoff = "20 kHz"
[interfaces.left]
at = ["0 mm", "25 mm", "20 mm"]
plane = {{ axis = "x" }}
[interfaces.right]
at = ["200 mm", "25 mm", "20 mm"]
plane = {{ axis = "x" }}
"""
PART = """
matrices = { format = "nastran", stiffness = "part.pch", mass = "part.pch" }
mesh = "part.pch"
cutoff = "20 kHz"
[interfaces]
left = { at = ["0 mm", "25 mm", "20 mm"], nodes = [1], kind = "rigid" }
right = { at = ["200 mm", "25 mm", "20 mm"], nodes = [2], kind = "rigid" }
"""
FORMS = {
    "nastran": """matrices = { format = "nastran", stiffness = "b.pch", mass = "b.pch", stiffness_name = "kmine" }
mesh = "b.bdf" """,
    "calculix": """matrices = { format = "calculix", stiffness = "b.sti", mass = "b.mas", dofs = "b.dof" }
mesh = "m.inp" """,
}


def field(value):
    """A number in 16 places, as Nastran writes it: -1.2345678901+10."""
    digits, exponent = f"{value:.10E}".split("E")
    return f"{digits}{int(exponent):+}".rjust(16)


def dmig(name, matrix, labels, form=6):
    """Lines of a DMIG in large fields; of form 6 the half below the diagonal."""
    lines = [f"{'DMIG':<8}{name:<8}{0:>8}{form:>8}{2:>8}{0:>8}"]
    for column, (node, component) in enumerate(labels):
        first = column if form == 6 else 0
        head = f"{'DMIG*':<8}{name:<16}{node:>16}{component:>16}{'':16}*\n"
        for row in first + np.flatnonzero(matrix[first:, column]):
            head += f"{'*':<8}{labels[row][0]:>16}{labels[row][1]:>16}{field(matrix[row, column])}\n"
        lines.append(head.rstrip("\n"))
    return "\n".join(lines) + "\n"


def grid(number, place, cp=""):
    return f"GRID*   {number:>16}{cp:>16}{field(place[0])}{field(place[1])}*\n{'*':<8}{field(place[2])}\n"


@pytest.fixture(scope="module")
def body(tmp_path_factory):
    folder, model = written(tmp_path_factory.mktemp("nastran"))
    labels = [(10 * int(n), int(d) + 1) for n, d in zip(model.nodes, model.directions, strict=True)]
    (folder / "b.pch").write_text(
        dmig("KMINE", model.stiffness.toarray(), labels) + dmig("MAAX", model.mass.toarray(), labels, form=1)
    )
    (folder / "b.bdf").write_text(
        "SOL 103\nCEND\nBEGIN BULK\n"
        + "".join(grid(10 * n, p) for n, p in zip(model.numbers, model.positions, strict=True))
        + "CQUAD4,1,1,10,20,30,40\nENDDATA\n"
    )
    for form, lines in FORMS.items():
        (folder / f"{form}.toml").write_text(BODY.format(lines))
    return folder, model


@pytest.mark.slow
@WITH_PACKAGE
class TestFiles:
    def test_the_same_body_as_of_calculix(self, body):
        """Matrices to the digits of the file; frequencies and mass of the reduced body to what these leave of them."""
        folder, _ = body
        plans = [read_body_file(folder / f"{form}.toml") for form in FORMS]
        read, expected = (read_model(plan) for plan in plans)
        assert np.array_equal(read.nodes, expected.nodes) and np.array_equal(read.directions, expected.directions)
        for name in ("stiffness", "mass"):
            found, given = (getattr(entry, name).toarray() for entry in (read, expected))
            assert found == pytest.approx(given, rel=DIGITS)
        assert read.positions == pytest.approx(expected.positions, rel=DIGITS)
        reduced = [reduce_model(plan, entry) for plan, entry in zip(plans, (read, expected), strict=True)]
        squares = [np.diag(entry.stiffness)[12:] for entry in reduced]
        assert squares[0].size > 0
        assert np.sqrt(squares[0]) == pytest.approx(np.sqrt(squares[1]), rel=1e-9)
        assert extent(read).mass == pytest.approx(extent(expected).mass, rel=1e-9)

    def test_a_part_that_was_reduced_already(self, body):
        """Two GRIDs with six freedoms, one in cylindrical coordinates, and an SPOINT for each mode, reduced again."""
        folder, _ = body
        plan = read_body_file(folder / "calculix.toml")
        model = read_model(plan)
        part = reduce_model(plan, model)
        modes = part.size - 12
        labels = [(node, k) for node in (1, 2) for k in range(1, 7)] + [(100 + k, 0) for k in range(modes)]
        (folder / "part.pch").write_text(
            "CORD2C,5,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
            + grid(1, (0.025, 90.0, 0.02), 5)
            + grid(2, (0.2, 0.025, 0.02))
            + "".join(f"SPOINT,{100 + k}\n" for k in range(modes))
            + dmig("KAAX", part.stiffness, labels)
            + dmig("MAAX", part.mass, labels)
        )
        (folder / "part.toml").write_text(PART)
        plan = read_body_file(folder / "part.toml")
        read = read_model(plan)
        assert read.position(1) == pytest.approx([0.0, 0.025, 0.02], abs=1e-12)
        found, given = extent(read), extent(model)
        assert found.mass == pytest.approx(given.mass, rel=1e-9)
        assert found.centre == pytest.approx(given.centre, rel=1e-9)
        again = reduce_model(plan, read)
        assert again.size == part.size > 12
        assert np.sqrt(np.diag(again.stiffness)[12:]) == pytest.approx(np.sqrt(np.diag(part.stiffness)[12:]), rel=1e-9)
        # Free, it swings as the part does; turns and shifts, of which rounding is left, apart.
        squares = [linalg.eigvalsh(entry.stiffness, entry.mass)[6:] for entry in (again, part)]
        assert np.sqrt(squares[0]) == pytest.approx(np.sqrt(squares[1]), rel=1e-7)

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("GRID,1,,0.,0.\x00,x\nDMIG,KAAX,0,6\n", r"b.bdf: cannot be read as bulk data \(.+\); allowed: GRID and"),
            ("GRID,1,,0.,0.,0.,2\n", r"b.bdf: got GRID node 1 with displacements in a system of their own \(CD\)"),
        ],
    )
    def test_files_that_are_refused(self, tmp_path, text, message):
        path = tmp_path / "b.bdf"
        path.write_text(text)
        with pytest.raises(InputError, match=message):
            read_nastran(path, path, path)


def parts(**changes):
    """What is found in two nodes joined by a spring, with changes."""
    found = {
        "numbers": np.array([1, 2]),
        "positions": np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]),
        "turned": np.array([], dtype=int),
        "default": np.array(False),
        "k_names": np.array(["KAAX", "KOTHER"]),
        "k_kind": np.array([6, 2]),
        "m_names": np.array(["MAAX"]),
        "m_kind": np.array([6, 2]),
    }
    for which, values in (("k", [2.0, -1.0, 2.0]), ("m", [1.0, 0.5, 1.0])):
        found |= {
            f"{which}_columns": np.array([[1, 1], [1, 1], [2, 1]]),
            f"{which}_rows": np.array([[1, 1], [2, 1], [2, 1]]),
            f"{which}_values": np.array(values),
        }
    return {key: value for key, value in (found | changes).items() if value is not None}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"k_kind": None}, "b.pch, DMIG KAAX: got none of this name; allowed: a DMIG of the file: KAAX, KOTHER"),
        ({"k_kind": np.array([9, 2])}, "KAAX: got a matrix of form 9; allowed: 6, symmetric, or 1, square"),
        ({"m_kind": np.array([6, 4])}, r"MAAX: got complex entries \(TIN 4\); allowed: real ones"),
        ({"k_values": np.array([2.0, np.inf, 2.0])}, "KAAX: got no entries, or some that are no finite numbers"),
        ({"k_values": np.array([])}, "KAAX: got no entries, or some"),
        (
            {"k_kind": np.array([1, 2])},
            "KAAX: is not symmetric: the entries of node . direction 1 and node . direction 1 differ by 1; allowed",
        ),
        (
            {"k_columns": np.array([[1, 1], [1, 1], [1, 1]])},
            "KAAX: got the entry of node 2 direction 1 and node 1 direction 1 twice; allowed: each once, in one half",
        ),
        (
            {"m_rows": np.array([[1, 1], [2, 1], [2, 2]]), "m_columns": np.array([[1, 1], [1, 1], [2, 2]])},
            "matrices: node 2 direction 2 in only one of stiffness and mass",
        ),
        (
            {"numbers": np.array([1]), "positions": np.zeros((1, 3))},
            "KAAX: got node 2 without a GRID in .*b.pch; allowed: nodes of the mesh, which has 1",
        ),
        ({"k_rows": np.array([[1, 1], [2, 0], [2, 1]])}, "got component 0 of GRID node 2; allowed: 1 to 6"),
        ({"numbers": np.array([], dtype=int)}, "b.pch: got no GRID; allowed: bulk data with the nodes"),
        ({"default": np.array(True)}, "b.pch: got a GRDSET; allowed: each GRID"),
    ],
)
def test_entries_that_are_no_body(tmp_path, monkeypatch, changes, message):
    path = tmp_path / "b.pch"
    path.write_text("$\n")
    monkeypatch.setattr(nastran_files, "_entries", lambda *given: parts(**changes))
    with pytest.raises(InputError, match=message):
        read_nastran(path, path, path)


def test_generalised_coordinates_have_no_unit_of_length(tmp_path, monkeypatch):
    path = tmp_path / "b.pch"
    path.write_text("$\n")
    labels = {f"{which}_rows": np.array([[1, 1], [9, 0], [9, 0]]) for which in "km"}
    columns = {f"{which}_columns": np.array([[1, 1], [1, 1], [9, 0]]) for which in "km"}
    monkeypatch.setattr(nastran_files, "_entries", lambda *given: parts(**labels, **columns))
    model = read_nastran(path, path, path, units="mm-t-s")
    # N/mm, N and N mm; tonne, tonne mm and tonne mm2.
    assert model.stiffness.toarray() == pytest.approx(np.array([[2e3, -1.0], [-1.0, 2e-3]]), rel=1e-15)
    assert model.mass.toarray() == pytest.approx(np.array([[1e3, 0.5], [0.5, 1e-3]]), rel=1e-15)


def test_too_many_freedoms(tmp_path, monkeypatch):
    path = tmp_path / "b.pch"
    path.write_text("$\n")
    monkeypatch.setattr(nastran_files, "_entries", lambda *given: parts())
    assert read_nastran(path, path, path).stiffness.toarray().tolist() == [[2.0, -1.0], [-1.0, 2.0]]
    monkeypatch.setattr(finite_elements, "MOST_FREEDOMS", 1)
    with pytest.raises(InputError, match="KAAX: got 2 degrees of freedom; allowed: at most"):
        read_nastran(path, path, path)


def test_text_that_is_not_whole(tmp_path):
    path = tmp_path / "b.pch"
    path.write_text("GRID,1\nINCLUDE '/etc/passwd'\n")
    with pytest.raises(InputError, match=r"b\.pch, line 2: got .*INCLUDE.*; allowed: bulk data in one file"):
        read_nastran(path, path, path)
    path.write_text("GRID,1,,0.,0.,1")
    with pytest.raises(InputError, match="its last line has no end"):
        read_nastran(path, path, path)


def test_names_of_entries(body):
    path = body[0] / "names.toml"
    lines = FORMS["nastran"].replace('"kmine"', '"K MINE"')
    path.write_text(BODY.format(lines))
    with pytest.raises(InputError, match="stiffness_name: got 'K MINE'; allowed: a name of a DMIG, such as 'KAAX'"):
        read_body_file(path)


def test_without_pynastran(tmp_path, monkeypatch):
    (tmp_path / "pyNastran.py").write_text("raise ImportError('none here')")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    path = tmp_path / "b.pch"
    path.write_text("GRID,1,,0.,0.,1.\n")
    message = r'b\.pch: reading this format: the package pyNastran .*\(none here\).*"ehdmaps\[nastran\]"'
    with pytest.raises(DependencyError, match=message):
        read_nastran(path, path, path)
