"""Helpers for functions of plug-ins that the engine compiles and calls, such as the ``evaluator`` of a body.

The decorator ``compiled`` marks a function that such functions may call. ``block_at`` returns the floats of an array
from an offset on. ``call_support`` returns the farthest point of a shape in a direction [m].
"""

from __future__ import annotations

from nonsmooth.engine.native.kernel import at as block_at
from nonsmooth.engine.native.kernel import call_support
from nonsmooth.engine.native.kernel import shared as compiled

__all__ = ["block_at", "call_support", "compiled"]
