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
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.benchmarks.against.pipe import FIRST
from tests.benchmarks.described.running import Observed, observe, prepared


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


def answer(request: dict[str, Any], models: dict[str, Callable[[], object]]) -> Any:
    """Return the answer to a request: hashes of a run; the processor time [s] to prepare one, or to run it once."""
    if request["what"] == "bits":
        return bits(observe(request["task"], request["seconds"]))
    began, name = time.process_time(), request["name"]
    if request["what"] == "prepare":
        models[name] = prepared(request["task"])
    else:
        models[name]()
    return time.process_time() - began


def main() -> None:
    """Answer requests until the standard input ends."""
    warnings.simplefilter("ignore")
    # what the package prints must not come among the answers
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    if sys.argv[1:] == [FIRST]:
        prepared(json.loads(sys.stdin.readline()))()
        return
    models: dict[str, Callable[[], object]] = {}
    for line in sys.stdin:
        try:
            found = {"answer": answer(json.loads(line), models)}
        except Exception as error:
            found = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps(found), file=answers, flush=True)


if __name__ == "__main__":
    main()
