"""Balls of steel and rubber in an open box: ``python -m tests.benchmarks.mixed_balls [VARIANT ...] [--seeds N]``.

Half of the balls (10 mm) are of steel and half of rubber, with laws by pair of materials: friction 0.15 to 0.8 and
restitution 0.5 to 0.9.  They start at random places, some next to the walls, at random velocities, and have 4 s to come
to rest.  A variant gives all contacts one coefficient of friction, or another impact law, or is a narrower box with so
many balls; all variants run by default.  A line a variant: how many seeds ended, how many of them at rest, and the
longest run [s], and what weight the forces of those at rest leave unbalanced, relative to a ball's, by a solver that is
not the engine's; every seed that did not end is listed with its reason.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from typing import cast

import numpy as np
from numpy.typing import NDArray

import nonsmooth as ns
from bodies import Ball, Plate, Rest
from laws import Coulomb, EnergeticImpact, Frictionless, MoreauImpact, NewtonImpact, PoissonImpact, Unilateral
from nonsmooth.interfaces import Body, FrictionLaw, ImpactLaw
from scenarios.ball_box import _TURNS
from tests.benchmarks import pile

RADIUS = 0.01
DENSITY = {"steel": 7800.0, "rubber": 1100.0}
FRICTION = {("steel", "steel"): 0.15, ("rubber", "steel"): 0.5, ("rubber", "rubber"): 0.8}
RESTITUTION = {("steel", "steel"): 0.9, ("rubber", "steel"): 0.7, ("rubber", "rubber"): 0.5}
T_END = 4.0
LIMIT = 20.0
"""A run that takes longer, in processor time, counts as one that does not end [s]."""
_AT_REST = 1e-6
"""Speed of centres that counts as rest [m/s]; balls may spin about the vertical for ever."""

Impact = Callable[[float], ImpactLaw]


def _variants() -> Mapping[str, tuple[float, int, float | None, Impact]]:
    """Width of the box [m], number of balls, the friction of all, the impact law."""
    named: dict[str, tuple[float, int, float | None, Impact]] = {
        "mixed": (0.1, 10, None, EnergeticImpact),
        "mu=0.8": (0.1, 10, 0.8, EnergeticImpact),
        "mu=0.5": (0.1, 10, 0.5, EnergeticImpact),
        "frictionless": (0.1, 10, 0.0, EnergeticImpact),
        "newton": (0.1, 10, None, NewtonImpact),
        "moreau": (0.1, 10, None, MoreauImpact),
        "poisson": (0.1, 10, None, PoissonImpact),
    }
    for width in (52, 70, 100):
        for n in (6, 8, 10):
            named[f"{width}mm-{n}"] = (1e-3 * width, n, None, EnergeticImpact)
    return named


VARIANTS = _variants()


def build(variant: str, seed: int) -> ns.System:
    """Return the box and its balls at their start."""
    width, n, friction, impact = VARIANTS[variant]
    rng = np.random.default_rng(seed)
    half = 0.5 * width
    sides = ((-half, 0.0, 0.0), (half, 0.0, 0.0), (0.0, -half, 0.0), (0.0, half, 0.0))
    box = [Plate(), *(Plate(Rest(position=p, orientation=q)) for p, q in zip(sides, _TURNS, strict=True))]
    kinds = ["steel" if i % 2 == 0 else "rubber" for i in range(n)]
    balls = [Ball(RADIUS, DENSITY[kind]) for kind in kinds]
    system = ns.System([*box, *balls], 9.81)

    def touch(first: Body, second: Body, *materials: str) -> None:
        pair = min(materials), max(materials)
        mu = FRICTION[pair] if friction is None else friction
        rub: FrictionLaw = Coulomb(mu) if mu > 0.0 else Frictionless()
        system.contact(first, second, normal=Unilateral(), friction=rub, impact=impact(RESTITUTION[pair]))

    a_side = min(int(width / (2.2 * RADIUS)), 3)
    cell = width / a_side
    # the box is of rubber
    for i, ball in enumerate(balls):
        for wall in box:
            touch(wall, ball, "rubber", kinds[i])
        for j in range(i):
            touch(balls[j], ball, kinds[j], kinds[i])
        layer, place = divmod(i, a_side**2)
        free = np.array([cell - 2.0 * RADIUS, cell - 2.0 * RADIUS, 0.5 * RADIUS])
        centre = np.array(
            [
                (place // a_side + 0.5) * cell - half,
                (place % a_side + 0.5) * cell - half,
                0.02 + RADIUS + 2.6 * RADIUS * layer,
            ]
        )
        start = centre + rng.uniform(-0.49, 0.49, 3) * free
        system.place(ball, position=tuple(start), velocity=tuple(rng.uniform(-0.5, 0.5, 3)))
    return system


def planes(variant: str) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Return a point and the normal of the floor and the walls."""
    width = VARIANTS[variant][0]
    inwards = np.array([(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0)])
    return [(np.zeros(3), np.array([0.0, 0.0, 1.0])), *((-0.5 * width * i, i) for i in inwards)]


