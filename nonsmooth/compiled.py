"""compiled: for the functions that evaluators share; block_at: for rows of a table that they read.

call_support is for shapes that are known by a function.
"""

from __future__ import annotations

from nonsmooth.engine.native.kernel import at as block_at
from nonsmooth.engine.native.kernel import call_support
from nonsmooth.engine.native.kernel import shared as compiled

__all__ = ["block_at", "call_support", "compiled"]
