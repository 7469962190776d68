"""Draw the figures of the pages on plug-ins: ``python docs/plugin_figures.py docs/pages/figures [PAGE ...]``.

A figure shows the example of its page: the Python blocks of the page run first, and the figure takes classes, systems
and solutions from them by name.
"""

from __future__ import annotations

import contextlib
import io
import math
import re
import sys
import types
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from law_axes import GREY, make_axes
from scipy.spatial import ConvexHull

import nonsmooth as ns

_PAGES = Path(__file__).parent / "pages" / "plugins"
_GRAVITY = 9.81
_RED, _BLUE = {"color": "tab:red"}, {"color": "tab:blue"}
_SMALL = {"frameon": False, "fontsize": 8}


def example(page: str) -> Mapping[str, Any]:
    """Run the Python blocks of a page up to its section on checks, and return its names."""
    text = (_PAGES / f"{page}.md").read_text(encoding="utf-8").split("\n## Check it")[0]
    module = types.ModuleType("example")
    sys.modules["example"] = module
    with contextlib.redirect_stdout(io.StringIO()):
        for block in re.findall(r"^```python\n(.*?)^```\n", text, re.M | re.S):
            exec(block, vars(module))
    return vars(module)


def history(solution: Any, body: Any, *names: str, count: int = 400) -> tuple[np.ndarray, ...]:
    """Return times and quantities of a body, shapes [n] and [n, 3]."""
    times = np.linspace(0.0, solution.t_end, count)
    found = solution.history(*names, times=times, of=body)
    return times, *(found[name][:, 0] for name in names)


def label(axis: Any, across: str, up: str, legend: bool = True) -> None:
    """Name the axes, and draw the legend."""
    axis.set_xlabel(across)
    axis.set_ylabel(up)
    if legend:
        axis.legend(**_SMALL)


def friction_law(page: Mapping[str, Any]) -> Any:
    """Draw the coefficient, and the slip of the ball."""
    law, ball = page["law"], page["ball"]
    figure, (left, right) = make_axes("A coefficient that decreases with the slip speed", 2)
    speeds = np.linspace(0.0, 0.06, 200)
    left.plot(1e3 * speeds, [law.coefficient(v, **law.parameters()) for v in speeds], **_RED)
    left.set_ylim(0.0, 0.35)
    label(left, "slip speed [mm/s]", r"coefficient $\mu$", legend=False)
    times, velocity, spin = history(page["solution"], ball, "velocity", "angular_velocity", count=2000)
    slip = velocity[:, 0] - ball.radius * spin[:, 1]
    right.plot(1e3 * times, slip, color="black", label="slip speed of the ball")
    right.axvline(1e3 * page["closed_form"], **GREY, label="end of slip, closed form")
    right.set_xlim(0.0, 100.0)
    label(right, "time [ms]", "slip speed [m/s]")
    return figure


def impact_law(page: Mapping[str, Any]) -> Any:
    """Draw the ratio of the rates of the process, and the bounces of the map."""
    figure, (left, right) = make_axes("A process and a map", 2)
    law, none = page["Softening"](fall_speed=1.0), page["Frictionless"]()
    speeds = np.geomspace(1e-3, 1e2, 41)

    def ratio(speed: float) -> float:
        result = ns.solve_impact([[1.0]], [[1.0]], [[[0.0, 0.0]]], [-speed], [law], [none])
        return float(result.velocity[0]) / speed

    left.semilogx(speeds, [ratio(v) for v in speeds], **_RED)
    printed = (0.01, 1.0, 10.0)
    left.plot(printed, [ratio(v) for v in printed], "o", color="black", label="printed above")
    left.set_ylim(0.0, 1.05)
    left.set_title("Softening", fontsize=9)
    label(left, "impact speed [m/s]", "speed after / before")
    solution = ns.simulate(page["system"], 0.55)
    times, position = history(solution, page["ball"], "position", count=2000)
    right.plot(times, 1e3 * (position[:, 2] - page["ball"].radius), color="black")
    right.axhline(100.0 * 0.25, **GREY, label=r"$e^2 \cdot 100$ mm and $e^4 \cdot 100$ mm")
    right.axhline(100.0 * 0.25**2, **GREY)
    right.set_title("Lone, e = 0.5", fontsize=9)
    label(right, "time [s]", "gap under the ball [mm]")
    return figure


