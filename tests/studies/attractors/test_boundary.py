"""The uncertainty exponent against boundaries of known dimension."""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.studies.attractors import pictures, uncertainty_exponent
from tests.studies.attractors.made import Floats, labels

pytest.importorskip("xarray")

_X, _Y = np.meshgrid(np.linspace(0.0, 1.0, 256), np.linspace(0.0, 1.0, 256), indexing="ij")


def _escapes(x: Floats) -> Floats:
    """Return whether x -> 3 x, 3 (1 - x) leaves the unit interval after an odd number of steps.

    What never does is Cantor's set of middle thirds, and each of its points has both kinds near it.
    """
    steps, inside = np.zeros(x.shape), np.ones(x.shape, bool)
    for i in range(40):
        x = np.where(inside, np.where(x < 0.5, 3.0 * x, 3.0 * (1.0 - x)), x)
        steps[inside & (x > 1.0)] = i
        inside &= x <= 1.0
    return np.mod(steps, 2.0)


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize(
    ("inside", "tolerance"),
    [(_X < 0.5, 1e-12), (_X + 0.37 * _Y < 0.7, 1e-12), ((_X - 0.5) ** 2 + (_Y - 0.5) ** 2 < 0.1, 0.01)],
    ids=["line", "slanted line", "circle"],
)
def test_a_smooth_boundary_has_exponent_one(inside: Floats, tolerance: float) -> None:
    found = uncertainty_exponent(labels(inside))
    assert found.exponent == pytest.approx(1.0, abs=tolerance)
    assert found.dimension == pytest.approx(1.0, abs=tolerance)
    assert found.error < 0.01
    assert found.starts == 192**2


def test_a_fit_above_one_has_an_error_that_covers_it() -> None:
    """A large circle reaches beyond the starts that have all neighbours; no curve has a dimension below 1."""
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, 128), np.linspace(-0.5, 0.5, 128))
    found = uncertainty_exponent(labels(x**2 + y**2 < 0.4**2))
    assert found.exponent > 1.01
    assert found.exponent - found.error <= 1.0
    assert found.dimension == 1.0


def test_a_share_is_that_of_the_starts_beside_the_line() -> None:
    found = uncertainty_exponent(labels(_X < 0.5))
    np.testing.assert_allclose(found.uncertain, 2.0 * found.steps / 192.0)


def test_cantors_set() -> None:
    exact = 1.0 - math.log(2.0) / math.log(3.0)
    x = (np.arange(16384) + 0.5) / 16384
    found = uncertainty_exponent(labels(_escapes(x)))
    assert found.exponent == pytest.approx(exact, abs=0.01)
    assert found.dimension == pytest.approx(1.0 - exact, abs=0.01)
    assert 0.0 < found.error < 0.01
    assert pictures.uncertainty(found).get_title().startswith("Uncertainty exponent 0.37")


def test_cantors_set_times_a_line() -> None:
    x = (np.arange(729) + 0.5) / 729
    found = uncertainty_exponent(labels(np.repeat(_escapes(x)[:, np.newaxis], 300, axis=1)))
    assert found.exponent == pytest.approx(1.0 - math.log(2.0) / math.log(3.0), abs=0.05)
    assert 1.5 < found.dimension < 1.7


def test_runs_that_failed_and_their_neighbours_are_left_out() -> None:
    made = np.array(_X < 0.5, int)
    made[:, 40] = -1
    found = uncertainty_exponent(labels(made))
    np.testing.assert_allclose(found.uncertain, 2.0 * found.steps / 192.0)
    # beside itself those that have it at a distance of 1, 2, 4, 8, 16, 32 on either side, where they are within
    assert found.starts == 192 * (192 - 1 - 6 - 4)


def test_grids_that_tell_nothing() -> None:
    with pytest.raises(ns.InvalidInput, match=r"lead to another attractor.*is there a boundary"):
        uncertainty_exponent(labels(np.zeros((64, 64))))
    with pytest.raises(ns.InvalidInput, match=r"at most half of the starts.*finer"):
        uncertainty_exponent(labels(np.random.default_rng(1).integers(0, 2, (64, 64))))
    with pytest.raises(ns.InvalidInput, match=r"larger grid.*32 values"):
        uncertainty_exponent(labels(_X[:20, :20] < 0.04))
    with pytest.raises(ns.InvalidInput, match=r"even grid.*'gamma'"):
        uncertainty_exponent(labels(_X[:3] < 0.5, gamma=[0.1, 0.2, 0.4], x=_Y[0]))
