"""A map for people: opened, described, drawn, compared, as a report."""
