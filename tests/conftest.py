"""Settings of all tests."""

import os
import tempfile
from collections.abc import Iterator

import pytest
from hypothesis import settings

# CI must not fail on an example that nobody has seen before; a developer wants to see new ones
settings.register_profile("ci", derandomize=True, deadline=None)
settings.register_profile("developer", deadline=None)
settings.load_profile("ci" if os.environ.get("CI") else "developer")


@pytest.fixture(scope="session", autouse=True)
def own_reductions() -> Iterator[None]:
    """Keep reductions of finite-element bodies out of the user's folder, in programs that tests start too."""
    with tempfile.TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        patch.setenv("EHDMAPS_REDUCED", folder)
        yield
