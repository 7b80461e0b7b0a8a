"""The search at the extremes of mbs in its short form: what it finds, and that it finds what is wrong."""

from __future__ import annotations

import json

import numpy as np
import pytest

from ehdmaps.maps.law import ContactLaw
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.laws import hertz
from mbs.cli import main
from mbs.laboratory.extremes.bearings import element_checks
from mbs.laboratory.extremes.integrator import SCENARIOS, integrator_checks
from mbs.model.elements import Forces
from tests.cases.laws import CONTACTS, OIL, SMALL_FIELD


def dry(bearing: Bearing):
    return {"hertz": hertz(bearing, damping_time=1.25e-5)}


def films(bearing: Bearing):
    return {"films": ContactLaw("series", CONTACTS, OIL, SMALL_FIELD, "asymptote")}


@pytest.mark.parametrize(("laws", "runs"), [(dry, 30), (films, 1)])
def test_bearing_elements_pass(laws, runs):
    checks = list(element_checks(runs, 3, laws))
    assert [failure.what for check in checks for failure in check.failures] == []
    assert sum(check.right for check in checks) == len(checks) * runs


def test_a_damping_that_gives_power_is_found(monkeypatch):
    evaluate = BearingElement.evaluate

    def wrong(self, displacement, velocity, operation):
        found = evaluate(self, displacement, velocity, operation)
        return Forces(found.force + 1e-3 * found.stiffness @ velocity, found.stiffness, found.damping)

    monkeypatch.setattr(BearingElement, "evaluate", wrong)
    found = {check.name: check for check in element_checks(10, 3, dry)}
    assert found["bearing: hertz, dampers take up"].failed > 0
    assert found["bearing: hertz, derivatives"].failed > 0


def test_integrator_passes_and_explicit_methods_fail_where_they_have_to():
    checks = list(integrator_checks(4, 2))
    assert [failure.what for check in checks for failure in check.failures] == []
    assert len(checks) == 3 + len(SCENARIOS)
    assert all(np.isfinite(check.seconds) for check in checks)


def test_command_writes_json_and_refuses_unknown_parts(capsys, tmp_path):
    assert main(["stability", "--only", "element", "--runs", "2", "-o", str(tmp_path / "checks.json")]) == 0
    assert json.loads((tmp_path / "checks.json").read_text())["checks"]
    capsys.readouterr()
    assert main(["stability", "--only", "elements"]) == 2
    assert "allowed: element, integrator" in capsys.readouterr().err
