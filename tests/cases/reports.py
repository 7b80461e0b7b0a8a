"""Reports as a parser of HTML sees them."""

from __future__ import annotations

import json
from html.parser import HTMLParser
from typing import Any

import pytest

from ehdmaps.errors import AnalysisError

VOID = frozenset({"meta", "br", "hr", "input"})
LOADED_BY = frozenset({"src", "srcset", "action", "data", "background", "poster", "ping"})


class Report(HTMLParser):
    """A report: its elements, texts and numbers; raises where elements are not closed in their order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[tuple[str, str]] = []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open:
            self.texts.append((self.open[-1], data))

    def named(self, tag: str) -> list[dict[str, str | None]]:
        """Attributes of all elements of a name."""
        return [attributes for name, attributes in self.elements if name == tag]

    @property
    def words(self) -> str:
        """All that is shown."""
        return " ".join(text for tag, text in self.texts if tag not in ("script", "style"))

    @property
    def charts(self) -> dict[str, dict[str, Any]]:
        """Numbers of the charts, by name."""
        names = [str(a["id"]) for a in self.named("figure") if a.get("class") == "chart"]
        blocks = [json.loads(text) for tag, text in self.texts if tag == "script" and text.startswith('{"x"')]
        assert len(names) == len(blocks)
        return dict(zip(names, blocks, strict=True))

    def check_alone(self, count: int = 1) -> None:
        """Nothing is loaded, nothing is executed but its scripts, every name is the only one of its kind."""
        scripts = self.named("script")
        assert sum(a.get("type") != "application/json" for a in scripts) == count
        for name, attributes in self.elements:
            assert name not in ("link", "img", "iframe", "object", "embed", "base", "form", "image", "use")
            assert not LOADED_BY & attributes.keys()
            assert not any(key.startswith("on") or key == "style" for key in attributes)
            assert (attributes.get("href") or "#").startswith("#")
        names = [a["id"] for _, a in self.elements if "id" in a]
        assert len(names) == len(set(names))
        for _, attributes in self.elements:
            for one in (attributes.get("aria-labelledby") or "").split():
                assert one in names


def without_budget(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have reports of scenes without an error budget, which needs a law for each of its lines, some 20 s in all."""

    def refused(*_: object) -> None:
        raise AnalysisError("left out")

    monkeypatch.setattr("mbs.report.examination.error_budget", refused)
