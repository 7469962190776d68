"""Draw the moving pictures of README and first page: ``python docs/wall_pictures.py docs/pages/figures [NAME ...]``.

Names are those of ``PICTURES``: six systems of the wall, and the run of the ten lines.  Each picture is written as
``wall_NAME.webp``, some 240 pixels wide and smaller than 250 kB.  The pictures of the gallery are stills; these move.
"""

from __future__ import annotations

import itertools
import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from nonsmooth.scenarios.dice_throw import DiceThrow
from nonsmooth.scenarios.dumbbell import DumbbellScenario
from nonsmooth.scenarios.polyhedron_stack import PolyhedronStack
from nonsmooth.scenarios.tippe_top import TippeTop
from nonsmooth.scenarios.woodpecker import Woodpecker

import nonsmooth as ns
from nonsmooth.bodies import Ball, DrivenBody, Hinge, OpenBox
from nonsmooth.laws import Coulomb, EnergeticImpact, Frictionless, Unilateral

SIZE = 240
"""Longer side of a picture [pixels]."""
_SAMPLES_PER_SECOND_WATCHED = 200
"""Bodies move along straight lines between samples; these are finer than the pictures."""


@dataclass(frozen=True)
class Picture:
    """A system, its run, and how it is watched.

    Attributes
    ----------
    system : callable
        Makes the system with its start.
    t_end : float
        End time of the run [s].
    speed : float
        Time of the run that passes in one second watched [1].
    view : str
        "corner", "front", "side" or "top".
    frames_per_second : float
        Pictures in one second watched [1/s].
    """

    system: Callable[[], ns.System]
    t_end: float
    speed: float
    view: str = "corner"
    frames_per_second: float = 20.0


def cradle() -> ns.System:
    """Five balls on rods without mass; the first one is raised by 40 degrees."""
    radius, length, raised = 0.01, 0.08, math.radians(40.0)
    balls, frame = [Ball(radius) for _ in range(5)], DrivenBody()
    system = ns.System([frame, *balls])
    for i, ball in enumerate(balls):
        x, angle = 2.0 * radius * (i - 2), raised if i == 0 else 0.0
        system.joint(Hinge(first=(x, 0.0, 0.0), second=(0.0, 0.0, length)), frame, ball)
        system.place(
            ball,
            position=(x - length * math.sin(angle), 0.0, -length * math.cos(angle)),
            orientation=ns.turned_about((0.0, 1.0, 0.0), angle),
        )
    for one, two in itertools.pairwise(balls):
        system.contact(one, two, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(1.0))
    return system


def ten_lines() -> ns.System:
    """Two balls in an open box, the example of the README."""
    box, first, second = OpenBox(0.1, 0.1), Ball(0.02), Ball(0.02)
    system = ns.System([box, first, second])
    system.contact_all(ns.ContactLaws(normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.8)))
    system.place(first, position=(-0.04, 0.0, 0.2), velocity=(0.6, 0.1, 0.0))
    system.place(second, position=(0.04, 0.01, 0.1))
    return system


PICTURES = {
    "cradle": Picture(cradle, t_end=0.59, speed=0.2, view="front"),
    "dice": Picture(DiceThrow(speed=0.3, spin=25.0).build, t_end=0.5, speed=0.15),
    "dumbbell": Picture(DumbbellScenario(mode="drift").build, t_end=0.2, speed=0.08),
    "tippe_top": Picture(TippeTop().build, t_end=2.4, speed=0.8, view="side"),
    "woodpecker": Picture(Woodpecker().build, t_end=0.292, speed=0.1, view="front"),
    "tower": Picture(PolyhedronStack().build, t_end=0.09, speed=0.03),
    "ten_lines": Picture(ten_lines, t_end=1.2, speed=0.4),
}


def draw(name: str, folder: Path) -> Path:
    """Run a system and write its picture; returns the path."""
    picture = PICTURES[name]
    interval = picture.speed / _SAMPLES_PER_SECOND_WATCHED
    solution = ns.simulate(picture.system(), picture.t_end, sample_interval=interval)
    return solution.export(
        folder / f"wall_{name}.webp",
        view=picture.view,
        speed=picture.speed,
        frames_per_second=picture.frames_per_second,
        size=SIZE,
    )


def main() -> None:
    """Draw the pictures named, or all, into the folder given."""
    folder, *names = sys.argv[1:]
    for name in names or PICTURES:
        path = draw(name, Path(folder))
        print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
