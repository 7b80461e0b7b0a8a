"""Share of true machines inside bands of what is not known; see `tests.benchmarks.coverage.__main__`."""
