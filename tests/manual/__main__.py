"""Run: python -m tests.manual [--write]. Compares the pages of keys and commands with the code, or rewrites them."""

from __future__ import annotations

import argparse
import sys

from tests.manual.keys import WordsError
from tests.manual.pages import PAGES


def main() -> int:
    """Compare or write; the exit status."""
    parser = argparse.ArgumentParser(prog="python -m tests.manual", description=(__doc__ or "").partition(". ")[2])
    parser.add_argument("--write", action="store_true", help="rewrite the pages that differ")
    write = parser.parse_args().write
    wrong = 0
    for path, made in PAGES.items():
        try:
            text = made()
        except WordsError as error:
            print(error)
            wrong += 1
            continue
        if path.is_file() and path.read_text(encoding="utf-8") == text:
            continue
        print(f"{path.name}: {'rewritten' if write else 'differs; python -m tests.manual --write'}")
        wrong += not write
        if write:
            path.write_text(text, encoding="utf-8")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
