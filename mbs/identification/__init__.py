"""Unknowns of a machine, found from what is measured of it; modules in the order of the data.

===========  ======================================================================================================
measured     frequency responses and modes of a state of the machine, with what noise leaves open of them
reading      the same from universal files and tables
free         an unknown that is set free: how it changes a scene, its range, what is known of it beforehand
machine      responses and modes of the machine with other values of the unknowns
search       residuals, many starts, least squares
certainty    bands: noise by the Jacobian, and what the model holds fixed by trials
planning     which hits, sensors and speeds tell unknowns apart, before anything is measured
found        the result: data set, and a scene with what was found
===========  ======================================================================================================
"""
