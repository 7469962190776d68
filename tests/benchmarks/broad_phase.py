"""What the search for near pairs costs: the tree of FCL from Python, beside the compiled sweep of the engine.

    pip install '.[full]' && python -m tests.benchmarks.broad_phase

Printed are, for 200 and 1000 balls at random places that move on between two searches, the number of pairs of boxes
that overlap, and least and median milliseconds of a search: by the tree (groups made, tree built, pairs of groups
collected, bodies compared), by numpy over all pairs, and by the engine's list (sorted balls; its own bodies evaluated
and the contacts of pairs that are near put into slots), which runs compiled between two steps.
"""

from __future__ import annotations

import itertools
import statistics
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

import nonsmooth as ns
from bodies import Ball
from bodies.fcl.broad_phase import BroadPhase
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.kernel import call_room
from nonsmooth.model.assembly import assemble

RADIUS, MARGIN = 0.02, 0.005
REPETITIONS = 30
CASES = ((200, 0.3), (1000, 0.5), (1000, 0.25))
"""Number of balls, half-length of the cube that they are in [m]."""

Places = NDArray[np.float64]


def _timed(task: Callable[[Places], object], places: Places) -> tuple[float, float]:
    """Return least and median time of a search [ms], the places moved on before each."""
    rng, seconds = np.random.default_rng(1), []
    for _ in range(REPETITIONS):
        places = places + rng.normal(0.0, 1e-3, places.shape)
        began = time.perf_counter()
        task(places)
        seconds.append(time.perf_counter() - began)
    return 1e3 * min(seconds), 1e3 * statistics.median(seconds)


def _by_numpy(places: Places) -> object:
    near = np.all(np.abs(places[:, None] - places[None]) <= 2.0 * (RADIUS + MARGIN), axis=2)
    return np.nonzero(np.triu(near, 1))


def _by_list(n: int) -> Callable[[Places], object]:
    """Return the engine's search; of the pairs only neighbours in number have contacts, but all are looked at."""
    balls = [Ball(RADIUS) for _ in range(n)]
    system = ns.System(balls)
    laws = {"normal": Unilateral(), "friction": Coulomb(0.3), "impact": EnergeticImpact(0.5)}
    for one, two in itertools.pairwise(balls):
        system.contact(one, two, **laws)  # type: ignore[arg-type]
    for ball, place in zip(balls, np.arange(3.0 * n).reshape(-1, 3), strict=True):
        system.place(ball, position=tuple(place.tolist()))
    model = assemble(system, ns.Options())
    scalars = model.memory.scalars
    scalars["margin_of_list"] = 2.0 * MARGIN
    state = model.memory.array("y", 13 * n)

    def search(places: Places) -> object:
        state[: 7 * n].reshape(n, 7)[:, :3] = places
        return call_room("list_contacts", model.memory)

    return search


def main() -> None:
    """Measure and print."""
    print(f"{'balls':>6}{'pairs':>7}{'tree':>9}{'median':>9}{'numpy':>9}{'median':>9}{'list':>9}{'median':>9}  [ms]")
    for n, half in CASES:
        places = np.random.default_rng(0).uniform(-half, half, (n, 3))
        tree = BroadPhase(np.full(n, RADIUS), MARGIN)
        line = f"{n:6d}{len(tree.pairs(places)):7d}"
        for task in (tree.pairs, _by_numpy, _by_list(n)):
            line += "".join(f"{value:9.3f}" for value in _timed(task, places))
        print(line, flush=True)


if __name__ == "__main__":
    main()
