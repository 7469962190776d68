"""Claims: properties written as functions. The docstring is the statement, the arguments are drawn inputs."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, final

from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.errors import NonsmoothError
from nonsmooth.parameters import UnusualValue
from nonsmooth.testing.child import about_to
from nonsmooth.testing.inputs import Drawn, draws, simplified
from nonsmooth.testing.outcome import Broken, NotChecked, Row, described, name_of, says_of, words_of

FEWEST = 3
"""Number of inputs of claims that run the engine in plain mode: as plain Python it is some 400 times slower."""


@final
class Inapplicable(Exception):
    """Raised by a trial if its claim does not apply to an input; the input then counts as passed."""


GIVEN = Drawn((), dict)
"""Placeholder for the inputs that the caller of :func:`rows` passes as ``given``."""


@final
@dataclass(frozen=True)
class Claim:
    """A statement about a component, and the function that tries it.

    Attributes
    ----------
    name : str
        Short name, such as "gap rate".
    says : str
        The statement.
    trial : callable
        Takes the component and its inputs. Returns a description of the fault, "" or None if the claim holds.
    inputs : tuple of Drawn
        Arguments of the trial after the component.
    n_inputs : int or None
        Number of inputs that are tried; by default (None) the number given to :meth:`examine`.
    fewest : int or None
        Number of inputs that are tried in plain mode (engine as plain Python); None for all inputs.
    """

    name: str
    says: str
    trial: Callable[..., str | None]
    inputs: tuple[Drawn, ...] = ()
    n_inputs: int | None = None
    fewest: int | None = None

    def at(self, *given: Drawn) -> Claim:
        """Return the claim with the inputs ``given`` in place of :data:`GIVEN`."""
        inputs = [other for drawn in self.inputs for other in (given if drawn is GIVEN else (drawn,))]
        return replace(self, inputs=tuple(inputs))

    def fault(self, component: Any, case: dict[str, float]) -> str:
        """Test the claim for one input; return the fault of the component as text, "" if the claim holds.

        An exception that the component raises is a fault, too.
        """
        about_to("it {takes}", component, case)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", UnusualValue)
                return self.trial(component, *(one.made(case) for one in self.inputs)) or ""
        except Inapplicable:
            return ""
        except (NotChecked, Broken):
            raise
        except (NonsmoothError, ArithmeticError, LookupError, TypeError, ValueError) as error:
            return words_of(error)

    def examine(self, components: Iterable[Any], count: int) -> None:
        """Try ``count`` inputs on each component.

        Raises
        ------
        Broken
            An input fails. The error holds the simplest failing input that was found.
        """
        count = self.n_inputs or count
        count = self.fewest if PLAIN and self.fewest is not None else count
        for component in components:
            for case in draws(self.inputs, count):
                if found := self.fault(component, case):
                    simplest = simplified(self.inputs, case, lambda c: self.fault(component, c) != "", count)  # noqa: B023
                    again = self.fault(component, simplest)
                    reason = again or f"{found}; tried again, it holds: something is random"
                    raise Broken(reason, *described(component), simplest)


def claim(
    *inputs: Drawn, name: str = "", n_inputs: int | None = None, fewest: int | None = None
) -> Callable[[Callable[..., str | None]], Claim]:
    """Return a decorator that turns a function into a :class:`Claim`, with its docstring as the statement."""

    def made(trial: Callable[..., str | None]) -> Claim:
        return Claim(name or name_of(trial), says_of(trial), trial, inputs, n_inputs, fewest)

    return made


def wrong_verdict(is_accepted: bool, expected: bool) -> str:
    """Return "is_fulfilled refuses" or "is_fulfilled accepts" if this verdict is wrong; "" if it is right."""
    if bool(is_accepted) is expected:
        return ""
    return "is_fulfilled refuses" if expected else "is_fulfilled accepts"


@final
class Claims(list[Claim]):
    """Claims (:class:`Claim`) about one kind of component, such as a friction law, in the order of their definition.

    Parameters
    ----------
    fewest : int, optional
        Number of inputs that are tried in plain mode (engine as plain Python), for claims that do not set it
        themselves.
    """

    def __init__(self, *, fewest: int | None = None) -> None:
        super().__init__()
        self._fewest = fewest

    def claim(self, *inputs: Drawn, **options: Any) -> Callable[[Callable[..., str | None]], Claim]:
        """Return a decorator that turns a function into a :class:`Claim` and appends the claim to these claims."""

        def added(trial: Callable[..., str | None]) -> Claim:
            self.append(claim(*inputs, **{"fewest": self._fewest, **options})(trial))
            return self[-1]

        return added


def rows(
    claims: Sequence[Claim], components: Callable[[], Iterable[Any]], count: int, given: Sequence[Drawn] = ()
) -> list[Row]:
    """Return a :class:`Row` for each claim: its name, its statement, and a function that tries it on the components.

    The components are made only when a row is checked.

    Parameters
    ----------
    claims : sequence of Claim
        The claims.
    components : callable
        Returns the components to check.
    count : int
        Number of inputs that are tried on each component.
    given : sequence of Drawn
        Inputs in place of :data:`GIVEN`.
    """
    return [Row(one.name, one.says, functools.partial(_examine, one.at(*given), components, count)) for one in claims]


def _examine(one: Claim, components: Callable[[], Iterable[Any]], count: int) -> None:
    one.examine(components(), count)
