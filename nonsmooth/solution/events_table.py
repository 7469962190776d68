"""The events of a run as a table of text: one line an event, and of contacts those whose mode it changes."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING

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
    with replacing(path) as part:
        part.write_bytes(events_table(solution).encode("utf-8"))


def events_table(solution: Solution) -> str:
    """Return the events as a table.

    In the column "modes" stand the contacts whose bits (closed, approaching, slipping) the event changes, each with
    these before, during and after it, "ball - plate 000 110 101", apart by semicolons.
    """
    events, names = solution.events, solution.system.names.contacts
    first, listed, codes = events.first.tolist(), events.listed.tolist(), events.codes.tolist()
    causes, energies = events.causes(), [getattr(events, name).tolist() for name in _ENERGIES]
    text = io.StringIO(newline="")
    table = csv.writer(text)
    table.writerow(_HEAD)
    for i, (time, trigger) in enumerate(zip(events.time.tolist(), solution.triggers(), strict=True)):
        modes = [
            f"{names[listed[j]]} {' '.join(_bits(codes[j] >> shift) for shift in (BEFORE, DURING, AFTER))}"
            for j in range(first[i], first[i + 1])
            if codes[j] not in _UNCHANGED
        ]
        numbers = (repr(column[i]) for column in energies)
        table.writerow([repr(time), causes[i], trigger, int(events.phases[i]), *numbers, "; ".join(modes)])
    return text.getvalue()


_UNCHANGED = {bits << BEFORE | bits << DURING | bits << AFTER for bits in range(CODE + 1)}


def _bits(code: int) -> str:
    return "".join(str(code >> i & 1) for i in range(3))
