"""Runs that are interrupted after some seconds of processor time."""

from __future__ import annotations

import time

import nonsmooth as ns

SECONDS = 5.0
"""Processor time after which a run is interrupted [s]: ten times that of the longest one that ends."""


def limited(system: ns.System, t_end: float) -> ns.Solution:
    """Return a run, interrupted after ``SECONDS``."""
    began = time.process_time()

    def watch(t: float, t_end: float) -> None:
        if time.process_time() - began > SECONDS:
            raise KeyboardInterrupt

    return ns.simulate(system, t_end, progress=watch)
