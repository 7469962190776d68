"""Draw the charts of speed, accuracy and theory: ``python docs/page_charts.py docs/pages/figures``.

The numbers of the charts are those of the tables of the pages, so that a table and its chart agree.
"""

from __future__ import annotations

import itertools
import sys
from pathlib import Path
from typing import Any

import numpy as np
from law_axes import make_axes
from pair_errors import stored

PAGES = Path(__file__).parent / "pages"
DPI = 110


def table(page: str, head: str) -> list[dict[str, str]]:
    """Return the rows of the table of a page whose head begins so, by the names of the columns."""
    lines = (PAGES / page).read_text(encoding="utf-8").splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith(head))
    names = _cells(lines[first])
    rows = []
    for line in lines[first + 2 :]:
        if not line.startswith("|"):
            break
        rows.append(dict(zip(names, _cells(line), strict=True)))
    return rows


def _cells(line: str) -> list[str]:
    return [part.strip() for part in line.strip().strip("|").split("|")]


def speed() -> Any:
    """Draw the cost of a simulated second, by system and engine."""
    rows = table("speed.md", "| system | engine |")
    systems = list(dict.fromkeys(row["system"] for row in rows))
    engines = list(dict.fromkeys(row["engine"] for row in rows))
    figure, (axis,) = make_axes("Cost of a simulated second (median, processor time)")
    figure.set_size_inches(7.2, 3.4)
    width = 0.8 / len(engines)
    for i, engine in enumerate(engines):
        of_engine = [row for row in rows if row["engine"] == engine]
        places = [systems.index(row["system"]) + (i - 0.5 * (len(engines) - 1)) * width for row in of_engine]
        bars = axis.bar(places, [float(row["median"]) for row in of_engine], 0.95 * width, label=engine)
        axis.bar_label(bars, [row["median"] for row in of_engine], fontsize=7)
    axis.set(yscale="log", ylabel="ms per simulated s", ylim=(1.0, 3e3), xticks=range(len(systems)))
    axis.set_xticklabels(systems)
    axis.grid(visible=False, axis="x")
    axis.legend(fontsize=8, loc="upper left", ncols=2)
    return figure


def tolerances() -> Any:
    """Draw errors and steps over the tolerance."""
    rows = [row for row in table("accuracy.md", "| both tolerances |") if row["both tolerances"] != "default"]
    tolerance = [float(row["both tolerances"]) for row in rows]
    figure, (errors, steps) = make_axes("One second of the drift mode of the dumbbell", 2)
    for name, look in (("position error [m]", "o-"), ("energy residual", "s--")):
        errors.loglog(tolerance, [float(row[name]) for row in rows], look, ms=4, label=name)
    errors.loglog(tolerance, tolerance, color="0.55", linewidth=0.8, label="tolerance")
    for name, look in (("steps of the flow", "o-"), ("steps in impacts", "s--")):
        steps.loglog(tolerance, [float(row[name]) for row in rows], look, ms=4, label=name)
    for axis in (errors, steps):
        axis.set_xlabel("both tolerances")
        axis.invert_xaxis()
        axis.legend(fontsize=8)
    return figure


def pairs() -> Any:
    """Draw the errors of all pairs of shapes, sorted."""
    rows = stored()
    figure, (axis,) = make_axes(f"Largest error of each of {len(rows)} pairs of shapes")
    figure.set_size_inches(6.4, 3.4)
    for name in ("gap [m]", "witness [m]", "normal [rad]", "first rate", "second rate"):
        values = np.sort([max(float(row[name]), 1e-17) for row in rows])
        axis.semilogy(np.arange(1, len(rows) + 1), values, label=name)
    axis.set(xlabel="pairs, sorted by each error", ylabel="largest error", ylim=(1e-17, 1e-7))
    axis.legend(fontsize=8, ncols=2)
    return figure


def gap_bounds() -> Any:
    """Draw two parabolas that bound a gap from below, over a step and over its halves."""
    s = np.linspace(0.0, 1.0, 401)
    gap = 0.42 - 0.9 * s + 0.8 * s**2 + 0.03 * np.sin(9.0 * s)
    rate = np.gradient(gap, s)
    figure, axes = make_axes("Lower bounds of a gap with one bound M of its acceleration", 2)
    titles = {"one step: undecided": (0, 400), "halved: it stays open": (0, 200, 400)}
    for axis, (title, ends) in zip(axes, titles.items(), strict=True):
        axis.plot(s, gap, "k", linewidth=1.8, label="gap")
        axis.axhline(0.0, color="0.5", linewidth=0.8)
        for one, two in itertools.pairwise(ends):
            x = s[one : two + 1]
            left = gap[one] + rate[one] * (x - s[one]) - 1.1 * (x - s[one]) ** 2
            right = gap[two] - rate[two] * (s[two] - x) - 1.1 * (s[two] - x) ** 2
            first = one == 0
            axis.plot(x, left, "C0--", label="bound from the left end" if first else None)
            axis.plot(x, right, "C3--", label="bound from the right end" if first else None)
            k = int(np.argmin(np.abs(left - right)))
            axis.plot(x[k], left[k], "ko", markersize=5, label="the bounds cross" if first else None)
        axis.set(title=title, xlabel="fraction of the step", xlim=(0.0, 1.0), ylim=(-0.45, 0.75))
        axis.title.set_fontsize(9)
    axes[0].set_ylabel("gap")
    axes[0].legend(fontsize=7, loc="upper right")
    return figure


CHARTS = {
    "speed_engines": speed,
    "accuracy_tolerances": tolerances,
    "accuracy_pairs": pairs,
    "gap_bounds": gap_bounds,
}


def main() -> None:
    """Save the charts in the folder given."""
    for name, draw in CHARTS.items():
        draw().savefig(Path(sys.argv[1]) / f"{name}.png", dpi=DPI)


if __name__ == "__main__":
    main()
