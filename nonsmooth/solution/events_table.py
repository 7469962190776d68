"""The events of a run as a table of text: one line an event, and of contacts those whose mode it changes."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from nonsmooth.engine.memory.modes import AFTER, BEFORE, CODE, DURING
from nonsmooth.storage.files import replacing

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

_ENERGIES = ("driven_work", "restitution_loss", "friction_loss", "closing_loss")
_HEAD = ("time [s]", "cause", "contact or guard", "phases", *(f"{name} [J]" for name in _ENERGIES), "modes")


def save_events(solution: Solution, path: Path) -> None:
    """Write the events to a CSV file, as :func:`events_table` has them.

    Raises
    ------
    FileError
        If that is not possible; an older file of that name stays as it was.
    """
    with replacing(path) as part, part.open("w", encoding="utf-8", newline="") as file:
        _write(solution, file)


def events_table(solution: Solution) -> str:
    """Return the events as a table.

    In the column "modes" stand the contacts whose bits (closed, approaching, slipping) the event changes, each with
    these before, during and after it, "ball - plate 000 110 101", apart by semicolons.
    """
    text = io.StringIO(newline="")
    _write(solution, text)
    return text.getvalue()


def _write(solution: Solution, file: TextIO) -> None:
    """Write the table block by block, because the events of a long run do not fit into memory."""
    names, guards, table = solution.system.names.contacts, solution.system.names.guards, csv.writer(file)
    table.writerow(_HEAD)
    for events in solution.events.blocks():
        first, listed, codes = events.first.tolist(), events.listed.tolist(), events.codes.tolist()
        causes, energies = events.causes(), [getattr(events, name).tolist() for name in _ENERGIES]
        for i, (time, trigger) in enumerate(zip(events.time.tolist(), events.triggers(names, guards), strict=True)):
            modes = [
                f"{names[listed[j]]} {' '.join(_bits(codes[j] >> shift) for shift in (BEFORE, DURING, AFTER))}"
                for j in range(first[i], first[i + 1])
                if codes[j] not in _UNCHANGED
            ]
            numbers = (repr(column[i]) for column in energies)
            table.writerow([repr(time), causes[i], trigger, int(events.phases[i]), *numbers, "; ".join(modes)])


_UNCHANGED = {bits << BEFORE | bits << DURING | bits << AFTER for bits in range(CODE + 1)}


def _bits(code: int) -> str:
    return "".join(str(code >> i & 1) for i in range(3))
