"""Functions of an exported Modelica package as Python functions: a second reader of its text.

It knows what the package has: assignments, also of several results, branches, loops, `assert`, and the constants of
`Table` and `Film`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

_FUNCTION = re.compile(r'  function (\w+) "[^"]*"(.*?)  algorithm\n(.*?)  end \1;', re.DOTALL)
_BRANCH = re.compile(r"if (.*?) then (.*?) else (.*)")


def functions(text: str) -> dict[str, Callable[..., Any]]:
    """Functions of a package by name; each takes its inputs and returns its outputs.

    Parameters
    ----------
    text : str
        The package.
    """
    known: dict[str, Any] = {
        "table": _table(text), "check": _check, "integer": int, "max": max, "min": min, "abs": abs,
        **{name: getattr(math, name) for name in ("floor", "log", "exp", "sqrt")},
    }  # fmt: skip
    names = []
    for name, head, body in _FUNCTION.findall(text):
        inputs, outputs = (re.findall(rf"{kind} \w+ (\w+)", head) for kind in ("input", "output"))
        lines = [f"def {name}({', '.join(inputs)}):", *_lines(body), f"  return {', '.join(outputs)}"]
        exec("\n".join(lines), known)
        names.append(name)
    return {name: known[name] for name in names}


def _table(text: str) -> dict[str, Any]:
    """Constants of the table, its cubics among them."""
    found: dict[str, Any] = {
        name: (int if kind == "Integer" else float)(value)
        for kind, name, value in re.findall(r"constant (\w+) (\w+)(?:\([^)]*\))? = ([-+.e\d]+)", text)
    }
    for name, body in re.findall(r"constant Real (\w+)\[[^]]*\] = \{\n(.*?)\} \"", text, re.DOTALL):
        found[name] = [[float(value) for value in row.split(",")] for row in re.findall(r"\{([^{}]+)\}", body + "}")]
    return found


def _check(holds: bool, words: str) -> None:
    """`assert` of Modelica."""
    if not holds:
        raise ValueError(words)


def _lines(body: str) -> list[str]:
    """Statements as lines of Python."""
    found, depth = [], 1
    body = re.sub(r"//.*", "", body)
    for statement in re.split(r"(?<=;)|(?<= then)(?=\n)|(?<= else)(?=\n)|(?<= loop)(?=\n)", body):
        words = " ".join(statement.split()).removesuffix(";")
        if not words or words.startswith("annotation"):
            continue
        if words in ("end if", "end for"):
            depth -= 1
            continue
        opens = words == "else" or words.endswith((" then", " loop"))
        if words.startswith("else"):
            depth -= 1
        words = re.sub(r"in (\d+):(\d+) loop", r"in range(\1, \2 + 1)", words)
        line = _expression(words.removesuffix(" then")) if opens else _assignment(words)
        found.append("  " * depth + line.replace("elseif", "elif") + (":" if opens else ""))
        depth += opens
    return found


def _assignment(words: str) -> str:
    """A statement that opens no branch."""
    if words.startswith("assert("):
        return _expression("check" + words.removeprefix("assert"))
    target, _, value = words.partition(" := ")
    return f"{target} = {_expression(value)}"


def _expression(words: str) -> str:
    """An expression, or the beginning of a branch."""
    words = re.sub(
        r"(?:Table|Film)\.(\w+)\[(\w+), (\d+)\]",
        lambda found: f"table['{found[1]}'][{found[2]} - 1][{int(found[3]) - 1}]",
        words,
    )
    words = re.sub(r"(?:Table|Film)\.(\w+)", r"table['\1']", words).replace("^", "**")
    branch = _BRANCH.fullmatch(words)
    return f"({branch[2]}) if {branch[1]} else ({branch[3]})" if branch else words
