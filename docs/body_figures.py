"""Draw the figures of the pages on bodies, joints, mechanisms, meshes and exports.

``python docs/body_figures.py docs/pages/figures`` runs the examples of these pages.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from law_axes import make_axes

import nonsmooth as ns
from nonsmooth.bodies import (
    Ball,
    Coordinate,
    DrivenBody,
    GeneralisedBody,
    Hinge,
    Plate,
    Point,
    PointFrame,
    Rest,
    Rod,
    TriangleMesh,
    Triangles,
)
from nonsmooth.laws import Coulomb, EnergeticImpact, Unilateral

_BLUE, _RED, _GROUND = "tab:blue", "tab:red", "0.35"


def _equal(axis: Any) -> None:
    axis.set_aspect("equal")
    axis.set_xlabel("x [m]")
    axis.set_ylabel("z [m]")


def joints(folder: Path) -> None:
    """Two rods on hinges at eight instants."""
    length, ends = 0.3, ((-0.15, 0.0, 0.0), (0.15, 0.0, 0.0))
    pivot, upper, lower = DrivenBody(), Rod(length, 0.005), Rod(length, 0.005)
    system = ns.System([pivot, upper, lower])
    system.joint(Hinge(second=ends[0]), pivot, upper, name="shoulder")
    system.joint(Hinge(first=ends[1], second=ends[0]), upper, lower, name="elbow")
    system.place(upper, position=(length / 2, 0.0, 0.0))
    system.place(lower, position=(3 * length / 2, 0.0, 0.0))
    solution = ns.simulate(system, 0.4)
    times = np.linspace(0.0, 0.35, 8)
    history = solution.history("position", "rotation", times=times, of=[upper, lower])
    figure, (axis,) = make_axes("Two rods on hinges")
    for i, time in enumerate(times.tolist()):
        shade = 0.25 + 0.75 * i / (len(times) - 1)
        for rod, colour in enumerate((_BLUE, _RED)):
            tips = history["position"][i, rod] + np.array(ends) @ history["rotation"][i, rod].T
            axis.plot(tips[:, 0], tips[:, 2], color=colour, linewidth=3.0, alpha=shade, solid_capstyle="round")
            axis.plot(tips[0, 0], tips[0, 2], "o", color="white", markeredgecolor="black", markersize=5)
        if i != 1:  # it would lie on the first label
            axis.annotate(
                f"{1e3 * time:.0f} ms", (tips[1, 0], tips[1, 2]), (5, -3), textcoords="offset points", fontsize=7
            )
    axis.set_xlim(-0.1, 0.75)
    axis.set_ylim(-0.65, 0.05)
    _equal(axis)
    axis.plot([], [], color=_BLUE, linewidth=3.0, label="upper rod")
    axis.plot([], [], color=_RED, linewidth=3.0, label="lower rod")
    axis.plot([], [], "o", color="white", markeredgecolor="black", markersize=5, label="hinge")
    axis.legend(frameon=False, fontsize=8, loc="lower right")
    figure.savefig(folder / "joints_chain.png", dpi=110)


def _mass(q: Any, out: Any, weight: float, length: float) -> None:
    out[0] = weight * length**2 / 3.0


def _force(t: float, q: Any, u: Any, out: Any, weight: float, length: float, damper: float, gravity_z: float) -> None:
    out[0] = 0.5 * weight * length * gravity_z * math.sin(q[0]) - damper * u[0]


def _potential(q: Any, weight: float, length: float, gravity_z: float) -> float:
    return 0.5 * weight * length * gravity_z * math.cos(q[0])


def _power(t: float, q: Any, u: Any, damper: float) -> float:
    return float(-damper * u[0] ** 2)


def _tip(q: Any, out: Any, length: float) -> None:
    out[0], out[2] = length * math.sin(q[0]), -length * math.cos(q[0])


def _tip_jacobian(q: Any, out: Any, length: float) -> None:
    out[0], out[2] = length * math.cos(q[0]), length * math.sin(q[0])


def _tip_bias(q: Any, u: Any, out: Any, length: float) -> None:
    out[0], out[2] = -length * math.sin(q[0]) * u[0] ** 2, length * math.cos(q[0]) * u[0] ** 2


def mechanism(folder: Path) -> None:
    """A pendulum whose tip strikes a floor, and the height of the tip over time."""
    length, level = 0.5, -0.45
    pendulum = GeneralisedBody(
        coordinates=(Coordinate("angle", "rad", start=1.2),),
        mass=_mass,
        force=_force,
        potential=_potential,
        power=_power,
        moving_frames=(PointFrame(_tip, _tip_jacobian, _tip_bias, carried=(Point(),)),),
        constants={"weight": 1.0, "length": length, "damper": 0.01},
    )
    floor = Plate(Rest(position=(0.0, 0.0, level)))
    system = ns.System([pendulum, floor])
    system.contact(pendulum, floor, normal=Unilateral(), friction=Coulomb(0.2), impact=EnergeticImpact(0.5))
    solution = ns.simulate(system, 1.0)
    figure, (left, right) = make_axes("A pendulum of one coordinate strikes a floor", 2)
    first = solution.events.time[1]
    times = np.linspace(0.0, first, 7)
    tips = solution.history("position", times=times, of=pendulum)["position"][:, 0]
    for i, (x, _, z) in enumerate(tips.tolist()):
        left.plot([0.0, x], [0.0, z], color=_BLUE, linewidth=2.5, alpha=0.25 + 0.75 * i / (len(times) - 1))
    left.plot(tips[:, 0], tips[:, 2], ".", color=_RED, label="tip")
    left.plot(0.0, 0.0, "o", color="white", markeredgecolor="black", label="pivot")
    left.axhline(level, color=_GROUND, linewidth=2.0, label="floor")
    left.set_xlim(-0.1, 0.55)
    left.set_ylim(-0.55, 0.05)
    _equal(left)
    left.legend(frameon=False, fontsize=8, loc="upper right")
    times = np.linspace(0.0, 1.0, 1000)
    height = solution.history("position", times=times, of=pendulum)["position"][:, 0, 2] - level
    right.plot(times, 1e3 * height, color=_BLUE)
    struck = solution.events.time[[cause == "impact" for cause in solution.events.causes()]]
    right.plot(struck, np.zeros(len(struck)), "|", color=_RED, markersize=12, label="impact")
    right.set_xlabel("time [s]")
    right.set_ylabel("height of the tip [mm]")
    right.legend(frameon=False, fontsize=8)
    figure.savefig(folder / "mechanism_pendulum.png", dpi=110)


def mesh(folder: Path) -> None:
    """A ball that falls onto a mesh of the shape of an L, with its two contacts at rest."""
    outline = ((0.0, 0.0), (0.06, 0.0), (0.06, 0.01), (0.01, 0.01), (0.01, 0.04), (0.0, 0.04))
    caps = ((0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5))
    points = [(x, y, z) for y in (-0.01, 0.01) for x, z in outline]
    faces: list[Sequence[int]] = [*caps, *((a + 6, c + 6, b + 6) for a, b, c in caps)]
    for i in range(6):
        j = (i + 1) % 6
        faces += [(i, j + 6, j), (i, i + 6, j + 6)]
    shelf = DrivenBody(Rest(slope=-0.2), (TriangleMesh(Triangles(points, faces, "L")),))
    ball = Ball(0.005, 7800.0)
    system = ns.System([shelf, ball])
    system.contact(shelf, ball, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.4))
    system.place(ball, position=(0.03, 0.0, 0.05))
    solution = ns.simulate(system, 1.5)
    end = solution.history("contact_point", "contact_normal", "normal_force", times=1.5)
    shape = solution.history("position", "rotation", times=1.5, of=shelf)
    path = solution.history("position", times=np.linspace(0.0, 1.5, 3000), of=ball)["position"][:, 0]
    corners = shape["position"][0] + np.array([(x, 0.0, z) for x, z in outline]) @ shape["rotation"][0].T
    figure, (axis,) = make_axes("A ball in the inner corner of a mesh")
    axis.fill(1e3 * corners[:, 0], 1e3 * corners[:, 2], color="0.85", edgecolor=_GROUND, label="mesh")
    axis.plot(1e3 * path[:, 0], 1e3 * path[:, 2], color=_BLUE, linewidth=0.9, label="path of the centre")
    turn = np.linspace(0.0, 2.0 * math.pi, 200)
    axis.fill(1e3 * (path[-1, 0] + 0.005 * np.cos(turn)), 1e3 * (path[-1, 2] + 0.005 * np.sin(turn)), alpha=0.35)
    for contact in range(2):
        at, normal = 1e3 * end["contact_point"][contact, 1], end["contact_normal"][contact]
        axis.plot(at[0], at[2], "o", color=_RED, markersize=4, zorder=4)
        tip = at + 11.0 * normal
        arrow = {"arrowstyle": "->", "color": _RED, "linewidth": 1.6}
        axis.annotate("", (tip[0], tip[2]), (at[0], at[2]), arrowprops=arrow)
        axis.annotate(
            f"contact {contact + 1}", (tip[0], tip[2]), (3, 2 - 9 * contact), textcoords="offset points", fontsize=8
        )
    axis.set_aspect("equal")
    axis.set_xlabel("x [mm]")
    axis.set_ylabel("z [mm]")
    axis.legend(frameon=False, fontsize=8, loc="upper right")
    figure.savefig(folder / "mesh_contacts.png", dpi=110)


def export(folder: Path) -> None:
    """The moving picture that the page on exports writes."""
    plate, ball = Plate(), Ball(0.02)
    system = ns.System([plate, ball])
    system.contact(ball, plate, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.7))
    system.place(ball, position=(0.0, 0.0, 0.12), velocity=(0.3, 0.0, 0.0))
    ns.simulate(system, 0.8).export(folder / "export_ball.webp", view="front", speed=0.5, size=320)


def feet(folder: Path) -> None:
    """A cylinder on its feet: a face from below, flat on a plane, and tilted until the rim touches."""
    radius, length, height = 1.0, 1.3, 0.08  # as high as is allowed, to be seen
    figure, (below, flat, tilted) = make_axes("The three feet of a flat face (height exaggerated)", 3)
    turn = np.linspace(0.0, 2.0 * math.pi, 200)
    circle = 2.0 / 3.0 * radius
    below.fill(radius * np.cos(turn), radius * np.sin(turn), color="0.85", edgecolor=_GROUND)
    below.plot(circle * np.cos(turn), circle * np.sin(turn), "--", color=_GROUND, linewidth=0.8)
    for angle in (0.0, 2.0 / 3.0 * math.pi, 4.0 / 3.0 * math.pi):
        below.plot(circle * math.cos(angle), circle * math.sin(angle), "o", color=_RED, markersize=8)
    below.annotate(r"$\frac{2}{3} R$", (0.3, 0.06), fontsize=10)
    below.plot([0.0, circle], [0.0, 0.0], color=_GROUND, linewidth=0.8)
    below.set_title("face from below", fontsize=9)
    # a side view across a foot at +2 R / 3; the two others are at -R / 3
    outline = np.array([(-radius, height), (radius, height), (radius, length), (-radius, length)])
    tips = [(circle, 0.0), (-0.5 * circle, 0.0)]
    angle = math.atan(3.0 * height / radius)
    turned = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    lowest = min(float((turned @ tip)[1]) for tip in (*tips, (radius, height)))
    for axis, rotation, lift in ((flat, np.eye(2), 0.0), (tilted, turned, -lowest)):
        body = outline @ rotation.T + (0.0, lift)
        axis.fill(body[:, 0], body[:, 1], color="0.85", edgecolor=_GROUND)
        for x, _ in tips:
            foot = np.array([(x - 0.06, height), (x, 0.0), (x + 0.06, height)]) @ rotation.T + (0.0, lift)
            axis.fill(foot[:, 0], foot[:, 1], color=_RED)
        axis.axhline(0.0, color=_GROUND, linewidth=2.0)
    flat.annotate("", (1.12, 0.0), (1.12, height), arrowprops={"arrowstyle": "<->", "shrinkA": 0, "shrinkB": 0})
    flat.annotate("$b$", (1.17, 0.04), fontsize=10, va="center")
    flat.set_title("flat: on the feet", fontsize=9)
    tilted.set_title(r"$\tan(\mathrm{tilt}) = 3 b / R$: rim and foot touch", fontsize=9)
    for axis in (below, flat, tilted):
        axis.set_aspect("equal")
        axis.set_axis_off()
    for axis in (flat, tilted):
        axis.set_xlim(-1.4, 1.4)
        axis.set_ylim(-0.15, 1.75)
    figure.savefig(folder / "body_feet.png", dpi=90)


def main() -> None:
    """Save the figures in the folder given."""
    folder = Path(sys.argv[1])
    for draw in (joints, mechanism, mesh, export, feet):
        draw(folder)


if __name__ == "__main__":
    main()
