"""A campaign: many cases in worker processes, kept as they come, with a table and small scripts of what is wrong."""

from __future__ import annotations

import argparse
import collections
import json
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from bodies import Ball, DiscBody
from laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth import ContactLaws
from tests.benchmarks.random_systems.case import Case, Start
from tests.benchmarks.random_systems.minimise import minimise
from tests.benchmarks.random_systems.pool import spread
from tests.benchmarks.random_systems.run import Outcome, run

_REPEATED = 20
"""Every so many-th case is run twice."""
_EXAMPLES = 8
"""Numbers told of each cause."""
_ENDS = ("refused", "done", "failed", "time-out", "hang", "crash", "exception")


def work(what: str, case_of: Callable[[int], Case], seed: int, seconds: float, script: Path) -> Outcome:
    """Run the case of a number, or make it smaller and write it as a script; called in a worker process."""
    warnings.simplefilter("ignore")
    case = case_of(seed)
    outcome = run(case, seconds, repeat=seed % _REPEATED == 0)
    if what == "minimise":

        def write(smaller: Case) -> None:
            lines = [f"Random system {seed}: {outcome.end} {outcome.message}".strip(), *outcome.found]
            ends = run(smaller, seconds)
            lines += ["", f"as it stands here: {ends.end} {ends.message}".strip(), *ends.found]
            script.write_text(smaller.script("\n".join(lines).replace('"""', "'''")), encoding="utf-8")

        write(case)
        minimise(case, outcome, 10.0 * seconds, write)
    return outcome


def _load() -> None:
    """Compile what is not in the cache yet, engine and checks, before the time of any process runs."""
    balls = Ball(0.01), Ball(0.01), DiscBody(0.01)
    laws = ContactLaws(Unilateral(), Frictionless(), EnergeticImpact(0.5))
    starts = tuple(Start("place", (("position", (0.0, 0.0, z)),)) for z in (0.0, 0.03, 0.06))
    run(Case(balls, starts, ((0, 1, laws), (1, 2, laws)), (), 9.81, 1e-3))


@dataclass(frozen=True)
class Draws:
    """Which system belongs to a number, and of which family it is."""

    case_of: Callable[[int], Case]
    family_of: Callable[[int], str]


def _kept(path: Path) -> dict[int, Outcome]:
    rows = {}
    if path.is_file():
        for line in path.read_text(encoding="utf-8").splitlines():
            row = json.loads(line)
            seed = row.pop("seed")
            del row["family"]
            rows[seed] = Outcome(**{**row, "found": tuple(row["found"])})
    return rows


def collect(draws: Draws, seeds: range, workers: int, seconds: float, folder: Path) -> dict[int, Outcome]:
    """Run the seeds that the folder has no result of yet, and return all results of the range."""
    folder.mkdir(parents=True, exist_ok=True)
    _load()
    path = folder / "results.jsonl"
    kept = _kept(path)
    tasks = (("run", draws.case_of, seed, seconds, folder) for seed in seeds if seed not in kept)
    last = time.monotonic()
    with path.open("a", encoding="utf-8") as file:
        for (_, _, seed, *_), word, value in spread(work, tasks, workers, 10.0 * seconds + 120.0):
            kept[seed] = value if word == "back" else Outcome(word, seconds=seconds)
            row = {"seed": seed, "family": draws.family_of(seed), **kept[seed].row()}
            print(json.dumps(row), file=file, flush=True)
            if time.monotonic() - last > 10.0:
                last = time.monotonic()
                counts = collections.Counter(o.end for o in kept.values())
                wrong = sum(o.silent for o in kept.values())
                print(f"{len(kept)} cases: {dict(counts)}, silently wrong {wrong}", file=sys.stderr, flush=True)
    return {seed: kept[seed] for seed in seeds if seed in kept}


def _some(seeds: list[int]) -> str:
    return ", ".join(map(str, seeds[:_EXAMPLES]))


