"""Requirements of a scene: the ranges that it visits, which physics matters there, and maps that hold just these.

========  ==========================================================================================
ranges    operating points of a scene and the loads and speeds seen there
plan      which ranges a scene needs of a contact map, and the jobs that cover them
criteria  by how much a physics changes a contact, in closed form
verdicts  which physics of the films a scene requires
auto      an analysis that chooses its physics, and makes maps of what the film table has not
========  ==========================================================================================
"""
