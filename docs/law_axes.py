"""Axes in the style of the catalogue of laws."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, final

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

GREY = {"color": "0.55", "linestyle": "--", "linewidth": 1.6}
DOTS = {"marker": "o", "fillstyle": "none", "markersize": 5, "color": "tab:red", "linestyle": "none"}


def make_axes(title: str, panels: int = 1) -> tuple[Any, Any]:
    """Return a figure with a title, and its panels side by side."""
    figure, axes = plt.subplots(1, panels, figsize=(3.9 * panels + 1.3, 3.4), layout="constrained", squeeze=False)
    figure.suptitle(title, fontsize=10)
    for axis in axes[0]:
        axis.grid(color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
    return figure, axes[0]


@final
class Falling:
    """An event that ends scipy's integration: a function of time and state falls to zero."""

    terminal = True
    direction = -1.0

    def __init__(self, function: Callable[[float, Any], float]) -> None:
        self.function = function

    def __call__(self, t: float, y: Any) -> float:
        """Return the function's value."""
        return float(self.function(t, y))
