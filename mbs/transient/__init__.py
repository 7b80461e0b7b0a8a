"""The nonlinear system in time: the method, runs in C, the same steps in Python, and hammer tests."""
