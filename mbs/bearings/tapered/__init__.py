"""Tapered roller bearings: five freedoms, quasi-static, rollers between cup, cone and rib in slices.

=====================  ================================================================================================
`kernel_structs`       lengths and laws of a bearing; the same for the kernel in C, and its functions: taper.h
`tapered_bearing`      the force; loads of the rollers, energy of dry contacts, the work of speed
`rollers_in_balance`   small motions: films with memory in linear analyses, errors of the law
`tapered_block`        the bearings of a compiled run
`line_film`            films of both raceways at one speed as tables for the kernel
`roller_report`        pressures and films of the contacts at rest, the cost of rolling
`tapered_point`        an operating point: equilibrium, pressures, films, the rib
=====================  ================================================================================================
"""
