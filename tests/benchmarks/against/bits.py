"""The same systems on both sides: hashes of all that they computed, and which differ."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from tests.benchmarks.against.pipe import NoAnswer, Worker
from tests.benchmarks.against.sides import Side

Tasks = dict[str, dict[str, Any]]
Results = dict[str, dict[str, Any]]
_PART = 0.7
"""Part of a random system's time that is run, so that nearly all end within the limit."""


def drawn(side: Side, first: int, count: int, file: Path) -> Tasks:
    """Return random systems by name, drawn on one side."""
    words = ("tests.benchmarks.against.draws", str(first), str(count), str(file))
    subprocess.run(side.command(*words), cwd=side.tree, env=side.environment, check=True, stdout=subprocess.DEVNULL)
    rows = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
    return {f"system {first + k}": row | {"t_end": _PART * row["t_end"]} for k, row in enumerate(rows)}


def of(side: Side, tasks: Tasks, seconds: float, told: Callable[[str], None]) -> Results:
    """Return the results of all tasks on one side, by name."""
    found: Results = {}
    with Worker(side) as worker:
        for number, (name, task) in enumerate(tasks.items(), 1):
            try:
                found[name] = worker.ask(what="bits", task=task, seconds=seconds)
            except NoAnswer as error:
                found[name] = lost(str(error))
            if number % 20 == 0:
                told(f"bits, {side.name} side: {number} of {len(tasks)}")
    return found


def lost(message: str) -> dict[str, Any]:
    """Return the result of a run that gave none."""
    return {"end": message, "q": "", "times": "", "impulses": "", "components": []}


def of_both(
    sides: tuple[Side, Side], tasks: Tasks, seconds: float, told: Callable[[str], None]
) -> tuple[Results, Results]:
    """Return the results of both sides, which run at the same time."""
    with ThreadPoolExecutor(2) as pool:
        one, two = (pool.submit(of, side, tasks, seconds, told) for side in sides)
        return one.result(), two.result()
