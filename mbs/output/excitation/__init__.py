"""Excitation by bearings in results: variables of datasets and lines for people.

Nothing is imported here: take the names from their modules.
"""
