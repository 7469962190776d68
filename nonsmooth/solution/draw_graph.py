"""Layout and drawing of the graph of modes; needs matplotlib (``nonsmooth[full]``)."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from nonsmooth.charts import verbatim
from nonsmooth.engine.memory.modes import CAUSES
from nonsmooth.solution.modes import ContactModes, TransitionGraph, grouped

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array: TypeAlias = NDArray[np.float64]
Point: TypeAlias = tuple[float, float]

_WIDE = 1.25
"""Horizontal stretch of the layout, because mode words are written horizontally."""
_STARTS, _ROUNDS = 16, 300
"""Number of initial layouts (16), and number of iterations from each of them (300)."""


def places_of(graph: TransitionGraph) -> dict[ContactModes, Point]:
    """Place of each mode in the plane; distances approximate the least numbers of transitions between modes.

    Stress majorisation (de Leeuw) minimises the weighted sum, over all pairs of modes, of the square of (distance -
    number of transitions).  It is started from several layouts, in which the modes lie on a circle in random order.
    The final layout with the fewest crossing lines is returned.
    """
    visits = graph.visits
    modes = sorted(graph.shares, key=lambda m: (m in graph.passing, m != graph.start, -graph.shares[m], -visits[m]))
    n = len(modes)
    steps = _steps_between(modes, graph)
    lines = [(i, j) for i in range(n) for j in range(i + 1, n) if steps[i, j] == 1.0]
    random = np.random.default_rng(n)
    trials = [_relaxed(steps, random.permutation(n).astype(float)) for _ in range(_STARTS)]
    points = min(trials, key=lambda trial: (_crossings(trial, lines), _stress(trial, steps)))
    # rotate the layout so that its longest extent is horizontal, and mirror it so that the start mode is on the left
    points = points - points.mean(axis=0)
    points = points @ np.linalg.svd(points, full_matrices=False)[2].T if n > 1 else points
    points[:, 0] *= -1.0 if points[modes.index(graph.start), 0] > 0.0 else 1.0
    return {mode: (_WIDE * float(x), float(y)) for mode, (x, y) in zip(modes, points, strict=True)}


def _relaxed(steps: Array, order: Array) -> Array:
    """Places of the n modes after majorisation, shape [n, 2].

    It starts with the modes on a circle, mode i at the angle 2 pi ``order[i]`` / n.
    """
    n = len(steps)
    weights = np.divide(1.0, steps**2, out=np.zeros_like(steps), where=steps > 0.0)
    inverse = np.linalg.pinv(np.diag(weights.sum(axis=1)) - weights)
    angles = 2.0 * np.pi * order / n
    points = np.stack([-np.cos(angles), np.sin(angles)], axis=1)
    for _ in range(_ROUNDS):
        apart = np.linalg.norm(points[:, None] - points[None], axis=2)
        pull = np.divide(weights * steps, apart, out=np.zeros_like(steps), where=apart > 1e-12)
        points = inverse @ ((np.diag(pull.sum(axis=1)) - pull) @ points)
    return np.asarray(points)


def _stress(points: Array, steps: Array) -> float:
    """Sum of ((distance - n) / n)^2 over pairs of modes; n is the number of transitions between the two modes."""
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    return float(np.sum(np.divide(apart - steps, steps, out=np.zeros_like(steps), where=steps > 0.0) ** 2))


def _crossings(points: Array, lines: Sequence[tuple[int, int]]) -> int:
    """Number of pairs of lines that cross; each line is given by the indices of its two ends in ``points``."""

    def side(a: int, b: int, c: int) -> bool:
        (x, y), (u, v) = points[b] - points[a], points[c] - points[a]
        return bool(x * v - y * u > 0.0)

    return sum(
        len({a, b, c, d}) == 4 and side(a, b, c) != side(a, b, d) and side(c, d, a) != side(c, d, b)
        for (a, b), (c, d) in itertools.combinations(lines, 2)
    )


def _steps_between(modes: Sequence[ContactModes], graph: TransitionGraph) -> Array:
    """Least number of transitions between modes, in either direction, shape [n, n].

    Modes without a connection get the largest of these numbers plus one.
    """
    n = len(modes)
    steps = np.full((n, n), np.inf)
    np.fill_diagonal(steps, 0.0)
    for one, other, _ in graph.counts:
        if one != other:
            i, j = modes.index(one), modes.index(other)
            steps[i, j] = steps[j, i] = 1.0
    for k in range(n):
        steps = np.minimum(steps, steps[:, k : k + 1] + steps[k : k + 1])
    known = np.isfinite(steps)
    return np.where(known, steps, np.max(steps[known]) + 1.0)


_MOST_MODES = 14
_LONGEST_WORD, _FEW = 16, 8
"""Longest mode word [characters], and largest number of nodes, respectively, of a graph whose nodes show mode words.

