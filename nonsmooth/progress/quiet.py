"""Quiet: a display that shows nothing."""

from __future__ import annotations

import math
from typing import final

from nonsmooth.progress.display import Display


@final
class Quiet(Display):
    """Shows nothing: ``continuation(..., display=Quiet())``."""

    patience, interval = math.inf, math.inf

    def show(self, share: float, before: str, behind: str) -> None:
        """Show nothing."""

    def close(self) -> None:
        """Remove nothing."""
