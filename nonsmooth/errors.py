"""Errors for users: each message names the input, the rule, the value and the remedy."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

_LONGEST = 400
"""Largest number of characters of a value or a list in a message: the value of a mesh has thousands of numbers."""


STUCK = "see the page 'Stuck?' of the documentation"
"""What to read about runs that failed or are suspect."""


class NonsmoothError(Exception):
    """Base of every error raised by this package."""


class InvalidInput(NonsmoothError, ValueError):
    """An input that breaks a rule, found before anything runs.

    Parameters
    ----------
    thing : str
        Input that is wrong, as the user wrote it ("Dumbbell.radius").
    rule : str
        Rule that the input must obey ("must be positive").
    value : object
        The value found.
    remedy : str
        What to do about it.
    """

    def __init__(self, thing: str, rule: str, value: object, remedy: str) -> None:
        self.thing, self.rule, self.value, self.remedy = thing, rule, value, remedy
        super().__init__(f"{thing} {rule}, but it is {_shortened(repr(value))}. {remedy}")

    def within(self, place: str) -> InvalidInput:
        """Same error with the place of the input in front, such as a file and a key."""
        return InvalidInput(f"{place}: {self.thing}", self.rule, self.value, self.remedy)


class MissingArgument(InvalidInput):
    """An argument of a component that has no default and was not given.

    Parameters
    ----------
    thing : str
        The argument ("Coulomb.friction").
    remedy : str
        How to give it, and what it is.
    """

    def __init__(self, thing: str, remedy: str) -> None:
        super().__init__(thing, "must be given", None, remedy)
        self.args = (f"{thing} must be given. {remedy}",)

    def within(self, place: str) -> MissingArgument:
        """Copy of the error that names ``place``, the function or table in which the argument is missing."""
        return MissingArgument(f"{place}: {self.thing}", self.remedy)


def _listed(names: Sequence[str]) -> str:
    """List of names for a message: as many as fit, and the number of the others."""
    fit = next((n for n in range(len(names), 1, -1) if len(", ".join(names[:n])) <= _LONGEST), 1)
    more = f" and {len(names) - fit} more" if fit < len(names) else ""
    return f"{', '.join(names[:fit])}{more}"


def _shortened(text: str) -> str:
    """Text for a message: the whole text, or its beginning and its end if it is long."""
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST // 2]} ... {text[-_LONGEST // 4 :]}"


class UnknownName(InvalidInput):
    """A name that does not exist, with the nearest known name.

    Parameters
    ----------
    kind : str
        Kind of the thing that has the name ("scenario", "parameter of dumbbell").
    name : str
        The name that the user gave.
    known : iterable of str
        The names that exist.
    other : str
        Kind of another component that has the name ("a friction law"); "" if there is none.
    remedy : str
        What to do, if another name does not suffice.
    """

    def __init__(self, kind: str, name: str, known: Iterable[str], other: str = "", remedy: str = "") -> None:
        known = sorted(set(known))
        letter = _LETTERS.get(name, "")
        near = _nearest(name, known)
        if other:
            hint = f"That is {other}. "
        elif letter in known:
            hint = f"It is called {letter!r}. "
        else:
            hint = f"Did you mean {near!r}? " if near else ""
        listing = _listed(known) if known else "none"
        super().__init__(kind, "must be a known one", name, f"{hint}Known: {listing}. {remedy}".rstrip())
        self._known, self._other, self._remedy = known, other, remedy
        place, mark, what = kind.rpartition(": ")
        unknown = f"{place}{mark}unknown {what}" if place else f"Unknown {what}"
        self.args = (f"{unknown} {_shortened(repr(name))}. {self.remedy}",)

    def within(self, place: str) -> UnknownName:
        """Copy of the error that names ``place``, the function or table in which the name was given."""
        return UnknownName(f"{place}: {self.thing}", str(self.value), self._known, self._other, self._remedy)


class UnknownRun(InvalidInput):
    """A word for a run that names no folder of results and no scenario; the message has the most similar scenario.

    Parameters
    ----------
    word : str
        The word that the user gave.
    scenarios : iterable of str
        Names of the scenarios.
    """

    def __init__(self, word: str, scenarios: Iterable[str]) -> None:
        near = _nearest(word, sorted(scenarios))
        hint = f"Did you mean the scenario {near!r}? " if near else ""
        remedy = f"{hint}`nonsmooth list scenarios` shows all scenarios, `nonsmooth run --out` writes folders."
        super().__init__("run", "must be a folder of results or a scenario", word, remedy)
        self.args = (f"{_shortened(repr(word))} is neither a folder nor a scenario. {remedy}",)


_LETTERS = {
    "c": "damping",
    "e": "restitution",
    "k": "stiffness",
    "m": "mass",
    "mu": "friction",
    "r": "radius",
    "rho": "density",
}
"""Letter in publications -> name of the parameter, which a message gives if the user has written the letter."""


def _nearest(name: str, known: Sequence[str]) -> str:
    """Known name that is most similar to ``name``, in upper or lower case; "" if no known name is similar."""
    # imported for a message only: most programs never need it
    from difflib import get_close_matches

    parts = [one for one in known if one.endswith(f".{name}")]
    if parts:
        return parts[0]
    lower = {one.lower(): one for one in known}
    found = get_close_matches(name.lower(), lower, n=1, cutoff=0.6)
    return lower[found[0]] if found else ""


class PluginError(NonsmoothError):
    """A law, body or scenario from a plug-in that cannot be loaded."""


class NonsmoothWarning(UserWarning):
    """Base of every warning of this package and of its components. The command line prints each once, in one line."""


class RunsInPython(NonsmoothWarning):
    """A function that cannot be compiled, and runs in Python: its results are the same, but it is slow."""


class MissingPackagesError(NonsmoothError):
    """Optional packages that a request needs and that are not installed."""


class NoDistance(NonsmoothError):
    """A pose at which the chosen method finds no distance."""


class DoubtfulDistance(NoDistance):
    """A result of a library for distances that contradicts a bound. It is not returned."""


class RunFailed(NonsmoothError, RuntimeError):
    """A run that could not continue. Its results until then are in ``solution``."""

    def __init__(self, message: str, solution: object = None) -> None:
        super().__init__(message)
        self.solution = solution
