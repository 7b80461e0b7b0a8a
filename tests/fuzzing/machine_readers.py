"""Every reader of mbs given damaged files: scenes, body files, matrices, reduced bodies, universal files."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import resources
from pathlib import Path

import numpy as np
from scipy import io, sparse

from ehdmaps.arrays import FloatArray
from mbs.flexible.carry_out import carry_out
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.reduced_file import read_reduced, write_reduced
from mbs.modal.records import Channel, Hits, Responses
from mbs.modal.uff import Measurement, read_uff, write_uff
from mbs.scene.assembly import assemble
from mbs.scene.flexible import read_body_file
from mbs.scene.reader import read_scene
from tests.fuzzing.search import Reader, as_written

_SCENES = ("nu308_rigid", "n1014_rigid")
"""Shipped scenes without files of their own."""

_BODY = """matrices = {{ format = "{form}", stiffness = "k.txt", mass = "m.txt"{dofs} }}
mesh = "mesh.inp"
units = "SI"
cutoff = "20 kHz"
[interfaces]
left = {{ at = ["0 mm", "50 mm", "50 mm"], plane = {{ axis = "x", tolerance = "0.1 mm" }}, kind = "rigid" }}
right = {{ at = ["100 mm", "50 mm", "50 mm"], nodes = [50, 60, 70, 80], freedoms = ["x", "y", "z"] }}
[points]
top = ["100 mm", "100 mm", "100 mm"]
node = 20
"""

_MATRICES = ("k.txt", "m.txt", "dofs.txt", "mesh.inp")


def _scenes() -> Reader:
    """Scene files, put together to a system of dry contacts."""
    texts = [(resources.files("mbs") / "systems" / f"{name}.toml").read_bytes() for name in _SCENES]

    def read(folder: Path) -> str:
        model = assemble(read_scene(str(folder / "scene.toml")), "hertz")
        matrices = model.system.mass, model.system.stiffness
        return "" if all(np.all(np.isfinite(matrix)) for matrix in matrices) else "a system that is not finite"

    return Reader("scene", [{"scene.toml": text} for text in texts], read)


def _matrices(name: str, form: str, damaged: tuple[str, ...] = _MATRICES) -> Reader:
    """A body file and all that it names, in a format of matrices."""
    return Reader(name, [_body(form)], lambda folder: _body_problem(_reduced(folder)), damaged)


def _reduced_bodies(ending: str) -> Reader:
    """Bodies that were reduced already."""
    name = f"body{ending}"
    content = as_written(name, lambda path: write_reduced(path, _reduced(path.parent)), _body("calculix"))
    return Reader(
        f"reduced body {ending}", [{name: content}], lambda folder: _body_problem(read_reduced(folder / name))
    )


def _universal_files() -> Reader:
    """Measured records: hits, and responses."""
    time = np.arange(64) / 1024.0
    place = Channel("hammer", 1, 2, "force")
    sensors = (Channel("tip", 1, 2, "displacement"), Channel("root", 2, 2, "acceleration"))
    force = np.zeros((2, 64))
    force[:, 3] = (80.0, 120.0)
    answer = np.exp(-20.0 * time) * np.sin(900.0 * time) * np.array([1e-5, 2.0])[:, None]
    hits = Hits(1.0 / 1024.0, force, np.stack([answer, 1.5 * answer]), place, sensors)
    axis = np.arange(1.0, 33.0)
    values = np.stack([1.0 / (400.0 - axis**2 + 2j * axis), 3.0 / (900.0 - axis**2 + 4j * axis)])
    responses = Responses(
        axis, values.astype(np.complex128), np.ones(values.shape), tuple((sensor, place) for sensor in sensors)
    )
    contents = [
        as_written("good.uff", lambda path, given=given: write_uff(path, given))  # type: ignore[misc]
        for given in (Measurement("hits", (hits,)), Measurement("both", (hits,), responses))
    ]
    return Reader("universal file", [{"records.uff": content} for content in contents], _records_problem)


READERS: Mapping[str, Callable[[], Reader]] = {
    "scene": _scenes,
    "body file": lambda: _matrices("body file", "calculix", ("body.toml",)),
    "matrices of CalculiX": lambda: _matrices("matrices of CalculiX", "calculix"),
    "matrices of Abaqus": lambda: _matrices("matrices of Abaqus", "abaqus"),
    "matrices in Matrix Market": lambda: _matrices("matrices in Matrix Market", "matrix-market"),
    "reduced body .nc": lambda: _reduced_bodies(".nc"),
    "reduced body .npz": lambda: _reduced_bodies(".npz"),
    "universal file": _universal_files,
}
"""What makes each reader with its good files."""


def _cube() -> tuple[FloatArray, FloatArray, FloatArray]:
    """Stiffness [N/m], mass [kg] and positions [m] of eight nodes, each pair joined by a rod."""
    positions = 0.1 * np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    stiffness = np.zeros((24, 24))
    for first in range(8):
        for second in range(first):
            apart = positions[first] - positions[second]
            length = float(np.linalg.norm(apart))
            block = 1e7 / length * np.outer(apart, apart) / length**2
            for row, column, sign in ((first, first, 1), (second, second, 1), (first, second, -1), (second, first, -1)):
                stiffness[3 * row : 3 * row + 3, 3 * column : 3 * column + 3] += sign * block
    return stiffness, np.diag(np.full(24, 0.25)), positions


def _deck(positions: FloatArray) -> bytes:
    """The nodes as an input deck."""
    lines = "".join(f"{10 * k}, {x!r}, {y!r}, {z!r}\n" for k, (x, y, z) in enumerate(positions.tolist(), start=1))
    return (
        f"*HEADING\na cube\n*NODE, NSET=ALL\n{lines}*ELEMENT, TYPE=C3D8\n1, 10, 20, 40, 30, 50, 60, 80, 70\n".encode()
    )


_ENTRY = {
    "calculix": lambda i, j, value: f"{i + 1} {j + 1} {value:.15e}\n",
    "abaqus": lambda i, j, value: f"{10 * (i // 3 + 1)},{i % 3 + 1}, {10 * (j // 3 + 1)},{j % 3 + 1}, {value:.15e}\n",
}
"""A line of a matrix, of the upper or the lower half."""


def _body(form: str) -> dict[str, bytes]:
    """A body file and all that it names."""
    stiffness, mass, positions = _cube()
    files = {"k.txt": _written(stiffness, form), "m.txt": _written(mass, form)}
    if form != "abaqus":
        space, rows = "." if form == "calculix" else " ", range(mass.shape[0])
        files["dofs.txt"] = "".join(f"{10 * (row // 3 + 1)}{space}{row % 3 + 1}\n" for row in rows).encode()
    dofs = ', dofs = "dofs.txt"' if "dofs.txt" in files else ""
    body = _BODY.format(form=form, dofs=dofs).encode()
    return {**files, "mesh.inp": _deck(positions), "body.toml": body}


def _written(matrix: FloatArray, form: str) -> bytes:
    """A matrix in a format."""
    if form == "matrix-market":
        return as_written("matrix.mtx", lambda path: io.mmwrite(path, sparse.coo_array(matrix), symmetry="symmetric"))
    half = np.triu(matrix) if form == "calculix" else np.tril(matrix)
    return "".join(_ENTRY[form](i, j, matrix[i, j]) for i, j in zip(*np.nonzero(half), strict=True)).encode()


def _reduced(folder: Path) -> ReducedBody:
    """Read a body file and all that it names, and reduce."""
    return carry_out(read_body_file(folder / "body.toml"))


def _body_problem(body: ReducedBody) -> str:
    """Problem with a reduced body, beyond what it looks for itself."""
    scale = 1.0 / np.sqrt(np.diag(body.mass))
    squares = np.linalg.eigvalsh(scale[:, None] * body.stiffness * scale)
    return "" if np.all(np.isfinite(squares)) else "own frequencies that are not finite"


def _records_problem(folder: Path) -> str:
    """Problem with measured records."""
    measured = read_uff(folder / "records.uff")
    arrays = [array for hits in measured.hits for array in (hits.force, hits.response, np.array([hits.step]))]
    if measured.responses is not None:
        arrays += [measured.responses.frequency, np.abs(measured.responses.response)]
    return "" if all(np.all(np.isfinite(array)) for array in arrays) else "records that are not finite"
