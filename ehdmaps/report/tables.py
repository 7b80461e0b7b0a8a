"""Tables of rows, and pairs of names and values."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ehdmaps.report.markup import Child, Markup, tag


def table(heads: Sequence[Child], rows: Iterable[Sequence[Child]], caption: str, texts: Sequence[int] = (0,)) -> Markup:
    """Return a table.

    Parameters
    ----------
    heads : sequence of str
        Heads of the columns, with units.
    rows : iterable of sequence of str
        One text a column; the first names the row.
    caption : str
        What the table holds.
    texts : sequence of int
        Columns of text; the others hold numbers, which stand to the right.
    """

    def cell(name: str, index: int, child: Child, **more: str) -> Markup:
        return tag(name, child, class_=None if index in texts else "number", **more)

    body = [
        tag(
            "tr",
            *(
                cell("td", index, child) if index else cell("th", index, child, scope="row")
                for index, child in enumerate(row)
            ),
        )
        for row in rows
    ]
    head = tag("tr", *(cell("th", index, child, scope="col") for index, child in enumerate(heads)))
    return tag(
        "div",
        tag("table", tag("caption", caption), tag("thead", head), tag("tbody", *body)),
        class_="wide",
    )


def pairs(rows: Iterable[tuple[str, Child]]) -> Markup:
    """Return names with their values; a name that is empty goes on with the one before.

    Parameters
    ----------
    rows : iterable of (str, str)
        Names and values.
    """
    return tag(
        "dl", *(Markup((tag("dt", name) if name else "") + tag("dd", value)) for name, value in rows), class_="pairs"
    )


def sentences(lines: Iterable[Child]) -> Markup:
    """Return a list of sentences.

    Parameters
    ----------
    lines : iterable of str
        The sentences.
    """
    return tag("ul", *(tag("li", line) for line in lines), class_="sentences")
