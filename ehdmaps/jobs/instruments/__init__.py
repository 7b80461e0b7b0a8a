"""Laboratory instruments: speed against accuracy of contacts, and wild inputs to all readers and solvers."""
