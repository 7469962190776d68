"""The profile by address: every pair is counted, and the parts make the whole."""

from __future__ import annotations

import pytest

from nonsmooth.engine.native.kernel import PLAIN


@pytest.mark.skipif(PLAIN, reason="reads the processor's clock")
def test_shares_of_a_run() -> None:
    """Two balls over a plate; each is looked at in every stage of every step, which takes time, but not all of it."""
    from tests.benchmarks.shape_profile import dumbbell, profile

    found = profile(dumbbell, 0.2)
    seconds, calls = found.pairs["evaluate_ellipsoid_over_plane"]
    assert calls > 1000
    assert 0.0 < seconds < found.wall
    assert found.searches == 0
    assert found.evaluators + found.search < found.wall