def unbalanced(variant: str, centres: NDArray[np.float64]) -> float:
    """Return what forces inside the cones leave of the balls' weights, relative to the largest."""
    _, n, friction, _ = VARIANTS[variant]
    kinds = [*("steel" if i % 2 == 0 else "rubber" for i in range(n)), "rubber"]

    def rub(i: int, j: int) -> float:
        return FRICTION[min(kinds[i], kinds[j]), max(kinds[i], kinds[j])] if friction is None else friction

    masses = np.array([DENSITY[kind] * 4.0 / 3.0 * np.pi * RADIUS**3 for kind in kinds[:n]])
    return pile.unbalanced(pile.touches(centres, RADIUS, planes(variant), rub), RADIUS, masses, 9.81)


def run(variant: str, seed: int) -> tuple[str, float, float, float, int, float]:
    """Return why the run ended, processor time, time [s], greatest speed of a centre [m/s], events, what is unbalanced.

    The last is 0 where the balls are not at rest.
    """
    warnings.simplefilter("ignore")
    model = ns.assemble(build(variant, seed))
    began = time.process_time()
    try:
        solution = model.run(T_END, sample_interval=1e-2, until=partial(_too_long, began))
        reason = "at the end" if solution.t_end == T_END else "too long"
    except ns.RunFailed as error:
        solution = cast(ns.Solution, error.solution)
        reason = solution.message
    wall = time.process_time() - began
    states = [solution.of(ball) for ball in model.system.bodies if isinstance(ball, Ball)]
    speed = max(float(np.linalg.norm(u[-1, :3])) for _, u in states)
    left = unbalanced(variant, np.array([q[-1, :3] for q, _ in states])) if speed <= _AT_REST else 0.0
    return reason, wall, solution.t_end, speed, len(solution.events.time), left


def _too_long(began: float, _so_far: object) -> bool:
    return time.process_time() - began > LIMIT


def main() -> None:
    """Run the variants and print a line of each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("variants", nargs="*", default=[*VARIANTS])
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args()
    seeds = range(given.first, given.first + given.seeds)
    with ProcessPoolExecutor(given.workers) as pool:
        for variant in given.variants:
            rows = list(pool.map(partial(run, variant), seeds))
            ended = [row for row in rows if row[0] == "at the end"]
            rests = sum(row[3] <= _AT_REST for row in ended)
            unheld = f", {max(row[5] for row in rows):.0e} of a weight unbalanced" if rests > 0 else ""
            longest = max(row[1] for row in rows)
            print(
                f"{variant:14}{len(ended):3d} of {len(rows)} ended, {rests} at rest{unheld}, {longest:6.1f} s",
                flush=True,
            )
            for seed, row in zip(seeds, rows, strict=True):
                if row[0] != "at the end":
                    print(
                        f"    seed {seed}: {row[0]} at {row[2]:.4f} s after {row[1]:.1f} s, {row[4]} events", flush=True
                    )


if __name__ == "__main__":
    main()
