"""Orbits that repeat after a period: Newton's method on the map of one period, Floquet multipliers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import is_finite
from nonsmooth.errors import InvalidInput, NonsmoothError, RunFailed
from nonsmooth.interfaces import Scenario
from nonsmooth.progress import Display, Pace, TimeReached, on_standard_error
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.derivatives.passage import Signature, named, passage
from nonsmooth.studies.orbits.linear import Corner, Linear, linear

Floats = NDArray[np.float64]
_CLOSE = 1e-12
"""What is left of an orbit that has been found, in units of scales."""
_AGAIN = 1e-8
"""What may be left of it after another period, for a map that stretches by 1."""
_CLOSED = 1
"""Bit a of Eq. (29)."""
_LOOKED_AT = 200
"""Times of a period among which the section is chosen."""
_MOST = 30
"""Steps of Newton's method."""


class NoOrbit(NonsmoothError):
    """No orbit was found, or none that has a derivative."""


@final
@dataclass(frozen=True)
class Orbit:
    """A motion that repeats, but for coordinates that were left out, as those along which it drifts.

    Attributes
    ----------
    family : Family
        What it is an orbit of, at its values.
    state : State
        Where it is at the time of the section.
    period : float
        [s].
    within : tuple of str or None
        The coordinates and velocities that repeat.
    residual : float
        What is left of the difference between end and start, in units of scales.
    map : Linear
        The map of one period about it; its matrix is the monodromy matrix.
    """

    family: Family
    state: State
    period: float
    within: tuple[str, ...] | None
    residual: float
    map: Linear

    @property
    def smooth(self) -> tuple[str, ...]:
        """The directions in which the map has a derivative."""
        rough = {corner.direction for corner in self.map.corners}
        return tuple(name for name in self.map.chart.names if name not in rough)

    @property
    def corners(self) -> tuple[Corner, ...]:
        """The directions in which it has none: several events at one instant, whose order a small change decides."""
        return self.map.corners

    @property
    def monodromy(self) -> Floats:
        """The derivatives of the map along the smooth directions, in units of scales, shape [m, m]."""
        kept = [name in self.smooth for name in self.map.chart.names]
        return np.asarray(self.map.matrix[np.ix_(kept, kept)])

    @property
    def multipliers(self) -> NDArray[np.complex128]:
        """Floquet multipliers, the largest first, of perturbations along the smooth directions."""
        found = np.linalg.eigvals(self.monodromy).astype(complex)
        return np.asarray(found[np.argsort(-np.abs(found), kind="stable")])

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie within the unit circle, and there are no corners."""
        return not self.corners and bool(np.all(np.abs(self.multipliers) < 1.0))

    @property
    def events(self) -> Signature:
        """The events of a period, by cause and contact."""
        return self.map.end.signature

    def __str__(self) -> str:
        """Return period, residual, multipliers and events."""
        model = self.family.model()
        values = ", ".join(f"{value:.8g}" for value in self.multipliers)
        rough = f"; no derivative along {', '.join(c.direction for c in self.corners)}" if self.corners else ""
        return (
            f"period {self.period:.9g} s, residual {self.residual:.1e}, multipliers {values}{rough}; "
            f"events: {named(self.events, model)}"
        )


def orbit(
    what: Scenario | Family,
    period: float,
    *,
    settle: float = 0.0,
    start: State | None = None,
    within: Sequence[str] | None = None,
    display: Display | None = None,
) -> Orbit:
    """Find the orbit near a start.

    The section is put where the least of all gaps is largest, in the period behind ``settle``: where no contact is
    closed all coordinates are free.

    Parameters
    ----------
    what : Scenario or Family
        The system.
    period : float
        [s].
    settle : float
        Time to run before, from the start [s]; attracting orbits come closer in it.
    start : State, optional
        Where to begin; by default as the system is placed.
    within : sequence of str, optional
        Names of coordinates and velocities that repeat ("z", or "ball.z" where bodies share a name); by default all.
        Leave out those along which the motion drifts, and all out of a plane that it stays in.
    display : Display, optional
        Where it is shown how far the time before is; on standard error by default.

    Raises
    ------
    InvalidInput
        If a number is not valid, contacts are closed all the time, or the system does not have the period.
    UnknownName
        If a coordinate has no such name.
    NoOrbit
        If Newton's method does not arrive.
    """
    if not (is_finite(period) and period > 0.0):
        raise InvalidInput("orbit: period", "must be positive and finite", period, "Give it in [s].")
    if not (is_finite(settle) and settle >= 0.0):
        raise InvalidInput("orbit: settle", "must not be negative", settle, "Give it in [s].")
    family, names = Family.of(what), None if within is None else tuple(within)
    model = family.model()
    begin = model.start if start is None else start
    if settle > 0.0:
        with Pace(display or on_standard_error()) as pace:
            begin = model.run(begin.time + settle, start=begin, progress=TimeReached(pace)).state
    return close(family, section(model, begin, period), period, names)


def section(model: Model, begin: State, period: float) -> State:
    """Return the state in the period behind a state in which the least gap of all contacts is largest.

    Raises
    ------
    InvalidInput
        If contacts are closed all the time.
    """
    times = begin.time + period * (np.arange(_LOOKED_AT) + 0.5) / _LOOKED_AT
    run = model.run(begin.time + period, start=begin, sample_interval=period)
    gaps = run.contact_motion(times).gap.reshape(_LOOKED_AT, -1)
    which = np.searchsorted(run.events.time, times, side="right") - 1
    closed = np.any(run.events.after[which] & _CLOSED, axis=1)
    room = np.where(closed, 0.0, np.min(gaps, axis=1, initial=np.inf))
    best = int(np.argmax(room))
    if room[best] <= 0.0:
        remedy = "Orbits are looked for where a system flies at least once in a period."
        raise InvalidInput("orbit: section", "must be where no contact is closed", "none within a period", remedy)
    return model.run(float(times[best]), start=begin, sample_interval=period).state


def close(family: Family, state: State, period: float, within: tuple[str, ...] | None) -> Orbit:
    """Return the orbit near a state of the section.

    Raises
    ------
    NoOrbit
        If Newton's method does not arrive.
    """
    model, residual = family.model(), np.inf
    for i in range(_MOST):
        try:
            found = linear(model, state, state.time + period, within)
        except (InvalidInput, RunFailed) as error:
            if i == 0:
                raise
            raise NoOrbit(
                f"no orbit of {period:.9g} s near the start: step {i} leads where no run is ({error})"
            ) from error
        residual = float(np.max(np.abs(found.way), initial=0.0))
        if residual <= _CLOSE:
            _check_again(model, found, period)
            return Orbit(family, state, period, within, residual, found)
        smooth = ~np.isnan(found.matrix[0]) if len(found.matrix) else np.zeros(0, dtype=bool)
        change = np.zeros(len(found.way))
        reduced = found.matrix[np.ix_(smooth, smooth)] - np.eye(int(np.sum(smooth)))
        # along directions of symmetry nothing is to be changed: the least change of all
        change[smooth] = np.linalg.lstsq(reduced, -found.way[smooth], rcond=1e-9)[0]
        state = found.chart.moved(state, change)
    raise NoOrbit(
        f"no orbit of {period:.9g} s near the start: after {_MOST} steps {residual:.2g} is left; begin nearer"
    )


def _check_again(model: Model, found: Linear, period: float) -> None:
    """Look whether the end of a period leads to itself as the start does: else the system has another period.

    Raises
    ------
    InvalidInput
        If it does not.
    """
    end = found.end.state
    again = passage(model, end, end.time + period).state
    off = float(np.max(np.abs(found.chart.between(end, again)), initial=0.0))
    finite = found.matrix[np.isfinite(found.matrix)]
    if off > _AGAIN * max(1.0, float(np.linalg.norm(finite))):
        rule = (
            f"must be one of the system, but after a second one {off:.2g} is left of what repeats, in units of scales"
        )
        raise InvalidInput("orbit: period", rule, period, "A plate that vibrates has that of its motion, or multiples.")
