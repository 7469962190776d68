"""Functions for plug-ins whose evaluators the engine calls: helpers, rows of tables, support functions.

The decorator ``compiled`` marks a function that evaluators may call. ``block_at`` returns the floats of a table from an
offset on. ``call_support`` returns the farthest point of a shape in a direction [m].
"""

from __future__ import annotations

from nonsmooth.engine.native.kernel import at as block_at
from nonsmooth.engine.native.kernel import call_support
from nonsmooth.engine.native.kernel import shared as compiled

__all__ = ["block_at", "call_support", "compiled"]
