"""The shipped flexible machines, from the map to the Campbell diagram: what the contact law does to them.

No number of these tests is a result of the program itself: they hold laws against each other, the linear analysis
against the run in time, shifts against their energies, and forces against the balance of the machine.
"""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.maps.emap import open_map
from mbs.linearised.averaged import steady_system
from mbs.linearised.linear import frequency_response, with_peaks
from mbs.linearised.modes import modes, undamped_modes
from mbs.linearised.sweep import sweep
from mbs.modal.estimation import estimate
from mbs.modal.fit import identify
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.scene.assembly import assemble, build_body
from mbs.scene.changes import with_slices
from mbs.scene.reader import read_scene
from mbs.settings import Settings
from mbs.spectral.campbell import run_up_spectra
from mbs.spectral.run_signal import RunSignal
from mbs.transient.hammer import HammerTest, linear_hits
from mbs.transient.run import run

RPM = math.pi / 30.0
FROM, TO = 500.0 * RPM, 2500.0 * RPM


@pytest.fixture(scope="module")
def emap(reynolds_map):
    return open_map(reynolds_map)


def with_load(scene, factor):
    loads = tuple(dataclasses.replace(load, force=factor * load.force) for load in scene.loads)
    return dataclasses.replace(scene, loads=loads)


@pytest.fixture(scope="module")
def films(emap):
    """Sweeps of the gearbox with films, by clearance; shifts are summed over the steps of the one with clearance."""
    scene = with_slices(read_scene("gearbox"), 9)
    return {
        clearance: sweep(assemble(scene, "map", emap, clearance).system, np.linspace(FROM, TO, points))
        for clearance, points in ((0.0, 4), (40e-6, 11))
    }


