"""Run: python -m tests.manual [--write]. Compares the pages of keys and commands with the code, or rewrites them."""

from __future__ import annotations

import argparse
import sys

from tests.manual.pages import PAGES


def main() -> int:
    """Compare or write; the exit status."""
    parser = argparse.ArgumentParser(prog="python -m tests.manual", description=(__doc__ or "").partition(". ")[2])
    parser.add_argument("--write", action="store_true", help="rewrite the pages that differ")
    write = parser.parse_args().write
    different = [path for path, made in PAGES.items() if not path.is_file() or path.read_text("utf-8") != made()]
    for path in different:
        print(f"{path.name}: {'rewritten' if write else 'differs; python -m tests.manual --write'}")
        if write:
            path.write_text(PAGES[path](), encoding="utf-8")
    return int(bool(different) and not write)


if __name__ == "__main__":
    sys.exit(main())
