"""Commands of the laboratory instruments: each is loaded where it is asked for."""
