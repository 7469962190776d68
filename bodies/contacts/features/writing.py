"""Functions that write the geometry block of a contact: curvature matrices, rounded surfaces, wide-open contacts."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import (
    FEATURE,
    GAP,
    NORMAL,
    PAIR,
    PAST_END,
    POINT_A,
    POINT_B,
    POSITION,
    SIDE_A,
    SIDE_B,
    SLIDE_MATRIX,
    TANGENT,
    TURN_MATRIX,
)
from nonsmooth.types import Floats

from ...vectors import Vector3, cross, divided, dot, minus, norm, plus_scaled, scaled, vector_at, write_vector
from .frames import write_tangent


@compiled
def write_round(out: Floats, side: int, radius: float) -> None:
    """Write the curvature matrices of a sphere: slide is the identity, turn is ``radius`` [m] times the identity.

    A vertex has the radius 0.  The matrices are explained in :func:`write_principal`.
    """
    slide, turn = side + SLIDE_MATRIX, side + TURN_MATRIX
    out[slide] = out[slide + 3] = 1.0
    out[turn] = out[turn + 3] = radius
    out[slide + 1] = out[slide + 2] = out[turn + 1] = out[turn + 2] = 0.0


@compiled
def write_flat(out: Floats, side: int) -> None:
    """Write the curvature matrices of a plane: slide is zero, turn is the identity (:func:`write_principal`)."""
    slide, turn = side + SLIDE_MATRIX, side + TURN_MATRIX
    out[slide] = out[slide + 3] = 0.0
    out[turn] = out[turn + 3] = 1.0
    out[slide + 1] = out[slide + 2] = out[turn + 1] = out[turn + 2] = 0.0


@compiled
def write_sweep(out: Floats, side: int, radius: float) -> None:
    """Change the curvature matrices of a core to those of its rounded surface, at the distance ``radius`` [m] from it.

    If the core's point moves by u while the normal turns by nu, the surface's point moves by u + radius nu.  So radius
    times the slide matrix is added to the turn matrix (:func:`write_principal`).
    """
    for i in range(side + SLIDE_MATRIX, side + TURN_MATRIX):
        out[i + TURN_MATRIX - SLIDE_MATRIX] += radius * out[i]


@compiled
def write_principal(
    out: Floats,
    side: int,
    along: Vector3,
    slide_along: float,
    turn_along: float,
    slide_across: float,
    turn_across: float,
) -> None:
    """Write the curvature matrices of a surface that are diagonal along and across the unit tangent ``along``.

    The matrices fulfil ``slide @ u = turn @ nu``: the contact point moves by u over the surface while the normal turns
    by nu.  The arguments are their diagonal elements.  The geometry block ``out`` must already hold the normal and the
    first tangent.

    =====================================  ===========  ==========  ============  ===========
    surface, tangent                       slide_along  turn_along  slide_across  turn_across
    =====================================  ===========  ==========  ============  ===========
    side of a cylinder, along the axis     0            1           1             radius [m]
    edge, along the edge                   0            1           1             0
    rim of radius R [m], along the rim     cos(psi)     R           1             0
    =====================================  ===========  ==========  ============  ===========

    psi is the angle between the normal at a rim and the plane of the rim.  If the contact point goes round the rim by
    an angle, it moves by R times this angle, and the normal turns by cos(psi) times this angle.
    """
    tangent = vector_at(out, TANGENT)
    # the second tangent is n x t1
    c, s = dot(along, tangent), dot(along, cross(vector_at(out, NORMAL), tangent))
    slide, turn = side + SLIDE_MATRIX, side + TURN_MATRIX
    out[slide] = c * c * slide_along + s * s * slide_across
    out[slide + 1] = out[slide + 2] = c * s * (slide_along - slide_across)
    out[slide + 3] = s * s * slide_along + c * c * slide_across
    out[turn] = c * c * turn_along + s * s * turn_across
    out[turn + 1] = out[turn + 2] = c * s * (turn_along - turn_across)
    out[turn + 3] = s * s * turn_along + c * c * turn_across


NO_CANDIDATE = (0.0, 0.0, 0.0, 0.0)
"""Argument ``candidate`` of a contact that has no pair of features at present: kind 0, no features, no margin.

Its four numbers are explained in :class:`nonsmooth.interfaces.CandidateSearch`.
"""
_APART = 1e3
"""Gap written for a contact without a pair of features, relative to the size of the larger body: surely open."""


@compiled
def write_apart(a: Floats, out: Floats, size: float) -> None:
    """Write the block of a wide-open contact, which has no features; ``size`` is the size of the larger body [m]."""
    for i in range(PAIR):
        out[i] = 0.0
    out[GAP] = out[PAST_END] = _APART * size
    out[NORMAL + 2], out[TANGENT] = 1.0, 1.0
    write_vector(out, POINT_A, vector_at(a, POSITION))
    write_vector(out, POINT_B, plus_scaled(vector_at(a, POSITION), out[GAP], vector_at(out, NORMAL)))
    write_flat(out, SIDE_A)
    write_round(out, SIDE_B, 0.0)


@compiled
def write_contact(
    a: Floats, out: Floats, gap: float, past: float, feature: float, normal: Vector3, point: Vector3, of_second: bool
) -> None:
    """Write the geometry block of a contact, except the curvature matrices.

    ``a`` is the frame block of the first body; ``past`` is the distance past the end of the features [m], ``feature``
    the number of the pair of features.  The contact point in the world is that of the first body, or ``of_second`` [m].
    """
    out[GAP], out[FEATURE], out[PAST_END] = gap, feature, past
    write_vector(out, NORMAL, normal)
    write_vector(out, POINT_B if of_second else POINT_A, point)
    write_vector(out, POINT_A if of_second else POINT_B, plus_scaled(point, -gap if of_second else gap, normal))
    write_tangent(a, out)


@compiled
def join_cores(a: Floats, out: Floats, radius_a: float, radius_b: float, n: Vector3) -> None:
    """Write gap, axes and witness points of two rounded bodies, from the nearest points of their cores.

    On entry, the witness points in ``out`` are the nearest points of the cores.  If the cores touch, these points give
    no normal, and ``n`` is taken: it must be perpendicular to both cores.
    """
    p, q = vector_at(out, POINT_A), vector_at(out, POINT_B)
    distance = norm(minus(q, p))
    n = divided(minus(q, p), distance) if distance > 0.0 else n
    out[GAP] = distance - radius_a - radius_b
    write_vector(out, NORMAL, n)
    write_vector(out, POINT_A, plus_scaled(p, radius_a, n))
    write_vector(out, POINT_B, minus(q, scaled(radius_b, n)))
    write_tangent(a, out)


@compiled
def place_sphere(a: Floats, out: Floats, center: Vector3, distance: float, radius: float) -> None:
    """Write gap, tangent and witness points of a sphere with ``center`` and ``radius`` [m].

    ``distance`` is the distance of the centre from the other surface [m], along the normal that ``out`` already holds.
    """
    out[GAP] = distance - radius
    n = vector_at(out, NORMAL)
    write_vector(out, POINT_A, minus(center, scaled(distance, n)))
    write_vector(out, POINT_B, minus(center, scaled(radius, n)))
    write_tangent(a, out)
