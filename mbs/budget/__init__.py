"""Error budget of a machine: by how much results are wrong where a source of error is left out or not known.

===========  ==============================================================================
linear_look  what a user looks at in a linear system
sources      laws, oil supplies and what a scene states, each beside the most complete film
===========  ==============================================================================
"""
