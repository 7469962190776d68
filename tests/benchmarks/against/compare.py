"""The comparison as a whole: what is done in which order, and the lines that it prints."""

from __future__ import annotations

import argparse
import contextlib
import json
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from tests.benchmarks.against import bits, differences, scenarios, source, speed, start
from tests.benchmarks.against.sides import commit, resolved, snapshot


@dataclass(frozen=True)
class Extent:
    """How much is measured.

    Attributes
    ----------
    systems : int
        Random systems.
    seconds : float
        Processor time after which a system is cut off [s].
    is_cold : bool
        Whether both sides compile the engine anew, and how long it takes is measured.
    rounds, starts : int
        Runs of every scene, and new processes of each kind, on either side.
    """

    systems: int
    seconds: float
    is_cold: bool
    rounds: int
    starts: int


FULL = Extent(systems=300, seconds=6.0, is_cold=True, rounds=15, starts=9)
"""For some ten minutes of two idle cores."""
QUICK = Extent(systems=40, seconds=3.0, is_cold=False, rounds=5, starts=3)
"""For some two minutes."""


def compare(given: argparse.Namespace, extent: Extent) -> Iterator[str]:
    """Compare as the command line says, and yield the lines of the report."""
    began = time.monotonic()

    def told(line: str) -> None:
        print(f"{time.monotonic() - began:6.0f} s  {line}", file=sys.stderr, flush=True)

    revision = resolved(given.commit)
    with _folder(given.folder) as folder:
        told("copying and counting the source of both sides")
        this = snapshot(folder)
        sides = this, commit(revision, folder, this)
        if not extent.is_cold:
            for side in sides:
                side.fill_cache()
        sizes = tuple(source.sizes(side.tree) for side in sides)
        constants = [source.engine_constants(side.tree) for side in sides]
        starts = start.measured(sides, extent.starts, told)
        count = extent.systems if given.systems is None else given.systems
        told(f"bits: {count} random systems and the scenarios")
        tasks = scenarios.tasks(sides) | bits.drawn(sides[0], given.first, count, folder / "drawn.jsonl")
        results = bits.of_both(sides, tasks, extent.seconds, told)
        speeds = speed.measured(sides, extent.rounds, told)
        alone = scenarios.only_one(sides)
    yield f"# The working tree against {given.commit} ({revision[:8]})"
    yield from ("", f"## Bits: {len(tasks) - count} scenarios and {count} random systems from {given.first}", "")
    yield from differences.table(*results)
    if alone:
        yield from ("", f"Scenarios of one side only: {', '.join(alone)}")
    yield from ("", f"## Speed: {extent.rounds} ratios of single runs", "")
    yield from speed.table(speeds)
    yield from ("", "## Processes", "")
    yield from start.table(starts, speeds.peaks)
    yield from ("", "## Source", "")
    yield from source.table(*sizes)
    yield from ("", f"Numeric constants of the engine: {source.change(constants[1], constants[0])}")
    told("done")
    if given.json:
        figures: dict[str, Any] = {
            "commit": revision,
            "bits": results,
            "speed": asdict(speeds),
            "starts": asdict(starts),
        }
        figures |= {
            "sizes": [{name: asdict(row) for name, row in one.items()} for one in sizes],
            "constants": constants,
        }
        Path(given.json).write_text(json.dumps(figures, indent=1), encoding="utf-8")


@contextlib.contextmanager
def _folder(name: str | None) -> Iterator[Path]:
    """Yield the folder of both sides: one that is kept, or a temporary one."""
    if name is not None:
        Path(name).mkdir(parents=True, exist_ok=True)
        yield Path(name).resolve()
        return
    with tempfile.TemporaryDirectory(prefix="against-") as folder:
        yield Path(folder)
