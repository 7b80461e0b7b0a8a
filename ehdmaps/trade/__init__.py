"""Speed against accuracy, as it was measured: one record for contacts, maps and systems, and how it is shown.

The modules in the order in which data pass through them:

=======  ================================================================================
record   `Trade`: choices with their cost, and the errors of what a user looks at; which no other one beats
text     printed tables
data     labelled dataset and JSON, and their files by the rule of all files that are written
figure   one picture, with the front of the best choices
=======  ================================================================================

What is measured is no part of it: contacts and maps are in `ehdmaps.jobs`, systems in `mbs.analyses`.
"""
