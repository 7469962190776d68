"""States with random changes are refused or run, and leave the model as it was."""

from __future__ import annotations

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.results.state_file import state_bytes
from tests.results.forged import T_END, forged, refused_or_runs
from tests.results.runs import balls


@pytest.fixture(scope="module")
def model() -> ns.Model:
    return ns.assemble(balls())


def test_a_state_with_random_changes_is_refused_or_runs(model: ns.Model) -> None:
    state = model.run(T_END - 1e-3).state
    content, whole = state_bytes(state), model.run(T_END)
    told = [refused_or_runs(model, forged(content, np.random.default_rng(seed))) for seed in range(60)]
    assert set(told) <= {"InvalidInput", "RunFailed", "done", "suspect"}
    assert told.count("InvalidInput") >= 10
    assert told.count("done") >= 10
    np.testing.assert_array_equal(model.run(T_END, start=state).q_end, whole.q_end)