The nodes of other graphs show numbers, which a legend explains.
"""
_MOST_CONTACTS = 14
"""Largest number of contacts with readable mode words; modes of more contacts are grouped."""
_LONGEST_LINE = 110
_FOOT = 0.62
"""Height of the caption [inches]."""
_COLOURS = (
    "#000000", "#d55e00", "#0072b2", "#009e73", "#e69f00", "#aa3377", "#56b4e9", "#999999", "#6b4c1e", "#f0e442",
    "#99cc00", "#882255", "#44aa99", "#332288", "#ddcc77",
)  # fmt: skip
"""Colour of each cause; letters at the arrows distinguish similar colours."""
_LETTERS = "abcdefghijklmno"
_BEND = 0.16


def draw(graph: TransitionGraph, most: int = _MOST_MODES) -> Figure:
    """Figure of the modes visited most and the transitions between them.

    Modes with a duration are inside, impacts around them.  A wider arrow is a more frequent transition.  Modes of many
    contacts are grouped (:func:`nonsmooth.solution.modes.grouped`).

    Parameters
    ----------
    graph : TransitionGraph
        The graph.
    most : int
        Largest number of modes, or groups, that are drawn; the title gives the number of those left out.
    """
    from matplotlib.figure import Figure

    many = len(graph.contacts) > _MOST_CONTACTS
    whole, words = grouped(graph) if many else (graph, {mode: graph.word(mode) for mode in graph.shares})
    shown = whole.most_visited(most)
    numbered = max(len(words[mode]) for mode in shown.shares) > _LONGEST_WORD or len(shown.shares) > _FEW
    visits, found = whole.visits, places_of(shown)
    places = {mode: found[mode] for mode in sorted(found, key=lambda mode: -visits[mode])}
    margin = 0.3
    left, right = min(x for x, _ in places.values()) - 2.0 * margin, max(x for x, _ in places.values()) + 2.0 * margin
    low, high = min(y for _, y in places.values()) - margin, max(y for _, y in places.values()) + margin
    width = 7.2 if numbered else 8.0
    height = min(
        max(width * (high - low) / (right - left), 0.3 * len(places) if numbered else 0.0),
        (0.8 if numbered else 0.62) * width,
    )
    inch = max((right - left) / width, (high - low) / height)
    whole_height = height + 0.8 + _FOOT
    figure = Figure(figsize=(width + 4.6 * numbered, whole_height), layout="constrained")
    body, foot = figure.subfigures(2, 1, squeeze=False, height_ratios=[whole_height - _FOOT, _FOOT])[:, 0]
    panels = body.subplots(1, 2, width_ratios=(7.2, 4.6)) if numbered else [body.subplots()]
    axis = panels[0]
    axis.set_aspect("equal")
    nodes = _draw_nodes(axis, shown, places, words, numbered, inch)
    _draw_edges(axis, shown, places, nodes)
    if numbered:
        _list_words(panels[1], shown, words, {mode: visits[mode] for mode in places})
    for panel in panels:
        panel.set_axis_off()
    axis.set_xlim(left, right)
    axis.set_ylim(low, high)
    body.suptitle(_title(graph, whole, shown), fontsize=11)
    foot.text(0.5, 0.5, _caption(graph, many), fontsize=7.5, color="0.3", ha="center", va="center")
    return figure


def _caption(graph: TransitionGraph, many: bool) -> str:
    what = "Mode word {closed, approaching, slipping}, first contact rightmost"
    if many:
        what = f"How many of {len(graph.contacts)} contacts are closed and slip; changes within a group are left out"
    text = (
        f"{what}; share of the time. Dashed: impacts,\nwhich take no time. Bold: the start. At the arrows: how often."
    )
    if many or not graph.contacts:
        return text
    names = f"From the right: {', '.join(graph.contacts)}."
    if len(names) > _LONGEST_LINE:
        names = "Contacts stand in the order of solution.system.contacts."
    return f"{text}\n{verbatim(names)}"


def _title(graph: TransitionGraph, whole: TransitionGraph, shown: TransitionGraph) -> str:
    # an impact is two transitions, into its mode (in `passing`) and out of it; count only the first of them
    changes = sum(n for (one, _, _), n in graph.counts.items() if one not in graph.passing)
    title = f"Modes of the run: {len(graph.shares)} visited, {changes} transition{'s' * (changes != 1)}"
    what = "modes"
    if whole is not graph:
        what, title = "groups", f"{title}; in {len(whole.shares)} groups"
    left_out = len(whole.shares) - len(shown.shares)
    return title + (f"; the {left_out} {what} visited least are left out" if left_out else "")


def _draw_nodes(
    axis: Axes,
    graph: TransitionGraph,
    places: dict[ContactModes, Point],
    words: dict[ContactModes, str],
    numbered: bool,
    inch: float,
) -> dict[ContactModes, Any]:
    """Draw the nodes; ``inch`` is the length of an inch in the units of the places."""
    from matplotlib.patches import Ellipse

    nodes = {}
    for number, (mode, (x, y)) in enumerate(places.items(), 1):
        share, passes = graph.shares[mode], mode in graph.passing
        label = str(number) if numbered else words[mode]
        width = 0.36 if numbered else 0.42 + 0.074 * len(label)
        node = Ellipse(
            (x, y), width * inch, (0.3 if numbered else 0.46) * inch, edgecolor="black", zorder=3,
            facecolor="white" if passes else str(0.97 - 0.22 * share), linestyle="--" if passes else "-",
            linewidth=2.2 if mode == graph.start else 1.0,
        )  # fmt: skip
        nodes[mode] = axis.add_patch(node)
        text = verbatim(label if passes or numbered else f"{label}\n{_percent(share)}")
        axis.text(x, y, text, ha="center", va="center", fontsize=8.5, zorder=4, linespacing=1.2)
    return nodes


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f} %" if share >= 5e-4 or share == 0.0 else "< 0.1 %"


def _draw_edges(
    axis: Axes, graph: TransitionGraph, places: dict[ContactModes, Point], nodes: dict[ContactModes, Any]
) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import FancyArrowPatch

    most = max(graph.counts.values(), default=1)
    seen = [cause for cause in CAUSES if any(edge[2] == cause for edge in graph.counts)]
    letters = dict(zip(seen, _LETTERS, strict=False)) if len(seen) > 1 else {}
    parallel: dict[tuple[ContactModes, ContactModes], int] = {}
    for (one, other, cause), n in sorted(graph.counts.items(), key=lambda item: -item[1]):
        bend = _BEND * (1 + parallel.get((one, other), 0))
        parallel[one, other] = parallel.get((one, other), 0) + 1
        colour, width = _COLOURS[CAUSES.index(cause)], 0.8 + 4.2 * math.sqrt(n / most)
        start, end = places[one], places[other]
        style = f"arc3,rad={bend}"
        if one == other:
            x, y = start
            start, end, style = (x - 0.07, y + 0.06), (x + 0.07, y + 0.06), f"arc3,rad={-1.6 - 6.0 * (bend - _BEND)}"
        arrow = FancyArrowPatch(
            start, end, connectionstyle=style, arrowstyle="-|>,head_length=0.5,head_width=0.28",
            mutation_scale=9.0 + 1.6 * width, patchA=None if one == other else nodes[one],
            patchB=None if one == other else nodes[other], shrinkA=1.0, shrinkB=2.0, color=colour, linewidth=width,
            zorder=2,
        )  # fmt: skip
        axis.add_patch(arrow)
        # label at the vertex of the arc, half of the bend away from the middle of the chord
        x, y = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
        x, y = x + 0.5 * bend * (end[1] - start[1]), y - 0.5 * bend * (end[0] - start[0])
        if one == other:
            x, y = places[one][0], places[one][1] + 0.06 + 0.07 * (1.6 + 6.0 * (bend - _BEND))
        box = {"boxstyle": "round,pad=0.12", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}
        label = f"{n} {letters.get(cause, '')}".strip()
        axis.text(x, y, label, fontsize=7.5, color=colour, ha="center", va="center", zorder=5, bbox=box)
    labels = {cause: f"{letters.get(cause, '')} {cause}".strip() for cause in seen}
    lines = [
        Line2D([], [], color=_COLOURS[CAUSES.index(cause)], linewidth=2.5, label=label)
        for cause, label in labels.items()
    ]
    if lines:
        axis.figure.legend(handles=lines, loc="outside lower center", ncols=4, fontsize=8, frameon=False)


def _list_words(
    panel: Axes, graph: TransitionGraph, words: dict[ContactModes, str], visits: dict[ContactModes, int]
) -> None:
    """Draw a list with number, visits, share of the time and mode word of each node."""
    rows = []
    for number, (mode, n) in enumerate(visits.items(), 1):
        share = "impact" if mode in graph.passing else _percent(graph.shares[mode])
        rows.append(f"{number:>2}  {n:>5} x  {share:>7}  {verbatim(words[mode])}")
    panel.text(0.0, 0.5, "\n".join(rows), fontsize=7.5, family="monospace", va="center", linespacing=1.7)
