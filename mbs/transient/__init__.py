"""The nonlinear system in time: the method, compiled run-ups, the same in plain Python, and hammer tests."""
