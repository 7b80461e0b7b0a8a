"""The laboratory: what measures the program and its choices, for contacts and for machines. Nothing imports it.

The commands of both programs load it by name.

=========  ==================================================================================
extremes   right, refused or wrong: contacts, bearings and runs over wild input
tradeoff   speed against accuracy of contacts and of machines
variants   how far a difference between two laws depends on what was assumed
commands   `stability` and `tradeoff` of both programs, `variants` of mbs
=========  ==================================================================================
"""
