"""The path of a body, seen along an axis of the world."""

from __future__ import annotations

from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from nonsmooth.charts import verbatim
from nonsmooth.errors import InvalidInput
from nonsmooth.histories.request import numbers_of
from nonsmooth.interfaces import Body
from nonsmooth.plot.arguments import axes_of, beside, times_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nonsmooth.solution.solution import Solution

_WHERE = "nonsmooth.plot.path"
_AXES = "xyz"


def path(
    solution: Solution,
    body: Body | str,
    ax: Axes | None = None,
    *,
    plane: str = "xy",
    frame: int = 0,
    times: ArrayLike | None = None,
) -> Axes:
    """Draw the path of the origin of a body's frame [m], to scale.

    Parameters
    ----------
    solution, ax, times
        As for :func:`nonsmooth.plot.gaps`.
    body : Body or str
        The body, or its name.
    plane : str
        The axes of the world across and up, "xy", "xz", "yz" or the other way round.
    frame : int
        Number of the frame of the body.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    InvalidInput, UnknownName
        If the system has no such body, the body no such frame, there is no such plane, or a time is not within the run.
    """
    (number,) = numbers_of(_WHERE, solution.system, ["body"], [body])["body"]
    one = solution.system.bodies[number]
    if len(plane) != 2 or len({*plane} & {*_AXES}) != 2:
        raise InvalidInput(f"{_WHERE}: plane", "must be two of the axes x, y and z", plane, 'For example "xz".')
    if frame not in range(len(one.frames)):
        rule = f"must be below {len(one.frames)}, the number of frames"
        raise InvalidInput(f"{_WHERE}: frame", rule, frame, "Count from 0.")
    row = times_of(_WHERE, solution, times)
    origin = solution.history("position", times=row, of=one)["position"][:, frame]
    across, up = (origin[:, _AXES.index(letter)] for letter in plane)
    name, ax = verbatim(solution.system.name_of(one)), axes_of(ax)
    ax.plot(across, up, color="black", linewidth=1.2, label=name if frame == 0 else f"{name}, frame {frame}")
    ax.plot(across[:1], up[:1], linestyle="none", marker="o", fillstyle="none", color="black", label="start")
    ax.plot(across[-1:], up[-1:], linestyle="none", marker="s", color="black", markersize=5, label="end")
    ax.set_aspect("equal", adjustable="datalim")
    ax.locator_params(axis="x", nbins=5)
    ax.set_xlabel(f"{plane[0]} [m]")
    ax.set_ylabel(f"{plane[1]} [m]")
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    beside(ax)
    return ax
