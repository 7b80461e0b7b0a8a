"""Processor time: what all printed costs are, so that a busy machine does not change them."""

from __future__ import annotations

import os
import time


def cpu_seconds() -> float:
    """Processor time of this process and of the programs that it ran and that ended [s]."""
    times = os.times()
    return time.process_time() + times.children_user + times.children_system
