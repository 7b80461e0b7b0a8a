"""Stability at the extremes of the multibody side: what a search over wild input found.

==========  ===================================================================
element     laws and bearing element: derivatives, symmetry, closed cycles
integrator  stiffness and damping over decades, reversal, unbalance, impact
readers     scenes, bodies of finite elements and measured records, damaged
==========  ===================================================================
"""
