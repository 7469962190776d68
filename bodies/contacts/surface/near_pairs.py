"""Search for pairs of features of two surfaces that are near each other and may touch before the next search."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from .edges_near import edges_across
from .surface_near import (
    EDGE_ACROSS,
    OVER_FIRST,
    OVER_SECOND,
    Near,
    is_node_near,
    patches_round,
    patches_under,
    room_ahead,
)
from .surface_search import ON_CORNER, ON_EDGE, corner_at, feature_of, member_of, node_at
from .surface_tables import N_EDGES, N_MEMBERS, N_NODES, SKIP, SWEEP


@compiled
def _features_near(
    frame: Floats, other: Floats, surface: Floats, parts: Floats, near: Near, kind: float, out: Floats, n: int
) -> int:
    """Append pairs of a feature of the other body and a near one of the surface in ``frame``; return their new number.

    The features are two edges, or a corner and a patch, by the ``kind`` of the candidates.  ``parts`` are the numbers
    of the surface of the other body.  ``out`` holds ``n`` candidates.
    """
    (margin, turn, most), node, radius = near, 0, surface[SWEEP] + parts[SWEEP]
    of_cores = margin + radius, turn, most
    while node < int(parts[N_NODES]) and n <= most:
        at = node_at(parts, node)
        if not is_node_near(frame, other, surface, parts, at, margin + radius):
            node = int(parts[at + SKIP])
            continue
        for i in range(int(parts[at + N_MEMBERS])):
            what, number, row = feature_of(parts, member_of(parts, at, i))
            if what == ON_EDGE and kind == EDGE_ACROSS:
                n = edges_across(frame, other, surface, parts, row, float(number), of_cores, kind, out, n)
            elif what == ON_CORNER and kind != EDGE_ACROSS and radius > 0.0:
                n = patches_round(frame, other, surface, parts, number, near, kind, out, n)
            elif what == ON_CORNER and kind != EDGE_ACROSS:
                corner, third = corner_at(parts, number), float(number)
                n = patches_under(frame, other, surface, *corner, margin, turn, kind, third, out, n, most)
        node += 1
    return n


def find_near_features(
    a: Floats,
    b: Floats,
    out: Floats,
    surface_a: Floats,
    surface_b: Floats,
    most: float,
    turning: float,
    narrow: float,
) -> None:
    """Write near pairs to ``out`` as candidates: corners of b over patches of a, those of a over b, and two edges.

    Parameters
    ----------
    a, b : Floats
        Frame blocks of both bodies.
    out : Floats
        On entry ``out[0]`` is the largest gap of a pair [m], on return the number of candidates, which follow.
    surface_a, surface_b : Floats
        Surfaces of both bodies (:mod:`bodies.contacts.surface.surface_tables`).
    most : float
        Largest number of candidates; one more is written if there are more.
    turning : float
        Largest relative rotation of the bodies until the next search, per metre of the largest gap [rad/m].
    narrow : float
        Largest gap up to which the candidates may fill all contacts [m]
        (:func:`bodies.contacts.surface.surface_near.room_ahead`).
    """
    limit = room_ahead(out[0], narrow, int(most))
    near = out[0], turning * out[0], limit
    n = _features_near(a, b, surface_a, surface_b, near, OVER_FIRST, out, 0)
    if surface_b[N_EDGES] > 0.0:
        n = _features_near(b, a, surface_b, surface_a, near, OVER_SECOND, out, n)
        n = _features_near(a, b, surface_a, surface_b, near, EDGE_ACROSS, out, n)
    out[0] = float(n) if n <= limit else most + 1.0
