"""`python -m mbs`."""

import sys

from mbs.cli import main

if __name__ == "__main__":
    sys.exit(main())
