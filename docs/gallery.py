"""Pages of the examples: text, code, and the printed lines and figure of a run while the documentation is built.

An example whose text, and the packages it runs on, are as they were at the last run is not run again: the tests of the
examples read these pages too.
"""

from __future__ import annotations

import ast
import hashlib
import os
import subprocess
import sys
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).parents[1]
EXAMPLES = ROOT / "examples"
PAGES = Path(__file__).parent / "gallery_pages"
PATIENCE = 1800.0
"""Seconds after which an example is taken to hang: some need minutes where a busy machine compiles film solvers."""


class ExampleError(RuntimeError):
    """An example fails, or leaves no figure."""


def make_gallery() -> None:
    """Write a page for every example, and remove those of examples that are gone.

    Raises
    ------
    ExampleError
        An example fails, or leaves no figure.
    """
    sources = surroundings()
    examples = sorted(EXAMPLES.glob("[0-9][0-9]_*.py"))
    for example in examples:
        make_page(example, sources)
    names = {example.stem for example in examples}
    for page in PAGES.glob("*.md"):
        if page.stem not in names:
            page.unlink()


def surroundings() -> str:
    """What the result of an example may depend on besides its text: Python, all packages, and the files of ours."""
    installed = sorted(f"{each.name} {each.version}" for each in metadata.distributions())
    found = hashlib.sha256("\n".join([sys.version, *installed]).encode())
    shapes = ("ehdmaps/**/*.py", "ehdmaps/**/*.toml", "mbs/**/*.py", "mbs/systems/*.toml", "mbs/systems/*.nc")
    for path in sorted(path for shape in shapes for path in ROOT.glob(shape)):
        found.update(path.read_bytes())
    return found.hexdigest()


def make_page(example: Path, sources: str) -> Path:
    """Run an example and write its page, if either changed.

    Parameters
    ----------
    example : Path
        The program.
    sources : str
        Found by `surroundings`.

    Returns
    -------
    Path
        The page; the figure lies in the folder of the same name.

    Raises
    ------
    ExampleError
        The example fails, or leaves no figure.
    """
    PAGES.mkdir(exist_ok=True)
    code = example.read_text(encoding="utf-8")
    state = hashlib.sha256(f"{Path(__file__).read_text(encoding='utf-8')}{sources}{code}".encode()).hexdigest()
    page, folder = PAGES / f"{example.stem}.md", PAGES / example.stem
    mark = f"% {state}"  # a comment of myst
    if page.is_file() and page.read_text(encoding="utf-8").startswith(mark):
        return page
    folder.mkdir(exist_ok=True)
    for old in folder.iterdir():
        old.unlink()
    printed = _run(example, folder)
    figures = sorted(folder.glob("*.png"))
    if len(figures) != 1:
        raise ExampleError(f"{example}: got {len(figures)} figures; an example writes one")
    title, _, words = (ast.get_docstring(ast.parse(code)) or example.stem).partition("\n")
    body = code.partition('"""')[2].partition('"""')[2].strip()
    text = [
        mark,
        f"# {title.rstrip('.')}",
        words.strip(),
        f"![{title}]({example.stem}/{figures[0].name})",
        f"```python\n{body}\n```",
        f"It prints\n\n```text\n{printed.rstrip()}\n```",
        f"File: `examples/{example.name}`",
    ]
    page.write_text("\n\n".join(text) + "\n", encoding="utf-8")
    return page


def _run(example: Path, folder: Path) -> str:
    """What an example prints; its figure goes to the folder."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg"}
    # small matrices: threads of BLAS that wait for each other on a busy machine cost more than they bring
    environment |= {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-W", "error", str(example), str(folder)]
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    if done.returncode != 0:
        raise ExampleError(f"{example}: exit status {done.returncode}\n{done.stderr.strip()}")
    return done.stdout
