"""TangentialLaw: what holds a closed contact in its tangent plane, or rubs there."""

from __future__ import annotations

from abc import ABC

from nonsmooth.parameters import Component


class TangentialLaw(Component, ABC):
    """A law of friction.  Law authors subclass :class:`FrictionLaw`, one of its variants, or :class:`TractionLaw`."""
