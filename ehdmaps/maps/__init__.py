"""The contract between those who make maps and those who use them: the file, and the contact law.

The modules in the order in which data pass through them:

=============  =======================================================================================
schema         names, units and types of everything in a map file
structure      films of a map -> approach, stiffness, damping, by a structural law
records        contacts, bearing and oil from the attributes of a map
validation     whether a file or a dataset is a map
reading        a map file as datasets
checksum       whether a map was changed since it was made
emap           `EHDMap`, `open_map`: a map file as a value
usable         whether a law can be made from a map
film_field     `FilmField`: film of each contact at any load, speed and temperature
grid_field     the film field of the map's own grid
low_loads      down to which load films are known, and where the tail is right
backbone_plan  which lines are solved for a contact law besides the map
backbone       the film field of those lines
own_lines      the same, whether contacts share their lines or each has its own
mixing         the compiled inner loop of the backbone
rolling_film   rolling force and mass flow of each contact at any load, speed and temperature
dry            stand-in for the film of a dry map
tail           film below the lowest known load
contact_curve  approach and damping of one contact over load
curves         the same of one contact or several in series, dense, for charts and tables
oil_layer      the film of a contact on an oil layer, from that of the flooded one
asperities     pressure of asperities, and the mean gap between rough surfaces
rough_films    Lambda, and the film's share of the load, at the points of a map
rough_layer    load sharing of film and asperities, between the film and the structure
splines        cubic splines on uniform axes
compilation    curves -> table over approach, speed and temperature
tables         the arrays of a compiled law
elementary     exp and log for compiled code
lines          splines and states in compiled code
kernel         the law at run time, one point at a time, for compiled code
bulk           the law at run time, many points
excursions     what of some values lies outside the map
outside_calls  the same as it adds up over the calls of a law
law_errors     bounds of the errors of a law, from what the map states
law_change     the table of a law with another stiffness, damping and film
law_arguments  arguments of a law: arrays of doubles, of one shape, finite
film_response  what films with memory leave out of the response of the film solver
law_films      below which load the films of a law are a guess, and how they lock
law            `ContactLaw`, `LawAtPoint`
=============  =======================================================================================

Nothing is imported here: take the names from their modules, or `open_map` from `ehdmaps`.
"""
