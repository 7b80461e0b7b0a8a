"""`python -m ehdmaps`."""

import sys

from ehdmaps.jobs.cli import main

if __name__ == "__main__":
    sys.exit(main())
