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


SECTIONS = re.compile(
    r"^(?:Parameters|Attributes|Returns|Yields)\n-+\n(.*?)(?=^\S[^\n]*\n-{3,}|\Z)", re.MULTILINE | re.DOTALL
)
NO_NOUN = re.compile(
    r"(?:Of|For|At|In|With|Without|Where|Its|By|From|To|On|As|Between|Beside|After|Before|Over|Along|Per|About|Below|"
    r"Above|Under|Until|Through|Against|Within|Into|Inside|Outside|Among|Like)\b|[A-Za-z]+(?:[.;]|$)"
)
"""How a description begins that says no more than a relation, as 'of a roller', or that is one word."""

STILL = {"ehdmaps/maps": 13}
"""Descriptions without a noun that packages still have: may only fall."""


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


class Text(NamedTuple):
    """A docstring: line and name of what it stands in; a module has no name."""

    line: int
    name: str
    text: str


def texts(tree: ast.Module) -> list[Text]:
    """All docstrings of a file."""
    kinds = ast.FunctionDef | ast.ClassDef | ast.Module
    held = [node for node in ast.walk(tree) if isinstance(node, kinds)]
    return [Text(getattr(node, "lineno", 1), getattr(node, "name", ""), ast.get_docstring(node) or "") for node in held]


@pytest.fixture(scope="module")
def looked_at() -> list[tuple[Path, list[Documented], list[Text]]]:
    """Public functions and docstrings of each file, of one look."""
    trees = ((path, ast.parse(path.read_text(encoding="utf-8"))) for path in FILES)
    return [(path, list(functions(tree, path.relative_to(ROOT).as_posix())), texts(tree)) for path, tree in trees]


@pytest.fixture(scope="module")
def public(looked_at) -> list[Documented]:
    return [function for _, found, _ in looked_at for function in found]


def test_documented_parameters_are_those_of_the_signature_in_its_order(public):
    wrong = [
        f"{one.where} {one.name}: documents {one.named}, takes {one.arguments}"
        for one in public
        if one.named is not None and one.named != one.arguments
    ]
    assert not wrong, "\n".join(wrong)


def test_functions_of_many_arguments_document_them(public):
    full = {part for one in public if one.named is not None for part in (one.name, one.name.rpartition(".")[2])}
    bare = [
        f"{one.where} {one.name}{one.arguments}"
        for one in public
        if one.named is None and len(one.arguments) >= MANY and not full & set(REFERENCE.findall(one.text))
    ]
    assert len(bare) <= LEFT, "without a section Parameters:\n" + "\n".join(bare)
    assert len(bare) >= LEFT - 8, f"only {len(bare)} are left: lower LEFT"


def described(text: str) -> Iterator[tuple[str, str]]:
    """Entries of the sections of a docstring: the name with its type, and the description."""
    for section in SECTIONS.findall(text):
        for entry in re.split(r"(?m)^(?=\S)", section)[1:]:
            name, _, words = entry.partition("\n")
            yield name, " ".join(words.split())


def nameless(path: Path, held: list[Text]) -> list[str]:
    """Descriptions of a file that have no noun, each with where it stands."""
    return [
        f"{path.relative_to(ROOT).as_posix()}:{one.line} {one.name}: {name}: {words}"
        for one in held
        if one.name
        for name, words in described(one.text)
        if NO_NOUN.match(words)
    ]


def test_descriptions_have_a_noun(looked_at):
    found: dict[str, list[str]] = {}
    for path, _, held in looked_at:
        found.setdefault("/".join(path.relative_to(ROOT).parts[:2]), []).extend(nameless(path, held))
    wrong = [line for package, lines in found.items() if len(lines) > STILL.get(package, 0) for line in lines]
    assert not wrong, "a description needs a noun ('Load of the roller', not 'Of the roller'):\n" + "\n".join(wrong)


QUESTION = re.compile(r"(?:What|Whether|How|Where|Which|Why|When|Of)\b")


def test_docstrings_begin_with_a_noun_or_a_verb(looked_at):
    """'Share of the load', 'Tell whether it touches': not 'What it carries', 'Whether it touches'."""
    wrong = [
        f"{path.relative_to(ROOT).as_posix()}: {one.text.splitlines()[0]}"
        for path, _, held in looked_at
        for one in held
        if QUESTION.match(one.text)
    ]
    assert wrong == []
    assert QUESTION.match("Whether it is") and not QUESTION.match("Whetstone") and not QUESTION.match("Tell whether")


@pytest.mark.parametrize(
    ("words", "wrong"),
    [
        ("Of a roller.", True),
        ("Its name.", True),
        ("Where.", True),
        ("Symmetric.", True),
        ("Weights; of the nodes.", True),
        ("Load of a roller.", False),
        ("Weights [1/s].", False),
        ("Number of rollers.", False),
    ],
)
def test_descriptions_without_a_noun_are_found(words, wrong):
    ((name, text),) = described(f"Words.\n\nParameters\n----------\na : float\n    {words}\n")
    assert (name, text) == ("a : float", words)
    assert bool(NO_NOUN.match(text)) is wrong


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
