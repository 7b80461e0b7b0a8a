"""The nonlinear system in time: the method, compiled run-ups, and the same in plain Python."""
