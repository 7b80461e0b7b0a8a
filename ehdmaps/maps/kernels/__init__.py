"""A contact law as arrays, and what computes with them: the C library, which knows no map file and no film field.

`ehdmaps.maps` makes these arrays from a map and calls this code, and so do bearings in runs and the exports;
nothing here imports a module of `ehdmaps.maps` outside this room. The modules in the order in which data pass through
them:

==============  ======================================================================================
splines         cubic splines on uniform axes: the coefficients of a table, weights, mixed lines
tables          the arrays of a law
ends            loads at which the films of a map end, over speed and temperature
kept_tables     tables of laws that were made before, kept on disk
law_in_c        the law in C, as Python calls it
locked_film     the stiffness of a contact whose film cannot give way
memory_table    a contact whose film has a memory, as arrays at one speed and temperature
memory          the same for other programs, step by step, with its energy
film_response   what films with memory leave out of the response of the film solver
==============  ======================================================================================

Nothing is imported here: take the names from their modules.
"""
