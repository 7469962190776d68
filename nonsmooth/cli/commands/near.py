"""The bodies of a scenario that are near each other at the start, as a table."""

from __future__ import annotations

from pathlib import Path

from nonsmooth.cli.asking import request
from nonsmooth.cli.telling.table import lines
from nonsmooth.files.formats import SUFFIXES
from nonsmooth.files.reading import read
from nonsmooth.queries.proximity import NearPair, proximity

_HEAD = ("gap [m]", "", "bodies", "found by", "contact")


def table(name: str, trust: bool) -> str:
    """Return the table of a scenario file, which may be trusted, or of a scenario with its defaults.

    Raises
    ------
    InvalidInput
        If there is no such file or scenario, or it is not valid.
    """
    system = read(Path(name), trust).system if name.endswith(SUFFIXES) else request.job(name, (), trust=trust).build()
    pairs, names = proximity(system), system.names.bodies
    if not pairs:
        return f"{name}: no two bodies are near each other at the start."
    rows = [
        (
            f"{pair.distance.gap:.3g}",
            pair.state,
            " and ".join(names[number] for number in pair.numbers),
            pair.distance.how,
            _said(pair),
        )
        for pair in pairs
    ]
    return "\n".join([f"{name}: bodies near each other at the start", "", *lines([_HEAD, *rows])])


def _said(pair: NearPair) -> str:
    words = {"declared": pair.declared, "joined": pair.joined, "excluded": pair.excluded}
    return ", ".join(word for word, holds in words.items() if holds) or "none"
