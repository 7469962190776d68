"""A search for features that fails is named, before the run or where it fails: no contact is lost in silence."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plane, Sphere
from laws import Coulomb, NewtonImpact, Unilateral
from nonsmooth.binding import bounds
from nonsmooth.compiled import compiled
from nonsmooth.interfaces import CandidateSearch, ContactKinematics, FeaturePair, Shape
from nonsmooth.system.contact import Contact
from nonsmooth.testing import check_contact_kinematics
from nonsmooth.types import Floats
from tests.testing.pair_dummies import evaluate

_sound: Any = compiled(evaluate)
TABLE = {"near": 1.0}
LAWS: dict[str, Any] = {"normal": Unilateral(), "impact": NewtonImpact(0.5), "friction": Coulomb(0.2)}


COUNTS = {1.0: (1, 1)}


def _evaluate(a: Floats, b: Floats, out: Floats, candidate: Floats) -> None:
    _sound(a, b, out, 0.0)


def finds(a: Floats, b: Floats, out: Floats) -> None:
    """Find the only pair of features."""
    out[0], out[1], out[2], out[3] = 1.0, 1.0, 0.0, 0.0


_finds: Any = compiled(finds)


def without_number(a: Floats, b: Floats, out: Floats) -> None:
    """Have no number of features for bodies that have come near."""
    _finds(a, b, out)
    if b[0] - a[0] < 1.0:
        out[0] = math.nan


def raising(a: Floats, b: Floats, out: Floats) -> None:
    """Raise for bodies that have come near."""
    _finds(a, b, out)
    if b[0] - a[0] < 1.0:
        raise ValueError("too near")


def raising_in_python(a: Floats, b: Floats, out: Floats) -> None:
    """Raise, and read a dictionary of the module: numba leaves it in Python."""
    _finds(a, b, out)
    if b[0] - a[0] < 1.0:
        out[0] = TABLE["far"]


def negative(a: Floats, b: Floats, out: Floats) -> None:
    """Give a number that is none."""
    out[0] = -1.0


def beyond(a: Floats, b: Floats, out: Floats) -> None:
    """Write more pairs than there is room for."""
    _finds(a, b, out)
    out[10] = 1.0


def near(search: CandidateSearch) -> FeaturePair:
    """Two spheres, found by a search."""
    return FeaturePair(_evaluate, {"candidate": (0.0, 0.0, 0.0, 0.0)}, ("spheres",), search)


class Near(ContactKinematics):
    """Spheres that are searched for."""

    pair = (Sphere, Sphere)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        return (near(CandidateSearch(finds, {}, COUNTS)),)


@pytest.fixture(autouse=True)
def _untried(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounds, "_tried", defaultdict(set))


def _approaching(function: Callable[..., None], second: Shape | None = None, start: float = 1.5) -> ns.System:
    """Return two balls of 0.2 and 0.3 m, as the dummies are, that come near each other by 1 m/s."""
    one, two = Ball(0.2), Ball(0.3)
    system = ns.System([one, two])
    system.place(one, position=(0.0, 0.0, 0.0))
    system.place(two, position=(start, 0.0, 0.0), velocity=(-1.0, 0.0, 0.0))
    search = CandidateSearch(function, {}, COUNTS)
    shapes = Sphere(0.2, x=0.1), second or Sphere(0.3, y=-0.05)
    for i in range(2):
        system.add_contact(
            Contact.of_shapes((one, two), shapes, near(search), ns.ContactLaws(**LAWS), name=f"pair {i}")
        )
    return system


@pytest.mark.slow
def test_a_sound_search_is_an_impact() -> None:
    """The balls meet, and part."""
    solution = ns.simulate(_approaching(finds), 1.5)
    assert solution.status == "done"
    assert solution.counters.impacts == 1
    assert solution.u_end[6] > solution.u_end[0]


@pytest.mark.slow
@pytest.mark.parametrize("function", [without_number, raising, raising_in_python], ids=lambda f: f.__name__)
@pytest.mark.filterwarnings("ignore::nonsmooth.RunsInPython")
def test_a_search_that_fails_ends_the_run(function: Callable[..., None]) -> None:
    """By name; up to there the run stands."""
    with pytest.raises(ns.RunFailed, match=rf"contact 'pair 0': {function.__name__} in .*test_searches.py") as caught:
        ns.simulate(_approaching(function), 1.5)
    solution = caught.value.solution
    assert isinstance(solution, ns.Solution)
    assert 0.3 < solution.t_end < 1.0
    assert np.all(np.isfinite(solution.q))
    if function is raising_in_python:
        assert "KeyError('far')" in str(caught.value)


@pytest.mark.parametrize("function", [without_number, raising, negative], ids=lambda f: f.__name__)
def test_a_search_that_fails_at_the_start_is_named(function: Callable[..., None]) -> None:
    """Before anything runs."""
    with pytest.raises(ns.PluginError, match=rf"^contact 'pair 0': {function.__name__} in .*test_searches.py"):
        ns.simulate(_approaching(function, start=0.75), 0.5)


@pytest.mark.parametrize("tried", [True, False])
def test_a_search_that_writes_beyond_its_room_is_named(tried: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a trial, with the line; or by the numbers behind its block."""
    if not tried:
        monkeypatch.setattr(bounds, "_MOST", 0)
    said = "reaches for number 10 of a block of 7" if tried else "has written past the 7 numbers of its block"
    with pytest.raises(ns.PluginError, match=rf"^[Cc]ontact 'pair 0': beyond in .*{said}"):
        ns.simulate(_approaching(beyond, start=0.75), 0.5)


def test_unbounded_shapes_have_no_search() -> None:
    """Nobody could say when to look again."""
    with pytest.raises(
        ns.InvalidInput, match=r"Plane of the contact 'pair 0' must be bounded .*, but it is inf\. Give"
    ):
        ns.simulate(_approaching(finds, second=Plane()), 0.5)


def test_the_kit_checks_every_pair_of_features() -> None:
    """A contact that a search fills is checked with the features that it may have."""
    for prop in check_contact_kinematics(Near, Sphere(0.2), Sphere(0.3)):
        prop()
