"""Mass properties of a superellipsoid with a radius about it, against the formula of Steiner."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bodies import Superellipsoid


@pytest.mark.parametrize("semi", [(1.0, 1.0, 0.4), (1.0, 0.1, 0.1), (1.0, 0.1, 0.01)])
@pytest.mark.parametrize("exponents", [(1.0, 1.0), (1.2, 1.6), (1.6, 1.2), (1.8, 1.8)])
def test_the_volume_is_a_cubic_of_the_radius(semi: tuple[float, float, float], exponents: tuple[float, float]) -> None:
    """Its third difference is that of the ball about each point, 4/3 pi r^3, for thin bodies as for thick ones."""
    radius = 0.5
    volumes = [Superellipsoid(*semi, *exponents, rounding=i * radius).volume for i in range(4)]
    expected = 6.0 * 4.0 / 3.0 * math.pi * radius**3
    np.testing.assert_allclose(np.diff(volumes, 3), expected, rtol=1e-10)
