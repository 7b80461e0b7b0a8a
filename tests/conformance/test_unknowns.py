"""What is not known of bearings of every kind: what is held open, and bands beside machines that are solved again.

The oracle is the command itself at the ends of the one thing that is open, a temperature: no look, pairing or sum is in
it. With one unknown a bound is the further of both ends, and of the middle; numerics widen it by their size at most.
"""

from __future__ import annotations

import re

import numpy as np
import pytest
import xarray as xr

from mbs import assemble, parse_scene, statics
from mbs.one_bearing import request
from mbs.unknowns.held_open import held_open
from tests.cases.commands import check_units, run
from tests.conformance.machines import KINDS, MIXED
from tests.conformance.test_one_bearing import KINDS as DESIGNATIONS

WITH_FILMS = [machine for machine in (*KINDS, *MIXED[:2]) if machine.films]
NAMES = [machine.name for machine in WITH_FILMS]
FEWER = [one for one in WITH_FILMS if one.name in ("cylindrical", "angular contact", "tapered")]
"""Machines whose bands are compared, of each shape of raceway; bearings of the other kinds have the same bounds alone,
in `test_one_bearing`."""

KNOWN = {
    "clearance": "0 um", "viscosity": "0 %", "pressure_viscosity": "0 %", "geometry": "0 %", "preload": "0 %",
    "profile": "0 %", "cage_angle": "0 deg",
}  # fmt: skip
"""All but the temperature, which is known to 2 K."""
TOLERANCES = "\n".join(["[tolerances]", 'temperature = "2 K"', *(f'{key} = "{at}"' for key, at in KNOWN.items())])
ENDS = ("58 degC", "62 degC")

EXACT = 1e-9
"""Part that sums of logarithms, and equilibria from other starts, leave."""


def solved(capsys, command, *options, **more):
    """The dataset of a command on the machine in the folder, and what it says."""
    status, out, err = run(capsys, command, *more.get("ask", ("machine.toml",)), *options, "-o", "a.nc")
    assert status == 0, err or out
    with xr.open_dataset("a.nc") as data:
        return data.load(), out


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path / "machine.toml"


@pytest.fixture
def machine(request, here):
    here.write_text(f"{request.param.text()}\n{TOLERANCES}\n", encoding="utf-8")
    return request.param


def hold(found, ends, names, slack):
    """Bounds enclose the value and both ends, and nothing beyond them but the slack of each side, by name."""
    for name in names:
        low, value, high = (found[f"{name}{side}"].values for side in ("_low", "", "_high"))
        known = np.isfinite(low)
        assert known.any(), name
        all_of_them = np.array([value, *(end[name].values for end in ends)])
        least, most = all_of_them.min(axis=0), all_of_them.max(axis=0)
        room = EXACT * np.nanmax(np.abs(all_of_them))
        wide = np.nan_to_num(slack.get(name, 0.0))
        for told, true in ((least - low, wide), (high - most, wide)):
            inside = (told >= -room) & (told <= true + room)
            assert np.all(inside[known]), name


@pytest.mark.parametrize("machine", FEWER, ids=[one.name for one in FEWER], indirect=True)
def test_statics(machine, capsys, monkeypatch):
    results = []
    monkeypatch.setattr("mbs.commands.statics.statics", lambda *given: results.append(statics(*given)) or results[-1])
    found, out = solved(capsys, "statics", "--bands", "all")
    check_units(found)
    assert "held open: temperature +-2 K" in out
    ends = [solved(capsys, "statics", "--temperature", end)[0] for end in ENDS]
    assert np.any(ends[0]["bearing_stiffness"].values != ends[1]["bearing_stiffness"].values)
    # numerics of K and C, which their bounds hold too, are in no file
    slack = {name: band.numerics for name, band in results[0].bands.items()}
    hold(found, ends, [name.removesuffix("_low") for name in found if name.endswith("_low")], slack)
    assert {"bearing_stiffness_low", "bearing_force_low", "minimum_film_low"} <= set(found)


