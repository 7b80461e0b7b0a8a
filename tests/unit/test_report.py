"""Pages, tables and charts of reports, and the reports of maps: what they say, and that foreign text is text."""

from __future__ import annotations

import base64
import hashlib
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.exports.map_curves import curves
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.show.map_charts import MapCurves
from ehdmaps.jobs.show.map_report import map_report
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.physics.solution import Status
from ehdmaps.report.axis import Axis, linear_axis, log_axis, symlog_axis
from ehdmaps.report.chart import Chart, Curve, Points, figure, path_of
from ehdmaps.report.page import Markup, Section, document, escaped, joined, tag, write_report
from tests.cases.reports import Report

DATA = Path(__file__).parents[1] / "data"
HOSTILE = "</title></script></pre><script>alert(1)</script><img src=x onerror=alert(2)>\"' 漢字"


def old_map(version: int = 4) -> EHDMap:
    return open_map(DATA / f"schema{version}.nc")


def without_solutions(emap: EHDMap, chosen: tuple[object, ...]) -> EHDMap:
    """The map where some points have no solution; without its backbone."""
    dataset = emap.dataset.copy(deep=True)
    for variable in dataset.data_vars.values():
        if variable.dims == dataset["status"].dims and variable.dtype.kind == "f":
            variable.values[chosen] = np.nan
    dataset["status"].values[chosen] = int(Status.STAGNATED)
    dataset["reason"].values[chosen] = "Newton <b>stagnated</b>"
    return EHDMap(dataset)


def test_foreign_text_is_escaped_wherever_it_stands():
    assert escaped("a<b>&\x00\u202e\ud800\n") == "a&lt;b&gt;&amp;\ufffd\ufffd\ufffd\n"
    element = tag("p", HOSTILE, tag("b", "x"), None, title=HOSTILE, class_=None, stroke_width=1.0 / 3.0)
    assert element.count("<") == 4 and 'stroke-width="0.3333"' in element and "class" not in element
    assert joined("<", Markup("<br>")) == "&lt;<br>"
    assert Report(str(element)).words == f"{HOSTILE} x"


@pytest.mark.parametrize(
    "axis, texts",
    [
        (log_axis("w", "N", np.array([0.1, 1000.0])), ["0.1", "1", "10", "100", "1000"]),
        (log_axis("w", "N", np.array([1.0, 30.0])), ["1", "2", "5", "10", "20"]),
        (log_axis("w", "N", np.array([31.0, 39.0])), ["32", "34", "36", "38"]),
        (
            log_axis("w", "N", np.array([1e-12, 1e12])),
            ["1e-12", "1e-09", "1e-06", "0.001", "1", "1000", "1e+06", "1e+09", "1e+12"],
        ),
        (linear_axis("f", "Hz", np.array([0.0, 6000.0])), ["0", "1000", "2000", "3000", "4000", "5000", "6000"]),
        (symlog_axis("x", "um", np.array([-100.0, 20.0]), 1.0), ["-100", "-10", "-1", "0", "1", "10"]),
        (log_axis("w", "N", np.array([])), ["0.1", "1", "10"]),
    ],
)
def test_ticks(axis, texts):
    assert [text for _, text in axis.ticks] == texts


def test_places_along_axes():
    # closed forms; round-off
    logarithmic = Axis("w", "N", "log", 1.0, 100.0)
    np.testing.assert_allclose(logarithmic.places(np.array([1.0, 10.0, 100.0])), [0.0, 0.5, 1.0], atol=1e-12)
    assert np.isnan(logarithmic.places(np.array([0.0, -1.0]))).all()
    both = Axis("x", "um", "symlog", -9.0, 9.0)
    np.testing.assert_allclose(both.places(np.array([-9.0, 0.0, 9.0])), [0.0, 0.5, 1.0], atol=1e-12)
    half = 0.5 + 0.5 * math.log(2.0) / math.log(10.0)
    np.testing.assert_allclose(both.places(np.array([1.0])), [half], atol=1e-12)


