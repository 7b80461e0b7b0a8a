"""Response of contacts over frequency: the dataset, its table and JSON, and what the figure draws."""

from __future__ import annotations

import json
import math

import matplotlib.colors
import numpy as np
import pytest
import xarray as xr

import ehdmaps
from ehdmaps import STEEL, BearingGeometry, Lubricant, OperatingPoint, Status
from ehdmaps.errors import InputError
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.solve.plots import spectrum_figure, write_page
from ehdmaps.jobs.solve.spectrum import spectrum_record, spectrum_table
from ehdmaps.physics.hertz import half_width

OIL = Lubricant.named("FVA3")
CONTACTS = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")
POINT = OperatingPoint(88571.4, 1.7, 313.15)
FREQUENCIES = np.geomspace(10.0, 2e4, 31)


@pytest.fixture(scope="module")
def found() -> xr.Dataset:
    return ehdmaps.frequency_response(CONTACTS, OIL, POINT, FREQUENCIES)


def test_dataset_is_of_one_piece(found: xr.Dataset) -> None:
    assert dict(found.sizes) == {"contact": 2, "frequency": 31}
    assert found["contact"].values.tolist() == ["inner", "outer"]
    omega = 2.0 * math.pi * found["frequency"]
    parts = found["stiffness"] + 1j * omega * found["damping"]
    np.testing.assert_allclose(parts.transpose("contact", "frequency"), found["dynamic_stiffness"], rtol=1e-12)
    dry = xr.DataArray([contact.structural_compliance(POINT.load) for contact in CONTACTS], dims="contact")
    np.testing.assert_allclose(1.0 / found["dynamic_stiffness"], dry + found["film_compliance"], rtol=1e-12)
    np.testing.assert_allclose(found["film_stiffness"] * found["film_compliance"], 1.0, rtol=1e-12)
    widths = [half_width(POINT.load, contact.radius, contact.reduced_modulus) for contact in CONTACTS]
    np.testing.assert_allclose(found["omega_b_over_u"][:, 0], 2.0 * math.pi * 10.0 * np.array(widths) / 1.7)
    assert all(found[name].attrs["units"] for name in found.data_vars if name not in ("status", "reason"))


def test_slow_values_are_those_of_a_solve(found: xr.Dataset) -> None:
    slow = ehdmaps.solve(CONTACTS[0], OIL, POINT)
    assert float(found["slow_stiffness"][0]) == slow.stiffness
    assert float(found["slow_damping"][0]) == slow.damping
    # omega b/u = 0.003: its square
    assert float(found["stiffness"][0, 0]) == pytest.approx(slow.stiffness, rel=1e-5)
    assert float(found["damping"][0, 0]) == pytest.approx(slow.damping, rel=1e-3)


def test_one_contact_and_a_solver_by_name() -> None:
    found = ehdmaps.frequency_response(CONTACTS[0], OIL, POINT, [100.0, 1e3], solver="formula")
    assert dict(found.sizes) == {"contact": 1, "frequency": 2}
    assert found.attrs["solver"] == "formula"
    compliance = found["film_compliance"].values[0]
    assert compliance[0].real == pytest.approx(compliance[1].real, rel=1e-12)
    assert 10.0 * compliance[0].imag == pytest.approx(compliance[1].imag, rel=1e-12)


def test_a_point_without_a_solution_has_a_reason() -> None:
    found = ehdmaps.frequency_response(CONTACTS[0], OIL, OperatingPoint(1e7, 1e-8, 313.15), [100.0])
    assert Status(int(found["status"][0])) is Status.OUTSIDE_VALIDITY
    assert str(found["reason"].values[0]).startswith("M = ")
    assert np.isnan(found["stiffness"]).all()
    assert json.dumps(spectrum_record(found, "inner"), allow_nan=False)
    assert "outside_validity; M = " in spectrum_table(read_job("nu308"), found, None)
    figure = spectrum_figure(found, "none")
    assert "no solution" in figure.axes[0].texts[0].get_text()


