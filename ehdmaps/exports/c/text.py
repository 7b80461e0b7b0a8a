"""Texts of C sources: templates, names with a prefix, comments, constants, tables."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from importlib.resources import files

from ehdmaps.arrays import FloatArray

_WIDTH = 118


def template(package: str, name: str) -> str:
    """Text of a template.

    Parameters
    ----------
    package : str
        Package whose file it is.
    name : str
        Name of the file.
    """
    return (files(package) / name).read_text(encoding="utf-8")


def renamed(text: str, prefix: str) -> str:
    """A text with another prefix of all public names and files.

    Parameters
    ----------
    text : str
        Text with the prefix ehd.
    prefix : str
        The other one, in lower case.
    """
    return re.sub(r"\bEHD_", f"{prefix.upper()}_", re.sub(r"\behd([_.]|$)", rf"{prefix}\1", text, flags=re.M))


def comment(lines: Iterable[str]) -> str:
    """Lines as a comment, whatever they hold.

    Parameters
    ----------
    lines : iterable of str
        The lines.
    """
    safe = (line.replace("*/", "* /").replace("/*", "/ *").rstrip() for line in lines)
    return "/*\n" + "".join(f" * {line}".rstrip() + "\n" for line in safe) + " */\n"


def number(value: float) -> str:
    """A number with all its digits, as C has it.

    Parameters
    ----------
    value : float
        The number; infinite ones become INFINITY.
    """
    if math.isinf(value):
        return "INFINITY" if value > 0.0 else "-INFINITY"
    text = repr(float(value))
    return text if any(mark in text for mark in ".en") else f"{text}.0"


def define(name: str, value: float | str, words: str) -> str:
    """A constant with what it is.

    Parameters
    ----------
    name : str
        Name of the constant.
    value : float, int or str
        Value of the constant.
    words : str
        What it is, with its unit.
    """
    text = value if isinstance(value, str) else str(value) if isinstance(value, int) else number(value)
    return f"#define {name} {f'({text})' if text.startswith('-') else text} /* {words} */\n"


def array(name: str, values: FloatArray) -> str:
    """An array of doubles.

    Parameters
    ----------
    name : str
        Name of the array.
    values : array
        Numbers of the array, of any shape; the array in C is flat.
    """
    lines, line = [], "   "
    for text in map(number, values.reshape(-1).tolist()):
        if len(line) + len(text) + 2 > _WIDTH:
            lines.append(line)
            line = "   "
        line += f" {text},"
    lines.append(line)
    return f"static const double {name}[{values.size}] = {{\n" + "\n".join(lines) + "};\n"
