"""Claims: properties written as functions. The docstring is the statement, the arguments are drawn."""

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
"""Inputs of claims that use the engine in plain mode, in which it is some 400 times slower."""


@final
class Inapplicable(Exception):
    """A claim says nothing about an input."""


GIVEN = Drawn((), dict)
"""Stands for the inputs that :func:`rows` is given."""


@final
@dataclass(frozen=True)
class Claim:
    """A statement about a component, and the function that tries it.

    Attributes
    ----------
    name : str
        A few words.
    says : str
        The statement.
    trial : callable
        Takes the component and its inputs. Returns the fault, "" or None if there is none.
    inputs : tuple of Drawn
        What the trial gets besides the component.
    n_inputs : int or None
        Inputs that are tried; None for as many as of the other claims.
    fewest : int or None
        Inputs that are tried in plain mode; None for all.
    """

    name: str
    says: str
    trial: Callable[..., str | None]
    inputs: tuple[Drawn, ...] = ()
    n_inputs: int | None = None
    fewest: int | None = None

    def at(self, *given: Drawn) -> Claim:
        """Return the claim with inputs in the place of :data:`GIVEN`."""
        inputs = [other for drawn in self.inputs for other in (given if drawn is GIVEN else (drawn,))]
        return replace(self, inputs=tuple(inputs))

    def fault(self, component: Any, case: dict[str, float]) -> str:
        """Return the fault of a component at an input, an exception included; "" if there is none."""
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
            If an input fails, with the simplest input that does.
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
    """Make a claim of a function: its name with blanks is the name, its docstring the statement."""

    def made(trial: Callable[..., str | None]) -> Claim:
        return Claim(name or name_of(trial), says_of(trial), trial, inputs, n_inputs, fewest)

    return made


def wrong_verdict(is_accepted: bool, expected: bool) -> str:
    """Return "is_fulfilled refuses" or "is_fulfilled accepts" if a certificate is wrong; "" if it is right."""
    if bool(is_accepted) is expected:
        return ""
    return "is_fulfilled refuses" if expected else "is_fulfilled accepts"


@final
class Claims(list[Claim]):
    """The claims about a kind of component, in the order in which they are written.

    Parameters
    ----------
    fewest : int, optional
        Inputs that are tried in plain mode.
    """

    def __init__(self, *, fewest: int | None = None) -> None:
        super().__init__()
        self._fewest = fewest

    def claim(self, *inputs: Drawn, **options: Any) -> Callable[[Callable[..., str | None]], Claim]:
        """Make a claim of a function, as :func:`claim` does, and add it."""

        def added(trial: Callable[..., str | None]) -> Claim:
            self.append(claim(*inputs, **{"fewest": self._fewest, **options})(trial))
            return self[-1]

        return added


def rows(
    claims: Sequence[Claim], components: Callable[[], Iterable[Any]], count: int, given: Sequence[Drawn] = ()
) -> list[Row]:
    """Return the rows of claims about components that are made when a claim is checked.

    Parameters
    ----------
    claims : sequence of Claim
        The claims.
    components : callable
        Returns the components.
    count : int
        Inputs that are tried on each.
    given : sequence of Drawn
        Inputs in the place of :data:`GIVEN`.
    """
    return [Row(one.name, one.says, functools.partial(_examine, one.at(*given), components, count)) for one in claims]


def _examine(one: Claim, components: Callable[[], Iterable[Any]], count: int) -> None:
    one.examine(components(), count)
