"""Speed against accuracy, as it was measured: rows of contacts and of machines, and what is made of them.

=======  ================================================================================
record   `Entry`: a way to an answer as it will be measured; `Trade`: choices with their cost and their errors
budget   sources of error, by how much results are wrong without them
=======  ================================================================================

Contacts are measured in `ehdmaps.jobs.budget`, machines in `mbs.budget`, both at length in `mbs.laboratory`.
"""
