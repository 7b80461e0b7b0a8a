"""Figures of the pages: runs the commands that they come from, and compares or rewrites what is shown.

Run: python -m tests.benchmarks.pages [--write] [--long] [--openfoam] [--only TEXT] [--maps FOLDER] [--folder FOLDER]
                                      [--reuse] [--against TREE] [PAGE ...]

Compares every figure of the marked blocks with what its commands print now, by the digits that are shown, and prints a
table. Exit status 1: a figure differs or a command fails. Times and ratios of times are exempt from the comparison;
they are counted apart. With --write the blocks are replaced in place, times too. `figures.toml` has
the commands, `tests.benchmarks.page_block` the form of the markers.

--against TREE runs the same commands with another checkout (a folder with `ehdmaps`, `mbs` and `tests`) and compares
with what that one prints: the figures of the blocks by each tree, and everything that the commands print.

Blocks are quick (together some minutes), long (with --long) or need the built ehlFoam (--openfoam). Maps that commands
read are generated in FOLDER first, each by its tree, unless --maps says where they are; cfd.nc takes an hour, night.nc
somewhat more.
"""

from __future__ import annotations

import argparse
import difflib
import hashlib
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

from tests.benchmarks.page_block import NUMBER, WEIGHTS, Block, Compared, Difference, blocks, compared_texts
from tests.benchmarks.page_recipes import TIMES, compared, rewritten
from tests.benchmarks.printed_tables import Output

ROOT = Path(__file__).parents[2]
PAGES = (
    "README.md",
    "docs/real_films.md",
    "docs/tradeoffs.md",
    "docs/measured.md",
    "docs/accuracy.md",
    "docs/point_contacts.md",
    "docs/cfd.md",
    "docs/overnight.md",
    "docs/witnesses.md",
    "docs/electrics.md",
    "docs/solids.md",
    "docs/python.md",
    "docs/glossary.md",
    "docs/machines.md",
    "docs/openfoam_results.md",
    "docs/clusters.md",
)
MADE = {
    "nu308.nc": "ehdmaps generate nu308 -o nu308.nc",
    "n1014.nc": "ehdmaps generate n1014 -o n1014.nc",
    "cfd.nc": "ehdmaps generate nu308_openfoam -o cfd.nc",
    "night.nc": (
        "python -m tests.benchmarks.overnight night.nc --make nu308_night --kills 3 --again 50 --witness 100 "
        "--plot overnight.png"
    ),
    "vg320.nc": "ehdmaps generate docs/vg320.toml -o vg320.nc --check",
    "dry.nc": "ehdmaps generate nu308 --solver hertz -o dry.nc",
    "spirax.nc": 'ehdmaps generate --bearing NU308 --oil "Spirax MA 80W" -o spirax.nc',
    "h12.nc": 'python -m examples.housings gearbox_housing --cutoff "12 kHz" -o h12.nc',
    "hits.uff": "mbs hammer n1014_testrig --map n1014.nc -o hits.uff",
}
"""Files that commands read, and what makes them."""

SHOWN = 12
"""Differences of a block that are printed."""

PROGRAMS = {
    "ehdmaps": ["-c", "import sys; from ehdmaps.jobs.cli import main; sys.exit(main())"],
    "mbs": ["-m", "mbs"],
    "python": [],
}
BANDED = ("bearing", "critical", "lsa", "modes", "report", "run", "statics", "sweep")
"""Commands whose figures on pages are those of the machine as stated: bands of what is not known round them."""

UNMET = 1
"""Exit status of the programs for a result with a tolerance that is not met, which is printed too."""


class CommandError(RuntimeError):
    """A command of a page fails."""


