"""compiled: for the functions that evaluators share; call_support: for shapes that are known by a function."""

from __future__ import annotations

from nonsmooth.engine.kernel import call_support
from nonsmooth.engine.kernel import shared as compiled

__all__ = ["call_support", "compiled"]
