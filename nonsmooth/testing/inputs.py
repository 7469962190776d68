"""Inputs of the properties: hypothesis draws them, and simplifies an input that fails.

There are a thousand steps from the simplest value of a number to either bound. Hypothesis draws the steps and reduces
the steps of a failing input. So a message names short numbers of ordinary size.
"""

from __future__ import annotations

import functools
import importlib.util
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, final

from nonsmooth.errors import MissingPackagesError

Case = dict[str, float]
"""An input: its numbers by name."""
MOST_TRIALS = 300
"""Largest number of inputs that are tried to simplify a failing input."""
_STEPS = 1000
"""Number of values between the simplest value of a drawn number and each of its bounds. With so few values, three
digits suffice to show a value in a message."""
_ORIGIN = 7_001_001_001
"""Integer that stands for the simplest value when hypothesis draws integers. Hypothesis also tries constants that it
finds in loaded modules. These are smaller than this integer, so they are outside of the range of drawn integers."""
_PACKAGES = ("hypothesis", "cloudpickle")


@final
@dataclass(frozen=True)
class DrawnNumber:
    """A number that is drawn between two bounds, evenly or, if ``is_log``, evenly in its logarithm.

    Attributes
    ----------
    name : str
        Name of the number in messages.
    low, high : float
        The bounds.
    simplest : float
        Value of the number in the simplest input.
    is_log : bool
        True if its logarithm is drawn.
    """

    name: str
    low: float
    high: float
    simplest: float = 0.0
    is_log: bool = False

    @property
    def n_steps(self) -> int:
        """Number of values besides the simplest one: 2000 if that lies between the bounds, 1000 if it is a bound."""
        return 2 * _STEPS if self.low < self.simplest < self.high else _STEPS

    def at(self, step: int) -> float:
        """Value number ``step`` of a sequence that moves away from the simplest value; step 0 is the simplest value.

        Steps 1, 2, 3, ... are alternately above and below the simplest value. If the simplest value is a bound, all of
        them are on the same side of it.
        """
        if step == 0:
            return self.simplest
        if self.n_steps == _STEPS:
            end, share = self.high if self.simplest < self.high else self.low, step / _STEPS
        else:
            end, share = (self.low, self.high)[step % 2], (step + 1) // 2 / _STEPS
        if self.is_log:
            value = self.simplest ** (1.0 - share) * end**share
        else:
            value = self.simplest + share * (end - self.simplest)
        # short numbers read better
        return min(max(float(f"{value:.3g}"), self.low), self.high)


@final
@dataclass(frozen=True)
class Drawn:
    """Numbers that are drawn together, and the function ``made`` that makes an argument of a property from them."""

    numbers: tuple[DrawnNumber, ...]
    made: Callable[[Case], Any]


def number(name: str, low: float, high: float, simplest: float = 0.0, *, is_log: bool = False) -> Drawn:
    """Return a single number that is drawn; the arguments are those of :class:`DrawnNumber`."""
    return Drawn((DrawnNumber(name, low, high, simplest, is_log),), lambda case: case[name])


def require_packages() -> None:
    """Raise MissingPackagesError unless the packages are installed that the conformance kit needs."""
    missing = [name for name in _PACKAGES if importlib.util.find_spec(name) is None]
    if missing:
        raise MissingPackagesError(
            f'The conformance kit needs {" and ".join(missing)}: pip install "nonsmooth[testing]"'
        )


def draws(inputs: Sequence[Drawn], count: int) -> list[Case]:
    """Return at most ``count`` inputs: the simplest one, then drawn ones. Every call returns the same inputs."""
    numbers = _numbers(inputs)
    return [_case(numbers, steps) for steps in _drawn(tuple(one.n_steps for one in numbers), count)]


def simplified(inputs: Sequence[Drawn], case: Case, fails: Callable[[Case], bool], count: int) -> Case:
    """Return the simplest failing input that hypothesis finds; ``case`` if it finds none.

    ``case`` is the failing input of the draws with which hypothesis starts. At most :data:`MOST_TRIALS` inputs are
    tried after the first failure.
    """
    numbers, found, trials = _numbers(inputs), case, 0

    def trial(steps: tuple[int, ...]) -> None:
        nonlocal found, trials
        one = _case(numbers, steps)
        if trials > MOST_TRIALS and one != found:
            return
        if fails(one):
            found, trials = one, max(trials, 1)
            raise _Fails
        trials += trials > 0

    if not MOST_TRIALS:
        return case
    from hypothesis.errors import Flaky

    try:
        _run(tuple(one.n_steps for one in numbers), count, trial, shrinks=True)
    except (_Fails, Flaky):
        return found
    return case


class _Fails(Exception):
    """Raised inside hypothesis to mark an input as failing."""


def _numbers(inputs: Sequence[Drawn]) -> list[DrawnNumber]:
    return [one for drawn in inputs for one in drawn.numbers]


def _case(numbers: Sequence[DrawnNumber], steps: Sequence[int]) -> Case:
    return {one.name: one.at(step) for one, step in zip(numbers, steps, strict=True)}


@functools.cache
def _drawn(sizes: tuple[int, ...], count: int) -> list[tuple[int, ...]]:
    """Return at most ``count`` inputs, each a tuple with one integer for each number of the input.

    An integer is from 0 to its entry of ``sizes``. :meth:`DrawnNumber.at` computes the number from the integer. The
    result is cached, because equal arguments always give the same tuples.
    """
    if not sizes:
        return [()]
    found: list[tuple[int, ...]] = []
    _run(sizes, count, found.append, shrinks=False)
    return found


def _run(sizes: tuple[int, ...], count: int, trial: Callable[[tuple[int, ...]], None], *, shrinks: bool) -> None:
    """Call ``trial`` with at most ``count`` tuples of steps, which hypothesis draws from 0 to each entry of ``sizes``.

    Hypothesis draws the same tuples in each run, without its database of examples and without a time limit. With
    ``shrinks`` it reduces a tuple for which ``trial`` raises an exception.
    """
    from hypothesis import HealthCheck, Phase, Verbosity, given, settings
    from hypothesis import strategies as st

    steps = st.tuples(*(st.integers(_ORIGIN, _ORIGIN + size) for size in sizes))

    @settings(
        max_examples=count,
        derandomize=True,
        database=None,
        deadline=None,
        phases=[Phase.generate, *([Phase.shrink] if shrinks else [])],
        # hypothesis must not complain of slow trials, because the engine takes some time. It must not complain of
        # nested tests either: a user's test may draw a component by hypothesis, and then check it here
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.nested_given],
        verbosity=Verbosity.quiet,
    )
    @given(steps)
    def run(numbers: tuple[int, ...]) -> None:
        trial(tuple(one - _ORIGIN for one in numbers))

    run()
