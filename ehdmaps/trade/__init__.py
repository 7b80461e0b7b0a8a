"""Speed against accuracy, as it was measured: rows of contacts and of machines, and the error budget made of them.

Contacts are measured in `ehdmaps.jobs.budget`, machines in `mbs.budget`, both at length in `mbs.laboratory`.
"""
