"""The display of a study: one that was given, or standard error."""

from __future__ import annotations

from nonsmooth.checks import check_kind
from nonsmooth.progress import Display, on_standard_error


def display_of(display: Display | None) -> Display:
    """Return the display that was given, by default the one on standard error.

    Raises
    ------
    InvalidInput
        If something else was given.
    """
    if display is None:
        return on_standard_error()
    remedy = "Leave it out, or give nonsmooth.progress.Quiet(), which shows nothing, or a Display of your own."
    check_kind("display", display, Display, remedy)
    return display