@dataclass
class Runner:
    """Runs commands with the code of a tree, each once; files and printed texts are kept in a folder."""

    tree: Path
    folder: Path
    maps: Path | None
    reuse: bool
    texts: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Make the folder."""
        self.folder.mkdir(parents=True, exist_ok=True)

    def output(self, command: str) -> Output:
        """What a command prints; files that it reads are made first.

        Raises
        ------
        CommandError
            The command fails.
        """
        if command not in self.texts:
            for name, making in MADE.items():
                if re.search(rf"(?<!-o )\b{re.escape(name)}\b", command) and command != making:
                    self._provide(name, making)
            self.texts[command] = self._run(command)
        return Output(command, self.texts[command])

    def _provide(self, name: str, making: str) -> None:
        """Have a file in the folder."""
        if (self.folder / name).exists():
            return
        if self.maps is not None and (self.maps / name).is_file():
            shutil.copy(self.maps / name, self.folder / name)
        else:
            self.output(making)

    def _run(self, command: str) -> str:
        kept = self.folder / f"{hashlib.sha256(command.encode()).hexdigest()[:16]}.txt"
        if self.reuse and kept.is_file():
            return kept.read_text(encoding="utf-8").partition("\n")[2]
        program, *words = shlex.split(command)
        if program == "mbs" and words[0] in BANDED and "--bands" not in words:
            words += ["--bands", "numerics"]
        words = [str(ROOT / word) if word.startswith(("tests/", "docs/")) else word for word in words]
        environment = {**os.environ, "PYTHONPATH": str(self.tree), "MPLBACKEND": "Agg"}
        environment |= {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
        print(f"  {command}", file=sys.stderr, flush=True)
        began = time.perf_counter()
        done = subprocess.run(
            [sys.executable, *PROGRAMS[program], *words],
            cwd=self.folder,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        print(f"    {time.perf_counter() - began:.0f} s", file=sys.stderr, flush=True)
        if done.returncode not in {0, UNMET} or "Traceback" in done.stderr or not done.stdout:
            raise CommandError(f"{command}: exit status {done.returncode}: {done.stderr.strip()[-500:]}")
        kept.write_text(f"{command}\n{done.stdout}", encoding="utf-8")
        return done.stdout


def script_before(page: Path, block: Block) -> str:
    """The Python script in the fence before a block."""
    found = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8")[: block.begin], re.DOTALL)
    return str(found[-1])


def outputs(runner: Runner, block: Block) -> list[Output]:
    """What the commands of a block print; the command `python script.py` is the script shown before the block."""
    if "python script.py" in block.commands:
        (runner.folder / "script.py").write_text(script_before(ROOT / block.page, block), encoding="utf-8")
    return [runner.output(command) for command in block.commands]


def whole_outputs(first: str, second: str) -> Compared:
    """Compare all that a command prints; lines that only one of both prints are differences."""
    one, two = (text.splitlines() for text in (first, second))
    masked = [[NUMBER.sub("#", " ".join(line.split())) for line in lines] for lines in (one, two)]
    figures = times = 0
    different: list[Difference] = []
    for tag, a, b, c, d in difflib.SequenceMatcher(None, *masked, autojunk=False).get_opcodes():
        if tag != "equal":
            different += [Difference(line.strip(), "(no such line)") for line in one[a:b]]
            different += [Difference("(no such line)", line.strip()) for line in two[c:d]]
            figures += b - a + d - c
            continue
        part = compared_texts("\n".join(one[a:b]), "\n".join(two[c:d]), TIMES)
        figures, times = figures + part.figures, times + part.times
        different += part.different
    return Compared(figures, times, tuple(different))


def report(name: str, found: Compared) -> None:
    """Print a row, and what differs."""
    print(f"{name:58} {found.figures:8d} {found.equal:7d} {len(found.different):10d} {found.times:7d}", flush=True)
    if found.problem:
        print(f"    {found.problem}")
    for each in found.different[:SHOWN]:
        print(f"    {each.shown}  ->  {each.found}")
    if len(found.different) > SHOWN:
        print(f"    and {len(found.different) - SHOWN} more")


def chosen(given: argparse.Namespace) -> list[tuple[int, Block]]:
    """Blocks that were asked for, each with its number among those of its page."""
    weights = {"quick"} | {weight for weight in WEIGHTS if getattr(given, weight, False)}
    found = []
    for page in given.pages or PAGES:
        found += [
            (number, block)
            for number, block in enumerate(blocks(page, (ROOT / page).read_text(encoding="utf-8")))
            if block.weight in weights and given.only in f"{block.place} {block.recipe} {' '.join(block.commands)}"
        ]
    return found


def write(number: int, block: Block, made: list[Output]) -> None:
    """Replace a block in its page; its place is looked up anew, since blocks before it may have changed."""
    path = ROOT / block.page
    text = path.read_text(encoding="utf-8")
    now = list(blocks(block.page, text))[number]
    path.write_text(text[: now.begin] + rewritten(now, made) + text[now.end :], encoding="utf-8")


def parser() -> argparse.ArgumentParser:
    """Describe the options."""
    top = argparse.ArgumentParser(prog="python -m tests.benchmarks.pages", description=(__doc__ or "").splitlines()[0])
    top.add_argument("pages", nargs="*", metavar="PAGE", help=f"default: {', '.join(PAGES)}")
    top.add_argument("--check", action="store_true", help="compare only; what is done without --write")
    top.add_argument("--write", action="store_true", help="replace the blocks in place")
    top.add_argument("--long", action="store_true", help="blocks of a minute and more, too")
    top.add_argument("--openfoam", action="store_true", help="blocks that need ehlFoam, too")
    top.add_argument("--only", default="", metavar="TEXT", help="blocks with this text in page, recipe or command")
    top.add_argument("--maps", type=Path, metavar="FOLDER", help="where nu308.nc and others are; else they are made")
    top.add_argument("--folder", type=Path, help="where files and printed texts are kept; default: a temporary one")
    top.add_argument("--reuse", action="store_true", help="take printed texts that are in --folder from a run before")
    top.add_argument("--against", type=Path, metavar="TREE", help="compare with another checkout, not with the page")
    return top


def main() -> int:
    """Compare or write; the exit status."""
    given = parser().parse_args()
    if given.check and given.write:
        parser().error("--check and --write: one of both")
    folder = given.folder or Path(tempfile.mkdtemp(prefix="pages-"))
    here = Runner(ROOT, (folder / "here").resolve(), given.maps, given.reuse)
    there = None
    if given.against is not None:
        there = Runner(given.against.resolve(), (folder / "there").resolve(), given.maps, given.reuse)
    print(f"{'block':58} {'figures':>8} {'equal':>7} {'different':>10} {'exempt':>7}")
    wrong, failed, seen = 0, 0, set[str]()
    for number, block in chosen(given):
        try:
            made = outputs(here, block)
            other = outputs(there, block) if there is not None else []
        except CommandError as error:
            print(f"{block.place:58} failed\n    {error}")
            failed += 1
            continue
        if there is not None:
            found = compared_texts(rewritten(block, other), rewritten(block, made), TIMES)
        else:
            found = compared(block, made)
        report(block.place, found)
        wrong += len(found.different) + bool(found.problem)
        if given.write:
            write(number, block, made)
        for mine, its in zip(made, other, strict=bool(other)) if other else ():
            if mine.command not in seen:
                whole = whole_outputs(its.text, mine.text)
                report(f"  all of: {mine.command[:48]}", whole)
                wrong += len(whole.different)
            seen.add(mine.command)
    print(f"{wrong} differences, {failed} blocks whose commands fail; files in {folder}")
    return int(bool(wrong or failed))


if __name__ == "__main__":
    sys.exit(main())
