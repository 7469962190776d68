"""The look that all figures share: line styles that survive greyscale, legend below, footnote."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from nonsmooth.parameters import rules
from scenarios.dumbbell.scenario import DumbbellScenario

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BALL_1: dict[str, Any] = {"color": "tab:red", "linestyle": "none", "marker": "o", "fillstyle": "none", "markersize": 4}
BALL_2: dict[str, Any] = {"color": "black", "linestyle": "-", "linewidth": 1.5}
PLATE: dict[str, Any] = {"color": "tab:blue", "linestyle": "--", "linewidth": 1.5}
CURVE: dict[str, Any] = {"color": "black", "linestyle": "-", "linewidth": 1.3}
OTHER: dict[str, Any] = {"color": "tab:blue", "linestyle": "--", "linewidth": 1.6}
IMPACT: dict[str, Any] = {"color": "tab:red", "linestyle": "none", "marker": "o", "fillstyle": "none", "markersize": 6}

_FOOT = 0.42
"""Height of the footnote [inches]."""
_SYMBOLS = {
    "radius": ("r", 1e3, "mm"),
    "rod_mass_fraction": ("rod mass share", 1.0, ""),
    "density": ("density", 1.0, "kg/m³"),
    "restitution": ("e", 1.0, ""),
    "friction": ("µ", 1.0, ""),
    "static_friction": ("µ$_s$", 1.0, ""),
    "young_modulus": ("E", 1e-9, "GPa"),
    "poisson_ratio": ("$\\nu$", 1.0, ""),
}


def new_figure(
    title: str, note: str, panels: int = 1, width: float = 7.2, height: float = 4.8
) -> tuple[Figure, list[Axes]]:
    """Return a figure with panels side by side, a title that says what to see and a footnote [inches]."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    body, foot = figure.subfigures(2, 1, squeeze=False, height_ratios=[height - _FOOT, _FOOT])[:, 0]
    body.suptitle(title, fontsize=11)
    foot.text(0.012, 0.5, note, fontsize=7, color="0.25", va="center", linespacing=1.3)
    axes = list(body.subplots(1, panels, squeeze=False)[0])
    for axis in axes:
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
    return figure, axes


def legend(axes: list[Axes], columns: int = 3) -> None:
    """Put one legend for all panels below them, each label once."""
    found: dict[str, Any] = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
    if found:
        body = axes[0].figure
        body.legend(
            list(found.values()), list(found), loc="outside lower center", ncols=columns, fontsize=8, frameon=False
        )


def footnote(*scenarios: DumbbellScenario, impact: str = "") -> str:
    """Say what the runs were made with, and which of it is assumed; ``impact``: the laws, if not the scenarios'."""
    rows = [scenario.resolved() for scenario in scenarios]
    assumed = [name for name, (_, rule) in rules(DumbbellScenario).items() if rule.assumed and name in _SYMBOLS]
    gamma, frequency, ratio = (_values(rows, name, 1.0) for name in ("gamma", "frequency", "aspect_ratio"))
    laws = impact or ", ".join(dict.fromkeys(row["impact"] for row in rows))
    given = f"Γ = {gamma}, f = {frequency} Hz, A$_r$ = {ratio}; impact law: {laws}"
    words = []
    for name in assumed:
        symbol, factor, unit = _SYMBOLS[name]
        words.append(f"{symbol} = {_values(rows, name, factor)} {unit}".strip())
    return f"{given}\nassumed (not given in the paper): {', '.join(words)}"


def _values(rows: list[Any], name: str, factor: float) -> str:
    return " / ".join(dict.fromkeys(f"{row[name] * factor:.4g}" for row in rows))
