"""The report of a run: one object, as JSON or in words."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from operator import attrgetter
from typing import Any

import numpy as np

from nonsmooth.cli.report.table import lines
from nonsmooth.engine.memory.modes import LIMITS, Limit
from nonsmooth.solution.checks import closing_gain, contacts_without_body_check, friction_gain, impulses_beyond_cone
from nonsmooth.solution.modes import are_recorded, mode_shares
from nonsmooth.solution.solution import Solution

Report = dict[str, Any]
_LONG_WORD = 80
"""Largest number of characters of a mode word ("{01,00,01}") that is printed in full, so that it fits into a line."""
_NAMED = 2
"""Largest number of contacts that are named if a mode word, the bits of all contacts, is too long to be printed."""
_COMMONEST = 5
"""Largest number of mode words that are printed; the report gives the number of further mode words."""
_INSTANT = 5e-5
"""Share of the run's time below which a mode word gets no line, because the share would be printed as 0.00 %.

The last line of the list gives the number of these mode words.
"""
_ROUND_OFF = 1e-15
"""Numbers of smaller magnitude, in their SI units, are printed as 0, because they are round-off."""
_NOTHING = 1e-9
"""Numbers of a list below this size, relative to the largest number of the list, are printed as 0."""


def _verdict(solution: Solution) -> dict[str, Any]:
    measured = solution.end.verdict.items()
    return {one.name: {"value": value, "unit": one.unit, "meaning": one.meaning} for one, value in measured}


_NUMBERS: Mapping[str, Callable[[Solution], Any]] = {
    "t_end": attrgetter("t_end"),
    "wall_seconds": attrgetter("counters.wall_seconds"),
    "n_events": lambda solution: len(solution.events),
    "n_impacts": attrgetter("counters.impacts"),
    "n_steps": attrgetter("counters.steps"),
    "step_limits": lambda solution: dict(solution.counters.limits),
    "event_intervals": lambda solution: solution.events.intervals(),
    "contacts": lambda solution: list(solution.system.names.contacts),
    "unseen_contacts": lambda solution: list(contacts_without_body_check(solution)),
    "impulses_beyond_cone": lambda solution: int(np.count_nonzero(impulses_beyond_cone(solution))),
    "friction_gain": friction_gain,
    "closing_gain": closing_gain,
    "mode_words": lambda solution: mode_shares(solution) if are_recorded(solution) else None,
    "energy_residual": attrgetter("energy.residual"),
    "cause": attrgetter("end.cause"),
    "verdict": _verdict,
}
"""Entry of a report that comes from the solution -> function that computes the entry from the solution."""
UNITS = {"t_end": "s", "wall_seconds": "s", "friction_gain": "J", "closing_gain": "J"}
"""Entry of a report -> its SI unit. Entries from the solution that are not listed have no unit."""


def of_solution(solution: Solution | None) -> Report:
    """Return the entries of a report that come from a solution; each entry is None if there is no solution."""
    return {name: None if solution is None else find(solution) for name, find in _NUMBERS.items()}


def as_json(report: Report) -> str:
    """Return one line of strictly valid JSON; numbers that are not finite become null."""
    plain = json.loads(json.dumps(report, default=_listed), parse_constant=lambda _: None)
    return json.dumps(plain, allow_nan=False)


def as_text(report: Report) -> str:
    """Return a report as a short text with aligned columns."""
    plain = json.loads(as_json(report))
    head = f"{plain['scenario']}: {plain['status']}" + (f" ({plain['cause']})" if plain["cause"] else "")
    if plain["t_end"] is None:
        return head
    head += (
        f" at t = {plain['t_end']:.6g} s in {plain['wall_seconds']:.3g} s of wall time; {plain['n_events']} events, "
        f"{plain['n_impacts']} impacts, {plain['n_steps']} steps"
    )
    units, residual = plain["units"] or {}, plain["energy_residual"]
    rows = [(name, _with_unit(_spell(value), units.get(name, ""))) for name, value in (plain["summary"] or {}).items()]
    rows.append(("energy residual", "none" if residual is None else f"{residual:.6g}"))
    rows.append(("steps limited by", _limits(plain["step_limits"])))
    for name, one in plain["verdict"].items():
        rows.append((name, f"{_with_unit(_spell(one['value']), one['unit'])}, {one['meaning']}"))
    for i, line in enumerate(_modes(plain["mode_words"], plain["contacts"])):
        rows.append(("" if i else "time in modes", line))
    rows.append(("contacts", _contacts(plain["contacts"])))
    counts = {
        "contacts whose bodies are not checked": str(len(plain["unseen_contacts"])),
        "impulses outside of cones": str(plain["impulses_beyond_cone"]),
        "friction gave": _with_unit(_spell(plain["friction_gain"]), UNITS["friction_gain"]),
        "averaged normal forces gave": _with_unit(_spell(plain["closing_gain"]), UNITS["closing_gain"]),
    }
    rows += [(name, count) for name, count in counts.items() if count.partition(" ")[0] != "0"]
    table = lines([(name.replace("_", " "), text) for name, text in rows])
    judged = plain.get("acceptance")
    return "\n".join([head, *table, *([] if judged is None else ["", *_judged(judged)])])


def _modes(shares: dict[str, float] | None, names: list[str]) -> list[str]:
    """Return lines with the commonest mode words ("{01,00,01}") and their shares of the run's time.

    The last line has the number of further mode words. ``shares`` is None if the engine records no modes.
    """
    if shares is None:
        return ["unknown: the engine records no modes"]
    lasting = [(word, share) for word, share in shares.items() if share >= _INSTANT]
    before = [word for word, _ in lasting[:1] + lasting]
    shown = [(_described(word, before[i], names), share) for i, (word, share) in enumerate(lasting[:_COMMONEST])]
    width = max((len(word) for word, _ in shown), default=0)
    found = [f"{word.ljust(width)} {share:7.2%}" for word, share in shown]
    others = len(shares) - len(found)
    return [*found, f"and {others} more"] if others > 0 else found


def _limits(counts: dict[str, int]) -> str:
    """Return the causes that limited steps, with the number of steps each, the commonest first."""
    ranked = sorted(counts.items(), key=lambda item: -item[1])
    return ", ".join(f"{limit} {n}" for limit, n in ranked if limit != LIMITS[Limit.NO_STEP]) or "none"


def _contacts(names: list[str]) -> str:
    """Return the contacts' names in the order of the digits in a mode word; their number if the names exceed a line."""
    text = f"from the right {', '.join(names)}"
    return text if names and len(text) <= _LONG_WORD else str(len(names))


