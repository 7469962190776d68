"""compiled: for the functions that evaluators share."""

from __future__ import annotations

from nonsmooth.engine.kernel import jit as compiled

__all__ = ["compiled"]
