"""The equations in C99, one shared library of them, and how Python calls it.

Laws of contacts, films with memory, bearings and runs in time stand once, in the folder `c`: Python calls them through
`ctypes`, and exports write the same files, unchanged, with their numbers as data.

==============  ======================================================================================
library         finds the library, has it built where it does not fit the C files, and calls it
building        the C compiler; which state of the C files a library was made of (standard library only)
record          structs: numbers and arrays of Python as C sees them
==============  ======================================================================================

The C files in the order in which data pass through them; `kernel.c` includes all others and is what is compiled, as one
unit. So every `static` name is unique among all files. A public name begins with `ehd_`, and a public function takes a
pointer to its data first: C keeps no state of its own.

============================  ======================================================================================
numbers.h                     what every part needs: the lesser and the greater of two numbers
elementary.h                  logarithm and exponential for loops of vector instructions
status.[hc]                   what calls find, and how it is called
law/law.[hc]                  contact law over approach, rate, speed and temperature: tables, points, ends
law/cells.c                   cells of tables that are the binary digits of a number
law/law_block.c               the law at rest at a block of places, for vector instructions
law/law_many.[hc]             the law at many places, in blocks for vector instructions, and at one for Python
law/film_lines.[hc]           films of a table, read at many points, and nodes of a law's table
law/rough.[hc]                load sharing of film and asperities
film/film.[hc]                films with memory of one contact: equilibrium, steps in time, rates
film/film_energy.c            what such films store and take up
film/film_fit.c               how far a film locks, from the response of the film solver
film/film_arrays.c            many films at once, for Python
film/film_slices.c            slices with such films: one step of all slices of a bearing
cylinder/cylinder_law.[hc]    the law at one speed and temperature, as a table for bearings with cylindrical rollers
cylinder/cylinder.[hc]        bearings with cylindrical rollers: force, stiffness and damping at a pose
cylinder/cylinder_films.[hc]  the same with films that have a memory
cylinder/cylinder_coupled.c   the same with slices that know of their neighbours
cylinder/cylinder_call.c      bearings with cylindrical rollers as Python calls them
pair/pair_law.[hc]            law of a contact of balls, or of lines with tables of their own, over its approach
pair/pair_speeds.c            such laws over the entrainment speed
pair/pair_memory.c            such contacts with films that have a memory: springs in series with dampers over a step
ball/ball.h                   structures of a ball bearing
ball/ball_balance.c           the balance of a ball
ball/ball_bearing.c           force, stiffness and damping of a ball bearing at a pose
taper/taper.h, _lines.c       sums over the slices of a line of a tapered roller, or of a cylindrical one between ribs
taper/taper_balance.c         the balance of such a roller
taper/taper_bearing.c         force, stiffness and damping of its bearing at a pose
taper/taper_films.c           its films with a memory
run/deviations.[hc]           deviations of bearings from their form: waves, spalls, sizes
run/rings.[hc]                bearings with cylindrical rollers in runs: how rings and rollers move
cylinder/cylinder_block.[hc]  such bearings whose films follow at once, or which are dry, as a kind of elements
film/film_block.c             such bearings with films that have a memory, as a kind of elements
run/block.h                   what a kind of elements brings to runs in time: its functions, for anyone's own ones, too
pair/pair_films.c             laws of pairs at nodes over the speed of a run, and those in use
pair/pair_port.c              what bearings of five freedoms answer in runs
ball/ball_block.c             ball bearings in runs
taper/taper_block.c           bearings of tapered rollers, or of such between ribs, in runs
dense.c                       small matrices: products, elimination, steps in Python
run/gear.c                    gear meshes
run/matrix.c                  connections by matrices
run/advance.c                 steps of a run in time
kernel.c                      the unit that is compiled
============================  ======================================================================================

Nothing is imported here: take the names from their modules.
"""
