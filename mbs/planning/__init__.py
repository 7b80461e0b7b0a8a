"""Requirements of a scene: the ranges that it visits, jobs of maps of just these, which physics matters there.

=========  ==========================================================================================
question   speeds that an analysis visits, of all that a scene states
plan       loads and speeds of the operating points of a scene, the ranges of a map, and the jobs that cover them
criteria   by how much a physics changes a contact, in closed form
physics    verdicts on the physics of the films of a scene, and an analysis that chooses it
tolerance  step and slices that keep the level of a run-up within a tolerance, and runs with them
=========  ==========================================================================================
"""
