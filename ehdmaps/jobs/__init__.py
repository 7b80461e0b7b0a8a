"""From a job file to a map file: the only place that knows every part of the project.

The modules in the order in which data pass through them:

===========  ====================================================================================
job          `Job`, what a job file asks for, in SI
table        one table of a TOML file, read key by key with all its problems
axes         the axes of the grid
problem      bearing or contact, material, lubricant
supply       oil supply of a job, a scene or a command line, as text
surface      roughness of a job, a scene or a command line, as text
reader       job file, shipped job or map file -> `Job`
job_text     values in SI -> the text of a job file, for `Job.build`
solvers      names and settings of the solvers
tasks        `Job` -> `LineTask`, the units of work, each with the key of everything that shapes it
store        results by key in a file beside the map; survives kill -9
sweep        tasks -> results, over all cores, past dead workers and Ctrl-C
sampling     random operating points of a job
refinement   the lines that a contact law needs besides the map, and the group they become
regression   a smooth function through few points, with what it is uncertain by
correction   films of one solver corrected by few points of a dearer one; `correction_design` chooses the points,
             `correction_report` says what came of it
law_points   what contact laws give at random points, and how far that is from fresh solves
law_check    the contact laws against fresh solves, as every map with `law_check` has it
holes        isolated holes filled from their neighbours
assemble     results -> dataset of the map
write        dataset -> map file, aside and renamed
generate     the whole story: job -> map file, or a map in memory
points       many operating points: dataset in, dataset out
point_report one operating point, in words and as JSON
calls        the functions of Python: generate, compare, solve, solve_points
progress     a bar on a terminal, lines elsewhere
status       how far a map is, for others to look at while it is made
report       statuses by cause and error estimates, for the next two
summary      what happened, in words
opening      the map of a command, by the structural law that it names
describe     what a map file holds, in words
plot         what a map file holds, on one page
plot_curves  one panel of that page
map_report   a map as one page to send
map_charts   its charts over load, with what they say
map_limits   where the map is limited, and why
film_output  files with the film itself, beside the numbers of one point
traction     traction of one point over the slide-to-roll ratio
supplied     one point behind an oil layer: flow ratio and place of the meniscus
film_plot    pressure, film and velocities of one point, on one page
compare_films films of two maps at random points of their common range
compare      differences between two maps
compare_text the same in words and as JSON
answers      what is asked of a contact and answered, and what errors are relative to
rough_solved load sharing of film and asperities with solved films
contact_ways ways of computing a contact: solvers, oil layers, rough surfaces, frequencies
contestants  the table of the ways that are measured
length_text  load and pressure over the length of a roller in words; `length_plot` draws them
tradeoff     speed against accuracy of contacts, measured
trade_frame  what a reader of that must know besides
commands     one module a command
cli          the command line
===========  ====================================================================================

Nothing is imported here: take the names from their modules.
"""
