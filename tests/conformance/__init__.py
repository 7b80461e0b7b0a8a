"""One test over all kinds of bearings: each kind, and machines that mix them, through one list of claims.

==============  =====================================================================================================
`machines`      the rows: kinds, pairs of them, mixed machines, as scenes
`elements`      claims on the element of a kind: derivatives, work, compiled code, relaxation, extremes
`commands`      commands of `mbs` as rows: each of them on each machine, dry and with films
`datasets`      names, dimensions and units of results are those of the first kind
`notes`         the same fact is told by the same words and ends with the same status
==============  =====================================================================================================

``python -m tests.conformance`` runs all of it and prints the table of kinds and claims.
"""
