"""The subcircuit of a bearing in ngspice: it charges with its time constant, and breaks down where it is said to."""

from __future__ import annotations

import math
import re
import subprocess

import pytest

from tests.cases.commands import run
from tests.cases.programs import needed

DECK = """* a bearing behind a resistor
.include bearing.cir
V1 in 0 PWL(0 0 {tiny} {high} {end} {high})
R0 in a {ohm}
X1 a 0 BEARING_6208
.tran {step} {end} 0 {step}
.control
run
meas tran charged find v(a) at={time}
meas tran peak max v(a)
meas tran after min v(a) from={late} to={end}
.endc
.end
"""


@pytest.mark.slow
def test_a_bearing_in_a_circuit(capsys, tmp_path, monkeypatch):
    """1 %: steps of a hundredth of the time constant; the switch closes between two of them."""
    program = needed("ngspice")
    monkeypatch.chdir(tmp_path)
    ask = ("6208", "--load", "2 kN", "--axial", "500 N", "--speed", "3000 rpm", "--bands", "numerics")
    dielectric = "{ value = 2.2, conductivity = '1e-9 S/m' }"
    status, page, err = run(capsys, "bearing", *ask, "--permittivity", dielectric, "-o", "bearing.cir")
    assert status == 0, err
    text = (tmp_path / "bearing.cir").read_text(encoding="utf-8")
    c, r, vbd = (float(re.search(rf" {name}=(\S+)", text)[1]) for name in ("c", "r", "vbd"))
    assert f"R C {c * r:.3g} s" in page
    ohm = 0.5 * r
    whole = r / (r + ohm)  # a resistor before the bearing: time constant and end by both
    time, high = c * r * ohm / (r + ohm), 3.0 * vbd
    deck = DECK.format(
        tiny=1e-6 * time, high=high, ohm=ohm, step=time / 100.0, end=5.0 * time, time=0.3 * time, late=2.0 * time
    )
    (tmp_path / "deck.cir").write_text(deck, encoding="utf-8")
    told = subprocess.run([program, "-b", "deck.cir"], capture_output=True, text=True, check=False).stdout
    found = {name: float(value) for name, value in re.findall(r"^(\w+)\s+=\s+(\S+)", told, re.MULTILINE)}
    assert found["charged"] == pytest.approx(high * whole * -math.expm1(-0.3), rel=0.01)
    assert found["peak"] == pytest.approx(vbd, rel=0.02)
    assert found["after"] < 0.1 * vbd
