"""What an analysis raises when it finds no result from input that is valid."""

from __future__ import annotations

from ehdmaps.errors import EhdmapsError


class AnalysisError(EhdmapsError):
    """An equilibrium or a time step was not found; the message says what to try."""
