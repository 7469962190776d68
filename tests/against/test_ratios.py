"""Ratios of interleaved measurements."""

from __future__ import annotations

from tests.benchmarks.against.ratios import Ratios


def test_ratios_are_of_pairs_and_not_of_medians() -> None:
    found = Ratios(this=(1.0, 8.0, 3.0, 8.0, 5.0), other=(1.0, 4.0, 1.0, 2.0, 1.0))
    assert found.values == [1.0, 2.0, 3.0, 4.0, 5.0]
    assert (found.median, found.quartiles) == (3.0, (2.0, 4.0))
    assert found.cells(10.0, ".0f") == "10 | 50 | 3.000 | 2.000 to 4.000 | 1.000 to 5.000"
