"""Stability at the extremes: what a search over wild input found, and how input is damaged.

=========  ==============================================================================
findings   `Check`: how many cases of one kind were right, refused with a reason, or wrong
=========  ==============================================================================

What is searched is no part of it: contacts and files of maps are in `ehdmaps.jobs`, bearings, runs and scenes in `mbs`.
"""
