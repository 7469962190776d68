"""Random systems with poison, and in turns: ``python -m tests.benchmarks.lives poison|poison_false|turns FIRST COUNT``.

A run must not change a bit if numbers whose life has ended are unusable, nor if other runs take
steps in the same memory (:mod:`tests.engine.life_engines`). Each run has a process of its own, which an index that is
poison may end.
"""

from __future__ import annotations

import hashlib
import multiprocessing
import sys
import warnings
from collections.abc import Callable

import numpy as np

import nonsmooth as ns
from nonsmooth.interfaces import Engine
from tests.benchmarks.random_systems.generate import case_of
from tests.engine.life_engines import Poisoned, Turns

ENGINES: dict[str, Callable[[], Engine]] = {
    "poison": Poisoned,
    "poison_false": lambda: Poisoned(booleans=False),
    "turns": Turns,
}
_SECONDS = 60.0
"""Time that a system may take [s]. One that takes longer is not compared."""
_PART = 0.5
"""Part of a system's time that is run, as single steps from Python are slow."""


def digest(system: ns.System, t_end: float, engine: Engine) -> str:
    """Hash of states, event times, impulses and modes of a run, or of what it computed until it failed."""
    try:
        solution, end = ns.assemble(system, engine).run(t_end), "done"
    except ns.RunFailed as failed:
        if not isinstance(failed.solution, ns.Solution):
            return str(failed)
        solution, end = failed.solution, str(failed)
    found = hashlib.sha256(end.encode())
    for part in (solution.q, solution.u, solution.events.time, solution.events.listed_impulse, solution.events.codes):
        found.update(np.ascontiguousarray(part).tobytes())
    return found.hexdigest()


def compared(name: str, seed: int) -> bool:
    """True if a random system has the same bits with an engine as with the built-in one."""
    case = case_of(seed)
    t_end = _PART * case.t_end
    return digest(case.build(), t_end, ns.EventDriven()) == digest(case.build(), t_end, ENGINES[name]())


def _task(name: str, seed: int, answers: multiprocessing.Queue[str]) -> None:
    warnings.simplefilter("ignore")
    try:
        answers.put("same" if compared(name, seed) else "DIFFERENT")
    except ns.NonsmoothError:
        answers.put("refused")


def look(name: str, seed: int) -> str:
    """How a random system compares: same, DIFFERENT, refused, slow, or DIED."""
    context = multiprocessing.get_context("fork")
    answers = context.Queue()
    process = context.Process(target=_task, args=(name, seed, answers))
    process.start()
    process.join(_SECONDS)
    if process.is_alive():
        process.kill()
        process.join()
        return "slow"
    return answers.get() if process.exitcode == 0 else "DIED"


def main() -> None:
    """Compare, and print a line for each system that differs, and the sums."""
    name, first, count = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    # compiled once, before any process is forked
    digest(case_of(first).build(), 1e-3, ns.EventDriven())
    sums: dict[str, int] = {}
    for seed in range(first, first + count):
        found = look(name, seed)
        sums[found] = sums.get(found, 0) + 1
        if found in ("DIFFERENT", "DIED"):
            print(f"system {seed}: {found}", flush=True)
    print(f"{name}, systems {first} to {first + count - 1}: {sums}")


if __name__ == "__main__":
    main()
