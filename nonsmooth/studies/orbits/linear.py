"""The derivative of a map from section to section, by differences, and its eigenvalues with error bounds."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.chart import Chart
from nonsmooth.studies.derivatives.differences import (
    BACKWARD,
    FORWARD,
    Derivative,
    OrderOfEvents,
    Sampled,
    derivative,
    slope,
    steady,
)
from nonsmooth.studies.derivatives.flow import FlowSegment, Signature
from nonsmooth.studies.orbits.sections import Section
from nonsmooth.types import Array

_STEPS = (3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7)
"""Steps of the one-sided derivatives at a non-differentiable point, relative to the scales of the coordinates.  The
derivative that changes least from one step to the next is used."""
_FIRST = 5e-3
"""Largest step of the finite differences, relative to the scales of the coordinates: for smooth motions, the error
series of the differences converges up to this step."""


@final
@dataclass(frozen=True)
class NonDifferentiablePoint:
    """A state at which a map has no derivative along one direction.

    A slightly smaller and a slightly larger coordinate in this direction give different orders of events.

    Attributes
    ----------
    direction : str
        The coordinate, velocity or rotation of a body that changes, such as "ball.rx".
    before, after : array
        One-sided derivatives of the map along the direction, from smaller and from larger coordinates, shape [m].  m is
        the number of coordinates of the map.  They are nan if no finite difference was found whose runs have the same
        order of events.
    signatures : tuple of Signature
        Order of events for a slightly smaller coordinate, and for a slightly larger one.
    """

    direction: str
    before: Array
    after: Array
    signatures: tuple[Signature, Signature]


@final
@dataclass(frozen=True)
class Linear:
    """Linearisation of the map from section to section at a state: image of the state, and derivatives.

    Attributes
    ----------
    chart : Chart
        The directions at the state.
    end : FlowSegment
        The run from the state to its image.
    way : array
        Image less state along the directions, shape [m].
    matrix : array
        Derivatives of the image, a column for each direction at the state, shape [m, m]; nan in a column without a
        derivative.
    non_differentiable : tuple of NonDifferentiablePoint
        The directions without a derivative.
    error : array
        Bounds of the errors of the derivatives, shape [m, m]; infinite if they are unknown.
    step : float
        The smallest step of the differences, relative to the scales of the coordinates.
    """

    chart: Chart
    end: FlowSegment
    way: Array
    matrix: Array
    non_differentiable: tuple[NonDifferentiablePoint, ...]
    error: Array
    step: float


def linear(
    model: Model,
    state: State,
    section: Section,
    within: Sequence[str] | None,
    step: float | None = None,
    *,
    is_smooth: bool = False,
) -> Linear:
    """Linearise the map from a state to its next return to a section, along the coordinates of ``within``.

    ``step`` is a step of the differences that was accurate at a state nearby, relative to the scales of the
    coordinates.  The derivatives are then single differences of fourth order, without error estimates, which is enough
    for Newton's method.  Without ``step``, steps are chosen at this state and errors are estimated.

    Raises
    ------
    UnknownName
        If ``within`` contains an unknown name.
    RunFailed
        If a run cannot continue.
    InvalidInput
        If a motion does not return to the section, or the friction law of a closed contact has states of its own.
    OrderOfEvents
        If ``is_smooth`` is True and the map lacks a derivative.
    """
    chart, end, maps = _maps(model, state, section, within)
    columns, points, m = list[Derivative](), list[NonDifferentiablePoint](), len(chart.names)
    for name, sampled in zip(chart.names, maps, strict=True):
        try:
            columns.append(_column(sampled, end.signature, step))
        except OrderOfEvents:
            if is_smooth:
                raise
            columns.append(Derivative(np.full(m, np.nan), np.inf, _FIRST))
            points.append(_one_sided(name, sampled))
    matrix = np.array([one.value for one in columns]).reshape(m, m).T
    error = np.tile([one.error for one in columns], (m, 1)).reshape(m, m)
    least = min((one.step for one in columns), default=_FIRST)
    return Linear(chart, end, chart.between(state, end.state), matrix, tuple(points), error, least)


def _chart_at(model: Model, state: State, section: Section, within: Sequence[str] | None) -> Chart:
    """Return the directions about a state within a section; errors as :meth:`Chart.at`."""
    return Chart.at(model, state, within, section.fixed(model), section.ignored(model, state))


def _maps(
    model: Model, state: State, section: Section, within: Sequence[str] | None
) -> tuple[Chart, FlowSegment, list[Sampled]]:
    """Return the chart of a state, the run to its image, and the map along each direction of the chart.

    The image is the state at the next return to the section.  The map along a direction is a function.  It takes a
    change of the state along this direction, and returns the change of the image and the events of the run.
    """
    chart, end = _chart_at(model, state, section, within), section.flow(model, state)
    there = _chart_at(model, end.state, section, within)
    # if the state is not on an orbit, the contacts that are closed at the image may differ from those at the state:
    # then describe changes of the image by the chart of the state
    there = there if there.names == chart.names else chart

    def moved(way: Array) -> Sampled:
        def sampled(change: float) -> tuple[Array, Signature]:
            image = section.flow(model, chart.moved(model, state, change * way))
            return there.between(end.state, image.state), image.signature

        return sampled

    return chart, end, [moved(way) for way in np.eye(len(chart.names))]


def _column(sampled: Sampled, expected: Signature, step: float | None) -> Derivative:
    if step is not None:
        with contextlib.suppress(OrderOfEvents, InvalidInput):
            return Derivative(slope(sampled, step, expected), np.inf, step)
    return derivative(sampled, _FIRST, expected)


def _one_sided(name: str, sampled: Sampled) -> NonDifferentiablePoint:
    sides, signatures = list[Array](), list[Signature]()
    for sign, stencil in ((-1.0, BACKWARD), (1.0, FORWARD)):
        size = len(sampled(0.0)[0])
        _, signature = sampled(sign * _STEPS[-1])
        signatures.append(signature)
        # shift the stencil by one step, off the unchanged state: the order of its events may differ from both sides
        inner = tuple((offset + int(sign), weight) for offset, weight in stencil)
        try:
            sides.append(steady(partial(slope, sampled, expected=signature, stencil=inner), _STEPS)[0])
        except OrderOfEvents:
            sides.append(np.full(size, np.nan))
    return NonDifferentiablePoint(name, sides[0], sides[1], (signatures[0], signatures[1]))


def eigenvalues(matrix: Array, error: Array) -> tuple[NDArray[np.complex128], Array]:
    """Return the eigenvalues, the largest first, and bounds of their errors, shape [m] each.

    Gershgorin's circles of the matrix in the basis of its eigenvectors V contain the eigenvalues of every matrix within
    the errors E; their radii are the row sums of abs(V^-1) E abs(V).  The radii grow beyond all bounds as two
    eigenvalues meet.  The bound of Elsner (1985) is then smaller: (2 |M| + |E|)^(1 - 1/m) |E|^(1/m).

    Parameters
    ----------
    matrix : array
        The matrix, shape [m, m].
    error : array
        Bounds of the errors of the entries of the matrix, shape [m, m].
    """
    m = len(matrix)
    if m == 0:
        return np.zeros(0, dtype=complex), np.zeros(0)
    found, vectors = np.linalg.eig(matrix)
    order = np.argsort(-np.abs(found), kind="stable")
    found, vectors = found[order].astype(complex), vectors[:, order]
    if not np.all(np.isfinite(error)):
        return found, np.full(m, np.inf)
    largest = float(np.linalg.norm(error))
    elsner = (2.0 * float(np.linalg.norm(matrix, 2)) + largest) ** (1.0 - 1.0 / m) * largest ** (1.0 / m)
    try:
        radii = np.sum(np.abs(np.linalg.inv(vectors)) @ error @ np.abs(vectors), axis=1)
    except np.linalg.LinAlgError:
        return found, np.full(m, elsner)
    return found, np.minimum(radii, elsner)
