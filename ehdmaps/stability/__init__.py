"""Stability at the extremes: what a search over wild input found, and how input is damaged.

=========  ==============================================================================
findings   `Check`: how many cases of one kind were right, refused with a reason, or wrong; as a table, and as JSON
mutations  how good files are damaged
fuzzing    a reader given damaged files, in child processes that may crash
=========  ==============================================================================

What is searched is no part of it: contacts and files of maps are in `ehdmaps.jobs`, bearings, runs and scenes in `mbs`.
"""
