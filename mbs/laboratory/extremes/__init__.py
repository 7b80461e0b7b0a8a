"""Stability at the extremes: cases are drawn, judged one by one, counted and told, whatever they are cases of.

==============  ======================================================================================
check           `Verdict` of a case, `Check` of all cases of a kind, and what a command tells of them
contact_points  points over all that inputs may declare and a decade beyond, and what theory says there
contacts        contact solvers at such points: a right value, or a status with a reason
bearings        laws and the bearing element: derivatives, symmetry, closed cycles
integrator      stiffness and damping over decades, reversal, unbalance, impact
==============  ======================================================================================
"""
