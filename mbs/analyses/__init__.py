"""The analyses of a scene, callable without files: a model goes in, a result with its dataset comes out.

The modules in the order in which a machine is examined:

=============  ====================================================================================
statics        equilibrium, pressures and films, stiffness and damping of the bearings
bearing_point  one bearing without a scene: its equilibrium under a load, pressures and films
modes          complex modes at the equilibrium
lsa            state space and frequency responses at the equilibrium
sweep          modes, bearings and responses over speed, of one or more models
critical       critical speeds, and the response to unbalances and orders over speed
drive          the speed of a run by torques, the rolling torque of the bearings among those that resist
runup          the nonlinear system in time over its speed profile
resolution     what the steps of a run resolve, and what the method of integration takes from oscillations
campbell       run-ups with one or more laws as levels over speed, frequency and order
followed       orders that such a diagram follows: those asked for, else what a machine excites itself
ramp           the run-up with a sample a step: its course, a silent one before it, and the recording
sensors        sensors whose levels are looked at
changed_laws   models whose laws are wrong by the errors that their map states
variants       how a difference between two laws in a run-up depends on clearance, temperature and the like
tradeoff       what laws, supplies, maps, slices, cut-off, step and cage angles cost, and how wrong they are
linear_look    what a user looks at in a linear system, and how two systems differ in it
tolerance      step, slices and cut-off of a run-up that keep its sum level within a tolerance
numerics       these settings
ramp_parts     short runs of parts of a run-up, and their sum levels
hammer         a simulated hammer test
plan           which ranges a scene needs of a contact map, and the jobs that cover them
planning       operating points of a scene and the loads and speeds seen there
planned_job    such a job, from the bearings and the oil of the scene
auto           an analysis that chooses its physics, and makes maps of what the film table has not
film_verdicts  which physics of the films a scene requires
film_criteria  such criteria at a contact, in closed form
shear_effect   what a limiting shear stress changes there, by solving
case           a law as it was chosen, a scene with its law, the models that an analysis compares
varied         what comparisons vary, one row a key
recorded       runs that are recorded, measured or simulated before: signals, levels, amplitudes
progress       how an analysis tells how far it is
side_by_side   cases in processes of their own
operating      a model as it is in operation: temperatures and clearances of its bearings at a speed
heat_balance   the temperatures at which the heat of all bearings is carried away
reach          where the films of a law begin, and calls outside its map, with the lines that say so
losses         what contacts feel at an equilibrium, and what rolling costs there
film_errors    how wrong the films are estimated to be over frequency
soundness      results whose own checks failed so grossly that their figures mean nothing
step_check     whether the steps of a run are short enough: its first part again with half of them
=============  ====================================================================================

Nothing is imported here: take the functions from `mbs`, or from their modules.
"""
