"""The components of the contact forces, three to each active contact: which is whose, and which of the three."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import kernel


@kernel("i8(i8)")
def contact_of(line: int) -> int:
    """Return the active contact whose force component ``line`` is."""
    return line // 3


@kernel("i8(i8)")
def direction_of(line: int) -> int:
    """Return the direction of force component ``line``: 0 for n, 1 for t1, 2 for t2."""
    return line % 3
