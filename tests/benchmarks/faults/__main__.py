"""What the tests find: plants faults in a copy of a tree, one at a time, and runs the tests on each.

    python -m tests.benchmarks.faults --out FILE [--tree FOLDER] [--seed N] [--count N] [--name TIER] -- WORDS OF PYTEST

writes a line of JSON for each fault to FILE and continues where it was interrupted.  A fault that FILE calls found is
not tried again, by any tier, so that a second tier is asked only what the first one missed.  The words choose the tests
(``tests/laws``, ``-m slow``); ``-x`` is added.

With ``--together`` all faults that are left are planted at once, and the tests run to their end: if none fails, none of
the faults is found.  Otherwise each fault is tried alone with the tests that failed, and the rest is planted again.
One run of a long tier so answers for many faults that it does not find.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from tests.benchmarks.faults.draw import Fault, draw
from tests.benchmarks.faults.trial import Trial, run


def _rows(path: Path) -> list[dict[str, object]]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []


def _write(path: Path, fault: Fault, name: str, trial: Trial) -> None:
    row = {
        "fault": str(fault),
        "tier": name,
        "found": trial.fails,
        "by": trial.failed[:3],
        "seconds": round(trial.seconds, 1),
    }
    with path.open("a", encoding="utf-8") as file:
        print(json.dumps(row), file=file)
    print(f"{'found' if trial.fails else 'NOT FOUND'} in {trial.seconds:.0f} s: {fault} {' '.join(trial.failed[:1])}")
    sys.stdout.flush()


def _one_by_one(tree: Path, faults: list[Fault], words: list[str], out: Path, name: str) -> None:
    for fault in faults:
        _write(out, fault, name, run(tree, [fault], ["-x", *words]))


def _together(tree: Path, faults: list[Fault], words: list[str], out: Path, name: str) -> None:
    left = list(faults)
    while left:
        all_of_them = run(tree, left, words)
        print(f"{len(left)} faults together: {len(all_of_them.failed)} tests fail in {all_of_them.seconds:.0f} s")
        found = []
        for fault in left if all_of_them.fails else []:
            alone = run(tree, [fault], ["-x", *(all_of_them.failed or words)])
            if alone.fails:
                found.append(fault)
                _write(out, fault, name, alone)
        left = [fault for fault in left if fault not in found]
        if not found:
            for fault in left:
                _write(out, fault, name, Trial(False, [], all_of_them.seconds))
            return


def main() -> None:
    """Plant, run and tell what the tests found."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tree", type=Path, default=Path(), help="folder of the project, of this or another commit")
    parser.add_argument("--seed", type=int, default=1, help="of the draw")
    parser.add_argument("--count", type=int, default=60, help="how many faults")
    parser.add_argument("--area", default="", help="try only the faults of this folder, such as laws")
    parser.add_argument("--name", default="tests", help="name of the tier")
    parser.add_argument("--out", type=Path, required=True, help="file of results")
    parser.add_argument("--together", action="store_true", help="plant all that are left at once")
    parser.add_argument("words", nargs="*", help="arguments of pytest")
    given = parser.parse_args()
    faults = draw(given.tree, given.seed, given.count)
    done = {row["fault"] for row in _rows(given.out) if row["found"] or row["tier"] == given.name}
    left = [fault for fault in faults if str(fault) not in done and fault.file.startswith(given.area)]
    (_together if given.together else _one_by_one)(given.tree, left, given.words, given.out, given.name)
    rows = _rows(given.out)
    found = {row["fault"]: row["tier"] for row in rows if row["found"]}
    print(f"{len(found)} of {len(faults)} found")
    for tier in dict.fromkeys(row["tier"] for row in rows):
        print(f"{tier}: {sum(one == tier for one in found.values())}")


if __name__ == "__main__":
    main()
