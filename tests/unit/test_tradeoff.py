"""Speed against accuracy of contacts: what is measured, told apart, lost and said."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.budget.contact_ways import (
    Answer,
    Flooded,
    FromLaw,
    LayerRule,
    LockedPole,
    Question,
    RoughRule,
    Slow,
    film_answer,
    more_piezoviscous,
    other_solids,
    scales,
    warmer,
)
from ehdmaps.jobs.budget.entries import sources
from ehdmaps.jobs.make.sampling import draw_sample
from ehdmaps.jobs.make.table_law import table_map
from ehdmaps.jobs.reader import parse_job
from ehdmaps.maps.contact_curve import ContactCurve
from ehdmaps.maps.law import ContactLaw
from ehdmaps.openfoam import installation
from ehdmaps.physics.bearing import with_law
from ehdmaps.physics.closed_form import FormulaSolver, HertzSolver
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.moes import moes_groups, valley_load_number
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solution import ContactSolverDefaults, FilmSolution, Status
from ehdmaps.physics.surface import Surface
from ehdmaps.trade.record import Choice, Entry, Group, Trade
from mbs.laboratory.tradeoff.contacts import measure
from mbs.laboratory.tradeoff.contestants import AtFrequency, FromTable, OnLayer, contestants
from tests.cases.jobs import LINE, SMALL
from tests.cases.laws import CONTACTS, NU308, OIL, SMALL_FIELD

JOB = parse_job(SMALL.replace('"formula"', '"reynolds"\ndensity = 3.25'), "small", "small.toml")
INNER = CONTACTS[0]
HEAVY = Question(INNER, OIL, OperatingPoint(5e4, 1.0, 313.15), 500.0)
LIGHT = Question(INNER, OIL, OperatingPoint(2e3, 2.0, 313.15), 500.0)


def held_against(truth, *entries: tuple[str, object, object], closed: bool = False) -> list[Entry]:
    group = Group("films", truth)
    return [Entry(group, label, model, finest, closed) for label, model, finest in entries]


def choice(trade: Trade, label: str) -> Choice:
    (found,) = [choice for choice in trade.choices if choice.label == label]
    return found


@dataclass(frozen=True)
class Holey(ContactSolverDefaults):
    """The film formula without a solution below a load."""

    least: float
    name: str = "holey"

    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        films = FormulaSolver().solve_line(contact, lubricant, loads, entrainment_speed, temperature)
        return tuple(
            film if load > self.least else FilmSolution(Status.STAGNATED, "too light")
            for load, film in zip(loads, films, strict=True)
        )

    def settings(self):
        return {}


def test_numerical_error_falls_with_the_grid_and_is_what_the_solver_states():
    """Densities 4 and 8 against 20, whose own error is a 25th of the first at order two, and less at the order seen."""
    fine = Flooded(ReynoldsSolver(density=20.0))
    coarse, usual = (Flooded(ReynoldsSolver(density=density)) for density in (4.0, 8.0))
    trade = measure(JOB, 8, 3, 0, held_against(fine, ("coarse", coarse, fine), ("usual", usual, fine)))
    first, second = (choice(trade, label) for label in ("coarse", "usual"))
    for name in ("film offset", "stiffness", "damping", "film compliance"):
        # order two at least: a half of the cell leaves a quarter of the error
        assert second.numerical[name].median < 0.25 * first.numerical[name].median
        # the finest solution is the reference: nothing is left to a model
        assert first.errors[name] == first.numerical[name] and not first.model
        # the solver's estimate holds at nineteen of twenty points, so at seven of eight
        assert first.numerical[name].covered >= 0.875
    assert trade.reference.startswith("reynolds, density 20, inlet length 1893.49 (")
    assert first.solved == first.asked == 8 and 0.0 < first.seconds < second.seconds


def test_closed_forms_have_errors_of_the_model_only():
    truth = Flooded(FormulaSolver())
    entries = held_against(truth, ("same", truth, None), ("dry", Flooded(HertzSolver()), None), closed=True)
    same, dry = measure(JOB, 6, 1, 0, entries).choices
    assert [same.errors[name].largest for name in same.errors] == [0.0] * 8
    # no film at all is off by the whole film, exactly
    for name in ("film offset", "central film", "minimum film"):
        assert (dry.errors[name].bias, dry.errors[name].largest) == (-1.0, 1.0)
    assert dry.model == dry.errors and not dry.numerical
    assert not math.isfinite(dry.errors["film offset"].stated)


def test_numerical_error_and_that_of_the_model_add_up():
    """At one point medians are values. Bar: rounding of three differences of numbers of size one."""
    rough = Surface(2e-7)
    usual, finest = (RoughRule(ReynoldsSolver(density=density), rough) for density in (3.0, 6.0))
    (found,) = measure(JOB, 1, 5, 0, held_against(Flooded(FormulaSolver()), ("rule", usual, finest))).choices
    for name, error in found.errors.items():
        assert found.numerical[name].bias + found.model[name].bias == pytest.approx(error.bias, abs=1e-12)
    assert found.model["film offset"].largest > 0.0


def test_points_without_a_solution_are_counted_and_named():
    loads = sorted(point.load for point in draw_sample(JOB, 10, np.random.default_rng(2)))
    by_formula, holey, worse = (
        Flooded(solver) for solver in (FormulaSolver(), Holey(0.5 * (loads[2] + loads[3])), Holey(loads[4]))
    )
    entries = held_against(holey, ("all", by_formula, worse), ("some", worse, None))
    trade = measure(JOB, 10, 2, 0, entries)
    everywhere, some = trade.choices
    assert (everywhere.solved, everywhere.asked, everywhere.errors["stiffness"].points) == (10, 10, 7)
    assert (some.solved, some.errors["stiffness"].points, len(some.lost)) == (5, 5, 5)
    assert everywhere.numerical["stiffness"].points == 5
    assert all("; too light" in text and " N/mm, " in text for text in some.lost)
    frame = list(trade.frame)
    at = frame.index("reference of films: without a solution at 3 of 10 points; nothing compared there")
    assert all(line.endswith(": stagnated; too light") for line in frame[at + 1 : at + 4])
    assert sum(line.startswith("no numerical error told apart: finest of all at ") for line in frame) == 5


def test_points_follow_from_the_seed_and_lie_in_the_valley_too():
    rng = np.random.default_rng
    first, again, other = (draw_sample(JOB, 40, rng(seed)) for seed in (1, 1, 2))
    assert first == again != other
    assert all(min(JOB.loads) < point.load < max(JOB.loads) for point in first)
    ratios = []
    for contact, load, speed, temperature in first:
        state = JOB.lubricant.at(temperature)
        alpha = state.pressure_viscosity.pressure_viscosity
        M, L = moes_groups(load, speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus)
        ratios.append(M / float(valley_load_number(L)))
    # a fifth is drawn between exp(-0.6) and exp(0.8) of the valley; the others may lie there too
    assert sum(0.54 < ratio < 2.23 for ratio in ratios) >= 8


def test_damping_is_not_measured_by_a_zero():
    """What errors are relative to: the value, but where it goes through zero a share of what it is made of."""
    k, time = 2e10, HEAVY.passing_time
    floors = scales(Answer({"stiffness": k, "damping": -1e-9, "film compliance": 1e-20}), HEAVY)
    assert floors["damping"] == pytest.approx(0.02 * k * time, rel=1e-12)
    assert floors["film compliance"] == pytest.approx(0.01 / k, rel=1e-12)
    usual = scales(film_answer(ReynoldsSolver().solve_line(INNER, OIL, (5e4,), 1.0, 313.15)[0], HEAVY), HEAVY)
    assert usual["film offset"] > 0.0 and usual["approach"] > usual["film offset"]
    thin = scales(Answer({"film offset": -1e-9}), HEAVY, least_film=2e-7)
    assert thin["film offset"] == 2e-7


def test_rules_of_layer_and_roughness_are_those_of_contact_laws():
    """The same films through a law's table, of the film formula. Bar: 1e-3, the error of the table on a layer."""
    question = LIGHT
    point = question.point
    speeds, temperatures = np.array([point.entrainment_speed]), np.array([point.temperature])

    @dataclass(frozen=True)
    class Field(ContactSolverDefaults):
        name: str = "field"

        def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
            curve = ContactCurve(SMALL_FIELD, contact, speeds, temperatures)
            film, compliance, loss = SMALL_FIELD.films(
                contact.name, np.array(loads)[:, None, None], speeds, temperatures
            )
            assert curve.tail.load.item() < min(loads)
            return tuple(
                FilmSolution(Status.CONVERGED, "", *values, mass_flow=1.2257484409676 * values[0] * mass)
                for values in zip(film.ravel(), compliance.ravel(), loss.ravel(), strict=True)
            )

        def settings(self):
            return {}

    mass = OIL.at(point.temperature).density * point.entrainment_speed
    for rule, law in (
        (LayerRule(Field(), OilSupply(5e-7)), ContactLaw("inner", (INNER,), OIL, SMALL_FIELD, supply=OilSupply(5e-7))),
        (RoughRule(Field(), Surface(2e-7)), ContactLaw("inner", (INNER,), OIL, SMALL_FIELD, surface=Surface(2e-7))),
    ):
        found = rule(question).values
        w, k, c = law(found["approach"], 0.0, point.entrainment_speed, point.temperature)
        assert w == pytest.approx(point.load, rel=1e-3)
        assert k == pytest.approx(found["stiffness"], rel=1e-3)
        assert c == pytest.approx(found["damping"], rel=5e-3)  # damping is a logarithm in the table


