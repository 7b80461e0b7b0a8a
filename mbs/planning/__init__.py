"""Requirements of a scene: the ranges that it visits, which physics matters there, and maps that hold just these.

=========  ==========================================================================================
question   speeds that an analysis visits, of all that a scene states
ranges     operating points of a scene and the loads and speeds seen there
plan       which ranges a scene needs of a contact map, and the jobs that cover them
seen       the same of balls, tapered and ribbed rollers, of which no map is made
criteria   by how much a physics changes a contact, in closed form
verdicts   which physics of the films a scene requires
of_table   which films balls, tapered and ribbed rollers need, and what is not known of points
machine    what the scene file switches, and how much the other choice would change
left_out   what commands without `--auto` say of heat
kept_maps  maps that were made before
tolerance  step and slices that keep the level of a run-up within a tolerance
tolerated  runs with such settings, for `--tolerance`
auto       an analysis that chooses its physics, and makes maps of what the film table has not
=========  ==========================================================================================
"""
