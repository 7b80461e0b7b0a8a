"""The contract between those who make maps and those who use them: the file, and the contact law.

The modules in the order in which data pass through them:

=============  =======================================================================================
schema         names, units and types of everything in a map file
records        contacts, bearing and oil from the attributes of a map; stiffness and damping by a structural law
reading        a map file as datasets: whether it is a map, and whether it was changed
edges          where the points of a map are known; films beyond its speeds and temperatures
emap           `EHDMap`, `open_map`: a map file as a value
usable         whether a law can be made from a map
film_field     `FilmField`: film of each contact at any load, speed and temperature; down to which load it is known
grid_field     the film field of the map's own grid, and of lines that its contacts share or have alone
backbone_plan  which lines are solved for a contact law besides the map
backbone       the film field of those lines
table_field    the film field of the film table
rolling_film   rolling force and mass flow of each contact at any load, speed and temperature
contact_curve  approach and damping of one contact over load, with the film below the lowest known load
oil_layer      the film of a contact on an oil layer, from that of the flooded one
points         the room of films of points on layers and between rough surfaces
rough_layer    asperities, and the load that they share with the film
compilation    curves -> table over approach, speed and temperature
kernels        the room of these tables and of the C that reads them, at one point or many; films with memory
outside_calls  arguments of a law, and its points outside the map
law_errors     bounds of the errors of a law, from what the map states
law_films      below which load the films of a law are a guess, and how they lock; `LawAtPoint`
law            `ContactLaw`
=============  =======================================================================================

Arrows run from these modules to `kernels`, and none runs back. Nothing is imported here: take the names from their
modules, or `open_map` from `ehdmaps`.
"""
