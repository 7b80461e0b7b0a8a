"""A housing of your own: stiffness and mass of a finite-element body as files, reduced to its interface.

Run it with `python examples/07_housing_of_your_own.py [FOLDER]`; matrices and figure are written to the folder.
The body is a clamped block, a truss of bars along edges and diagonals of cubes: numpy makes it here, so that no mesher
is needed; any program that writes Matrix Market does as well. A Craig-Bampton reduction keeps low frequencies: those
of the reduced body must be those of the whole matrices.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy import io, sparse
from scipy.linalg import eigh
from scipy.spatial import KDTree

from ehdmaps.outputs import write_figure
from mbs.flexible.matrix_files import NodePositions, assemble_model, read_matrix_market
from mbs.flexible.reduction import reduce
from mbs.flexible.spiders import Interface, nodes_in_plane

FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
SPACING, COUNT, MODULUS, DENSITY = 0.02, (12, 4, 4), 210e9, 7850.0
places = SPACING * np.array(list(np.ndindex(COUNT)), dtype=float)
first, second = KDTree(places).query_pairs(1.8 * SPACING, output_type="ndarray").T  # ends of the bars
length = np.linalg.norm(places[second] - places[first], axis=1)[:, None]
stretch, bars = np.zeros((len(length), *places.shape)), np.arange(len(length))  # of each bar, by motions of the nodes
stretch[bars, second] = (places[second] - places[first]) / length
stretch[bars, first] = -stretch[bars, second]
free = np.flatnonzero(np.repeat(places[:, 0] > 0.0, 3))  # clamped at x = 0
stretch = stretch.reshape(len(length), -1)[:, free]
K = stretch.T @ (0.2 * MODULUS * SPACING**2 / length * stretch)  # every bar is a spring E A/length
M = DENSITY * SPACING**3 * np.eye(free.size)

np.savetxt(FOLDER / "07_dofs.txt", np.column_stack([free // 3 + 1, free % 3 + 1]), fmt="%d")
read = []
for name, matrix in (("stiffness", K), ("mass", M)):
    file = FOLDER / f"07_{name}.mtx"
    io.mmwrite(file, sparse.coo_array(matrix), symmetry="symmetric", precision=17)
    read.append(read_matrix_market(file, FOLDER / "07_dofs.txt"))
model = assemble_model(*read, NodePositions(np.arange(1, len(places) + 1), places))
end = places[-1] * (1.0, 0.5, 0.5)
reduced = reduce(model, {"seat": Interface(end, nodes_in_plane(model, end, (1, 0, 0), 1e-6))}, cutoff=20e3)
frequency = np.sqrt(eigh(reduced.stiffness, reduced.mass, eigvals_only=True)) / (2.0 * np.pi)
whole = np.sqrt(eigh(K, M, eigvals_only=True)) / (2.0 * np.pi)
print(f"{free.size} to {frequency.size} freedoms; lowest {frequency[0]:.3f} Hz, of the whole {whole[0]:.3f} Hz")
assert abs(frequency[0] / whole[0] - 1.0) < 1e-4  # what modes beyond the cut-off would add

figure = Figure(figsize=(6.0, 3.0), layout="constrained")
axes = figure.subplots()
axes.semilogy(range(1, 13), np.abs(frequency[:12] / whole[:12] - 1.0), "o")
axes.set(xlabel="mode", ylabel="error of the reduced frequency")
write_figure(figure, FOLDER / "07_housing.png", 120)
