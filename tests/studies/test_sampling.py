"""Which parameters a study runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas
import pytest

import nonsmooth as ns
from nonsmooth import studies


def test_a_grid_has_all_combinations_the_last_fastest() -> None:
    points = studies.grid(a=[1.0, 2.0], b=["x", "y", "z"])
    assert [points.at(run) for run in (0, 1, 3)] == [{"a": 1.0, "b": "x"}, {"a": 1.0, "b": "y"}, {"a": 2.0, "b": "x"}]
    assert points.dims == {"a": 2, "b": 3}


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("draw", [studies.random, studies.sobol, studies.latin_hypercube])
def test_draws_are_the_same_for_the_same_seed_and_within_their_ranges(draw: Callable[..., studies.Sampling]) -> None:
    one, same, other = (draw(16, seed, n=(1.0, 2.0), seed=(-3.0, -2.0)) for seed in (1, 1, 2))
    assert one.digest == same.digest != other.digest
    for name, low in (("n", 1.0), ("seed", -3.0)):
        assert low <= one.columns[name].min() < one.columns[name].max() < low + 1.0


def test_a_longer_random_study_begins_with_a_shorter_one() -> None:
    short, long = (studies.random(n, 5, a=(0.0, 1.0)).columns["a"] for n in (4, 9))
    assert np.array_equal(short, long[:4])


def test_a_latin_hypercube_has_a_run_in_each_part() -> None:
    values = studies.latin_hypercube(8, 1, a=(0.0, 8.0)).columns["a"]
    assert sorted(values.astype(int)) == list(range(8))


def test_rows_and_tables_are_the_same() -> None:
    rows: list[dict[str, float | str]] = [{"a": 1.0, "b": "x"}, {"a": 2.0, "b": "y"}]
    listed = studies.listed(rows)
    assert [listed.at(run) for run in range(2)] == rows
    assert studies.columns(pandas.DataFrame({"a": [1.0, 2.0]})).at(1) == {"a": 2.0}


def test_whole_numbers_stay_whole() -> None:
    """A seed is a parameter, too, of 64 bits without a sign at most."""
    large = np.random.SeedSequence(1).generate_state(2, np.uint64)
    points = studies.columns({"large": large, "seed": range(2), "mixed": [0, 0.5]})
    assert points.at(0) == {"large": int(large[0]), "seed": 0, "mixed": 0.0}
    assert [type(value) for value in points.at(0).values()] == [int, int, float]


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: studies.grid(a=[]), ("a", "at least", "[]")),
        (lambda: studies.grid(a=[1.0, np.nan]), ("a", "finite", "nan")),
        (lambda: studies.grid(a=[1.0, 1.0]), ("a", "once", "1.0")),
        (lambda: studies.grid(a=[[1.0]]), ("a", "row")),
        (lambda: studies.grid(), ("grid", "at least")),
        (lambda: studies.random(0, 1, a=(0.0, 1.0)), ("n", "from 1 on", "0")),
        (lambda: studies.random(4, 1, a=(1.0, 1.0)), ("a", "range", "(1.0, 1.0)")),
        (lambda: studies.random(4, 1, a=(0.0, np.inf)), ("a", "finite", "inf")),
        (lambda: studies.random(4, 1), ("random", "at least")),
        (lambda: studies.sobol(100, 1, a=(0.0, 1.0)), ("power of two", "100", "64 or 128")),
        (lambda: studies.listed([]), ("table", "column")),
        (lambda: studies.listed([{"a": 1.0}, {"b": 1.0}]), ("row 1", "names a", "b")),
        (lambda: studies.columns({"a": [1.0], "b": [1.0, 2.0]}), ("one length", "2")),
    ],
)
def test_what_is_no_sampling_is_refused(make: Callable[[], Any], words: tuple[str, ...]) -> None:
    with pytest.raises(ns.InvalidInput) as error:
        make()
    for word in words:
        assert word in str(error.value)
