"""Throws of three dice: ``python -m tests.benchmarks.dice_throws [--first N] [--last N] [--rounding MM]``.

Each runs for one second, unless it takes longer than the limit of processor time.  A line for every throw that does not
end, with reason, time and events, and a summary: how many ended, how many with all dice on a face, how many with
unbalanced books, and the five slowest.
"""

from __future__ import annotations

import argparse
import time
import warnings
from functools import partial
from typing import cast

import nonsmooth as ns
from scenarios.dice_throw import DiceThrow


def run(scenario: DiceThrow, limit: float) -> tuple[str, float, ns.Solution]:
    """Return why a throw ended, its processor time [s], and its solution."""
    model = ns.assemble(scenario.build())
    began = time.process_time()
    too_long = partial(_too_long, began + limit)
    try:
        solution = model.run(scenario.t_end, sample_interval=scenario.sample_interval, until=too_long)
        reason = "" if solution.t_end == scenario.t_end else "too long"
    except ns.RunFailed as error:
        solution = cast(ns.Solution, error.solution)
        reason = solution.message
    return reason, time.process_time() - began, solution


def _too_long(deadline: float, _so_far: object) -> bool:
    return time.process_time() > deadline


def main() -> None:
    """Run the throws and print those that do not end."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--last", type=int, default=59)
    parser.add_argument("--rounding", type=float, default=1.0, help="[mm]")
    parser.add_argument("--limit", type=float, default=40.0, help="processor time of a throw [s]")
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    spent: list[tuple[float, int]] = []
    ended = resting = unbalanced = 0
    for throw in range(given.first, given.last + 1):
        scenario = DiceThrow(throw=throw, rounding=1e-3 * given.rounding)
        reason, took, solution = run(scenario, given.limit)
        spent.append((took, throw))
        if reason:
            events = len(solution.events.time)
            print(f"throw {throw}: {reason} at {solution.t_end:.4f} s after {took:.1f} s, {events} events", flush=True)
            continue
        ended += 1
        resting += scenario.on_a_face(solution)
        unbalanced += not all(criterion.fulfilled for criterion in scenario.acceptance(solution))
    slowest = ", ".join(f"{throw} ({took:.1f} s)" for took, throw in sorted(spent, reverse=True)[:5])
    print(
        f"rounding {given.rounding} mm: {ended} of {len(spent)} ended, {resting} on faces, {unbalanced} not balanced, "
        f"{sum(took for took, _ in spent):.0f} s; slowest {slowest}",
        flush=True,
    )


if __name__ == "__main__":
    main()
