"""Saved states with random changes: each is refused or runs.  ``python -m tests.results.forged SEED N`` tries many."""

from __future__ import annotations

import io
import os
import signal
import sys
import warnings
from dataclasses import replace

import numpy as np

import nonsmooth as ns
from nonsmooth.errors import NonsmoothError
from nonsmooth.model.checkpoint import Difference
from nonsmooth.results.description import state_bytes, state_from
from tests.results.runs import balls, on_hills

VALUES = (-1, 0, 1, 2, 3, 7, 255, 2**31, 2**40, -(2**62), 0.5, -1e9, 1e300, np.nan, np.inf)
LONGEST = 5
"""Seconds."""
T_END = 0.301


def forged(content: bytes, draw: np.random.Generator) -> bytes:
    """Return the content of a state file with some of its numbers changed, or an array of another shape."""
    with np.load(io.BytesIO(content)) as file:
        arrays = dict(file)
    for _ in range(int(draw.integers(1, 4))):
        name = str(draw.choice([name for name in arrays if name != "model"]))
        if name == "difference":
            arrays[name] = _other_difference(arrays[name].tobytes(), draw)
        elif draw.random() < 0.2:
            arrays[name] = draw.choice(VALUES, size=tuple(draw.integers(0, 4, size=draw.integers(0, 3))))
        elif arrays[name].size > 0:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                arrays[name].flat[draw.integers(arrays[name].size)] = np.array(draw.choice(VALUES)).astype(
                    arrays[name].dtype
                )
    made = io.BytesIO()
    np.savez(made, **arrays)
    return made.getvalue()


def _other_difference(packed: bytes, draw: np.random.Generator) -> np.ndarray:
    found = Difference.unpacked(packed)
    places, bits = [one.copy() for one in found.places], [one.copy() for one in found.bits]
    part = int(draw.integers(len(bits)))
    for _ in range(int(draw.integers(1, 20))):
        i = int(draw.integers(len(bits[part])))
        if draw.random() < 0.1:
            places[part][i] = int(draw.choice([-1, 2**40, int(draw.integers(1000))]))
        value = float(draw.choice(VALUES))
        if draw.random() < 0.1:
            # what stands next to what has changed
            places[part][i] += int(draw.integers(-3, 4))
        whole = part == 2 or not abs(value) < 2**62 or draw.random() < 0.5
        bits[part][i] = int(np.nan_to_num(value)) % 2**62 if whole else int(np.float64(value).view(np.int64))
    if draw.random() < 0.05:
        del bits[-1]
    return np.frombuffer(replace(found, places=tuple(places), bits=tuple(bits)).packed(), np.uint8)


def refused_or_runs(model: ns.Model, content: bytes) -> str:
    """Return what came of it."""
    try:
        state = state_from(content, "it")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return model.run(T_END, start=state).status
    except NonsmoothError as error:
        return type(error).__name__


def main(seed: int, n: int) -> None:
    """Try some, each in a process of its own, and tell what came of them."""
    models = [ns.assemble(balls()), ns.assemble(on_hills())]
    contents, told = [state_bytes(model.run(T_END - 1e-3).state) for model in models], dict[str, int]()
    for number in range(seed, seed + n):
        model, content = models[number % 2], contents[number % 2]
        child = os.fork()
        if child == 0:
            signal.alarm(LONGEST)
            word = refused_or_runs(model, forged(content, np.random.default_rng(number)))
            os._exit({"done": 0, "InvalidInput": 10, "RunFailed": 11}.get(word, 12))
        status = os.waitpid(child, 0)[1]
        word = f"signal {os.WTERMSIG(status)}" if os.WIFSIGNALED(status) else f"exit {os.WEXITSTATUS(status)}"
        told[word] = told.get(word, 0) + 1
        if word.startswith("signal") or word == "exit 1":
            print(f"{number}: {word}", flush=True)
    print(told)


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