@pytest.mark.parametrize("machine", FEWER[:2], ids=[one.name for one in FEWER[:2]], indirect=True)
def test_modes(machine, capsys):
    """Modes keep their order over so small a change; those that do not swing everywhere have no bounds."""
    found, _ = solved(capsys, "modes", "--bands", "all", "--highest", "3 kHz")
    check_units(found)
    ends = [solved(capsys, "modes", "--temperature", end, "--highest", "3 kHz")[0] for end in ENDS]
    banded = np.flatnonzero(np.isfinite(found["frequency_low"].values))
    # modes of rollers on their films, far above, swing at one temperature and creep at another
    assert banded.size and all(banded.max() < end.sizes["mode"] for end in ends)
    shown = [end.isel(mode=banded) for end in ends]
    names, own = ("frequency", "damping_ratio"), found.isel(mode=banded)
    hold(own, shown, names, {name: own[f"{name}_error"].values for name in names})


COMMANDS = {
    "lsa": ("peak_frequency", "peak_level"),
    "sweep": ("complex_frequency", "complex_damping_ratio"),
    "critical": ("critical_speed", "critical_damping_ratio"),
}
IN_TURN = list(zip(FEWER, COMMANDS, strict=True))
"""Each machine has one of these commands: bounds of a kind are those of one bearing, and of a command of all kinds."""


@pytest.mark.parametrize(("one", "command"), IN_TURN, ids=[one.name for one, _ in IN_TURN])
@pytest.mark.slow
def test_responses_and_speeds(one, command, here, capsys):
    """Values lie within their bounds, some of which are apart."""
    here.write_text(f"{one.text()}\n{TOLERANCES}\n", encoding="utf-8")
    found, out = solved(capsys, command, "--bands", "all")
    check_units(found)
    assert "held open: temperature +-2 K" in out
    for name in COMMANDS[command]:
        if name not in found:  # no peak of a mode, no critical speed
            continue
        low, value, high = (found[f"{name}{side}"].values for side in ("_low", "", "_high"))
        known = np.isfinite(low)
        assert np.all((low <= value)[known] & (value <= high)[known])
        assert not known.any() or np.any((low < high)[known])


# of two rows, and of ribs, one each: others are two bearings to round-off (`test_roller_rows`), or its mirror image
@pytest.mark.parametrize("name", [one for one in DESIGNATIONS if one not in ("NNCF5010", "NJ308", "QJ208", "1208")])
def test_one_bearing(name, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    known = "; ".join(f"{key} = +- {at}" for key, at in KNOWN.items())
    ask = (name, "--load", "2 kN", "--speed", "1500 rpm", "--law", "table", *DESIGNATIONS[name])
    at = ("--temperature", "60 degC", "--know", f"temperature = +- 2 K; {known}")
    bands, make = {}, request.point_bands
    monkeypatch.setattr(request, "point_bands", lambda *given: bands.update(make(*given)) or bands)
    found, out = solved(capsys, "bearing", *at, "--bands", "all", ask=ask)
    check_units(found)
    assert "held open: temperature +-2 K" in out and "K along, N/um" in out
    ends = [solved(capsys, "bearing", "--temperature", end, ask=ask)[0] for end in ENDS]
    told = [each.removesuffix("_low") for each in found if each.endswith("_low")]
    # numerics, which bounds hold too, are in no file
    hold(found, ends, told, {each: bands[each].numerics for each in told})
    assert np.all(bands["stiffness_along"].numerics > 0.0)
    assert {"stiffness_along", "damping_along", "minimum_film"} <= set(told)


@pytest.mark.parametrize("machine", WITH_FILMS, ids=NAMES)
def test_what_is_held_open_has_a_row_for_each_part(machine):
    """Each error that an estimate states of itself, a clearance of all but tapered rollers and washers, and profiles of
    rollers."""
    scene = assemble(parse_scene(machine.text(), machine.name, "machine.toml"), law="hertz").scene
    found = held_open(scene)
    groups = {one.group for one in found}
    assert {"temperature", "pressure_viscosity", "cage_angle"} <= groups
    for entry in scene.of_all_kinds:
        mine = {one.name for one in found if one.name.endswith(f" of {entry.name}")}
        rollers, without = hasattr(entry.geometry, "roller_diameter"), entry.geometry.name == "51208"
        assert (f"clearance of {entry.name}" in mine) != (without or entry.geometry.clearance is None)
        assert (f"profile of {entry.name}" in mine) == rollers
        words = re.sub(r" \([^)]*\)", "", entry.geometry.estimated or "")  # effects of parts are no parts
        for part in re.findall(r"(?:, |: )([a-z ]+?) (?:to )?(?:about )?[\d.]+ (?:%|deg)", words):
            assert f"{part} of {entry.name}" in mine, part
