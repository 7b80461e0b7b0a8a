"""Requirements of a scene: the ranges that it visits, jobs of maps of just these, which physics matters there.

=========  ==========================================================================================
question   speeds that an analysis visits, of all that a scene states
ranges     operating points of a scene and the loads and speeds seen there
plan       which ranges a scene needs of a contact map, and the jobs that cover them
criteria   by how much a physics changes a contact, in closed form
physics    verdicts on the physics of the films of a scene
tolerance  step and slices that keep the level of a run-up within a tolerance, and runs with them
auto       an analysis that chooses its physics
=========  ==========================================================================================
"""
