"""The system linearised at an equilibrium: modes and responses, both over speed, and where that stops to hold."""
