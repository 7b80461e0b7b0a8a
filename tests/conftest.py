"""Settings of all tests."""

import os

from hypothesis import settings

# CI must not fail on an example that nobody has seen before; a developer wants to see new ones
settings.register_profile("ci", derandomize=True, deadline=None)
settings.register_profile("developer", deadline=None)
settings.load_profile("ci" if os.environ.get("CI") else "developer")
