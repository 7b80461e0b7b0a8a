"""The page of catalogue bearings in headless Chromium: numbers beside those of Python, charts, and no network."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.jobs.cli import main
from ehdmaps.jobs.show.catalogue_page import QUANTITIES, catalogue_bearings, contact_numbers
from ehdmaps.report.page import LARGEST
from tests.cases.chromium import browser
from tests.cases.reports import Report

KEYS = ("offset", "central", "minimum", "stiffness", "damping", "capacitance")

DRAWN = "[...document.querySelectorAll('#catalogue-film svg g path.curve')].map(p => p.getAttribute('d'))"


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    made = tmp_path_factory.mktemp("catalogue") / "catalogue.html"
    assert main(["report", "--catalogue", "-o", str(made)]) == 0
    return made


def test_the_page_can_be_sent_and_asks_for_nothing(path: Path, capsys):
    assert path.stat().st_size < LARGEST
    report = Report(path.read_text())
    assert {f"catalogue-{name}" for name, *_ in QUANTITIES} == set(report.charts)
    assert len(catalogue_bearings()) > 800
    assert main(["report", "--catalogue", "some.nc"]) == 2
    assert "--catalogue: stands beside a map, some.nc; allowed: alone, with -o" in capsys.readouterr().err


@pytest.mark.slow  # a browser
def test_numbers_are_those_of_python_and_charts_follow_them(path: Path, tmp_path):
    """Within 1e-6 at random points, holes too: what the page adds is that its numbers have ten digits."""
    random = np.random.default_rng(5)
    names = list(catalogue_bearings())
    asked = [("NU308", "FVA3"), ("7208B", "ISO VG 32"), ("6208", "FVA3")]
    asked += [
        (str(name), oil)
        for name, oil in zip(random.choice(names, 3), ("FVA3", "ISO VG 460", "Spirax MA 80W"), strict=True)
    ]
    with browser(tmp_path) as page:
        page.open(path)
        found = 0
        for name, oil in asked:
            loads, speed = np.exp(random.uniform(np.log(2.0), np.log(3e4), 8)), float(random.uniform(0.05, 12.0))
            T = float(random.uniform(315.0, 385.0))
            for place, expected in enumerate(contact_numbers(name, oil, loads, speed, T)):
                call = f"ehdmaps.contactAt({name!r}, {place}, {oil!r}, F, {speed!r}, {T!r}, 2.2, 1e-4)"
                rows = json.loads(page.evaluate(f"JSON.stringify({loads.tolist()}.map(F => {call}))"))
                for key in KEYS:
                    read = np.array([np.nan if row[key] is None else row[key] for row in rows])
                    np.testing.assert_allclose(read, expected[key], rtol=1e-6, err_msg=f"{name}, {oil}, {key}")
                    found += int(np.isfinite(read).sum())
        assert found > 300
        before = page.evaluate(DRAWN)
        given = "document.getElementById('catalogue-bearing')"
        page.evaluate(f"(f => {{f.value = '6208'; f.dispatchEvent(new Event('input'))}})({given})")
        after = page.evaluate(DRAWN)
        assert len(after) == len(before) == 4 and all(one != other for one, other in zip(before, after, strict=True))
        shown = float(page.evaluate("document.querySelector('#catalogue-table td').textContent"))
        speed = catalogue_bearings()["6208"].entrainment_speed(1500.0 * np.pi / 30.0)
        expected = contact_numbers("6208", "FVA3", np.array([1000.0]), speed, 333.15)[0]["central"][0]
        assert shown == pytest.approx(1e6 * expected, rel=1e-4)  # five digits are shown
        # the cursor reads what is drawn now
        data = json.loads(page.evaluate("document.querySelector('#catalogue-film script').textContent"))
        svg = "document.querySelector('#catalogue-film svg')"
        page.evaluate(f"{svg}.focus()")
        page.press("ArrowRight")
        values = page.evaluate(
            "[...document.querySelectorAll('#catalogue-film .legend output')].map(o => o.textContent)"
        )
        assert [float(text.split()[0]) for text in values] == pytest.approx(
            [curve[1] for curve in data["curves"]], rel=1e-3
        )
        asked_for = [event["request"]["url"] for event in page.named("Network.requestWillBeSent")]
        assert asked_for == [path.as_uri()]
        assert page.named("Log.entryAdded", "Runtime.exceptionThrown") == []
