"""Laboratory instruments of mbs: what measures the program and its choices. No analysis loads them.

==========  ==================================================================================
tradeoff    speed against accuracy of a scene
tolerance   step, slices and cut-off that keep the level of a run-up within a tolerance
ramp_parts  short runs around some speeds of a ramp
variants    how far a difference between two laws depends on what was assumed
element     laws and bearing element at the extremes: derivatives, symmetry, closed cycles
integrator  stiffness and damping over decades, reversal, unbalance, impact
readers     scenes, bodies of finite elements and measured records, damaged
==========  ==================================================================================
"""
