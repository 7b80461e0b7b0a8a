"""Tapered roller bearings: five freedoms, quasi-static, rollers between cup, cone and rib in slices.

=====================  ================================================================================================
`tapered_shape`        numbers of a bearing: lengths, laws of contacts
`kernel_structs`       the same for the kernel in C, and its functions: `ehdmaps.kernel`, taper.h and those after it
`tapered_bearing`      the force; loads of the rollers
`tapered_element`      a bearing in a machine: films of its speed
`tapered_memory`       films with memory in time
`rollers_in_balance`   small motions: films with memory in linear analyses, errors of the law
`tapered_energy`       energy of dry contacts, and the work of speed
`tapered_block`        the bearings of a compiled run
`line_film`            films of both raceways at one speed as tables for the kernel
`tapered_point`        an operating point: equilibrium, pressures, films, the rib
=====================  ================================================================================================
"""
