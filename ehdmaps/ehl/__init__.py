"""The EHL line contact by finite differences, in the order of the data.

| module | one idea |
|---|---|
| `grid` | nodes graded by a smooth map: inlet, exit, Hertz zone, pressure spike |
| `elastic` | deflection of the half-spaces: logarithmic kernel, fifth order |
| `column` | one column of an oil that is not Newtonian: what it lets flow and what it carries |
| `reynolds` | the discrete equations and their exact Jacobian |
| `dense` | linear systems: rows scaled, LU factors, and what they solve |
| `stored_mass` | the oil that a film stores, and how it changes |
| `newton` | damped Newton with the dense Jacobian |
| `warm_oil` | groups of heat, and the oil's laws over temperature for compiled code |
| `warm_column` | one column with temperatures: velocity, flow and heat of shear, with exact derivatives |
| `energy` | the energy of all columns, and the derivative of temperatures by pressures |
| `warm_newton` | damped Newton for a film with its temperatures |
| `warm_response` | their response to slow motion, with stored heat |
| `profile` | a converged solution, and how it starts the next one |
| `linearisation` | the equations to first order, on a grid that follows the spike; response to slow motion |
| `spectrum` | response at many frequencies from one Krylov space |
| `resolution` | what decides accuracy and cost of a solve |
| `one_grid` | Newton on one grid: isothermal, warm, or of an oil that is let yield step by step |
| `two_grids` | a point on its two grids: coarse ones until the spike is in its place, then twice the cells |
| `ways` | the ways to a coarse solution: from the point before, from Hertz, up a ladder of loads, heated by parts |
| `moving_grid` | the equations to first order about a profile, whose grid follows the spike |
| `group_solution` | film of one point in groups: response, numbers, and their errors from both grids |
| `line` | the story of one solve: coarse grid, place of the spike, fine grid, response, error estimate |
| `meniscus` | a starved contact: the place of the inlet's meniscus behind a given oil layer |
| `frequency` | film compliance over frequency, with its error from both grids |
| `limits` | allowed settings of the solver |
| `solver` | `ReynoldsSolver`: operating points in SI, one line of loads after another |
| `start` | what the solution of a point gives to another solver |

Kernels take and return arrays in the groups of the problem; units appear in `solver` only.
"""
