"""The system linearised at an equilibrium: modes and responses, both over speed, and where that is no longer valid."""
