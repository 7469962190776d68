"""Boxes and capsules as polytopes, for their pairs with smooth bodies."""

from __future__ import annotations

import itertools

from bodies.contacts.polytope import polytope_numbers
from bodies.shapes.box import Box
from bodies.shapes.capsule import Capsule

_LOOPS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
"""Faces -x, +x, -y, +y, -z, +z by the numbers of ``Box.vertices``."""
_SIDES = tuple(itertools.product("-+", repeat=3))
_FACES = tuple(f"face {sign}{axis}" for axis in "xyz" for sign in "-+")


def _edges() -> tuple[str, ...]:
    """Return the names of the edges in the order in which the loops meet them."""
    pairs = dict.fromkeys(
        tuple(sorted(pair)) for loop in _LOOPS for pair in zip(loop, (*loop[1:], loop[0]), strict=True)
    )
    names = []
    for one, two in pairs:
        both = zip(_SIDES[one], _SIDES[two], "xyz", strict=True)
        names.append("edge " + "".join(a + axis for a, b, axis in both if a == b))
    return tuple(names)


_VERTICES = tuple("vertex " + "".join(a + b for a, b in zip(signs, "xyz", strict=True)) for signs in _SIDES)
BOX_FEATURES = (*_FACES, *_edges(), *_VERTICES)
"""Faces, edges and vertices of a box, each by the axes that it lies on."""
CAPSULE_FEATURES = "side", "low end", "high end"


def box_numbers(box: Box) -> tuple[float, ...]:
    """Return the numbers of a box as a polytope (:func:`bodies.contacts.polytope.polytope_numbers`)."""
    return polytope_numbers(box.vertices, _LOOPS)


def capsule_numbers(capsule: Capsule) -> tuple[float, ...]:
    """Return the numbers of a capsule, which is a segment with a radius."""
    return polytope_numbers(capsule.ends, (), capsule.radius, ((0, 1),))
