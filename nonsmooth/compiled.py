"""compiled: for the functions that evaluators share."""

from __future__ import annotations

from nonsmooth.engine.kernel import shared as compiled

__all__ = ["compiled"]