def test_a_layer_that_brings_enough_changes_nothing():
    solver, plenty = ReynoldsSolver(density=4.0), OilSupply(1e-3)
    flooded = Flooded(solver)(HEAVY)
    assert OnLayer(solver, plenty)(HEAVY) == flooded
    # the polynomials of the rule are good to 1e-4 at their end; damping has that of two of them
    by_rule = LayerRule(solver, plenty)(HEAVY).values
    assert all(by_rule[name] == pytest.approx(flooded.values[name], rel=3e-4) for name in by_rule)


def test_a_meniscus_that_follows_gives_the_slope_of_the_film_over_load():
    """Second method: a difference quotient of films behind the layer. Bar: its error of second order, 1e-4."""
    solver, layer, load, step = ReynoldsSolver(), OilSupply(1.5e-6), LIGHT.point.load, 2e-3
    films = [
        solver.supplied_film(INNER, OIL, replace(LIGHT.point, load=load * factor), layer).film.film_offset
        for factor in (1.0 - step, 1.0 + step)
    ]
    found = OnLayer(solver, layer)(LIGHT)
    slope = (films[0] - films[1]) / (2.0 * step * load)
    assert found.values["film compliance"] == pytest.approx(slope, rel=1e-3)
    assert found.values["loss compliance"] == pytest.approx(
        found.values["damping"] / found.values["stiffness"] ** 2, rel=1e-12
    )
    assert "stiffness" not in found.stated and "film offset" in found.stated


