"""A housing of your own: stiffness and mass of a finite-element body as files, reduced to its interface.

Run it with `python examples/07_housing_of_your_own.py [FOLDER]`; matrices and figure are written to the folder.
The body is a clamped block, a truss of bars, so that no mesher is needed. Its reduction must keep the low frequencies.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from scipy import io, linalg, sparse, spatial

from ehdmaps.outputs import write_figure
from mbs.flexible.finite_elements import NodePositions
from mbs.flexible.matrix_files import assemble_model, read_matrix_market
from mbs.flexible.reduction import Interface, nodes_in_plane, reduce

FOLDER, SPACING = Path(sys.argv[1] if len(sys.argv) > 1 else "."), 0.02
places = SPACING * np.array(list(np.ndindex(12, 4, 4)), dtype=float)
first, second = spatial.KDTree(places).query_pairs(1.8 * SPACING, output_type="ndarray").T  # ends of the bars
along, ends = (each[second] - each[first] for each in (places, np.eye(len(places))))
length = np.linalg.norm(along, axis=1)[:, None]  # every bar is a spring E A/length
free = np.flatnonzero(np.repeat(places[:, 0] > 0.0, 3))  # clamped at x = 0
stretch = (ends[:, :, None] * (along / length)[:, None]).reshape(len(along), -1)[:, free]
K, M = stretch.T @ (0.2 * 210e9 * SPACING**2 / length * stretch), 7850.0 * SPACING**3 * np.eye(free.size)
np.savetxt(FOLDER / "07_dofs.txt", np.column_stack([free // 3 + 1, free % 3 + 1]), fmt="%d")
for name, matrix in (("stiffness", K), ("mass", M)):
    io.mmwrite(FOLDER / f"07_{name}.mtx", sparse.coo_array(matrix), symmetry="symmetric", precision=17)
read = [read_matrix_market(FOLDER / f"07_{name}.mtx", FOLDER / "07_dofs.txt") for name in ("stiffness", "mass")]
model = assemble_model(read[0], read[1], NodePositions(np.arange(1, len(places) + 1), places))
end = places[-1] * (1.0, 0.5, 0.5)
reduced = reduce(model, {"seat": Interface(end, nodes_in_plane(model, end, (1, 0, 0), 1e-6))}, cutoff=20e3)
frequency = np.sqrt(linalg.eigh(reduced.stiffness, reduced.mass, eigvals_only=True)) / (2.0 * np.pi)
whole = np.sqrt(linalg.eigh(K, M, eigvals_only=True)) / (2.0 * np.pi)
print(f"{free.size} to {frequency.size} freedoms; lowest {frequency[0]:.3f} Hz, of the whole {whole[0]:.3f} Hz")
assert abs(frequency[0] / whole[0] - 1.0) < 1e-4  # what modes beyond the cut-off would add
figure, axes = plt.subplots(subplot_kw={"xlabel": "mode", "ylabel": "error of the reduced frequency"})
axes.semilogy(range(1, 13), np.abs(frequency[:12] / whole[:12] - 1.0), "o")
write_figure(figure, FOLDER / "07_housing.png")
