"""Speed against accuracy, as it was measured: rows of contacts and of machines, and what is made of them.

=======  ================================================================================
record   `Trade`: choices with their cost, and the errors of what a user looks at
entry    `Entry`: a way to an answer as it will be measured, beside what it is held against
budget   sources of error, by how much results are wrong without them
=======  ================================================================================

Contacts are measured in `ehdmaps.jobs.budget`, machines in `mbs.budget`, both at length in `mbs.laboratory`.
"""
