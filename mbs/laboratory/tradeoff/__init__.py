"""Speed against accuracy: ways to an answer are drawn up, asked, held against their reference, and answered for.

============  ==============================================================================
contestants   who takes part among contacts, and dear ways of computing one
contacts      contacts at random points of a job
ramp_parts    short runs around some speeds of a ramp
machines      laws, supplies, maps, slices, cut-off, step and cage angles of a scene
answer        what keeps a tolerance at the least cost, and the error budget
text          printed tables
data          labelled dataset and JSON, and their files by the rule of all files that are written
figure        one picture, with the front of the best choices
============  ==============================================================================

Rows and their errors are those of `ehdmaps.trade`, which reports of maps and of machines use, too.
"""
