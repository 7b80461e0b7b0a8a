"""A small map by the Reynolds solver with its backbone and the check of its laws, from job text to laws."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import ehdmaps
from ehdmaps.jobs.make.generate import Generated, generate, summary
from ehdmaps.jobs.make.law_check import EDGE_SHARE
from ehdmaps.jobs.make.spacing import RANDOM
from ehdmaps.jobs.reader import parse_job
from ehdmaps.maps.schema import BACKBONE
from tests.cases.coarse import fine_tables

pytestmark = pytest.mark.slow  # its map is checked against forty fresh solves

OIL = (Path(__file__).parents[1] / "references" / "n1014_thin_oil.toml").read_text()
TEXT = OIL.replace('"10 N/mm", "100 N/mm"', '"2 N/mm", "15 N/mm", "100 N/mm"') + 'law_check = 40\nfilms = "solved"\n'


@pytest.fixture(scope="module", autouse=True)
def fine() -> Iterator[None]:
    """What is checked is how exact laws are."""
    with fine_tables():
        yield


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Generated, Path]:
    path = tmp_path_factory.mktemp("maps") / "thin.nc"
    return generate(parse_job(TEXT, "thin", "thin"), path, workers=1), path


def test_map_has_its_backbone(made: tuple[Generated, Path]) -> None:
    generated, path = made
    emap = ehdmaps.open_map(path)
    assert emap.backbone is not None
    assert {"film_offset", "film_compliance", "loss_compliance", "status"} <= set(emap.backbone.data_vars)
    lines = int((emap.backbone["status"] >= 0).sum())
    assert generated.sweep.solved == emap.dataset["status"].size + lines + 40 + 2 * round(EDGE_SHARE * 40)


def test_laws_are_checked_against_fresh_solves(made: tuple[Generated, Path]) -> None:
    generated, path = made
    attributes = generated.dataset.attrs
    assert attributes["law_check_usable"] == 40
    # the bars are for 99 % (95 % in the valley) of many points; of 32 and 8 drawn ones two and one may be outside
    assert attributes["law_film_compliance_within_bar"] >= 30 / 32
    assert attributes["law_damping_within_bar"] >= 30 / 32
    for name in ("film_compliance", "damping"):
        assert attributes.get(f"law_valley_{name}_within_bar", 1.0) >= 7 / 8
    assert "accuracy of the contact laws" in summary(generated, path)


def test_the_law_meets_the_points_of_the_map(made: tuple[Generated, Path]) -> None:
    """The map's own points are not nodes of the law: another check of the interpolation."""
    _, path = made
    emap = ehdmaps.open_map(path)
    for contact in ("inner", "outer"):
        data = emap.dataset.sel(contact=contact)
        load, speed, temperature = np.meshgrid(
            *(data[n].values for n in ("load", "entrainment_speed", "temperature")), indexing="ij"
        )
        w, k, c = emap.law(contact)(data["approach"].values, 0.0, speed, temperature)
        # interpolation of the law: its bar is 1 % of the film compliance, which is half of 1/k at the lowest load
        assert w == pytest.approx(load, rel=5e-3)
        assert k == pytest.approx(data["stiffness"].values, rel=5e-3)
        assert c == pytest.approx(data["damping"].values, rel=3e-2)


def test_without_backbone(tmp_path: Path) -> None:
    generated = generate(
        parse_job(TEXT.replace("law_check = 40", 'backbone = "none"'), "thin", "thin"), tmp_path / "bare.nc", workers=1
    )
    assert generated.sweep.solved == 24 + 8 + RANDOM  # and what tells the errors between them: two points a cell
    assert ehdmaps.open_map(tmp_path / "bare.nc").backbone is None
    assert BACKBONE not in generated.dataset
    assert not any(name.startswith("law_") for name in generated.dataset.attrs)
