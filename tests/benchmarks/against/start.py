"""What new processes cost on either side: the engine compiled, a first run, the command line."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from tests.benchmarks.against.pipe import FIRST, WORKER
from tests.benchmarks.against.ratios import HEAD, Ratios
from tests.benchmarks.against.sides import Side
from tests.benchmarks.against.speed import scenes

_SCENE, _T_END = "drift", 0.1
"""What a new process runs first, and for how long [s]."""
_VERSION = ("nonsmooth", "--version")
_COMMAND = ("nonsmooth", "run", "dumbbell", "--set", "t_end=0.1", "--json")


@dataclass(frozen=True)
class Cost:
    """What a process and those that it started took: wall and processor time [s], memory of the largest [MB]."""

    wall: float
    processor: float
    peak: float


@dataclass(frozen=True)
class Starts:
    """Costs of new processes in pairs of this and the other side; the first run on an empty cache is one pair.

    Attributes
    ----------
    cold : tuple of Cost or None
        The engine compiled, on this side and the other; None if the caches were filled before.
    first, command : tuple of tuple of Cost
        Import and first run, and the command line, with a filled cache.
    """

    cold: tuple[Cost, Cost] | None
    first: tuple[tuple[Cost, Cost], ...]
    command: tuple[tuple[Cost, Cost], ...]


def cost(side: Side, words: tuple[str, ...], line: str) -> Cost:
    """Return what a module of one side costs that runs in a new process and is given a line.

    Raises
    ------
    RuntimeError
        If it fails.
    """
    with tempfile.TemporaryFile() as given, tempfile.TemporaryFile() as said:
        given.write(line.encode())
        given.seek(0)
        began = time.perf_counter()
        process = subprocess.Popen(
            side.command(*words),
            cwd=side.tree,
            env=side.environment,
            stdin=given,
            stdout=subprocess.DEVNULL,
            stderr=said,
        )
        _, status, used = os.wait4(process.pid, 0)
        wall = time.perf_counter() - began
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            said.seek(0)
            message = said.read().decode(errors="replace").strip().splitlines()
            raise RuntimeError(f"{' '.join(words)} failed on the {side.name} side: {' '.join(message[-1:])}")
    return Cost(wall, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0)


def measured(sides: tuple[Side, Side], repetitions: int, told: Callable[[str], None]) -> Starts:
    """Fill the caches of both sides, and measure new processes, one of either side in turn."""
    this, other = sides
    first: dict[str, Any] = scenes()[_SCENE] | {"t_end": _T_END}
    line = json.dumps(first) + "\n"
    is_cold = not any(any(side.cache.iterdir()) for side in sides)
    # writes the bytecode, which is no part of compiling the engine
    told("a first start of Python on both sides")
    for side in sides:
        cost(side, _VERSION, "")
    told("compiling the engine of both sides")
    filled = cost(this, (WORKER, FIRST), line), cost(other, (WORKER, FIRST), line)
    told("starts of new processes")
    # the command compiles what the first run did not
    for side in sides:
        cost(side, _COMMAND, "")

    def pairs(words: tuple[str, ...], given: str) -> tuple[tuple[Cost, Cost], ...]:
        return tuple((cost(this, words, given), cost(other, words, given)) for _ in range(repetitions))

    return Starts(filled if is_cold else None, pairs((WORKER, FIRST), line), pairs(_COMMAND, ""))


def table(starts: Starts, peaks: tuple[float, float]) -> Iterator[str]:
    """Yield the lines of the table in Markdown; ``peaks`` are those of the processes that ran all scenes [MB]."""
    yield f"| processes | {HEAD[0]} |"
    yield f"|---|{HEAD[1]}|"
    if starts.cold is not None:
        yield f"| engine compiled, processor s | {_once(*(one.processor for one in starts.cold))} |"
        yield f"| engine compiled, wall s | {_once(*(one.wall for one in starts.cold))} |"
    for name, pairs in (("import and first run", starts.first), ("command line", starts.command)):
        yield f"| {name}, processor s | {_ratios(pairs, 'processor').cells(1.0, '.2f')} |"
        yield f"| {name}, wall s | {_ratios(pairs, 'wall').cells(1.0, '.2f')} |"
    yield f"| memory of a first run, MB | {_ratios(starts.first, 'peak').cells(1.0, '.1f')} |"
    yield f"| memory after all scenes, MB | {_once(*peaks)} |"


def _ratios(pairs: tuple[tuple[Cost, Cost], ...], name: str) -> Ratios:
    return Ratios(tuple(getattr(one, name) for one, _ in pairs), tuple(getattr(two, name) for _, two in pairs))


def _once(this: float, other: float) -> str:
    return f"{other:.1f} | {this:.1f} | {this / other:.3f} | | "
