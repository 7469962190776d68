"""Speed of the scenes, interleaved: one run on one side, one on the other, in processes that live on."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.benchmarks.against.pipe import NoAnswer, Worker
from tests.benchmarks.against.ratios import HEAD, Ratios
from tests.benchmarks.against.sides import Side

SCENES = Path(__file__).resolve().parent / "scenes"
"""Folder of the systems that are timed."""


def scenes() -> dict[str, dict[str, Any]]:
    """Return the systems that are timed, by name."""
    rows = (json.loads(path.read_text(encoding="utf-8")) for path in sorted(SCENES.glob("*.json")))
    return {row["name"]: row for row in rows}


@dataclass(frozen=True)
class Speed:
    """Figures of the scenes, and of the two processes that ran them.

    Attributes
    ----------
    scenes : dict
        Processor times of single runs [s] by name; a sentence for a scene that failed.
    preparing : Ratios
        Processor time in which every scene was built and assembled [s].
    peaks : tuple of float
        Memory of the two processes [MB], this side's first.
    """

    scenes: dict[str, Ratios | str]
    preparing: Ratios
    peaks: tuple[float, float]


def measured(sides: tuple[Side, Side], rounds: int, told: Callable[[str], None]) -> Speed:
    """Run every scene on both sides in turn; a first run on either side is not counted."""
    found: dict[str, Ratios | str] = {}
    prepared: list[list[float]] = []
    with Worker(sides[0]) as this, Worker(sides[1]) as other:
        for name, scene in scenes().items():
            try:
                prepared.append([worker.ask(what="prepare", name=name, task=scene) for worker in (this, other)])
                found[name] = _ratios((this, other), name, rounds)
            except NoAnswer as error:
                found[name] = str(error)
            told(f"speed: {name}")
    return Speed(found, Ratios(*zip(*prepared, strict=True)), (this.peak, other.peak))


def _ratios(workers: tuple[Worker, Worker], name: str, rounds: int) -> Ratios:
    seconds: tuple[list[float], list[float]] = ([], [])
    for number in range(rounds + 1):
        # the side that begins changes from round to round
        for k in (0, 1) if number % 2 else (1, 0):
            seconds[k].append(workers[k].ask(what="run", name=name))
    return Ratios(tuple(seconds[0][1:]), tuple(seconds[1][1:]))


def table(found: Speed) -> Iterator[str]:
    """Yield the lines of the table in Markdown."""
    yield f"| processor ms | {HEAD[0]} |"
    yield f"|---|{HEAD[1]}|"
    for name, row in found.scenes.items():
        yield f"| {name} | {row} | | | | |" if isinstance(row, str) else f"| {name} | {row.cells(1e3, '.1f')} |"
    yield f"| building and assembling, all scenes | {found.preparing.cells(1e3, '.1f')} |"
