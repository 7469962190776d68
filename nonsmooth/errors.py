"""The errors a user meets: each names the thing, the rule, the value and the remedy."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

_LONGEST = 400
"""Characters of a value or a list that are told; meshes have thousands."""


class NonsmoothError(Exception):
    """Base of every error raised by this package."""


class InvalidInput(NonsmoothError, ValueError):
    """An input that breaks a rule, found before anything runs.

    Parameters
    ----------
    thing : str
        What is wrong, as the user wrote it ("Dumbbell.radius").
    rule : str
        The rule it must obey ("must be positive").
    value : object
        The value found.
    remedy : str
        What to do about it.
    """

    def __init__(self, thing: str, rule: str, value: object, remedy: str) -> None:
        self.thing, self.rule, self.value, self.remedy = thing, rule, value, remedy
        super().__init__(f"{thing} {rule}, but it is {_shortened(repr(value))}. {remedy}")


def _shortened(said: str) -> str:
    return said if len(said) <= _LONGEST else f"{said[: _LONGEST // 2]} ... {said[-_LONGEST // 4 :]}"


class UnknownName(InvalidInput):
    """A name that nothing answers to, with the nearest known one.

    Parameters
    ----------
    kind : str
        What was looked for ("scenario", "parameter of dumbbell").
    name : str
        The name asked for.
    known : iterable of str
        The names that exist.
    other : str
        What else has that name, where something has ("a friction law").
    remedy : str
        What to do about it, where another name is not all there is to it.
    """

    def __init__(self, kind: str, name: str, known: Iterable[str], other: str = "", remedy: str = "") -> None:
        known = sorted(set(known))
        near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
        hint = f"That is {other}. " if other else f"Did you mean {near[0]!r}? " if near else ""
        listing = _shortened(", ".join(known)) if known else "none"
        super().__init__(kind, "must be a known one", name, f"{hint}Known: {listing}. {remedy}".rstrip())


class PluginError(NonsmoothError):
    """A law, body or scenario from a plug-in that cannot be loaded."""


class NonsmoothWarning(UserWarning):
    """Base of every warning of this package and of its components; the command line tells each in one line, once."""


class RunsInPython(NonsmoothWarning):
    """A function that the compiler refuses, which runs in Python: as right, but slow; where, why, at which cost."""


class MissingPackagesError(NonsmoothError):
    """Optional packages that a request needs and that are not installed."""


class NoDistance(NonsmoothError):
    """A pose at which the way that was asked for tells no distance."""


class DoubtfulDistance(NoDistance):
    """An answer of a library for distances that contradicts a bound; neither answer nor guess is returned."""


class RunFailed(NonsmoothError, RuntimeError):
    """A run that could not go on.  What was computed until then is in ``solution``."""

    def __init__(self, message: str, solution: object = None) -> None:
        super().__init__(message)
        self.solution = solution
