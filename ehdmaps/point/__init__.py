"""The EHL point contact by finite differences, in the order of the data.

| module | one idea |
|---|---|
| `problem` | the groups of a point contact, and the film that a solve starts from |
| `tail` | pressure and load of the far inlet, as closed forms |
| `grid` | a graded tensor grid of half a contact; deflection of the half-spaces on it |
| `reynolds` | the discrete equations with their exact derivatives, as bands; the dense Jacobian |
| `equations` | the linear equations of a step, and their solution by factors of their own or of a step nearby |
| `newton` | Newton, with the nodes that cavitate chosen in each step |
| `linearisation` | the equations to first order with the oil that the film stores: slow motion, and any frequency |
| `two_grids` | the ways to a solution, both grids, extrapolation and errors |
| `solver` | `solve`: one contact in SI |
| `roller_grid` | grids of a roller of finite length with its profile, and the dry contact on them |
| `finite_roller` | `solve_roller`: the film of such a roller in SI |
"""

from ehdmaps.point.solver import PointField, PointResponse, PointSolution, solve

__all__ = ["PointField", "PointResponse", "PointSolution", "solve"]
