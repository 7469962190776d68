"""A task that hangs or ends its process, for the test of the pool; it imports nothing that takes time."""

import os
import time


def task(what: str) -> str:
    """Return the word, or do what it says."""
    if what == "hang":
        time.sleep(1000.0)
    if what == "crash":
        os._exit(3)
    return what
