"""Runs whose numbers agree, and what basins are along a parameter."""

from __future__ import annotations

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth import studies
from nonsmooth.studies.attractors import matched, pictures
from tests.studies.attractors.made import labels, logistic, study

pytest.importorskip("xarray")


def test_numbers_agree_within_the_tolerance_of_each() -> None:
    made = study({}, failed=(4,), speed=[1.0, 1.05, 2.0, 1.1, 1.0, 1.0], flights=[1.0, 1.0, 1.0, 1.0, 1.0, np.nan])
    found = studies.features(made, {"speed": 0.06, "flights": 0.5})
    assert found.attractor.values.tolist() == [0, 0, 1, 0, -1, 2]
    assert found.attractor.attrs["flag_meanings"] == "A1 A2 A3"
    finer = studies.features(made, {"speed": 0.04})
    assert finer.attractor.values.tolist() == [0, 1, 2, 3, -1, 0]


def test_features_that_are_none() -> None:
    made = study({}, speed=[1.0])
    for tolerances, words in (
        ({}, "one at least"),
        ({"sped": 1.0}, "Did you mean 'speed'"),
        ({"speed": -1.0}, "must be positive"),
    ):
        with pytest.raises(ns.InvalidInput, match=words):
            studies.features(made, tolerances)


def test_matching_takes_the_nearest_within_the_tolerance() -> None:
    a, b, c = np.array([[0.0, 0.0]]), np.array([[1.0, 0.0], [2.0, 0.0]]), np.array([[9.0, 9.0]])
    assert matched([a, b], [b + 0.1, c, a - 0.1], 0.2) == [1, -1, 0]
    assert matched([a, b], [b + 0.1, c, a - 0.1], 0.05) == [-1, -1, -1]
    assert matched([], [a], 1.0) == [-1]
    # each goes to one; of two that are near, to the nearer
    assert matched([a], [a + 0.3, a + 0.2], 1.0) == [-1, 0]
    # a pair that both can have does not go to the nearer one where the other would have none
    assert matched([a, a + 1.0], [a + 0.4, a - 0.9], 1.0) == [1, 0]


def test_an_attractor_that_moves_is_followed_through_its_doubling() -> None:
    """The fixed point 1 - 1/r of the logistic map becomes a cycle of two at r = 3; another orbit comes and goes."""
    r = np.repeat(np.linspace(2.6, 3.2, 13), 4)
    points = logistic(r, np.full(52, 0.3), settle=20_000)
    which = np.tile([0, 0, 0, 1], 13)
    points[which == 1] += 4.0  # the other one
    visible = ~((which == 1) & (r > 2.81) & (r < 2.94))
    made = study({"r": r[visible]}, stroboscopic=points[visible])
    found = studies.recurrences(made, 1e-3, along=studies.Along("r", 0.25, bins=13))
    assert (found.attractor.values == which[visible]).all()
    assert found.attractor.attrs["flag_meanings"] == "A1 A2"
    assert found.period.values[(r < 2.99)[visible]].max() == 1
    assert set(found.period.values[(r > 3.01)[visible]].tolist()) == {2}
    shares = studies.basin_fractions(found.attractor, "r", bins=13)
    assert shares.runs.values.tolist() == [4] * 5 + [3] * 2 + [4] * 6
    np.testing.assert_allclose(shares.share.sel(attractor="A2"), [0.25] * 5 + [0.0] * 2 + [0.25] * 6)
    # too far for one step
    apart = studies.recurrences(made, 1e-3, along=studies.Along("r", 1e-3, bins=13))
    assert len(apart.attractor.attrs["flag_meanings"].split()) > 13


def test_shares_along_a_parameter_of_a_grid() -> None:
    gamma, e = [0.3, 0.6, 0.9], [0.5, 0.6, 0.7, 0.8]
    made = labels([[0, 0, 0, 0], [0, 0, 1, -1], [1, 1, 1, 0]], gamma=gamma, e=e)
    found = studies.basin_fractions(made, "gamma")
    np.testing.assert_allclose(found.share.sel(attractor="A1"), [1.0, 2.0 / 3.0, 0.25])
    np.testing.assert_allclose(found.error.sel(attractor="A2"), [0.0, np.sqrt(2.0 / 27.0), np.sqrt(3.0 / 64.0)])
    assert found.runs.values.tolist() == [4, 3, 4]
    ax = pictures.fractions(found)
    assert ax.get_title() == "A1: 1.00 at gamma = 0.3, 0.25 at gamma = 0.9"
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["A1", "A2"]  # type: ignore[union-attr]
    assert pictures.shares(made).get_title() == "63.6 % of 11 starts lead to A1; 1 failed"
    with pytest.raises(ns.InvalidInput, match="Did you mean 'gamma'"):
        studies.basin_fractions(made, "gama")


def test_where_nothing_came_to_its_end() -> None:
    made = labels([[0, 1], [-1, -1]], gamma=[0.3, 0.6], e=[0.5, 0.6])
    found = studies.basin_fractions(made, "gamma")
    assert np.isnan(found.share.values[:, 1]).all()
    with pytest.raises(ns.InvalidInput, match="came to their end"):
        studies.basin_stability(labels([-1, -1]))
    made.attrs.clear()
    with pytest.raises(ns.InvalidInput, match="record of words"):
        studies.basin_stability(made)
