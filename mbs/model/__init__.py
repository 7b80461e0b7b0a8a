"""A machine as bodies and what connects them: parts, prescribed courses, the system and its equilibrium."""
