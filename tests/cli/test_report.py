"""Strict JSON from whatever a scenario reports."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nonsmooth.cli.report import as_json


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (math.nan, None),
        (-math.inf, None),
        (np.float64(0.1), 0.1),
        (np.int64(3), 3),
        (np.bool_(True), True),
        (np.array([1.0, np.inf, 0.1 + 0.2]), [1.0, None, 0.1 + 0.2]),
        ([(1, np.float32(0.5))], [[1, 0.5]]),
        ({"NaN": "Infinity"}, {"NaN": "Infinity"}),
        (Path("a"), "a"),
        (None, None),
    ],
)
def test_values_come_out_as_plain_json(value: Any, expected: Any) -> None:
    text = as_json({"value": value})
    assert "\n" not in text

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is not JSON")

    assert json.loads(text, parse_constant=refuse) == {"value": expected}
