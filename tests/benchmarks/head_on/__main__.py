"""Marks of pairs of bodies that meet head on.

    python -m tests.benchmarks.head_on [--seed S --count N --only "NAME;NAME" --impact-tolerance T --verbose]

runs N drawn meetings of every pair.  The first body flies along one of its axes.  The second one is at rest, shifted
across by 0 to 5 mm and turned about the line by 0 to a quarter turn.  The speed is 0.1, 1 or 10 m/s.  Of two meetings
one has another orientation of the world.  Each run has a mark: . right, X passed through each other, F failed, ~ wrong
speed, time or momentum.  A run that is not right is listed with the reason.
"""

import argparse
import collections

import nonsmooth as ns
from tests.benchmarks.head_on.meeting import MARKS, drawn, meet
from tests.benchmarks.head_on.pairs import PAIRS


def main() -> None:
    """Run the meetings that the command line asks for, and print their marks."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1, help="seed of the draws")
    parser.add_argument("--count", type=int, default=20, help="meetings of every pair")
    parser.add_argument("--only", help="names of pairs, with semicolons between them")
    parser.add_argument("--impact-tolerance", type=float, default=1e-8, help="of the engine")
    parser.add_argument("--verbose", action="store_true", help="also print the runs that are right")
    given = parser.parse_args()
    engine = ns.EventDriven(impact_tolerance=given.impact_tolerance)
    counts: collections.Counter[str] = collections.Counter()
    for name in PAIRS if given.only is None else given.only.split(";"):
        rows = [(meeting := drawn(name, k, given.seed), meet(meeting, engine)) for k in range(given.count)]
        marks = "".join(verdict.mark for _, verdict in rows)
        print(f"{name:22} {marks} {sum(verdict.seconds for _, verdict in rows):.1f} s", flush=True)
        for k, (meeting, verdict) in enumerate(rows):
            if verdict.mark != "." or given.verbose:
                pose = f"axis {meeting.axis} shift {meeting.shift} turn {meeting.turn:g} v {meeting.speed:g}"
                print(f"    {k:3} {verdict.mark} {pose} u2/v {verdict.speed:.10g} {verdict.reason[:170]}", flush=True)
        counts.update(marks)
    print(", ".join(f"{words} {counts[mark]}" for mark, words in MARKS.items()), f"of {counts.total()}")


if __name__ == "__main__":
    main()
