"""Programs started so that Ctrl-C reaches them, also where the tests run with interrupts ignored, as under nohup."""

import signal
import subprocess


def start(command, **options):
    """Start a process as a terminal does: a handler of ours is not inherited, but "ignored" would be."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        return subprocess.Popen(command, **options)
    finally:
        signal.signal(signal.SIGINT, before)
