"""What a folder says that no run has written."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from nonsmooth.errors import InvalidInput, NonsmoothError


@contextlib.contextmanager
def naming_damage(thing: str) -> Iterator[None]:
    """Turn what reading of other content raises into a message that names the thing.

    Raises
    ------
    InvalidInput
        If a value is missing or of another kind.
    """
    try:
        yield
    except NonsmoothError:
        raise
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
        reason = f"{type(error).__name__}: {error}"
        raise InvalidInput(thing, "must be as a run has written it", reason, "It is damaged.") from error
