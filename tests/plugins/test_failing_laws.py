"""A law that fails in the middle of a run: its name, file, line and input are told, and nothing computed is lost."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from laws import Coulomb, EnergeticImpact
from nonsmooth.engine.native.kernel import PLAIN
from tests.plugins import failing_laws as dummies

FRICTION: dict[Callable[..., float], tuple[int, str]] = {
    dummies.no_number: (2, "returns nan"),
    dummies.raising: (3, r"raises ValueError\('no such speed'\)"),
    dummies.out_of_table: (2, r"raises IndexError\("),
    dummies.missing_key: (2, r"raises KeyError\('cinetic'\)"),
    dummies.no_number_in_python: (2, "returns nan"),
}
"""By function: how far below its first line it fails, and what it does."""
SHARE: dict[Callable[..., float], tuple[int, str]] = {
    dummies.soft_and_lost: (2, "returns nan"),
    dummies.soft_and_raising: (3, r"raises ArithmeticError\('too slow'\)"),
    dummies.soft_in_python: (2, r"raises KeyError\('fast'\)"),
}
NUMBER = r"[-+.e0-9]+"


def _failure(run: Callable[[], Any]) -> tuple[str, ns.Solution]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ns.RunsInPython)
        with pytest.raises(ns.RunFailed) as caught:
            run()
    solution = caught.value.solution
    assert isinstance(solution, ns.Solution)
    assert solution.status == "failed"
    for values in (solution.t, solution.q, solution.u, solution.q_end, solution.u_end):
        assert np.all(np.isfinite(values))
    return str(caught.value), solution


def _read(message: str, owner: str, function: Callable[..., Any], offset: int, what: str) -> float:
    """Look for owner, function, file, lines and what it did; return the input."""
    first = function.__code__.co_firstlineno
    place = rf"{owner}: {function.__name__} in \S*failing_laws\.py, line {first}, "
    found = re.search(rf"{place}{what}.* \(line {first + offset}(, `.*`)?\) at (?P<x>{NUMBER}) with ", message)
    assert found is not None, message
    return float(found["x"])


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("function", FRICTION, ids=lambda f: f.__name__)
def test_friction_in_the_middle_of_a_slide(function: Callable[..., float]) -> None:
    """The slip 0.5 - 7 mu g t / 2 reaches 0.31 m/s; up to there the motion is that of Coulomb's law."""
    message, solution = _failure(lambda: dummies.sliding(dummies.Friction(function)))
    assert 0.3 < _read(message, "Friction", function, *FRICTION[function]) < 0.31
    assert "{'level': 0.2}" in message
    t = (0.5 - 0.31) / (3.5 * 0.2 * 9.81)
    assert solution.t_end == pytest.approx(t, abs=1e-8)
    assert f"At t = {solution.t_end:.9g} s" in message
    whole = dummies.sliding(Coulomb(0.2))
    n = len(solution.t) - 1
    assert t - whole.t[1] <= solution.t[-2] <= t
    assert solution.t[-1] == solution.t_end
    np.testing.assert_array_equal(solution.t[:n], whole.t[:n])
    np.testing.assert_allclose(solution.q[:n], whole.q[:n], rtol=0.0, atol=1e-9)
    assert solution.events.causes() == ["start"]


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("function", SHARE, ids=lambda f: f.__name__)
def test_efficiency_in_the_first_impact(function: Callable[..., float]) -> None:
    """On its way from rest the rate passes the interval without values."""
    message, solution = _failure(lambda: dummies.bouncing(dummies.Process(share_of=function)))
    assert 0.05 < _read(message, "Process", function, *SHARE[function]) < 0.2
    t = (2.0 * 0.01 / 9.81) ** 0.5
    assert solution.t_end == pytest.approx(t, abs=1e-9)
    np.testing.assert_allclose(solution.q[:, 2], 0.02 - 0.5 * 9.81 * solution.t**2, rtol=0.0, atol=1e-12)
    assert len(solution.t) > 200


def test_force_that_is_no_number() -> None:
    message, solution = _failure(lambda: dummies.falling_flat(dummies.Process(force_of=dummies.stiff_and_lost)))
    assert _read(message, "Process", dummies.stiff_and_lost, 2, "returns nan") >= 1e-4
    assert solution.t_end > 0.03
    assert len(solution.t) > 500


@pytest.mark.slow
@pytest.mark.parametrize(
    ("function", "offset", "what"),
    [
        (dummies.newton_lost, None, "gives impulses that are not finite"),
        (dummies.newton_raising, 3, r"raises ValueError\('too slow'\) "),
    ],
    ids=["nan", "raises"],
)
def test_a_map_in_the_second_impact(function: Callable[..., None], offset: int | None, what: str) -> None:
    """The first, faster one is kept with all that it did."""
    message, solution = _failure(lambda: dummies.bouncing(dummies.Map(function)))
    first = function.__code__.co_firstlineno
    line = "" if offset is None else rf"\(line {first + offset}\) "
    before = rf"\[\[(?P<rate>{NUMBER}), {NUMBER} ?, {NUMBER} ?\]\] m/s \(1 in contact: contact 'plate - ball"
    found = re.search(
        rf"Map: {function.__name__} in \S*failing_laws\.py, line {first}, {what} ?{line}for the rates {before}", message
    )
    assert found is not None, message
    assert float(found["rate"]) == pytest.approx(-0.5 * (2.0 * 9.81 * 0.01) ** 0.5, rel=1e-5)
    assert solution.events.causes() == ["start", "impact"]
    assert solution.t_end == pytest.approx(2.0 * (2.0 * 0.01 / 9.81) ** 0.5, abs=1e-9)
    assert solution.q[:, 2].max() == pytest.approx(0.02)