def test_a_chart_holds_its_numbers_and_draws_them_there():
    x, y = np.array([1.0, 10.0, 100.0, 1000.0]), np.array([1.23456, np.nan, 123456.0, 1e-3])
    chart = Chart(
        "one", "Title <1>", "Words.", log_axis("load", "N/mm", x), log_axis("k", "N", y), x,
        [Curve(HOSTILE, y, "#000"), Curve("", y, "#111", read=False)],
        [Points("mark", x[:1], np.array([np.nan]), "cross", "#222")],
    )  # fmt: skip
    found = Report(str(figure(chart)))
    assert found.words.count(HOSTILE) == 1 and "mark" in found.words
    (data,) = found.charts.values()
    assert data["x"]["values"] == [1, 10, 100, 1000]
    assert data["curves"] == [[1.2346, None, 123460, 0.001]]
    path = next(str(a["d"]) for a in found.named("path") if a.get("stroke") == "#000" and "M1 6" not in str(a["d"]))
    # a gap where there is no value; the places of the script are those of the drawing, to a tenth of a pixel
    assert path.count("M") == 2 and path.count("L") == 1
    assert float(path[1:].split()[0]) == data["x"]["pixels"][0]
    assert path_of(np.array([0.0, 1e9]), np.array([0.0, 1.0])) == "M0.0 0.0L4000.0 1.0"


def test_a_page_executes_its_own_script_alone(tmp_path):
    text = document(HOSTILE, HOSTILE, [Section("a", HOSTILE, [HOSTILE])])
    report = Report(text)
    report.check_alone()
    assert report.words.count(HOSTILE) == 6
    (policy,) = (str(a["content"]) for a in report.named("meta") if "http-equiv" in a)
    assert policy.startswith("default-src 'none'; ") and "unsafe" not in policy
    for name in ("style", "script"):
        (content,) = re.findall(rf"<{name}>(.*?)</{name}>", text, re.DOTALL)
        digest = base64.b64encode(hashlib.sha256(content.encode()).digest()).decode()
        assert f"{name}-src 'sha256-{digest}'" in policy
    write_report(tmp_path / "a.html", text)
    write_report(tmp_path / "a.html", text)  # its own kind is replaced
    (tmp_path / "b.html").write_text("<p>mine</p>")
    with pytest.raises(InputError, match="is not a report of ehdmaps"):
        write_report(tmp_path / "b.html", text)
    with pytest.raises(InputError, match="has 2000001 bytes"):
        write_report(tmp_path / "c.html", "a" * 2_000_001)
    assert not (tmp_path / "c.html").exists()


@pytest.mark.parametrize("version", [1, 2, 3, 4])
def test_maps_of_every_version_have_a_report(version):
    text = map_report(old_map(version), f"schema{version}.nc", "ehdmaps report")
    report = Report(text)
    report.check_alone()
    assert len(text.encode()) < 200_000
    assert not re.search(r"\b(nan|inf|None)\b", report.words)
    assert "NU308" in report.words and "FVA3" in report.words


def test_values_of_charts_are_those_of_contact_laws():
    emap = old_map()
    charts = Report(map_report(emap, "a.nc", "")).charts
    of = MapCurves(emap)
    found = charts["map-inner-stiffness-speed"]
    law = curves(emap.film_field(), (emap.contacts[0],), of.loads, 1.0, 313.15)
    # five digits
    np.testing.assert_allclose(found["x"]["values"], 1e-3 * of.loads, rtol=6e-5)
    np.testing.assert_allclose(found["curves"][0], 1e-9 * law.stiffness, rtol=6e-5)
    dry = 1e-9 / emap.contacts[0].structural_compliance(of.loads)
    np.testing.assert_allclose(found["curves"][1], dry, rtol=6e-5)


