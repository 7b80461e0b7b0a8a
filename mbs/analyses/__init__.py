"""The analyses of a scene, callable without files: a model goes in, a result with its dataset comes out.

The modules in the order in which a machine is examined:

=============  ====================================================================================
statics        equilibrium, pressures and films, stiffness and damping of the bearings
bearing_point  one bearing without a scene: its equilibrium under a load, pressures and films
modes          complex modes at the equilibrium
lsa            state space and frequency responses at the equilibrium
sweep          modes, bearings, responses, critical speeds over speed, of one or more models
runup          the nonlinear system in time over its speed profile
ramp           its course, by torques too, what is recorded, and whether its steps are short enough
step_error     by how much the levels of a run are off because of its step
campbell       run-ups with one or more laws as levels over speed, frequency and order, with their errors
sensors        sensors and orders that are looked at
recorded       runs that are recorded, measured or simulated before: signals, levels, amplitudes
hammer         a simulated hammer test
case           what an analysis compares, computed side by side in processes of their own
operating      a model as it is in operation: temperatures and clearances of its bearings at a speed
heat_balance   the temperatures at which the heat of all bearings is carried away
losses         what contacts feel at an equilibrium, and what rolling costs there
film_errors    how wrong the films are estimated to be over frequency
reach          where the films of a law begin, and calls outside its map, with the lines that say so
soundness      results whose own checks failed so grossly that their figures mean nothing
=============  ====================================================================================

What a scene requires of its maps and physics is in `mbs.planning`, what measures the program and its
choices in `mbs.laboratory`. Nothing is imported here: take
the functions from `mbs`, or from their modules.
"""
