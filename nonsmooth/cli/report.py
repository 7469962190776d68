"""The report of a run: one object, as JSON or in words."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from nonsmooth.cli.table import lines
from nonsmooth.solution.solution import Solution

Report = dict[str, Any]
_LONG_WORD = 80
"""Characters of a word of modes, from which its middle is left out."""
_NUMBERS = ("t_end", "wall_seconds", "n_events", "n_impacts", "n_steps", "mode_words", "energy_residual")


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
        "mode_words": solution.modes,
        "energy_residual": solution.energy.residual,
    }


def as_json(report: Report) -> str:
    """Return one line of strictly valid JSON; what is not finite becomes null."""
    return json.dumps(_plain(report), allow_nan=False)


def as_text(report: Report) -> str:
    """Return a short summary to read."""
    rounded = json.loads(as_json(report), parse_float=lambda number: float(f"{float(number):.6g}"))
    rounded["acceptance"] = json.loads(as_json(report)).get("acceptance")
    head = f"{rounded['scenario']}: {rounded['status']}"
    if rounded["t_end"] is None:
        return head
    head += (
        f" at t = {rounded['t_end']} s in {rounded['wall_seconds']:.3g} s of wall time; {rounded['n_events']} events, "
        f"{rounded['n_impacts']} impacts, {rounded['n_steps']} steps"
    )
    rows = [(name.replace("_", " "), _spell(value)) for name, value in (rounded["summary"] or {}).items()]
    rows.append(("energy residual", _spell(rounded["energy_residual"])))
    modes = rounded["mode_words"].items()
    rows += [("time in modes" * (i == 0), f"{_shortened(word)} {share:7.2%}") for i, (word, share) in enumerate(modes)]
    judged = rounded.get("acceptance")
    table = [] if judged is None else ["", *_judged(judged), ""]
    return "\n".join([head, *lines(rows), *table, "SI units, radians"])


def _shortened(word: str) -> str:
    """Return a word of modes, its middle left out where many contacts make it long."""
    return word if len(word) <= _LONG_WORD else f"{word[: _LONG_WORD // 2]} ... {word[-_LONG_WORD // 2 :]}"


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


def _spell(value: Any) -> str:
    return json.dumps(value).replace('"', "").strip("[]{}")