def normal_law(page: Mapping[str, Any]) -> Any:
    """Draw the loops of force over indentation."""
    figure, axes = make_axes("Foam: the area of a loop is the energy lost in an impact", 2)
    for axis, speed in zip(axes, (0.1, 1.0), strict=True):
        floor, ball = page["Plate"](), page["Ball"](radius=0.01)
        system = ns.System([floor, ball], gravity=0.0)
        (contact,) = system.contact(floor, ball, normal=page["Foam"](), friction=page["Coulomb"](0.3))
        system.place(ball, position=(0.0, 0.0, 0.01), velocity=(0.0, 0.0, -speed))
        solution = ns.simulate(system, t_end=0.5)
        end = float(solution.events.time[1])
        found = solution.history("gap", "normal_force", times=np.linspace(0.0, end, 600), of=contact)
        depth, force = -1e3 * found["gap"][:, 0], found["normal_force"][:, 0]
        top = int(np.argmax(depth))
        axis.plot(depth[: top + 1], force[: top + 1], **_RED, label="compression")
        axis.plot(depth[top:-1], force[top:-1], **_BLUE, label="expansion")
        restitution = float(solution.u_end[2]) / speed
        axis.set_title(f"impact at {speed:g} m/s: e = {restitution:.3f}", fontsize=9)
        label(axis, "indentation [mm]", "normal force [N]")
    return figure


def traction_law(page: Mapping[str, Any]) -> Any:
    """Draw the velocity of the ball on oil, and with the laws of direction and memory."""
    figure, (left, right) = make_axes("A ball that starts with 0.2 m/s and no spin", 2)

    def slide(t_end: float, **laws: Any) -> tuple[np.ndarray, np.ndarray]:
        floor, ball = page["Plate"](), page["Ball"](radius=0.01)
        system = ns.System([floor, ball])
        system.contact(floor, ball, **laws)
        system.place(ball, position=(0.0, 0.0, 0.01), velocity=(0.2, 0.0, 0.0))
        times, velocity = history(ns.simulate(system, t_end), ball, "velocity")
        return times, velocity[:, 0] / 0.2

    times, speed = slide(0.2, normal=page["HuntCrossley"](1e9, 1.0), friction=page["Oil"]())
    left.plot(1e3 * times, speed, **_RED, label="Oil")
    left.plot(1e3 * times, (5.0 + 2.0 * np.exp(-3.5 * _GRAVITY * times)) / 7.0, **GREY, label="closed form")
    left.axhline(5.0 / 7.0, color="black", linewidth=0.8, linestyle=":", label="rolls: 5/7")
    label(left, "time [ms]", "velocity / velocity at the start")
    laws = ((page["Coulomb"](0.4), "black"), (page["Brake"](), "tab:red"), (page["Runner"](), "tab:blue"))
    for friction, colour in laws:
        times, speed = slide(0.06, friction=friction, **page["rigid"])
        right.plot(1e3 * times, speed, color=colour, label=type(friction).__name__)
    right.axhline(5.0 / 7.0, color="black", linewidth=0.8, linestyle=":")
    right.axvline(8.0, **GREY, label="printed below: 8 ms")
    label(right, "time [ms]", "velocity / velocity at the start")
    return figure


def body(page: Mapping[str, Any]) -> Any:
    """Draw the hollow ball that starts to roll, and the bead that bounces."""
    figure, (left, right) = make_axes("A hollow ball on a floor, and a bead on a wire", 2)
    floor, ball = page["Plate"](), page["HollowBall"]()
    system = ns.System([floor, ball])
    laws = {name: page[name] for name in ("Unilateral", "Coulomb", "EnergeticImpact")}
    system.contact(
        floor,
        ball,
        normal=laws["Unilateral"](),
        friction=laws["Coulomb"](0.3),
        impact=laws["EnergeticImpact"](0.5),
    )
    ns.touching(system, ball, velocity=(0.5, 0.0, 0.0))
    times, velocity, spin = history(ns.simulate(system, 0.15), ball, "velocity", "angular_velocity")
    left.plot(1e3 * times, velocity[:, 0] / 0.5, color="black", label="velocity of the centre")
    left.plot(1e3 * times, ball.radius * spin[:, 1] / 0.5, **_RED, label="radius times spin")
    left.axhline(0.6, **GREY, label="closed form 3/5")
    left.set_ylim(0.0, 1.05)
    label(left, "time [ms]", "speed / speed at the start")
    times = np.linspace(0.0, 0.5, 1000)
    height = ns.simulate(page["system"], 0.5).history("position", times=times, of=page["one"])["position"][:, 0, 2]
    right.plot(1e3 * times, 1e3 * (height - 0.005), color="black", label="bead")
    right.axhline(25.0, **GREY, label=r"$e^2 \cdot 100$ mm")
    label(right, "time [ms]", "gap under the bead [mm]")
    return figure


def _outline(points: np.ndarray) -> np.ndarray:
    """Return the closed hull of points in the plane of x and z, shape [n, 2]."""
    flat = points[:, [0, 2]]
    around = ConvexHull(flat).vertices
    return np.asarray(flat[np.append(around, around[0])])