def _described(word: str, before: str, names: list[str]) -> str:
    """Return a mode word. For a word that is too long, return text on it instead.

    The text has the numbers of closed, approaching and slipping contacts, and names the contacts whose bits differ from
    those in ``before``, the word printed above.
    """
    if len(word) <= _LONG_WORD:
        return word
    kinds, others = word.strip("{}").split(","), before.strip("{}").split(",")
    counts = zip((bits.count("1") for bits in kinds), ("closed", "approaching", "slipping"), strict=True)
    text = ", ".join(f"{n} {what}" for n, what in counts if n) or "all open"
    pairs = zip(zip(*map(reversed, kinds), strict=True), zip(*map(reversed, others), strict=True), strict=True)
    differing = [name for name, (here, there) in zip(names, pairs, strict=True) if here != there]
    more = [f"{len(differing) - _NAMED} more"] if len(differing) > _NAMED else []
    return f"{text}; unlike above {', '.join([*differing[:_NAMED], *more])}" if differing else text


def _judged(criteria: list[dict[str, Any]]) -> list[str]:
    """Return a table of criteria: result, name, value, bounds, and source of the bounds."""
    if not criteria:
        return ["  not accepted: no criterion for these parameters"]
    word = "accepted" if all(one["fulfilled"] for one in criteria) else "not accepted"
    rows = [(word, "", "value", "range", "source")]
    for one in criteria:
        lower, upper = ("" if one[bound] is None else f"{one[bound]:.9g}" for bound in ("lower", "upper"))
        value = "none" if one["value"] is None else f"{one['value']:.9g}"
        word = "holds" if one["fulfilled"] else "fails"
        rows.append((word, one["name"], value, f"{lower} .. {upper}".strip(), one["source"]))
    return lines(rows)


def _listed(value: Any) -> Any:
    """Convert numbers and arrays of numpy to numbers and lists, and any other object to text, for JSON."""
    listed = np.asarray(value).tolist()
    return str(value) if listed is value else listed


def _spell(value: Any, scale: float = _ROUND_OFF) -> str:
    """Return a value as text. A number is 0 below ``scale``, or below 1e-9 of the largest number of its list."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value if abs(value) >= scale else 0.0:.6g}"
    if isinstance(value, list):
        largest = max((abs(one) for one in value if isinstance(one, (int, float))), default=0.0)
        return ", ".join(_spell(one, max(scale, _NOTHING * largest)) for one in value) or "none"
    if isinstance(value, dict):
        return ", ".join(f"{name.replace('_', ' ')} {_spell(one)}" for name, one in value.items()) or "none"
    return "none" if value is None else str(value)


def _with_unit(spelt: str, unit: str) -> str:
    return f"{spelt} {unit}" if unit and spelt != "none" else spelt
