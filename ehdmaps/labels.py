"""Free texts that users give to an oil or a bearing, to be shown instead of its name."""

from __future__ import annotations

LONGEST_LABEL = 60
"""Characters; a title has no room for more."""


def label_problem(label: str | None) -> list[str]:
    """Problems of a label, in words; nothing where it is None."""
    if label is None:
        return []
    rule = f"allowed: 1 to {LONGEST_LABEL} printable characters on one line"
    if not isinstance(label, str):
        return [f"got {label!r:.40}; {rule}, in quotes"]
    if not (label.strip() and len(label) <= LONGEST_LABEL and label.isprintable()):
        return [f"got {label[:40]!r}{'...' if len(label) > 40 else ''} ({len(label)} characters); {rule}"]
    return []
