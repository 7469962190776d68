"""Speed of the scenes, interleaved: one run on one side, one on the other, in processes that live on."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from tests.benchmarks.against.pipe import Worker
from tests.benchmarks.against.ratios import HEAD, Ratios
from tests.benchmarks.against.sides import Side

SCENES = Path(__file__).resolve().parent / "scenes"
"""Folder of the systems that are timed."""


def scenes() -> dict[str, dict[str, Any]]:
    """Return the systems that are timed, by name."""
    rows = (json.loads(path.read_text(encoding="utf-8")) for path in sorted(SCENES.glob("*.json")))
    return {row["name"]: row for row in rows}


def measured(
    sides: tuple[Side, Side], rounds: int, part: float, told: Callable[[str], None]
) -> tuple[dict[str, Ratios | str], tuple[float, float]]:
    """Return the times of the scenes [s], or why there are none, and the peak memory of the two processes [MB].

    The side that begins changes from round to round.  A first run on either side is not counted.

    Parameters
    ----------
    sides : tuple of Side
        This one and the other.
    rounds : int
        Runs of every scene on either side.
    part : float
        Part of the scenes' time that is run.
    told : callable
        Is given lines of progress.
    """
    found: dict[str, Ratios | str] = {}
    with Worker(sides[0]) as this, Worker(sides[1]) as other:
        for name, scene in scenes().items():
            found[name] = _ratios((this, other), name, scene | {"t_end": part * scene["t_end"]}, rounds)
            told(f"speed: {name}")
    return found, (this.peak, other.peak)


def _ratios(workers: tuple[Worker, Worker], name: str, task: dict[str, Any], rounds: int) -> Ratios | str:
    seconds: tuple[list[float], list[float]] = ([], [])
    for number in range(rounds + 1):
        for k in (0, 1) if number % 2 else (1, 0):
            answered = workers[k].ask(what="time", name=name, task=task)
            if "error" in answered:
                return f"{('this', 'other')[k]} side: {answered['error']}"
            seconds[k].append(answered["answer"])
    return Ratios(tuple(seconds[0][1:]), tuple(seconds[1][1:]))


def table(found: dict[str, Ratios | str]) -> Iterator[str]:
    """Yield the lines of the table in Markdown."""
    yield f"| scene, processor ms of a run | {HEAD[0]} |"
    yield f"|---|{HEAD[1]}|"
    for name, row in found.items():
        yield f"| {name} | {row} | | | | |" if isinstance(row, str) else f"| {name} | {row.cells(1e3, '.1f')} |"
