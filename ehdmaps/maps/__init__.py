"""The contract between those who make maps and those who use them: the file, and the contact law.

The modules in the order in which data pass through them:

==============  ======================================================================================
schema          names, units and types of everything in a map file
records         contacts, bearing and oil from the attributes of a map; stiffness and damping by a structural law
reading         a map file as datasets: whether it is a map, and whether it was changed
emap            `EHDMap`, `open_map`: a map file as a value
usable          whether a law can be made from a map
film_field      `FilmField`: film of each contact at any load, speed and temperature; down to which load it is known
grid_field      the film field of the map's own grid, and of lines that its contacts share or have alone
backbone_plan   which lines are solved for a contact law besides the map
backbone        the film field of those lines
table_field     the film field of the film table
rolling_film    rolling force and mass flow of each contact at any load, speed and temperature
contact_curve   approach and damping of one contact over load, with the film below the lowest known load
curves          the same of one contact or several in series, dense, for charts and tables
oil_layer       the film of a contact on an oil layer, from that of the flooded one
rough_layer     asperities, and the load that they share with the film
splines         cubic splines on uniform axes
compilation     curves -> table over approach, speed and temperature
tables          the arrays of a compiled law
lines           splines and states in compiled code, with exp and log for it
roller_balance  a roller between its two contacts
kernel          the law at run time, one point at a time, for compiled code
bulk            the law at run time, many points
outside_calls   arguments of a law, and its points outside the map
law_errors      bounds of the errors of a law, from what the map states
law_films       below which load the films of a law are a guess, and how they lock
locked_film     the stiffness of a contact whose film cannot give way
memory_table    a contact whose film has a memory, as arrays at one speed and temperature
memory          the same for other programs, step by step, with its energy
film_response   what films with memory leave out of the response of the film solver
law             `ContactLaw`, `LawAtPoint`
==============  ======================================================================================

Nothing is imported here: take the names from their modules, or `open_map` from `ehdmaps`.
"""
