"""The report of a run: one object, as JSON or in words."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from nonsmooth.cli.telling.table import lines
from nonsmooth.engine.memory.modes import LIMITS, Limit
from nonsmooth.solution.checks import contacts_without_body_check, friction_gain, impulses_beyond_cone
from nonsmooth.solution.modes import are_recorded, mode_shares
from nonsmooth.solution.solution import Solution

Report = dict[str, Any]
_LONG_WORD = 80
"""Characters of a word of modes up to which it is told; of longer ones the contacts are."""
_NAMED = 2
"""Contacts that are named then; the others are counted."""
_COMMONEST = 5
"""Words of modes that are told; the others are counted,"""
_INSTANT = 5e-5
"""as are those that last for no more than this part of the time, such as those of an instant."""
_ROUND_OFF, _NOTHING = 1e-15, 1e-9
"""Numbers below which, in SI units, and beside the largest of their list, no run is right: 0 is told."""
_NUMBERS = (
    "t_end",
    "wall_seconds",
    "n_events",
    "n_impacts",
    "n_steps",
    "step_limits",
    "event_intervals",
    "contacts",
    "unseen_contacts",
    "impulses_beyond_cone",
    "friction_gain",
    "mode_words",
    "energy_residual",
    "cause",
    "verdict",
)
UNITS = {"t_end": "s", "wall_seconds": "s", "friction_gain": "J"}
"""Of these numbers; others have none, or are those of the scenario."""


def of_solution(solution: Solution | None) -> Report:
    """Return what the report takes from the solution; nothing but None without one."""
    if solution is None:
        return dict.fromkeys(_NUMBERS)
    return {
        "t_end": solution.t_end,
        "wall_seconds": solution.counters.wall_seconds,
        "n_events": len(solution.events),
        "n_impacts": solution.counters.impacts,
        "n_steps": solution.counters.steps,
        "step_limits": dict(solution.counters.limits),
        "event_intervals": solution.events.intervals(),
        "contacts": list(solution.system.names.contacts),
        "unseen_contacts": list(contacts_without_body_check(solution)),
        "impulses_beyond_cone": int(np.count_nonzero(impulses_beyond_cone(solution))),
        "friction_gain": friction_gain(solution),
        "mode_words": mode_shares(solution) if are_recorded(solution) else None,
        "energy_residual": solution.energy.residual,
        "cause": solution.end.cause,
        "verdict": {
            one.name: {"value": value, "unit": one.unit, "meaning": one.meaning}
            for one, value in solution.end.verdict.items()
        },
    }


def as_json(report: Report) -> str:
    """Return one line of strictly valid JSON; what is not finite becomes null."""
    return json.dumps(_plain(report), allow_nan=False)


def as_text(report: Report) -> str:
    """Return a short summary to read."""
    plain = json.loads(as_json(report))
    head = f"{plain['scenario']}: {plain['status']}" + (f" ({plain['cause']})" if plain["cause"] else "")
    if plain["t_end"] is None:
        return head
    head += (
        f" at t = {plain['t_end']:.6g} s in {plain['wall_seconds']:.3g} s of wall time; {plain['n_events']} events, "
        f"{plain['n_impacts']} impacts, {plain['n_steps']} steps"
    )
    units = plain["units"] or {}
    rows = [
        (name.replace("_", " "), _with_unit(_spell(value), units.get(name, "")))
        for name, value in (plain["summary"] or {}).items()
    ]
    residual = plain["energy_residual"]
    rows.append(("energy residual", "none" if residual is None else f"{residual:.6g}"))
    rows.append(("steps limited by", _limits(plain["step_limits"])))
    rows += [
        (name.replace("_", " "), f"{_with_unit(_spell(one['value']), one['unit'])}, {one['meaning']}")
        for name, one in plain["verdict"].items()
    ]
    rows += [
        ("time in modes" * (i == 0), line) for i, line in enumerate(_modes(plain["mode_words"], plain["contacts"]))
    ]
    rows.append(("contacts", _contacts(plain["contacts"])))
    told = (
        ("seen by their gaps only", len(plain["unseen_contacts"])),
        ("outside of cones", plain["impulses_beyond_cone"]),
    )
    rows += [(f"{what} {name}", str(n)) for what, (name, n) in zip(("contacts", "impulses"), told, strict=True) if n]
    given = _spell(plain["friction_gain"])
    if given != "0":
        rows.append(("friction gave", _with_unit(given, UNITS["friction_gain"])))
    judged = plain.get("acceptance")
    table = [] if judged is None else ["", *_judged(judged)]
    return "\n".join([head, *lines(rows), *table])


def _modes(shares: dict[str, float] | None, names: list[str]) -> list[str]:
    """Return the commonest words of modes with their shares of time, and how many others there are."""
    if shares is None:
        return ["unknown: the engine records no modes"]
    lasting = [(word, share) for word, share in shares.items() if share >= _INSTANT]
    before = [word for word, _ in lasting[:1] + lasting]
    told = [(_described(word, before[i], names), share) for i, (word, share) in enumerate(lasting[:_COMMONEST])]
    width = max((len(word) for word, _ in told), default=0)
    found = [f"{word.ljust(width)} {share:7.2%}" for word, share in told]
    others = len(shares) - len(found)
    return [*found, f"and {others} more"] if others > 0 else found


def _limits(counts: dict[str, int]) -> str:
    """Return what limited the steps, the commonest first."""
    ranked = sorted(counts.items(), key=lambda item: -item[1])
    return ", ".join(f"{limit} {n}" for limit, n in ranked if limit != LIMITS[Limit.NO_STEP]) or "none"


def _contacts(names: list[str]) -> str:
    """Return how many contacts there are, and, where they fit into a line, which digit of a word is whose."""
    text = f"from the right {', '.join(names)}"
    return text if names and len(text) <= _LONG_WORD else str(len(names))


def _described(word: str, before: str, names: list[str]) -> str:
    """Return a word of modes, or, where many contacts make it long, its counts and what differs from the one before."""
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
    """Return a line per criterion: whether it holds, the value, its bounds, where they are from."""
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


def _plain(report: Report) -> Any:
    return json.loads(json.dumps(report, default=_listed), parse_constant=lambda _: None)


def _listed(value: Any) -> Any:
    """Return numpy's numbers and arrays as Python's; the words for anything else that JSON does not know."""
    listed = np.asarray(value).tolist()
    return str(value) if listed is value else listed


def _spell(value: Any, scale: float = _ROUND_OFF) -> str:
    """Return a value in words; a number that is round-off beside a scale, or the largest of its list, is 0."""
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
