"""The garbage collector of Python while functions are compiled or loaded."""

from __future__ import annotations

import contextlib
import gc
from collections.abc import Iterator


@contextlib.contextmanager
def uncollected() -> Iterator[None]:
    """Switch the garbage collector off within a ``with`` block. A collector that was off stays off.

    The compiler and the loader make millions of small objects, all of which are needed. The collector would go through
    them again and again, a tenth of the time. One block about many functions saves more than a block about each: after
    each block the collector goes through all objects once.
    """
    is_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if is_enabled:
            gc.enable()
