"""TOML as both programs read it."""

from __future__ import annotations

import pytest

from ehdmaps.errors import InputError
from ehdmaps.jobs.table import DEEPEST, parse


@pytest.mark.parametrize(
    "text",
    [
        "# " + "." * 100 + "\na = 1",
        "a = [" + ", ".join(["1.5"] * 100) + "]",
        ".".join(["a"] * DEEPEST) + " = 1",
        'a = "' + "..." * 50 + '"',
    ],
)
def test_dots_that_are_no_deep_keys(text):
    assert "a" in parse(text, "here")


@pytest.mark.parametrize("key", ["a", '"a"', "'a'"])
@pytest.mark.parametrize("place", ["{} = 1", "[{}]", "[[ {} ]]", "b = {{ {} = 1 }}"])
def test_keys_that_are_too_deep(key, place):
    text = "\n" + place.format(" . ".join([key] * (DEEPEST + 1)))
    with pytest.raises(InputError, match=r"here: .* line 2 has a dotted key of more than 64 parts; allowed: tables as"):
        parse(text, "here")


def test_what_is_no_toml():
    with pytest.raises(InputError, match=r"here: is not TOML: .*; allowed: TOML 1.0; strings with units stand in quot"):
        parse("a = ", "here")
