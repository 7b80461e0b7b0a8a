"""Results as labelled datasets and as figures."""
