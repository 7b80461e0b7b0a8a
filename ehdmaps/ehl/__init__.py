"""The EHL line contact by finite differences, in the order of the data.

| module | one idea |
|---|---|
| `grid` | nodes graded by a smooth map: inlet, exit, Hertz zone, spike; deflection of half-spaces; points across |
| `column` | oil laws and groups of heat for compiled code; one column of an oil that is not Newtonian |
| `reynolds` | the discrete equations and their exact Jacobian |
| `dense` | linear systems: rows scaled, LU factors, and what they solve |
| `newton` | damped Newton with the dense Jacobian |
| `warm_column` | columns with temperatures: velocity, flow and heat of shear, with exact derivatives |
| `energy` | the energy of all columns, and the derivative of temperatures by pressures |
| `warm_newton` | damped Newton for a film with its temperatures and those of the surfaces |
| `warm_response` | their response to slow motion, with stored heat |
| `profile` | the converged solution that a solve gives; how that starts the next one |
| `linearisation` | the equations to first order, with the oil that the film stores; response to slow motion |
| `spectrum` | response at many frequencies from one Krylov space |
| `ways` | the ways to a solution: Newton on one grid and on two, starts from before, from Hertz, up a ladder of loads |
| `group_solution` | film of one point in groups: response, numbers, and their errors from both grids |
| `line` | the story of one solve: coarse grid, place of the spike, fine grid, response over frequency, error estimate |
| `meniscus` | a starved contact: the place of the inlet's meniscus behind a given oil layer |
| `limits` | settings of the solver and of its grids, and which are allowed |
| `solver` | `ReynoldsSolver`: operating points in SI, one line of loads after another |
| `start` | what the solution of a point gives to another solver |

Kernels take and return arrays in the groups of the problem; units appear in `solver` only.
"""
