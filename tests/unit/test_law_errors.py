"""Bounds of the errors of a law, from what a map states, and laws that are wrong on purpose."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.film_field import valley_loads
from ehdmaps.maps.law import ContactLaw
from ehdmaps.maps.law_errors import NOT_IN, LawChange, quantile_of
from ehdmaps.maps.schema import typed, variable
from tests.cases.laws import CONTACTS, OIL, SMALL_FIELD, dataset_of

BOTH = ("inner", "outer")
SPEED, WARM = 0.6, 323.15
"""A node of the map."""

CHECKED = {
    "law_check_usable": 100,
    "law_film_compliance_error": "median 1e-5, 95 % 0.02, 99 % 0.3, largest 0.4",
    "law_damping_error": "median 1e-5, 95 % 0.01, 99 % 0.3, largest 0.4",
    "law_stiffness_error": "median 1e-5, 95 % 0.001, 99 % 0.3, largest 0.4",
    "law_film_offset_error": "median 1e-5, 95 % 0.0005, 99 % 0.3, largest 0.4",
}


@pytest.fixture(scope="module")
def stated():
    """A map of a closed form that states an error of 1 % of its film compliances, and of 2 % of its losses."""
    dataset = dataset_of().drop_vars(["stiffness_error", "damping_error", "stiffness", "damping", "approach"])
    for name, value in (("film_compliance_error", 0.01), ("loss_compliance_error", 0.02), ("film_offset_error", 1e-3)):
        dataset[name].values[:] = value
    return EHDMap(dataset).dataset


def errors_of(dataset, **attributes):
    return EHDMap(dataset.assign_attrs(attributes)).law_errors


def with_model_errors(dataset, stiffness, damping):
    """The map with model errors, the same at all points."""
    errors = (("stiffness_model_error", stiffness), ("damping_model_error", damping))
    shape = dataset["stiffness"].shape
    return dataset.assign({name: typed(variable(name), np.full(shape, value)) for name, value in errors})


def test_a_contact_at_a_node_has_what_the_map_states(stated):
    loads = stated["load"].values
    for name in BOTH:
        at = {"contact": name, "entrainment_speed": SPEED, "temperature": WARM}
        found, node = errors_of(stated).bounds([name], loads, -SPEED, WARM), stated.sel(at)
        # round-off
        np.testing.assert_allclose(found.stiffness, node["stiffness_error"], rtol=1e-9)
        np.testing.assert_allclose(found.damping, node["damping_error"], rtol=1e-9)
        np.testing.assert_allclose(found.film_offset, 1e-3 * node["film_offset"], rtol=1e-9)


def test_contacts_in_series_add_their_compliances_and_losses(stated):
    """Against both contacts with a film compliance that is 1 % larger: 1/k and c/k^2 add."""
    loads = stated["load"].values
    found = errors_of(stated).bounds(BOTH, loads, SPEED, WARM)
    node = stated.sel(entrainment_speed=SPEED, temperature=WARM)
    whole = (1.0 / node["stiffness"]).sum("contact")
    more = (0.01 * node["film_compliance"]).sum("contact")
    np.testing.assert_allclose(found.stiffness, more / whole, rtol=1e-9)
    assert np.all(found.stiffness < 0.01)
    # c = loss k^2 by signs that are known here; a bound has 5 % of both in case they cancel, and knows of no signs
    # between contacts, whose shares in 1/k and in the loss differ.
    shares = [(values / values.sum("contact")).values for values in (1.0 / node["stiffness"], node["loss_compliance"])]
    differ = np.abs(shares[0] - shares[1]).sum(axis=0)
    signed = np.abs(0.02 - 2.0 * found.stiffness)
    assert np.all(found.damping >= signed)
    assert np.all(found.damping <= signed + 0.05 * (0.02 + 2.0 * found.stiffness) + 4.0 * differ * 0.01)
    np.testing.assert_allclose(found.film_offset, 1e-3 * node["film_offset"].sum("contact"), rtol=1e-9)


def test_errors_of_the_law_and_of_the_model_are_added(stated):
    loads = stated["load"].values
    plain = errors_of(stated).bounds(BOTH, loads, SPEED, WARM)
    checked = errors_of(stated, **CHECKED).bounds(BOTH, loads, SPEED, WARM)
    np.testing.assert_allclose(checked.stiffness - plain.stiffness, 0.001, rtol=1e-6)
    # Two contacts with the same relative errors have these, and something for shares in 1/k and loss that differ.
    more = checked.damping - plain.damping
    assert np.all((more > 0.01 * (1.0 - 1e-9)) & (more < 0.01 + 2.0 * 0.001))
    film = stated["film_offset"].sel(entrainment_speed=SPEED, temperature=WARM).sum("contact")
    np.testing.assert_allclose(checked.film_offset - plain.film_offset, 0.0005 * film, rtol=1e-6)
    modelled = with_model_errors(stated, 0.03, -0.04)
    both = errors_of(modelled).bounds(BOTH, loads, SPEED, WARM)
    np.testing.assert_allclose(both.stiffness - plain.stiffness, 0.03, rtol=1e-6)
    more = both.damping - plain.damping
    assert np.all((more > 0.04 * (1.0 - 1e-9)) & (more < 0.04 + 2.0 * 0.03))


def test_the_valley_has_quantiles_of_its_own(stated):
    more = {"law_valley_damping_error": "median 0.1, 95 % 0.5, 99 % 1, largest 1"}
    (place,) = valley_loads(CONTACTS[0], OIL, np.array([SPEED]), np.array([WARM])).ravel()
    at = place * np.exp([-3.0, 0.0, 3.0])
    plain, found = (errors_of(stated, **CHECKED, **added).bounds(["inner"], at, SPEED, WARM) for added in ({}, more))
    np.testing.assert_allclose(found.damping - plain.damping, [0.0, 0.49, 0.0], rtol=1e-6, atol=1e-12)


def test_maps_made_before_state_an_error_of_their_film_compliance_only(stated):
    loads, older = stated["load"].values, {**CHECKED, "law_stiffness_error": ""}
    plain, found = (errors_of(stated, **attributes).bounds(["outer"], loads, SPEED, WARM) for attributes in ({}, older))
    node = stated.sel(contact="outer", entrainment_speed=SPEED, temperature=WARM)
    share = node["film_compliance"] * node["stiffness"]
    np.testing.assert_allclose(found.stiffness - plain.stiffness, 0.02 * share, rtol=1e-6)


def test_what_is_not_stated_is_said(stated):
    assert errors_of(stated).bounds(BOTH, np.array([1e4]), 0.0, WARM) is None
    words = errors_of(stated).words
    assert "it was not checked" in words and "none stated" in words and words.endswith(NOT_IN)
    whole = errors_of(with_model_errors(stated, 0.0, 0.0), **CHECKED).words
    assert "95 % of 100 checked points" in whole and "errors of its model;" in whole and "without" not in whole
    unknown = stated.drop_vars(["stiffness_error", "damping_error", "stiffness", "damping", "approach"])
    unknown["loss_compliance_error"] = unknown["loss_compliance_error"] * np.nan
    unknown["loss_compliance_error"].attrs = stated["loss_compliance_error"].attrs
    assert "damping_error (not known)" in errors_of(unknown).words
    assert quantile_of("none: no film to relate to") is None


def test_a_changed_law_is_exact():
    """Its table is B-splines, which take a factor and a constant as they are: to round-off."""
    law = ContactLaw("series", CONTACTS, OIL, SMALL_FIELD, "clamp")
    other = law.changed(LawChange(0.02, -0.1, 2e-8))
    delta = np.linspace(1e-6, 2e-5, 20)
    w, k, c = law(delta + 2e-8, 0.0, 1.2, 320.0)
    found = other(delta, 0.0, 1.2, 320.0)
    for got, expected in zip(found, (1.02 * w, 1.02 * k, 0.9 * c), strict=True):
        np.testing.assert_allclose(got, expected, rtol=1e-9)
    assert law.at(1.2, 320.0) is law.at(1.2, 320.0) is not other.at(1.2, 320.0)
    other(1.0, 0.0, 1.2, 320.0)
    assert other.outside_counts["load"] == 1 and law.outside_counts["load"] == 0
