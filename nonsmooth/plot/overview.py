"""An overview of a run: one figure with the panels that it has something for."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from nonsmooth.interfaces import Body
from nonsmooth.plot.arguments import contacts_of, pyplot
from nonsmooth.plot.contacts import forces, gaps, impulses
from nonsmooth.plot.energies import energies
from nonsmooth.plot.modes import modes
from nonsmooth.plot.path import path

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from nonsmooth.solution.solution import Solution

Panel: TypeAlias = "Callable[[Axes], Axes]"
_WIDTH, _HEIGHT = 13.0, 2.6
_LOOKS, _BODIES = 30, 40
"""Approximate number of instants (30), and largest number of bodies (40), searched for the body with the longest path.

The limits keep the search short in runs of many samples or bodies.
"""


def overview(solution: Solution) -> Figure:
    """Overview of a run (:meth:`nonsmooth.Solution.plot`)."""
    drawn = _panels(solution)
    rows = (len(drawn) + 1) // 2
    figure: Figure = pyplot().figure(figsize=(_WIDTH, 0.6 + _HEIGHT * rows), layout="constrained")
    for number, (title, draw) in enumerate(drawn, 1):
        draw(figure.add_subplot(rows, 2, number)).set_title(title, fontsize=10)
    n = len(solution.events)
    figure.suptitle(f"{solution.status} at t = {solution.t_end:.6g} s, {n} event{'s' * (n != 1)}", fontsize=11)
    return figure


def _panels(solution: Solution) -> list[tuple[str, Panel]]:
    events, found = solution.events, list[tuple[str, Panel]]()
    if solution.system.contacts:
        numbers = contacts_of("Solution.plot", solution, None)
        if solution.recorded.engine.records_contacts:
            found.append(("Modes of the contacts", lambda ax: modes(solution, numbers, ax)))
        found.append(("Gaps", lambda ax: gaps(solution, ax=ax)))
    if np.any(events.codes >> 6 & 1):
        found.append(("Normal forces between events", lambda ax: forces(solution, ax=ax)))
    if np.any(events.listed_impulse[:, 0] > 0.0):
        found.append(("Impulses of impacts", lambda ax: impulses(solution, ax=ax)))
    found.append(("Energies and losses, stacked", lambda ax: energies(solution, ax)))
    far = _farthest(solution)
    if far is not None:
        body, plane = far
        name = solution.system.name_of(body)
        found.append((f"Path of {name!r}", partial(_path, solution, body, plane)))
    return found


def _path(solution: Solution, body: Body, plane: str, ax: Axes) -> Axes:
    return path(solution, body, ax, plane=plane)


def _farthest(solution: Solution) -> tuple[Body, str] | None:
    """Body with the largest range of positions, and the plane of its path such as "xz"; None if no body moves."""
    times = solution.t[:: max(1, len(solution.t) // _LOOKS)]
    if len(times) == 0:  # a run that was cut off at once
        return None
    free = [body for body in solution.system.bodies if body.n_u > 0][:_BODIES]
    ways = [np.ptp(solution.history("position", times=times, of=body)["position"][:, 0], axis=0) for body in free]
    if not ways or np.max(ways) == 0.0:
        return None
    first = int(np.argmax(np.max(ways, axis=1)))
    return free[first], "".join("xyz"[i] for i in sorted(np.argsort(ways[first], kind="stable")[1:].tolist()))