class _Countdown:
    """Raises at a call that no look at the law can find again."""

    def __init__(self, calls: int) -> None:
        self.left = calls

    def __call__(self, speed: float, level: float) -> float:
        self.left -= 1
        if self.left == 0:
            raise OSError("table gone")
        return level


@pytest.mark.skipif(PLAIN, reason="a compiled engine retries a step where a plain one does")
def test_what_was_raised_once_is_told_though_it_never_comes_again() -> None:
    """In the first impact, after the timing of the warning: the exception itself was kept."""
    law = dummies.Friction(_Countdown(104))
    message, _ = _failure(lambda: dummies.bouncing_with(law))
    assert "raises OSError('table gone')" in message
    assert re.search(r"test_failing_laws\.py, line \d+, raises", message)


FORMS: dict[str, tuple[Callable[[], Any], str, Callable[..., Any], str]] = {
    "compliance": (
        lambda: dummies.pressed(normal=dummies.Compliance(dummies.lost_deep)),
        "Compliance",
        dummies.lost_deep,
        r"returns nan \(.*\) at indentation = (?P<x>\S+), rate = \S+, closing_rate = \S+ with",
    ),
    "traction": (
        lambda: dummies.pressed(friction=dummies.Traction(dummies.drag_lost)),
        "Traction",
        dummies.drag_lost,
        r"writes \[.*nan.*\] \(.*\) at normal_force = \S+, motion = \[(?P<x>[^,]*), .*\], state = \[\] with",
    ),
    "rates": (
        lambda: dummies.sliding(dummies.Stateful(rates_by=dummies.settle_lost)),
        "Stateful",
        dummies.settle_lost,
        r"raises ZeroDivisionError\(.*\) \(.*\) at speed = (?P<x>\S+), state = \[\S+\] with",
    ),
    "coefficient with a state": (
        lambda: dummies.sliding(dummies.Stateful(dummies.remembering_lost)),
        "Stateful",
        dummies.remembering_lost,
        r"returns nan \(.*\) at (?P<x>\S+) with \{'level': 0.2, 'state': \[\S+\]\}",
    ),
}


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("form", FORMS)
def test_other_forms_of_contact_laws(form: str) -> None:
    """Each names all of its input, inner states as well."""
    run, owner, function, told = FORMS[form]
    message, solution = _failure(run)
    place = rf"{owner}: {function.__name__} in \S*failing_laws\.py, line {function.__code__.co_firstlineno}, "
    found = re.search(place + told, message)
    assert found is not None, message
    assert 0.0 < abs(float(found["x"])) < 0.5
    assert solution.t_end > 0.0
    assert len(solution.t) > 1


def test_one_impact_names_the_law() -> None:
    """solve_impact, too."""
    words: Any = {"mass": np.eye(2), "normal": [[1.0], [0.0]], "tangential": [[[0.0, 0.0]], [[1.0, 0.0]]]}
    with pytest.raises(ns.RunFailed) as caught:
        ns.solve_impact(
            **words,
            velocity=[-1.0, 0.5],
            impact=[dummies.Process(share_of=dummies.soft_and_silent)],
            friction=[Coulomb(0.2)],
        )
    assert _read(str(caught.value), "Process", dummies.soft_and_silent, 2, "returns nan") > 0.05
    with pytest.raises(ns.RunFailed) as caught:
        ns.solve_impact(
            **words, velocity=[-1.0, 0.305], impact=[EnergeticImpact(0.5)], friction=[dummies.Friction(dummies.raising)]
        )
    assert 0.3 < _read(str(caught.value), "Friction", dummies.raising, 3, "raises ValueError") < 0.31


def test_sustained_contact_names_the_law() -> None:
    """solve_contact, too."""
    with pytest.raises(ns.RunFailed) as caught:
        ns.solve_contact(
            mass=np.eye(2),
            normal=[[1.0], [0.0]],
            tangential=[[[0.0, 0.0]], [[1.0, 0.0]]],
            force=[-1.0, 0.0],
            slip=[[0.305, 0.0]],
            friction=[dummies.Friction(dummies.no_number)],
        )
    assert _read(str(caught.value), "Friction", dummies.no_number, 2, "returns nan") == 0.305


@pytest.mark.parametrize(
    ("run", "owner", "function", "hint"),
    [
        (lambda f: dummies.sliding(dummies.Friction(f)), "Friction", dummies.misspelt, "Did you mean 'level'"),
        (lambda f: dummies.sliding(dummies.Friction(f)), "Friction", dummies.of_a_stranger, "Known: level"),
        (lambda f: dummies.bouncing(dummies.Process(share_of=f)), "Process", dummies.misspelt, "Did you mean 'level'"),
        (lambda f: dummies.bouncing(dummies.Map(f)), "Map", dummies.newton_misspelt, "Did you mean 'level'"),
    ],
)
def test_a_parameter_that_the_class_does_not_have(
    run: Callable[[Any], Any], owner: str, function: Callable[..., Any], hint: str
) -> None:
    """Before anything runs: class, function, file and line, and the nearest name."""
    with pytest.raises(ns.UnknownName) as caught:
        run(function)
    message = str(caught.value)
    assert message.startswith(owner)
    assert f"{function.__name__} in {dummies.__file__}, line {function.__code__.co_firstlineno}, asks for" in message
    assert hint in message
