"""Allowed settings of the solver `reynolds`, for the solver and the reader of job files; imports nothing heavy."""

from __future__ import annotations

from collections.abc import Mapping

SETTING_LIMITS: Mapping[str, tuple[float, float]] = {
    "density": (3.0, 60.0),
    "inlet_length": (20.0, 1e5),
    "tolerance": (1e-12, 1e-3),
    "slide_to_roll": (-2.0, 2.0),
}
"""Smallest and largest value of each setting of `ReynoldsSolver`."""