def test_a_standstill_is_dry() -> None:
    found = ehdmaps.frequency_response(CONTACTS[0], OIL, OperatingPoint(1e5, 0.0, 313.15), [100.0, 200.0])
    np.testing.assert_allclose(found["stiffness"], 1.0 / CONTACTS[0].structural_compliance(1e5), rtol=1e-12)
    assert not found["damping"].any()
    assert np.isinf(found["omega_b_over_u"]).all()
    assert len(spectrum_figure(found, "dry").axes) == 3
    assert spectrum_record(found, "inner")["omega_b_over_u"] == [None, None]


def test_what_is_refused() -> None:
    with pytest.raises(InputError, match=r"frequencies: got 0\.0 Hz"):
        ehdmaps.frequency_response(CONTACTS[0], OIL, POINT, [0.0])
    with pytest.raises(InputError, match="contacts: got none; allowed: at least one, with names apart"):
        ehdmaps.frequency_response([], OIL, POINT, [1.0])
    with pytest.raises(InputError, match="contacts: got inner, inner"):
        ehdmaps.frequency_response([CONTACTS[0]] * 2, OIL, POINT, [1.0])
    with pytest.raises(InputError, match="solver: got 'none'"):
        ehdmaps.frequency_response(CONTACTS[0], OIL, POINT, [1.0], solver="none")


def test_record_and_table(found: xr.Dataset) -> None:
    record = spectrum_record(found, "outer")
    assert record["status"] == "converged"
    assert record["frequency"] == FREQUENCIES.tolist()
    assert record["dynamic_stiffness_imaginary"] == found["dynamic_stiffness"].values[1].imag.tolist()
    assert {len(value) for value in record.values() if isinstance(value, list)} == {31}
    json.dumps(record, allow_nan=False)
    table = spectrum_table(read_job("nu308"), found, 0.7e-3)
    lines = table.splitlines()
    assert "slice of 0.7 mm (62 N)" in lines[1]
    assert sum("negative damping" in line for line in lines) == int((found["damping"] < 0.0).sum()) > 0
    assert "k x length" in table
    assert "k x length" not in spectrum_table(read_job("nu308"), found, None)


def test_figure_draws_the_data_and_marks_negative_damping(found: xr.Dataset) -> None:
    figure = spectrum_figure(found, "NU308")
    assert len(figure.axes) == 6
    loss = figure.axes[2]
    c = found["damping"].values[0]
    omega = 2.0 * np.pi * FREQUENCIES
    np.testing.assert_allclose(loss.lines[0].get_ydata(), 1e-9 * omega * c, rtol=1e-12)
    words = [text.get_text() for text in loss.get_legend().get_texts()]
    assert words[-1] == "negative damping: the film feeds the oscillation"
    red = matplotlib.colors.to_rgba("#c8102e")[:3]
    shaded = [patch.get_extents() for patch in loss.patches if patch.get_facecolor()[:3] == red]
    to_data = loss.transData.inverted()
    spans = [tuple(to_data.transform(box)[:, 0]) for box in shaded]
    for frequency, value in zip(FREQUENCIES, c, strict=True):
        assert any(low * (1.0 - 1e-9) <= frequency <= high * (1.0 + 1e-9) for low, high in spans) == (value < 0.0)


def test_figure_without_negative_damping_marks_none() -> None:
    found = ehdmaps.frequency_response(CONTACTS[0], OIL, OperatingPoint(1e3, 1.7, 313.15), [10.0, 100.0, 1e3])
    assert bool((found["damping"] > 0.0).all())
    loss = spectrum_figure(found, "NU308").axes[1]
    assert not loss.patches
    assert all("negative" not in text.get_text() for text in loss.get_legend().get_texts())


def test_error_bands_are_what_is_stated(found: xr.Dataset) -> None:
    wide = found.copy()
    wide["stiffness_error"] = xr.full_like(found["stiffness_error"], 0.01)
    real = spectrum_figure(wide, "NU308").axes[0]
    (band,) = real.collections
    heights = band.get_paths()[0].vertices[:, 1]
    k = 1e-9 * found["stiffness"].values[0]
    assert heights.max() == pytest.approx(1.01 * k.max(), rel=1e-12)
    assert heights.min() == pytest.approx(0.99 * k.min(), rel=1e-12)


@pytest.mark.slow
def test_figure_is_written(found: xr.Dataset, tmp_path) -> None:
    write_page(tmp_path / "z.png", spectrum_figure, found, "NU308")
    assert (tmp_path / "z.png").stat().st_size > 10_000