def test_frequency_models_meet_in_slow_motion_and_the_pole_comes_closer():
    solver = ReynoldsSolver()
    models = (AtFrequency(solver), Slow(solver), LockedPole(solver, False), LockedPole(solver, True))
    still = [model(replace(HEAVY, frequency=1e-2)).values for model in models]
    for answer in still[1:]:
        # what a film remembers goes with the square of omega T, 1e-5 here
        assert answer["stiffness"] == pytest.approx(still[0]["stiffness"], rel=1e-6)
        assert answer["damping"] == pytest.approx(still[0]["damping"], rel=1e-4)
    exact, slow, formula, fitted = (model(replace(HEAVY, frequency=3e3)).values for model in models)
    off = [abs(answer["damping"] / exact["damping"] - 1.0) for answer in (slow, formula, fitted)]
    # the stated 7 and 5 % of the complex stiffness are more of its small imaginary part
    assert off[0] > max(off[1], off[2]) and off[2] < off[0] / 3.0


def test_the_table_of_contestants():
    job = parse_job(
        SMALL.replace('"formula"', '"reynolds"\ndensity = 4.0') + '[supply]\noil_layer = "1 um"\n', "j", "j.toml"
    )
    entries = contestants(job, openfoam=False)
    labels = [entry.label for entry in entries]
    assert len(set(labels)) == len(labels)
    assert labels[:2] == ["hertz", "formula, moes"]
    assert "reynolds, density 4" in labels and not any("openfoam" in label for label in labels)
    assert "oil layer 1 um" in {entry.group.name for entry in entries}
    # a grid of the job's own is not what is used where nothing is said
    assert not any(entry.default for entry in entries if entry.group.name == "reynolds")
    plain = contestants(parse_job(SMALL, "j", "j.toml"), openfoam=False)
    assert [entry.label for entry in plain if entry.default] == [
        "formula, moes",
        "reynolds, density 6.5",
        "shear: newtonian",
        *(["heat: isothermal"] if solvers.takes("reynolds", "physics", "thermal") else []),
        "layer: flooded film",
        "rough: smooth film",
        "frequency: one pole, fitted",
    ]


