"""Flexible bodies: beams, finite-element matrices, and their reduction to a few coordinates."""