def test_without_laws_the_values_are_those_of_the_points():
    emap = without_solutions(old_map(), (slice(None), slice(1, 3)))
    report = Report(map_report(emap, "a.nc", ""))
    here = emap.dataset.sel(contact="outer", entrainment_speed=1.0).isel(temperature=0)
    for name, factor in (("stiffness", 1e-9), ("damping", 1e-6), ("approach", 1e6), ("minimum-film", 1e6)):
        found = report.charts[f"map-outer-{name}-speed"]
        values = [np.nan if value is None else value for value in found["curves"][0]]
        # five digits
        np.testing.assert_allclose(values, factor * here[name.replace("-", "_")].values, rtol=6e-5)
    assert "No contact law can be made from this map" in report.words
    assert "Without a solution: 8 of 16 points; isolated and filled from neighbours: 0 of these." in report.words
    assert "Newton <b>stagnated</b>" in report.words
    assert not report.named("b")


@pytest.mark.parametrize(
    "part",
    [{"load": [3]}, {"entrainment_speed": [1]}, {"entrainment_speed": [0]}, {"load": [0], "entrainment_speed": [1]}],
)
def test_parts_of_a_map_and_maps_of_holes(part):
    emap = EHDMap(old_map().dataset.isel(part))
    for one in (emap, without_solutions(emap, (...,))):
        report = Report(map_report(one, "a.nc", ""))
        report.check_alone()
        assert not re.search(r"\b(nan|inf|None)\b", report.words)


def test_hostile_texts_of_a_map_are_shown():
    dataset = old_map().dataset.copy(deep=True)
    dataset.attrs["job_toml"] = f"# {HOSTILE}\n{dataset.attrs['job_toml']}"
    dataset.attrs["job_name"] = HOSTILE
    oil = json.loads(dataset.attrs["lubricant"])
    dataset.attrs["lubricant"] = json.dumps({**oil, "name": HOSTILE + "x" * 2000})
    text = map_report(EHDMap(dataset), HOSTILE, HOSTILE)
    report = Report(text)
    report.check_alone()
    assert report.words.count(HOSTILE) > 8
    assert text == map_report(EHDMap(dataset), HOSTILE, HOSTILE)


def test_roughness_gives_the_film_parameter(tmp_path, capsys):
    source, target = str(DATA / "schema4.nc"), tmp_path / "rough.html"
    assert main(["report", source, "-o", str(target), "--roughness", "0.3 um"]) == 0
    report = Report(target.read_text())
    film = report.charts["map-inner-minimum-film-speed"]["curves"][0]
    parameter = report.charts["map-inner-film-parameter-speed"]["curves"][0]
    # two numbers of five digits
    np.testing.assert_allclose(parameter, np.array(film) / 0.3, rtol=2e-4)
    loads = report.charts["map-inner-film-parameter-speed"]["x"]["values"]
    below = [load for load, value in zip(loads, parameter, strict=True) if value < 3.0]
    assert f"Λ is below 3 (mixed lubrication) from {min(below):.3g} N/mm on, at 1 m/s." in report.words
    assert "--roughness '0.3 um' -o rough.html" in report.words


def test_the_command_writes_beside_the_map_and_over_nothing_else(tmp_path, capsys):
    source = tmp_path / "map.nc"
    source.write_bytes((DATA / "schema4.nc").read_bytes())
    assert main(["report", str(source)]) == 0
    assert capsys.readouterr().out == f"{tmp_path / 'map.html'}: written\n"
    for output, words in ((source, "ends in .html, .htm"), (tmp_path / "a.pdf", "ends in .html, .htm")):
        assert main(["report", str(source), "-o", str(output)]) == 2
        assert words in capsys.readouterr().err
    (tmp_path / "b.html").write_text("<p>mine</p>")
    assert main(["report", str(source), "-o", str(tmp_path / "b.html")]) == 2
    assert "is not a report of ehdmaps" in capsys.readouterr().err
    assert (tmp_path / "b.html").read_text() == "<p>mine</p>"