def test_missing_openfoam_is_said(monkeypatch):
    monkeypatch.setattr(installation, "missing", lambda: ("setpriv is not in PATH",))
    monkeypatch.setattr(
        "mbs.laboratory.tradeoff.contacts.contestants", lambda job, openfoam: _nothing_but_formulas(openfoam)
    )
    frame = measure(JOB, 2, 1, 3).frame
    assert "openfoam: left out; setpriv is not in PATH" in frame
    assert "openfoam: left out, as asked" in measure(JOB, 2, 1, 0).frame


def _nothing_but_formulas(openfoam: bool) -> list[Entry]:
    assert not openfoam
    return held_against(Flooded(FormulaSolver()), ("dry", Flooded(HertzSolver()), None), closed=True)


def test_a_job_at_standstill_has_nothing_to_measure():
    still = parse_job(LINE.replace('["0 m/s", "1 m/s"]', '["0 m/s"]'), "still", "still.toml")
    with pytest.raises(InputError, match="entrainment_speed of still: got 0 m/s only; allowed: a job with a speed"):
        measure(still, 2)


def test_the_film_table_and_its_law_are_as_near_as_they_state():
    """Against a film of four times the density at the same points: k of the table, w of the law by its approach."""
    questions = [HEAVY, LIGHT]
    fine = [Flooded(ReynoldsSolver(density=20.0))(question) for question in questions]
    read = FromTable().many(questions)
    assert read == (FromTable()(HEAVY), FromTable()(LIGHT))
    contacts = {contact.name: contact for contact in CONTACTS}
    emap = table_map(NU308, OIL)
    law = FromLaw({name: emap.law(name, outside="asymptote") for name in contacts})
    for question, answer, truth in zip(questions, read, fine, strict=True):
        # medians of the table are 0.002 and 0.009 %; these bound all of 500 points
        assert answer.values["stiffness"] == pytest.approx(truth.values["stiffness"], rel=2e-3)
        assert answer.values["damping"] == pytest.approx(truth.values["damping"], rel=2e-2)
        assert answer.stated["stiffness"] > 0.0
        by_law = law(question)
        assert by_law.values["stiffness"] == pytest.approx(truth.values["stiffness"], rel=3e-3)
        assert by_law.values["film offset"] == pytest.approx(truth.values["film offset"], rel=5e-3)


def test_what_is_stated_otherwise_is_solved_otherwise():
    """Each way of being told wrong is the same solver at another question, bit for bit."""
    solver = ReynoldsSolver(density=4.0)
    plain = Flooded(solver)
    hot = replace(HEAVY, point=replace(HEAVY.point, temperature=HEAVY.point.temperature + 5.0))
    assert plain(warmer(5.0, HEAVY)) == plain(hot)
    assert plain(more_piezoviscous(1.0, HEAVY)).values["stiffness"] == pytest.approx(
        plain(HEAVY).values["stiffness"], rel=1e-9
    )
    # the film goes with about the square root of alpha there: between the powers of 0.3 and 0.8
    thicker = plain(more_piezoviscous(1.1, HEAVY)).values["film offset"] / plain(HEAVY).values["film offset"]
    assert 1.1**0.3 < thicker < 1.1**0.8
    soft = plain(other_solids("half_space", NU308, HEAVY)).values
    assert soft["film offset"] == plain(HEAVY).values["film offset"]
    compliance = with_law(INNER, "half_space", NU308).structural_compliance(HEAVY.point.load)
    assert 1.0 / soft["stiffness"] == pytest.approx(float(compliance) + soft["film compliance"], rel=1e-9)


def test_sources_name_who_lacks_and_who_has_them():
    found = {source.name: source for source in sources(contestants(JOB, openfoam=False))}
    assert found["film memory"].off == "frequency: slow motion"
    assert found["film memory"].on == "frequency: one pole, fitted"
    assert {"grid of the solver", "rings 5 K warmer than stated", "roughness 0.2 um"} <= set(found)
