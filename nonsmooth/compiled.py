"""Functions for evaluators: ``compiled`` shares a function, ``block_at`` gives a row of a table.

``call_support`` calls the support function of a shape.
"""

from __future__ import annotations

from nonsmooth.engine.native.kernel import at as block_at
from nonsmooth.engine.native.kernel import call_support
from nonsmooth.engine.native.kernel import shared as compiled

__all__ = ["block_at", "call_support", "compiled"]