def shape(page: Mapping[str, Any]) -> Any:
    """Draw the egg at several instants, from the side."""
    figure, (axis,) = make_axes("An egg falls on a box")
    figure.set_size_inches(6.6, 3.6)
    egg, box = page["egg"], page["box"]
    times = np.array([0.0, 0.07, 0.1, 0.3, 0.46, 0.54])
    solution = ns.simulate(page["system"], float(times[-1]))
    points = egg.shape.drawing()[0]
    found = solution.history("position", "rotation", times=times, of=egg)
    for number, time in enumerate(times):
        placed = points @ found["rotation"][number, 0].T + found["position"][number, 0]
        pole = egg.shape.support(np.array([0.0, 0.0, 1.0])) @ found["rotation"][number, 0].T
        tip = found["position"][number, 0] + pole
        strength = 0.25 + 0.75 * number / (len(times) - 1)
        outline = 1e3 * _outline(placed)
        axis.plot(*outline.T, color="tab:red", alpha=strength, linewidth=1.2)
        axis.plot(1e3 * tip[0], 1e3 * tip[2], ".", color="tab:red", alpha=strength)
        axis.annotate(
            f"{1e3 * time:.0f} ms", (outline[:, 0].mean(), outline[:, 1].mean() + 6.0), fontsize=7, ha="center"
        )
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * np.array([0.03, 0.03, 0.01])
    last = solution.history("position", "rotation", times=times[-1:], of=box)
    axis.fill(*(1e3 * _outline(corners @ last["rotation"][0, 0].T + last["position"][0, 0])).T, color="0.8", zorder=0)
    axis.axhline(0.0, color="black", linewidth=1.0)
    axis.set_aspect("equal")
    label(axis, "x [mm]", "z [mm]", legend=False)
    return figure


