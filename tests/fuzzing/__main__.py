"""Give every reader many damaged files, and print what becomes of them.

    python -m tests.fuzzing                         # 10000 files a reader: an hour
    python -m tests.fuzzing --mutations 500 map     # some readers alone, by their names

Exit status 1 where something failed.
"""

from __future__ import annotations

import argparse
import sys

from mbs.laboratory.extremes.check import checks_text
from tests.fuzzing import machine_readers, map_readers
from tests.fuzzing.search import fuzz

READERS = {**map_readers.READERS, **machine_readers.READERS}

if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m tests.fuzzing", description="Readers given damaged files.")
    parser.add_argument("readers", nargs="*", metavar="READER", help=f"default: all; {', '.join(READERS)}")
    parser.add_argument("--mutations", type=int, default=10000, help="damaged files for each reader; 10000")
    parser.add_argument("--seed", type=int, default=1, help="seed of all chance; 1")
    arguments = parser.parse_args()
    found = [fuzz(READERS[name](), arguments.mutations, arguments.seed) for name in arguments.readers or READERS]
    print(checks_text(found))
    sys.exit(any(check.failed for check in found))
