"""Random systems as data."""

from __future__ import annotations

import json
from typing import Any

from nonsmooth import ContactLaws
from tests.benchmarks.described.components import data_of
from tests.benchmarks.random_systems.case import Case, Start


def describe(case: Case) -> dict[str, Any]:
    """Return the description of a case, from which ``systems.build`` makes the same system."""
    laws: list[dict[str, Any]] = []
    contacts = [[one, other, _number(laws, _laws(row))] for one, other, row in case.contacts]
    return {
        "gravity": case.gravity,
        "t_end": case.t_end,
        "sample_interval": case.sample_interval,
        "bodies": data_of(case.bodies),
        "starts": [_start(start) for start in case.starts],
        "laws": laws,
        "contacts": contacts,
        "joints": [[one, other, data_of(joint)] for one, other, joint in case.joints],
    }


def _start(start: Start | None) -> dict[str, Any] | None:
    return None if start is None else {"how": start.how} | {name: data_of(value) for name, value in start.arguments}


def _laws(laws: ContactLaws) -> dict[str, Any]:
    return {"normal": data_of(laws.normal), "friction": data_of(laws.friction), "impact": data_of(laws.impact)}


def _number(known: list[dict[str, Any]], laws: dict[str, Any]) -> int:
    """Return the number of laws among the known ones, which they join if they are new."""
    texts = [json.dumps(one) for one in known]
    text = json.dumps(laws)
    if text not in texts:
        known.append(laws)
        return len(known) - 1
    return texts.index(text)
