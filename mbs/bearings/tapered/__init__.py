"""Tapered roller bearings: five freedoms, quasi-static, rollers between cup, cone and rib in slices.

=====================  ================================================================================================
`tapered_kernel`       the balance of each roller, and the sums over rollers: force, stiffness, damping
`tapered_bearing`      the force; loads of the rollers
`tapered_element`      a bearing in a machine: films of its speed
`line_kernel`          sums over the slices of a line
`tapered_memory`       films with memory in time
`tapered_relaxing`     films with memory in linear analyses
`tapered_energy`       energy of dry contacts, and the work of speed
`tapered_block`        the bearings of a compiled run
`line_film`            films of both raceways at one speed as tables for the kernel
`tapered_point`        an operating point: equilibrium, pressures, films, the rib
`reference_load`       equivalent load and life by the loads of all slices
=====================  ================================================================================================
"""
