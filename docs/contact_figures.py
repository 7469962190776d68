"""Draw the figure of the page on contacts of two bodies: ``python docs/contact_figures.py docs/pages/figures``."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
from law_axes import make_axes
from matplotlib.ticker import MultipleLocator
from scipy.spatial import ConvexHull

import nonsmooth as ns
from bodies.contacts.surface.surface_near import EDGE_ACROSS, OVER_FIRST, OVER_SECOND
from nonsmooth.bodies import BoxBody, Plate
from nonsmooth.laws import Coulomb, EnergeticImpact, Unilateral

_BLUE, _RED, _GREY = "tab:blue", "tab:red", "0.35"
_TEXT: dict[str, Any] = {
    "textcoords": "offset points",
    "fontsize": 7,
    "arrowprops": {"arrowstyle": "-", "color": _GREY},
}
_WORDS = {
    EDGE_ACROSS: "edge {}\nand edge {}",
    OVER_FIRST: "face {}\nand corner {}",
    OVER_SECOND: "face {} of the second\nand corner {}",
}
"""Words for a pair of features by its kind."""
_LOW, _HIGH = (0.06, 0.04, 0.02), (0.03, 0.03, 0.015)


def _laws() -> ns.ContactLaws:
    """Return the laws of all contacts."""
    return ns.ContactLaws(normal=Unilateral(), friction=Coulomb(0.5), impact=EnergeticImpact(0.0))


def _two(position: tuple[float, float, float], turn: tuple[float, ...]) -> ns.System:
    """Return a system of two boxes: a wide one, and a smaller one at a position [m] and an orientation."""
    one, two = BoxBody(*_LOW), BoxBody(*_HIGH)
    system = ns.System([one, two], gravity=0.0)
    system.contact_all(_laws())
    system.place(two, position=position, orientation=turn)
    return system


def _corners(half: tuple[float, float, float]) -> Any:
    """Return the corners of a box [m], shape [8, 3]."""
    return np.array(np.meshgrid(*((-h, h) for h in half))).reshape(3, 8).T


def _outline(axis: Any, points: Any, colour: str, name: str) -> None:
    """Draw the outline of a body seen along an axis, from points in the plane of the picture [m], shape [n, 2]."""
    hull = points[ConvexHull(points).vertices]
    axis.fill(hull[:, 0], hull[:, 1], facecolor=colour, edgecolor=colour, alpha=0.18)
    axis.plot(*np.vstack([hull, hull[:1]]).T, color=colour, linewidth=1.2)
    axis.plot([], [], color=colour, linewidth=1.2, label=name)


def _side(axis: Any, gap: float, tilt: float) -> tuple[Any, Any]:
    """Draw two boxes from the side, the upper one tilted [rad] and higher by a gap [m]; return normal and points."""
    reach = _HIGH[0] * math.sin(tilt) + _HIGH[2] * math.cos(tilt)
    turn = ns.turned_about((0.0, 1.0, 0.0), tilt)
    system = _two((0.02, 0.0, _LOW[2] + reach + gap), turn)
    near = ns.proximity(system, within=1.0)[0].distance
    c, s = math.cos(tilt), math.sin(tilt)
    upper = _corners(_HIGH)
    x, z = c * upper[:, 0] + s * upper[:, 2] + 0.02, -s * upper[:, 0] + c * upper[:, 2] + _LOW[2] + reach + gap
    _outline(axis, _corners(_LOW)[:, ::2], _BLUE, "first body")
    _outline(axis, np.column_stack([x, z]), _RED, "second body")
    return near.normal[::2], (near.first[::2], near.second[::2])


def pair_area_feature(folder: Path) -> None:
    """Separation of two boxes, features next to each other, and the contacts of their common area."""
    figure, axes = make_axes("Two boxes: apart, next to each other, and flush (seen from above)", 3)
    n, (first, second) = _side(axes[0], 0.022, 0.5)
    for point, colour in ((first, _BLUE), (second, _RED)):
        along = np.array([-n[1], n[0]])
        axes[0].plot(*np.array([point - 0.02 * along, point + 0.07 * along]).T, "--", color=colour, linewidth=0.8)
    axes[0].annotate("", second - [0.055, 0.0], first - [0.055, 0.0], arrowprops={"arrowstyle": "->", "color": _GREY})
    axes[0].annotate("n, s(n)", first - [0.055, -0.008], (-4, 0), textcoords="offset points", ha="right", fontsize=8)
    _, (first, second) = _side(axes[1], 0.004, 0.5)
    axes[1].plot(*np.array([first, second]).T, color=_GREY, linewidth=1.2)
    axes[1].plot(*second, "o", color=_RED, markersize=4)
    axes[1].annotate("vertex of the second body\nover a face of the first", second, (-75, -40), **_TEXT)
    _area(axes[2])
    for axis in axes[:2]:
        axis.set_ylim(-0.03, 0.11)
        axis.set_xlim(-0.075, 0.085)
    for axis, label in zip(axes, ("z [m]", "z [m]", "y [m]"), strict=True):
        axis.set_aspect("equal")
        axis.xaxis.set_major_locator(MultipleLocator(0.05))
        axis.set_xlabel("x [m]")
        axis.set_ylabel(label)
    axes[0].legend(frameon=False, fontsize=7, loc="lower right")
    figure.savefig(folder / "pair_area_feature.png", dpi=110)


def _area(axis: Any) -> None:
    """Draw both boxes from above as they meet flush, and the contacts of their impact with their names."""
    angle, place = 0.3, (0.045, 0.0)
    floor, one, two = Plate(), BoxBody(*_LOW), BoxBody(*_HIGH)
    system = ns.System([floor, one, two])
    system.contact_all(_laws())
    turn = ns.turned_about((0.0, 0.0, 1.0), angle)
    system.place(one, position=(0.0, 0.0, _LOW[2] + 1e-4))
    system.place(two, position=(*place, 2.0 * _LOW[2] + _HIGH[2] + 2e-4), orientation=turn)
    solution = ns.simulate(system, 0.05)
    c, s = math.cos(angle), math.sin(angle)
    upper = _corners(_HIGH)[:, :2] @ np.array([[c, s], [-s, c]]) + place
    _outline(axis, _corners(_LOW)[:, :2], _BLUE, "first body")
    _outline(axis, upper, _RED, "second body")
    history = solution.history("mode", "contact_point", times=[0.05])
    for contact in np.flatnonzero(history["mode"][0] > 0).tolist():
        if solution.system.contacts[contact].first is floor:
            continue
        point = history["contact_point"][0, contact, 0, :2]
        kind, one_feature, two_feature = solution.state.features[contact]
        words = _WORDS[kind].format(int(one_feature), int(two_feature))
        axis.plot(*point, "o", color="black", markersize=4)
        axis.annotate(words, point, (6, 12), **_TEXT)


def main() -> None:
    """Draw it."""
    pair_area_feature(Path(sys.argv[1]))


if __name__ == "__main__":
    main()
