"""Writes the arguments of a run into the memory, by places of scalars: a short run takes less time than their names."""

from __future__ import annotations

import math

from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.tables import places
from nonsmooth.solution.request import RunRequest

_T_END, _INTERVAL, _FIRST, _NEXT, _SPAN, _INDEX, _CAPACITY = places(
    "request.t_end",
    "request.sample_interval",
    "request.sample_start",
    "output.next_sample",
    "request.sample_span",
    "output.sample_index",
    "model.sample_capacity",
).tolist()
_BUFFER_PART = 0.5
"""Part of the buffer of samples that one step may fill. The engine pauses if more than half of the buffer is full."""


def write_request(memory: Memory, request: RunRequest) -> None:
    """Write the end time, and the times of samples."""
    floats, integers = memory.cells
    floats[_T_END], floats[_FIRST], floats[_INTERVAL] = request.t_end, request.sample_start, request.sample_interval
    # the end time must not change the steps; the samples by default depend on it, and all of them fit the buffer
    longest = _BUFFER_PART * integers.item(_CAPACITY) * request.sample_interval
    floats[_SPAN] = math.inf if request.has_default_samples else longest


def write_first_sample(memory: Memory, request: RunRequest) -> None:
    """Let the next sample be the first one of the request."""
    floats, integers = memory.cells
    floats[_NEXT], integers[_INDEX] = request.sample_start, 0
