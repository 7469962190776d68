"""The folder in which programs of a user keep what they can compute again."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path


def user_cache() -> Path | None:
    """Cache folder of the user; None for a user without a home.

    It is the folder of the variable XDG_CACHE_HOME, or else ``.cache`` in the home.  By the standard of this variable
    (https://specifications.freedesktop.org/basedir-spec) a relative path in it is ignored.
    """
    cache = Path(os.environ.get("XDG_CACHE_HOME", ""))
    if not cache.is_absolute():
        # a user may have neither HOME nor an entry in the list of users
        with contextlib.suppress(RuntimeError):
            cache = Path.home() / ".cache"
    return cache if cache.is_absolute() else None
