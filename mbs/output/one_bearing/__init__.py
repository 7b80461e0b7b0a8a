"""Points of one bearing of any kind: as a page or a table, as a dataset and CSV.

========================  ============================================================================
kind                      what a kind of bearings has, and parts that kinds share
balls, cylindrical, ribs  the kinds: a row each, and lines on such bearings of a machine
table, files              words of all kinds; datasets and files of all kinds
========================  ============================================================================
"""