def _arrow(axis: Any, start: np.ndarray, end: np.ndarray, colour: str, both: bool = False) -> None:
    style = {"arrowstyle": "<->" if both else "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0}
    axis.annotate("", end, start, arrowprops=style)


def contact_kinematics(page: Mapping[str, Any]) -> Any:
    """Draw the numbers of the geometry block for a tilted plane and a tilted pin."""
    figure, (axis,) = make_axes("Geometry block of a plane and the tip of a pin")
    figure.set_size_inches(6.0, 4.2)
    frames = []
    for angle, place in ((-0.2, (0.0, 0.0, 0.0)), (0.75, (0.0, 0.0, 0.15))):  # about the axis y, into the picture
        c, s = math.cos(angle), math.sin(angle)
        frames.append(np.array([*place, c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c, *12 * (0.0,)]))
    first, second = frames
    out = np.zeros(31)
    page["contact"].evaluator(first, second, out, **page["contact"].values)
    tangent, normal, a, b = (out[[i, i + 2]] for i in (4, 1, 7, 10))
    centre, along = second[[0, 2]], second[[3, 9]]
    line = np.array([first[[0, 2]] - 0.05 * tangent, first[[0, 2]] + 0.2 * tangent])
    axis.plot(*line.T, color="black")
    axis.fill(*np.vstack([line, line[::-1] - 0.012 * normal]).T, color="0.85")
    axis.plot(*np.array([centre, centre + 0.1 * along]).T, color="0.4", linewidth=2.5)
    circle = np.linspace(0.0, 2.0 * math.pi, 100)
    axis.fill(centre[0] + 0.02 * np.cos(circle), centre[1] + 0.02 * np.sin(circle), color="0.85", ec="0.4")
    axis.plot(*np.array([a, b]).T, color="tab:blue", linewidth=1.0, linestyle="--")
    axis.plot(*np.array([a, b]).T, "o", color="tab:blue", markersize=5)
    _arrow(axis, a, a + 0.045 * normal, "tab:red")
    _arrow(axis, a, a + 0.045 * tangent, "tab:red")
    for text, spot in (
        ("normal $n$", a + 0.036 * normal - 0.032 * tangent),
        ("first tangent $t_1$", a + 0.035 * tangent - 0.011 * normal),
        ("POINT_A", a - 0.026 * tangent - 0.009 * normal),
        ("POINT_B: tip of the pin", b + 0.005 * tangent + 0.004 * normal),
        (f"gap = {1e3 * out[0]:.1f} mm", 0.35 * a + 0.65 * b + 0.005 * tangent),
        ("first body: plane", first[[0, 2]] - 0.045 * tangent - 0.022 * normal),
        ("second body", centre + np.array([0.025, 0.0])),
    ):
        axis.text(*spot, text, fontsize=8, va="center")
    axis.set_aspect("equal")
    axis.grid(visible=False)
    axis.set_axis_off()
    return figure


def joint(page: Mapping[str, Any]) -> Any:
    """Draw the ball on its slope at equal times, and its path over time."""
    figure, (left, right) = make_axes("A ball whose centre a joint holds on a slope", 2)
    solution, ball = page["solution"], page["ball"]
    times = np.linspace(0.0, 0.25, 6)
    places = 1e3 * solution.history("position", times=times, of=ball)["position"][:, 0]
    direction = places[-1, [0, 2]] / np.linalg.norm(places[-1])
    ends = np.array([-30.0 * direction, places[-1, [0, 2]] + 30.0 * direction])
    left.plot(*ends.T, color="black", linewidth=1.0)
    circle = np.linspace(0.0, 2.0 * math.pi, 60)
    for time, place in zip(times, places, strict=True):
        left.fill(place[0] + 10.0 * np.cos(circle), place[2] + 10.0 * np.sin(circle), color="0.85", ec="tab:red")
        left.plot(place[0], place[2], ".", **_RED)
        if time > 0.09:
            left.annotate(f"{1e3 * time:.0f} ms", (place[0] + 3.0, place[2] + 14.0), fontsize=7)
    left.set_aspect("equal", adjustable="datalim")
    label(left, "x [mm]", "z [mm]", legend=False)
    times, position = history(solution, ball, "position", count=60)
    right.plot(times, np.linalg.norm(position, axis=1), color="tab:red", label="run")
    right.plot(times, 0.5 * _GRAVITY * math.sin(0.3) * times**2, **GREY, label=r"$g\,\sin(0.3)\,t^2/2$")
    label(right, "time [s]", "distance on the slope [m]")
    return figure


def motion(page: Mapping[str, Any]) -> Any:
    """Draw the positions of tray and ball over time."""
    figure, (axis,) = make_axes("A ball on a tray that is pulled away with 2 m/s²")
    times, position = history(page["solution"], page["ball"], "position", count=100)
    axis.plot(times, times**2, color="black", label="tray")
    axis.plot(times, position[:, 0], **_RED, label="ball")
    axis.plot(times, 2.0 / 7.0 * times**2, **GREY, label="2/7 of the tray, closed form")
    label(axis, "time [s]", "position x [m]")
    return figure


def load(page: Mapping[str, Any]) -> Any:
    """Draw the speed of the falling ball."""
    figure, (axis,) = make_axes("A ball falls through the air")
    final = page["final_speed"]
    times, velocity = history(ns.simulate(page["system"], 1.9), page["ball"], "velocity", count=100)
    axis.plot(times, -velocity[:, 2], **_RED, label="with Drag")
    axis.plot(times, final * np.tanh(_GRAVITY * times / final), **GREY, label="closed form")
    axis.plot(times, _GRAVITY * times, color="black", linewidth=0.8, label="without drag")
    axis.axhline(final, color="black", linestyle=":", linewidth=0.8, label=r"final speed $v_\infty$")
    axis.set_ylim(0.0, 12.0)
    label(axis, "time [s]", "speed [m/s]")
    return figure


def scenario(page: Mapping[str, Any]) -> Any:
    """Return the figure that the scenario makes."""
    return page["figures"]["slip"]


def engine(page: Mapping[str, Any]) -> Any:
    """Draw the errors of the midpoint rule over its step."""
    figure, (axis,) = make_axes("The midpoint rule on a tumbling box, 0.2 s")
    steps = 4e-3 * 0.5 ** np.arange(6)
    runs = [ns.simulate(page["system"], 0.2, engine=page["Midpoint"](h)) for h in steps]
    errors = np.array([abs(run.q_end - page["exact"].q_end).max() for run in runs])
    axis.loglog(1e3 * steps, errors, "o-", **_RED, label="largest error of a coordinate")
    lengths = [run.end.measured["error"] for run in runs]
    axis.loglog(1e3 * steps, lengths, "s-", **_BLUE, label="error of a quaternion's length")
    axis.loglog(1e3 * steps, 3.0 * errors[0] * (steps / steps[0]) ** 2, **GREY, label="slope 2")
    axis.set_xticks(1e3 * steps, [f"{1e3 * h:g}" for h in steps])
    axis.minorticks_off()
    label(axis, "step [ms]", "error")
    return figure


FIGURES: Mapping[str, Callable[[Mapping[str, Any]], Any]] = {
    function.__name__: function
    for function in (
        friction_law,
        impact_law,
        normal_law,
        traction_law,
        body,
        shape,
        contact_kinematics,
        joint,
        motion,
        load,
        scenario,
        engine,
    )
}


def main() -> None:
    """Save the figures in the folder given."""
    for name in sys.argv[2:] or FIGURES:
        FIGURES[name](example(name)).savefig(Path(sys.argv[1]) / f"plugin_{name}.png", dpi=90)


if __name__ == "__main__":
    main()
