"""Which systems differ, in what, and what they consist of."""

from __future__ import annotations

from typing import Any

from tests.benchmarks.against import differences


def _result(*components: str, **changes: str) -> dict[str, Any]:
    return {"end": "done", "q": "1", "times": "2", "impulses": "3", "components": list(components)} | changes


_OTHER = {
    "a": _result("friction.stribeck", "body.ball"),
    "b": _result("friction.coulomb", "body.ball"),
    "c": _result("friction.stribeck", "body.box"),
    "d": _result("friction.coulomb", end="RunFailed: stuck"),
    "e": _result("friction.coulomb", end="cut off"),
}


def test_equal_results_are_one_line() -> None:
    same = {name: row for name, row in _OTHER.items() if name != "e"}
    assert list(differences.table(same, same)) == ["all 4 equal"]


def test_a_failure_with_the_same_message_is_equal_only_if_what_was_computed_is() -> None:
    assert differences.differing({"d": _OTHER["d"]}, {"d": _OTHER["d"]}) == {}
    assert differences.differing({"d": _OTHER["d"] | {"q": "9"}}, {"d": _OTHER["d"]}) == {"d": "q"}


def test_what_differs_is_named_with_the_messages_of_both_sides() -> None:
    this = {"d": _result(impulses="9", end="done")}
    assert differences.differing(this, _OTHER) == {"d": "impulses, end: RunFailed: stuck → done"}


def test_what_was_cut_off_on_either_side_is_named_and_not_compared() -> None:
    this = _OTHER | {"b": _OTHER["b"] | {"end": "cut off", "q": "9"}}
    assert differences.differing(this, _OTHER) == {}
    assert next(differences.table(this, _OTHER)) == "all 3 equal"
    assert list(differences.table(this, _OTHER))[-1].endswith(": b, e")


def test_the_component_whose_systems_are_those_that_differ_is_the_first() -> None:
    this = _OTHER | {name: _OTHER[name] | {"q": "9"} for name in ("a", "c")}
    assert differences.by_component(this, _OTHER) == [
        ("friction.stribeck", 2, 2),
        ("body.box", 1, 1),
        ("body.ball", 2, 1),
    ]