@pytest.mark.slow
class TestGearbox:
    scene = read_scene("gearbox")

    def test_bearings_carry_what_the_mesh_pushes(self, emap):
        model = assemble(self.scene, "map", emap)
        balance = equilibrium(steady_system(model.system), Operation(FROM))
        for shaft, torque, teeth, first in (("shaft_1", 82.0, 21, 0), ("shaft_2", 82.0 * 23 / 21, 23, 2)):
            # The soft coupling takes a little of the torque.
            turn = balance.system.relative(f"{shaft}:left")[3] @ balance.displacement
            force = (torque - 20.0 * turn) / (0.5 * teeth * 4.5e-3 * math.cos(math.radians(20.0)))
            assert force == pytest.approx(torque / (0.5 * teeth * 4.5e-3 * math.cos(math.radians(20.0))), rel=1e-3)
            on_shaft = balance.forces[first] + balance.forces[first + 1]
            # Newton leaves 1e-10 of the largest force, which is a moment here; the weight is left out.
            assert np.hypot(on_shaft[1], on_shaft[2]) == pytest.approx(force, rel=1e-8)
            assert abs(on_shaft[2] / on_shaft[1]) == pytest.approx(1.0 / math.tan(math.radians(20.0)), rel=1e-8)
        np.testing.assert_allclose(balance.forces[0][1:3], -balance.forces[2][1:3], rtol=1e-6)

    def test_dry_modes_do_not_move_with_the_speed(self):
        result = sweep(assemble(self.scene, "hertz").system, np.linspace(FROM, TO, 3))
        # Without gyroscopic terms nothing depends on the speed: what is left is Newton's 1e-10.
        np.testing.assert_allclose(result.undamped.frequency[-1], result.undamped.frequency[0], rtol=1e-7)
        # Shaft-bearing modes turn in a plane here, as the bearing is softer across its load: no splitting to speak of.
        shown = np.nanmax(result.damped.bearing_share, axis=0) > 0.3
        moved = result.damped.frequency[-1] / result.damped.frequency[0] - 1.0
        assert np.max(np.abs(moved[shown])) < 1e-3

    def test_modes_move_as_the_energy_in_the_bearings_says(self, films):
        result = films[40e-6].undamped
        moved = np.abs(result.shift[-1]) > 2e-3
        assert np.count_nonzero(moved & (result.bearing_share[0] > 0.3)) >= 6
        # the sum over ten steps leaves their squares
        np.testing.assert_allclose(result.summed_shift[-1][moved], result.shift[-1][moved], rtol=0.05)

    def test_modes_along_the_load_fall_with_films_and_clearance(self, films):
        loose = films[40e-6]
        assert np.all(np.diff(loose.bearings.stiffness, axis=0) < 0.0)
        assert np.all(np.diff(loose.bearings.damping, axis=0) < 0.0)
        found = loose.undamped
        shaft = (found.frequency[0] > 2000.0) & (found.bearing_share[0] > 0.3) & (found.shift[-1] < 0.0)
        assert np.min(found.shift[-1][shaft]) < -0.015
        # Without clearance the film preloads the bearings, and all of these modes rise.
        tight = films[0.0]
        assert np.all(np.diff(tight.bearings.stiffness, axis=0) > 0.0)
        rising = tight.undamped.shift[-1][tight.undamped.bearing_share[0] > 0.3]
        assert np.all(rising > 0.0)

    def test_run_up_peaks_where_the_linear_sweep_has_modes(self, emap):
        model = assemble(with_slices(self.scene, 5), "map", emap)
        # Orders 42 and 63 pass modes between 1.1 and 1.7 kHz in this part of the run-up, as slowly as in the whole one.
        begin, end, duration, step = 1500.0 * RPM, 1800.0 * RPM, 0.75, 20e-6
        speed = SpeedProfile.ramp(begin, end, duration)
        start = equilibrium(model.system, Operation(begin))
        sensor = self.scene.sensors[0]
        settings = Settings(step, step, 0.9)
        recorded = run(model.system, speed, duration, settings, (sensor,), displacement=start.displacement)
        assert not any(recorded.outside.values())
        signal = RunSignal(recorded.time, recorded.speed, recorded.angle, recorded.signals[:, 0])
        spectra = run_up_spectra(signal, 1e-6, 5000.0, None, [21.0, 42.0, 63.0])
        linear = sweep(model.system, np.linspace(begin, end, 3))
        middle = linear.damped.frequency[1]
        assert len(spectra.peaks) >= 2
        for peak in spectra.peaks[:2]:
            nearest = middle[np.nanargmin(np.abs(middle - peak.frequency))]
            # Half the width of a peak with 2 % damping, and what it lags in a sweep.
            assert peak.frequency == pytest.approx(nearest, rel=0.015)


@pytest.mark.slow
class TestFlexibleShaft:
    scene = read_scene("nu308_flexible")

    def at(self, law, emap=None, factor=1.0, speed=2000.0, clearance=None):
        model = assemble(with_load(self.scene, factor), law, emap, clearance)
        return equilibrium(model.system, Operation(speed * RPM))

    def test_equilibrium_is_the_preload(self, emap):
        for forces in self.at("map", emap).forces:
            # preload between the rings goes through the bearing alone
            assert np.hypot(forces[1], forces[2]) == pytest.approx(141.42136, rel=1e-7)

    def test_a_housing_mode_does_not_care_about_the_law(self, emap):
        dry, wet = undamped_modes(self.at("hertz")), undamped_modes(self.at("map", emap))
        housing = dry.shares[list(dry.parts).index("housing")] > 0.97
        assert np.count_nonzero(housing & (dry.frequency < 3000.0)) >= 3
        mass = self.at("hertz").system.mass
        likeness = np.abs(dry.shapes.T @ mass @ wet.shapes) ** 2
        for k in np.nonzero(housing & (dry.frequency < 3000.0))[0]:
            partner = int(np.argmax(likeness[k]))
            # a third more stiffness in the 3 % of their energy that they have elsewhere at most
            assert wet.frequency[partner] == pytest.approx(dry.frequency[k], rel=5e-3)

    @pytest.mark.parametrize("law", ["hertz", "map"])
    def test_frequencies_rise_with_the_load(self, emap, law):
        found = []
        for factor in (1.0, 1.5, 2.0):
            balance = self.at(law, emap if law == "map" else None, factor, speed=500.0)
            shown = undamped_modes(balance)
            bearings = shown.shares[[part.startswith("bearing") for part in shown.parts]].sum(axis=0)
            found.append(shown.frequency[bearings > 0.5])
        assert found[0].size == found[1].size == found[2].size
        assert np.all(found[1] > found[0])
        assert np.all(found[2] > found[1])

    @pytest.mark.parametrize(("films", "most"), [("slow", 0.5), ("memory", 1.0)])
    def test_no_force_jumps_in_the_run_up(self, emap, films, most):
        """A jump would be as large however short the steps are; here it falls with them.

        Films with memory are stiffer against the oscillation that the start of the run excites while they form.
        """
        model = assemble(self.scene, "map", emap, films=films)
        speed = SpeedProfile.ramp(0.0, 2000.0 * RPM, 0.1)
        start = equilibrium(model.system, Operation(0.0))
        largest = []
        for step in (10e-6, 2.5e-6):
            recorded = run(model.system, speed, 0.01, Settings(step, step), displacement=start.displacement)
            size = np.hypot(recorded.forces[0][:, 1], recorded.forces[0][:, 2])
            largest.append(float(np.max(np.abs(np.diff(size)))))
        # A quarter, but for what the start of the run excites at the highest frequencies.
        assert largest[1] < 0.5 * largest[0]
        # The preload is 141 N; the jump of the switched law of the source is 155 % of it.
        assert largest[0] < most


