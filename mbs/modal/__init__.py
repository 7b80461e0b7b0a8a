"""Experimental modal analysis, of measured records and of simulated ones alike.

In the order in which data pass through:

================  =====================================================================================
`records`         channels, time records of hits, frequency responses
`uff`             universal files (UFF) with either of them, by pyuff
`estimation`      H1, H2 and coherence from averaged hits; windows; which hits are left out
`stabilisation`   which poles are modes: those that come back from order to order
`residues`        residues for given poles, responses made of them, poles of the least error
`fit`             all of that for one band, with poles by p-LSCF of the library sdypy-EMA
`result`          the modes found, their uncertainty, and their dataset
================  =====================================================================================

The package knows nothing of the rest of mbs: a machine that is hit in a simulation (`mbs.transient.hammer`) makes
records like those of a measured one. The libraries pyuff and sdypy-EMA are loaded when they are needed.
"""
