"""The linear part of a map from a state to a later one: by differences about it, direction by direction."""

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
from nonsmooth.studies.derivatives.extrapolation import Derivative, derivative
from nonsmooth.studies.derivatives.passage import Passage, Signature
from nonsmooth.studies.derivatives.slope import BACKWARD, FORWARD, OrderOfEvents, Sampled, slope, steady
from nonsmooth.studies.orbits.sections import Section

Floats = NDArray[np.float64]
STEPS = (3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7)
"""Steps that one-sided derivatives at a corner are tried with, in units of scales."""
_FIRST = 5e-3
"""Largest step of derivatives, in units of scales: the series of a smooth motion converges within it."""


@final
@dataclass(frozen=True)
class Corner:
    """A direction in which a map has no derivative, as events change their order on either side.

    Attributes
    ----------
    direction : str
        What is changed.
    before, behind : array
        One-sided derivatives on the side of less and of more; nan where events change there, too; shape [m].
    signatures : tuple of Signature
        The events on the side of less and of more.
    """

    direction: str
    before: Floats
    behind: Floats
    signatures: tuple[Signature, Signature]


@final
@dataclass(frozen=True)
class Linear:
    """A map about a state.

    Attributes
    ----------
    chart : Chart
        The directions at the state.
    end : Passage
        Where the map leads.
    way : array
        How far along the directions that is, shape [m].
    matrix : array
        The derivatives of the end along the directions there, a column for each direction at the state; nan where there
        is none; shape [m, m].
    corners : tuple of Corner
        The directions without one.
    error : array
        Bounds of the errors of the derivatives; infinite where there is none; shape [m, m].
    step : float
        The smallest step that derivatives were taken with, in units of scales.
    """

    chart: Chart
    end: Passage
    way: Floats
    matrix: Floats
    corners: tuple[Corner, ...]
    error: Floats
    step: float


def linear(
    model: Model, state: State, section: Section, within: Sequence[str] | None, step: float | None = None
) -> Linear:
    """Return the map from a state to the next one of a section, along the coordinates that are named.

    With a step that is known to be good near the state the derivatives are quick differences of fourth order, whose
    errors are not known.  They serve Newton's method.  Without one the steps are chosen at this state.

    Raises
    ------
    UnknownName
        If a coordinate has no such name.
    RunFailed
        If a run cannot go on.
    InvalidInput
        If a motion does not come back to the section, or the law of a closed contact has inner states.
    """
    chart, end = chart_at(model, state, section, within), section.passage(model, state)
    there = _directions_at(end, chart, model, section, within)
    columns, corners = list[Derivative](), list[Corner]()
    for name, sampled in zip(chart.names, _directions(model, state, section, chart, end, there), strict=True):
        try:
            columns.append(_column(sampled, end.signature, step))
        except OrderOfEvents:
            columns.append(Derivative(np.full(len(chart.names), np.nan), np.inf, _FIRST))
            corners.append(_corner(name, sampled))
    return _joined(chart, state, end, columns, tuple(corners))


def smooth(
    model: Model, state: State, section: Section, within: Sequence[str] | None, step: float | None = None
) -> Linear:
    """Return the same of a map that has all derivatives.

    Raises
    ------
    OrderOfEvents
        If it lacks one.
    """
    chart, end = chart_at(model, state, section, within), section.passage(model, state)
    there = _directions_at(end, chart, model, section, within)
    moves = _directions(model, state, section, chart, end, there)
    return _joined(chart, state, end, [_column(sampled, end.signature, step) for sampled in moves], ())


def _column(sampled: Sampled, expected: Signature, step: float | None) -> Derivative:
    if step is not None:
        with contextlib.suppress(OrderOfEvents, InvalidInput):
            return Derivative(slope(sampled, step, expected), np.inf, step)
    return derivative(sampled, _FIRST, expected)


def _joined(chart: Chart, state: State, end: Passage, columns: list[Derivative], corners: tuple[Corner, ...]) -> Linear:
    m = len(columns)
    matrix = np.array([one.value for one in columns]).reshape(m, m).T
    error = np.tile([one.error for one in columns], (m, 1)).reshape(m, m)
    step = min((one.step for one in columns), default=_FIRST)
    return Linear(chart, end, chart.between(state, end.state), matrix, corners, error, step)


def chart_at(model: Model, state: State, section: Section, within: Sequence[str] | None) -> Chart:
    """Return the directions about a state within a section; errors as :meth:`Chart.at`."""
    return Chart.at(model, state, within, section.without(model), section.ignored(model, state))


def _directions_at(end: Passage, chart: Chart, model: Model, section: Section, within: Sequence[str] | None) -> Chart:
    """Return the directions at the end, which turn with bodies; of an orbit they are those at the start."""
    there = chart_at(model, end.state, section, within)
    # on the way to an orbit other contacts may be closed at the end
    return there if there.names == chart.names else chart


def _directions(
    model: Model, state: State, section: Section, chart: Chart, end: Passage, there: Chart
) -> list[Sampled]:
    """Return what comes of small changes along each direction of a chart, in those at the end."""
    return [_moved(model, state, section, chart, way, end.state, there) for way in np.eye(len(chart.names))]


def _moved(
    model: Model, state: State, section: Section, chart: Chart, way: Floats, origin: State, there: Chart
) -> Sampled:
    def sampled(change: float) -> tuple[Floats, Signature]:
        end = section.passage(model, chart.moved(model, state, change * way))
        return there.between(origin, end.state), end.signature

    return sampled


def _corner(name: str, sampled: Sampled) -> Corner:
    sides, told = list[Floats](), list[Signature]()
    for sign, stencil in ((-1.0, BACKWARD), (1.0, FORWARD)):
        size = len(sampled(0.0)[0])
        _, signature = sampled(sign * STEPS[-1])
        told.append(signature)
        inner = tuple((offset + int(sign), weight) for offset, weight in stencil)
        try:
            # next to the corner, not at it: what happens there belongs to neither side
            sides.append(steady(partial(slope, sampled, expected=signature, stencil=inner), STEPS)[0])
        except OrderOfEvents:
            sides.append(np.full(size, np.nan))
    return Corner(name, sides[0], sides[1], (told[0], told[1]))
