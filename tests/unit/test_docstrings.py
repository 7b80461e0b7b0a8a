"""What docstrings say of parameters is what signatures have."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[2]
FILES = sorted([*ROOT.glob("ehdmaps/**/*.py"), *ROOT.glob("mbs/**/*.py"), *ROOT.glob("examples/housings/*.py")])

MANY = 3
"""Arguments from which on a public function has a section Parameters."""

LEFT = 15
"""Public functions of so many arguments that have none yet, most of them in compiled kernels: may only fall."""

SECTION = re.compile(r"^Parameters\n-+\n(.*?)(?=^\S[^\n]*\n-{3,}|\Z)", re.MULTILINE | re.DOTALL)
REFERENCE = re.compile(r"(?:see|as of|as for|as in)(?: the)? `([\w.]+)`")
"""Words of a docstring that leaves its arguments to another one, such as 'see `Element.evaluate`'."""


class Documented(NamedTuple):
    """A public function: where, its arguments, and those that its docstring names; None without the section."""

    where: str
    name: str
    arguments: tuple[str, ...]
    named: tuple[str, ...] | None
    text: str


def arguments_of(node: ast.FunctionDef, method: bool) -> tuple[str, ...]:
    given = node.args
    names = [argument.arg for argument in (*given.posonlyargs, *given.args)]
    if method and not any(ast.unparse(mark) == "staticmethod" for mark in node.decorator_list):
        names = names[1:]
    names += [f"*{given.vararg.arg}"] if given.vararg else []
    names += [argument.arg for argument in given.kwonlyargs]
    names += [f"**{given.kwarg.arg}"] if given.kwarg else []
    return tuple(names)


def named_in(text: str) -> tuple[str, ...] | None:
    found = SECTION.search(text)
    if found is None:
        return None
    entries = [line.partition(" : ")[0] for line in found[1].splitlines() if line and not line[0].isspace()]
    return tuple(name.strip() for entry in entries for name in entry.split(","))


def functions(node: ast.AST, where: str, name: str = "") -> Iterator[Documented]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.ClassDef | ast.FunctionDef) and child.name.startswith("_"):
            continue
        if isinstance(child, ast.ClassDef):
            yield from functions(child, where, f"{name}{child.name}.")
        elif isinstance(child, ast.FunctionDef):
            text = ast.get_docstring(child) or ""
            arguments = arguments_of(child, isinstance(node, ast.ClassDef))
            yield Documented(f"{where}:{child.lineno}", name + child.name, arguments, named_in(text), text)


PUBLIC = [
    function
    for path in FILES
    for function in functions(ast.parse(path.read_text(encoding="utf-8")), path.relative_to(ROOT).as_posix())
]


def test_documented_parameters_are_those_of_the_signature_in_its_order():
    wrong = [
        f"{one.where} {one.name}: documents {one.named}, takes {one.arguments}"
        for one in PUBLIC
        if one.named is not None and one.named != one.arguments
    ]
    assert not wrong, "\n".join(wrong)


def test_functions_of_many_arguments_document_them():
    full = {part for one in PUBLIC if one.named is not None for part in (one.name, one.name.rpartition(".")[2])}
    bare = [
        f"{one.where} {one.name}{one.arguments}"
        for one in PUBLIC
        if one.named is None and len(one.arguments) >= MANY and not full & set(REFERENCE.findall(one.text))
    ]
    assert len(bare) <= LEFT, "without a section Parameters:\n" + "\n".join(bare)
    assert len(bare) >= LEFT - 8, f"only {len(bare)} are left: lower LEFT"


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("Words.", None),
        (
            "Words.\n\nParameters\n----------\na, b : float\n    Text.\n*rest : int\n    Words.",
            ("a", "b", "*rest"),
        ),
        ("Words.\n\nParameters\n----------\na : int\n    Words.\n\nReturns\n-------\nb : int\n    Words.", ("a",)),
    ],
)
def test_sections_are_read(text, named):
    assert named_in(text) == named
