"""What is reported of a run that does not end as it should."""

from __future__ import annotations

from typing import Any

from tests.benchmarks.against.worker import bits
from tests.benchmarks.described.running import observe


def _dumbbell(**parameters: Any) -> dict[str, Any]:
    return {"scenario": "dumbbell", "parameters": parameters, "part": 0.02}


def test_a_run_is_reported_with_its_components_and_repeats_its_bits() -> None:
    found = bits(observe(_dumbbell(), 10.0))
    assert found["end"] == "done"
    assert found["components"] == [
        *("body.dumbbell", "body.plate"),
        *("friction.coulomb", "impact.energetic", "normal.unilateral"),
    ]
    assert found == bits(observe(_dumbbell(), 10.0))
    assert found["q"] != bits(observe(_dumbbell(friction=0.3), 10.0))["q"]


def test_a_run_beyond_its_time_is_cut_off() -> None:
    assert observe(_dumbbell(), -1.0).end == "cut off"


def test_what_cannot_be_built_is_reported_with_its_message() -> None:
    found = observe(_dumbbell(radius=-1.0), 10.0)
    assert found.end.startswith("InvalidInput: DumbbellScenario.radius must be")
    assert len(found.q) == len(found.times) == len(found.impulses) == 0
