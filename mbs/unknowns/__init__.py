"""Unknowns of a machine: what a scene leaves open, by how much, and the machines that it may be as well.

==========  ================================================================================================
unknown     one thing that is not known: half-width, reason, and the changed scenes that a band looks at
statement   how well a number is known, as files and commands say it; the nearest statement wins
geometry    what an estimated inner geometry may be off, and profiles that are not stated
held_open   all that a scene leaves open, with the sources of its spreads
words       the same for people: head of a result, list of `mbs check`
looks       the band of a result from looks at the changed scenes
of_..., bounds, over_speed  bands of modes, peaks and variables, over speed, and as variables of files
==========  ================================================================================================

The first five compute no result: whoever has a result looks at the changed scenes beside it.
"""
