"""Display: where it is shown how far something is."""

from __future__ import annotations

from abc import ABC, abstractmethod


class Display(ABC):
    """Where it is shown how far something is."""

    patience: float
    """Wall time of what takes long before it is shown [s]."""
    interval: float
    """Wall time between two of its states [s]."""

    @abstractmethod
    def show(self, share: float, before: str, behind: str) -> None:
        """Show which share is done, in words how far it is, and in words what else is known."""

    @abstractmethod
    def close(self) -> None:
        """Remove what should not stay."""
