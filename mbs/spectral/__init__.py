"""Results of a run-up: levels over speed, frequency and order."""
