"""The process that runs systems on one side: a request and its answer are lines of JSON on the standard streams.

It is started in the tree of its side, so that it imports the package and the adapter of that side.  Of the package it
knows no more than the adapter, :mod:`tests.benchmarks.described`.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
import time
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.benchmarks.against.pipe import FIRST
from tests.benchmarks.described.running import Observed, Task, observe


def digest(array: NDArray[np.float64]) -> str:
    """Return a hash of the bits of an array."""
    return hashlib.sha256(np.ascontiguousarray(array, dtype=np.float64).tobytes()).hexdigest()


def bits(run: Observed) -> dict[str, Any]:
    """Return how a run ended, and the hashes of what it computed."""
    return {
        "end": run.end,
        "q": digest(run.q),
        "times": digest(run.times),
        "impulses": digest(run.impulses),
        "components": list(run.components),
    }


def seconds(task: Task) -> float:
    """Return the processor time of one run [s]."""
    began = time.process_time()
    task.simulate()
    return time.process_time() - began


def answer(request: dict[str, Any], tasks: dict[str, Task]) -> Any:
    """Return the answer to a request: hashes of a run, or its processor time; tasks to be timed are built once."""
    if request["what"] == "bits":
        return bits(observe(request["task"], request["seconds"]))
    name = request["name"]
    if name not in tasks:
        tasks[name] = Task.of(request["task"])
    return seconds(tasks[name])


def main() -> None:
    """Answer requests until the standard input ends."""
    warnings.simplefilter("ignore")
    # what the package prints must not come among the answers
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    if sys.argv[1:] == [FIRST]:
        Task.of(json.loads(sys.stdin.readline())).simulate()
        return
    tasks: dict[str, Task] = {}
    for line in sys.stdin:
        try:
            found = {"answer": answer(json.loads(line), tasks)}
        except Exception as error:
            found = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps(found), file=answers, flush=True)


if __name__ == "__main__":
    main()
