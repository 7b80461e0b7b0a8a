"""What a run-up shows: levels over speed, frequency and order."""