def _counts(families: dict[str, dict[int, Outcome]]) -> Iterator[str]:
    """Yield the lines of the table of ends by family."""
    ends = [*_ENDS, *sorted({o.end for rows in families.values() for o in rows.values()} - set(_ENDS))]
    yield f"| family | systems | {' | '.join(ends)} | **wrong in silence** | mean time [s] |"
    yield f"|{' --- |' * (len(ends) + 4)}"
    for family, rows in families.items():
        counts = collections.Counter(o.end for o in rows.values())
        silent, mean = sum(o.silent for o in rows.values()), sum(o.seconds for o in rows.values()) / len(rows)
        numbers = " | ".join(str(counts[end]) for end in ends)
        yield f"| {family} | {len(rows)} | {numbers} | **{silent}** | {mean:.2f} |"


def _causes(rows: dict[int, Outcome]) -> Iterator[tuple[str, str, list[int]]]:
    """Yield how systems end, why, and their numbers: those that are wrong first, then by end."""
    for name, done in (("done, wrong in silence", True), ("not done, and wrong in what was computed", False)):
        kinds: dict[str, list[int]] = collections.defaultdict(list)
        for seed, o in rows.items():
            if o.found and (o.end == "done") == done:
                for kind in {text.split(":")[0] for text in o.found}:
                    kinds[kind].append(seed)
        yield from ((name, kind, seeds) for kind, seeds in sorted(kinds.items(), key=lambda row: -len(row[1])))
    causes: dict[tuple[str, str], list[int]] = collections.defaultdict(list)
    for seed, o in rows.items():
        if o.end != "done":
            causes[o.end, o.cause].append(seed)
    yield from ((end, cause, seeds) for (end, cause), seeds in sorted(causes.items(), key=lambda row: -len(row[1])))


def table(outcomes: dict[int, Outcome], family_of: Callable[[int], str]) -> Iterator[str]:
    """Yield the lines of two tables: ends by family, and causes by family with the first numbers of each."""
    families: dict[str, dict[int, Outcome]] = collections.defaultdict(dict)
    for seed, outcome in outcomes.items():
        families[family_of(seed)][seed] = outcome
    yield from _counts(families)
    yield ""
    yield "| family | end | cause | systems | for example |"
    yield "| --- | --- | --- | --- | --- |"
    for family, rows in families.items():
        for end, cause, seeds in _causes(rows):
            yield f"| {family} | {end} | {cause} | {len(seeds)} | {_some(seeds)} |"


def _worth(outcomes: dict[int, Outcome], most: int) -> list[int]:
    """Return which cases are made smaller: of each way to end the first ones, the wrong ones first."""
    bad = [
        (not o.silent, o.kind, seed)
        for seed, o in outcomes.items()
        if o.found or o.end not in ("done", "refused", "hang", "crash")
    ]
    counts: collections.Counter[str] = collections.Counter()
    chosen = []
    for _, kind, seed in sorted(bad):
        counts[kind] += 1
        if counts[kind] <= most:
            chosen.append(seed)
    return chosen


def parser_of(description: str | None) -> argparse.ArgumentParser:
    """Return the parser of the arguments that all campaigns have."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first", type=int, help="number of the first system")
    parser.add_argument("count", type=int, help="how many")
    parser.add_argument("--workers", type=int, default=2, help="processes")
    parser.add_argument("--seconds", type=float, default=20.0, help="processor time of a system [s]")
    parser.add_argument("--out", type=Path, default=Path("random_systems"), help="folder of results and scripts")
    parser.add_argument("--minimise", type=int, default=2, help="scripts written of each way to end badly; 0 for none")
    return parser


def campaign(draws: Draws, given: argparse.Namespace) -> None:
    """Run the systems that the command line asks for, and print the tables."""
    seeds = range(given.first, given.first + given.count)
    outcomes = collect(draws, seeds, given.workers, given.seconds, given.out)
    scripts = {seed: given.out / f"system_{seed}.py" for seed in _worth(outcomes, given.minimise)}
    tasks = [
        ("minimise", draws.case_of, seed, given.seconds, path) for seed, path in scripts.items() if not path.exists()
    ]
    for (_, _, seed, *_), word, _ in spread(work, tasks, given.workers, 25.0 * given.seconds + 60.0):
        print(f"{seed}: {scripts[seed]} {'' if word == 'back' else word}", file=sys.stderr, flush=True)
    lines = "\n".join(table(outcomes, draws.family_of))
    (given.out / "table.md").write_text(lines + "\n", encoding="utf-8")
    print(lines)