class TestRig:
    scene = read_scene("n1014_testrig")

    def height(self, law):
        """Highest response of the shaft to the hammer."""
        model = assemble(self.scene, law)
        balance = equilibrium(model.system, model.operation)
        frequencies = with_peaks(np.array(self.scene.frequencies), modes(balance).eigenvalues)
        response = frequency_response(balance, self.scene.inputs, self.scene.sensors[:1], frequencies)
        return float(np.max(np.abs(response)))

    def test_amplitudes_go_with_the_damping(self):
        undamped, film, damped = (self.height(f"constant:{law}") for law in ("undamped", "cfd", "damped"))
        assert undamped > 2.0 * film > 4.0 * damped

    @pytest.mark.slow
    def test_hammer_test_finds_the_modes(self):
        model = assemble(self.scene, "formula")
        balance = equilibrium(model.system, model.operation)
        test = HammerTest(highest=5000.0, duration=0.6, hits=8, noise=0.01, seed=0, spread=0.5)
        records = linear_hits(balance, self.scene.inputs, self.scene.sensors, test)
        fit = identify(estimate(records).responses, (1000.0, 2900.0))
        true = modes(balance)
        assert fit.frequency.size >= 2
        for mode in range(2):
            nearest = int(np.argmin(np.abs(true.frequency - fit.frequency[mode])))
            # four standard deviations of what the noise of 1 % does, which the fit states, and which are small
            near, alike = 4.0 * fit.frequency_uncertainty[mode], 4.0 * fit.damping_uncertainty[mode]
            assert near < 1e-3 * fit.frequency[mode] and alike < 0.05 * fit.damping_ratio[mode]
            assert fit.frequency[mode] == pytest.approx(true.frequency[nearest], abs=near)
            assert fit.damping_ratio[mode] == pytest.approx(true.damping_ratio[nearest], abs=alike)


def test_a_machine_of_ones_own_is_a_copied_file(tmp_path):
    """A scene in another folder finds its own housing file, and what is not there is said."""
    shipped = Path(__file__).parents[2] / "mbs" / "systems"
    text = (shipped / "nu308_flexible.toml").read_text()
    (tmp_path / "own.toml").write_text(text.replace("nu308_housing.nc", "own_housing.nc"))
    with pytest.raises(Exception, match=r"own_housing\.nc"):
        read_scene(str(tmp_path / "own.toml"))
    (tmp_path / "own_housing.nc").write_bytes((shipped / "nu308_housing.nc").read_bytes())
    own, theirs = read_scene(str(tmp_path / "own.toml")), read_scene("nu308_flexible")
    assert build_body(own.bodies[1]).size == build_body(theirs.bodies[1]).size
