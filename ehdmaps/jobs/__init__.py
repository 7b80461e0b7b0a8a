"""From a job file to a map file: the only place that knows every part of the project.

The modules in the order in which data pass through them:

===========  ====================================================================================
job          `Job`, what a job file asks for, in SI
table        one table of a TOML file, read key by key with all its problems
problem      bearing or contact, material, lubricant, axes of the grid
supply       oil supply and roughness of a job, a scene or a command line, as text
solids       the structural law
profiles     profiles of rollers, by name, as an arc or a table
solvers      names and settings of the solvers
defaults     what a job takes where it says nothing; the job of a designation
reader       job file, shipped job or map file -> `Job`
job_text     values in SI -> the text of a job file, for `Job.build`
smooth       a smooth function through few points, with its spread by leaving out
estimate_bands  effect of what is estimated on stiffness, damping and film
make         the room from a job to a map file, from a batch to its maps
solve        the room of single operating points
show         the room where a map is opened, described, drawn, compared
budget       the room of error budgets: ways of computing a contact beside others
cost         time and memory of a job, from points that are tried
calls        the functions of Python: generate, compare, solve, solve_points
commands     one module a command
cli          the command line
===========  ====================================================================================

Arrows run from `show`, `solve` and `budget` to `make`, and from all of them to the modules above the rooms.
Nothing is imported here: take the names from their modules.
"""
