"""Reports in headless Chromium: values at the cursor, nothing from a network, no foreign script, and on paper.

The browser is started once for all of them.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ehdmaps.jobs.cli import main
from ehdmaps.jobs.show.map_report import map_report
from ehdmaps.maps.emap import EHDMap, open_map
from mbs.cli import main as mbs
from tests.cases.chromium import browser
from tests.cases.reports import Report

MAP = Path(__file__).parents[1] / "data" / "schema4.nc"
HOSTILE = "</script></style></title><script>alert(1)</script><img src=http://127.0.0.1:9/x onerror=alert(2)>"


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """A page; its tests are skipped without the browser, but in CI that is a failure."""
    with browser(tmp_path_factory.mktemp("chromium")) as found:
        yield found


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """The report of a map."""
    path = tmp_path_factory.mktemp("report") / "map.html"
    assert main(["report", str(MAP), "-o", str(path), "--roughness", "0.2 um"]) == 0
    return path


def check_quiet(page, path):
    """Nothing but the file itself was asked for, nothing was refused or went wrong, no dialog came up."""
    asked = [event["request"]["url"] for event in page.named("Network.requestWillBeSent")]
    assert asked == [path.as_uri()]
    assert page.named("Log.entryAdded", "Runtime.exceptionThrown", "Page.javascriptDialogOpening") == []


def test_the_cursor_reads_the_values_of_the_map(page, report):
    page.open(report)
    name = "map-outer-damping-speed"
    data = Report(report.read_text()).charts[name]
    svg = f"document.querySelector('#{name} svg')"
    page.evaluate(f"{svg}.scrollIntoView({{block: 'center'}})")
    left, top, width, height = page.evaluate(
        f"(b => [b.left, b.top, b.width, b.height])({svg}.getBoundingClientRect())"
    )

    def shown():
        texts = page.evaluate(f"[...document.querySelectorAll('#{name} output')].map(o => o.textContent)")
        return [float(text.split()[0]) for text in texts]

    for index in (0, 17, len(data["x"]["values"]) - 1):
        page.point_at(left + width * data["x"]["pixels"][index] / 460.0, top + height / 2.0)
        values = [data["x"]["values"][index], *(curve[index] for curve in data["curves"])]
        # four digits of five
        assert shown() == pytest.approx(values, rel=6e-4)
    page.evaluate(f"{svg}.focus()")
    page.press("ArrowLeft")
    assert shown()[0] == pytest.approx(data["x"]["values"][-2], rel=6e-4)
    check_quiet(page, report)


def test_all_is_there_without_scripts(page, report):
    page.open(report, script=False)
    tree = page.call("DOM.getDocument", depth=1)["root"]["nodeId"]
    html = page.call("DOM.querySelector", nodeId=tree, selector="html")["nodeId"]
    assert "js" not in str(page.call("DOM.getAttributes", nodeId=html))
    drawn = page.call("DOM.querySelectorAll", nodeId=tree, selector="figure.chart svg path.curve")["nodeIds"]
    assert len(drawn) > 20
    check_quiet(page, report)


def test_foreign_text_is_shown_and_not_executed(page, tmp_path):
    dataset = open_map(MAP).dataset.copy(deep=True)
    dataset.attrs["job_name"] = HOSTILE
    dataset.attrs["job_toml"] = HOSTILE
    path = tmp_path / "hostile.html"
    path.write_text(map_report(EHDMap(dataset), HOSTILE, HOSTILE))
    page.open(path)
    assert page.evaluate("document.querySelectorAll('img').length") == 0
    assert page.evaluate("document.querySelectorAll('script:not([type])').length") == 1
    assert page.evaluate("document.body.textContent").count(HOSTILE) == 5
    check_quiet(page, path)
    # the policy of the page refuses what would come in all the same
    page.evaluate(
        "document.body.insertAdjacentHTML('beforeend', '<img src=\"http://127.0.0.1:9/x\" onerror=\"alert(3)\">')"
    )
    page.evaluate("document.body.append(Object.assign(document.createElement('script'), {textContent: 'alert(4)'}))")
    assert page.named("Page.javascriptDialogOpening") == []
    assert any("Content Security Policy" in entry["entry"]["text"] for entry in page.named("Log.entryAdded"))


@pytest.mark.slow
def test_a_scene_is_legible_on_a_screen_and_on_paper(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    speeds = ("--speed", "1000 rpm", "2000 rpm", "3")
    assert mbs(["report", "nu308_rigid", "--map", str(MAP), *speeds, "-o", "scene.html"]) in (0, 1)
    path = tmp_path / "scene.html"
    page.open(path)
    # nothing is wider than the window, no text of a drawing is smaller than nine pixels
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
    assert page.evaluate("[...document.querySelectorAll('svg text')].every(t => t.getBoundingClientRect().height >= 9)")
    report = Report(path.read_text())
    report.check_alone(2)
    assert "Campbell diagram" in report.words and "highest load in operation" in report.words
    printed = page.printed()
    assert printed.startswith(b"%PDF-")
    sizes = set(re.findall(rb"/MediaBox ?\[0 0 ([0-9.]+) ([0-9.]+)\]", printed))
    assert {(round(float(a)), round(float(b))) for a, b in sizes} == {(595, 842)}  # A4 in points
    check_quiet(page, path)
