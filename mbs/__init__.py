"""Multibody consumer of the contact maps: bearing force element, shaft-bearing-housing systems, gearbox.

Not part of this version: the package is reserved, so that one distribution holds both.
"""
