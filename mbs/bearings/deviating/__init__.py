"""Deviations of bearings from their form, by which they excite what they carry: `tables`.

Nothing is imported here: take the names from the module.
"""
