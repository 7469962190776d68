"""Periodic orbits by Newton's method on the map from section to section, and their Floquet multipliers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import is_finite
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.errors import InvalidInput, NonsmoothError, RunFailed
from nonsmooth.progress import Display, TimeReached
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.coordinates import coordinate_number, values_of
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.derivatives.flow import Signature
from nonsmooth.studies.derivatives.flow import named as events_in_words
from nonsmooth.studies.inputs import check_phase, check_positive, meter
from nonsmooth.studies.orbits.linear import Linear, NonDifferentiablePoint, eigenvalues, linear
from nonsmooth.studies.orbits.sections import (
    PoincareSection,
    Section,
    StroboscopicSection,
    clearest_state,
    state_at_phase,
)
from nonsmooth.studies.orbits.symmetries import RelativeSection, Symmetry
from nonsmooth.types import Array

_CLOSE = 1e-12
"""Largest residual of an orbit, relative to the scales of the coordinates."""
_AGAIN = 1e-8
"""Largest residual after a second period, relative to the scales of the coordinates.  It is multiplied by the norm of
the period map's derivative, if above 1, because the map amplifies the residual of the first period."""
_MOST = 30
"""Largest number of steps of Newton's method."""
_HELD = 1e-6
"""Largest change, over a period, of the coordinates that closed contacts determine; relative to their scales.  It is
above the errors of runs."""
_MODES = {Mode.OPEN: "open", Mode.STICK: "closed and sticks", Mode.SLIDE: "closed and slides"}
_NAMED = 3
"""Largest number of contacts that a message names."""
_NEARLY_ONE = 1e-3
"""Largest difference between a multiplier and 1 that explains a failure of Newton's method, which divides by it."""


class NoOrbit(NonsmoothError):
    """No orbit was found."""


@final
@dataclass(frozen=True)
class Orbit:
    """A motion whose coordinates and velocities ``within`` repeat after each period.

    Attributes
    ----------
    family : Family
        The systems, at the values of this orbit; with a Poincare section their runs end at the section.
    state : State
        State of the motion at the section.
    section : Section
        Section at which a period ends.
    within : tuple of str or None
        The coordinates and velocities that repeat.
    residual : float
        Largest difference between end and start, relative to the scales of the coordinates.
    map : Linear
        The map of one period, linearised about the orbit; its matrix is the monodromy matrix.
    """

    family: Family
    state: State
    section: Section
    within: tuple[str, ...] | None
    residual: float
    map: Linear

    @property
    def period(self) -> float:
        """The period [s]."""
        return self.map.end.state.time - self.state.time

    @property
    def turns(self) -> dict[str, float]:
        """Angle by which the motion has turned after one period [rad], about the axis of each symmetry, by its name."""
        return self.section.turns(self.family.model(), self.state)

    @property
    def smooth(self) -> tuple[str, ...]:
        """Names of the directions along which the period map has a derivative."""
        rough = {point.direction for point in self.non_differentiable}
        return tuple(name for name in self.map.chart.names if name not in rough)

    @property
    def non_differentiable(self) -> tuple[NonDifferentiablePoint, ...]:
        """Directions along which the period map has no derivative: a small change reorders simultaneous events."""
        return self.map.non_differentiable

    @property
    def monodromy(self) -> Array:
        """Derivatives of the period map along the directions of :attr:`smooth`, in units of scales, shape [m, m]."""
        return self._smooth_part(self.map.matrix)

    @property
    def multipliers(self) -> NDArray[np.complex128]:
        """Floquet multipliers of perturbations along the directions of :attr:`smooth`, largest first, shape [m]."""
        return eigenvalues(self.monodromy, np.zeros_like(self.monodromy))[0]

    @property
    def multiplier_errors(self) -> Array:
        """Bounds of the errors of the multipliers, from the errors of the derivatives; shape [m]."""
        return eigenvalues(self.monodromy, self._smooth_part(self.map.error))[1]

    @property
    def stable(self) -> bool:
        """True if the period map has a derivative in every direction, and each multiplier plus its error is below 1."""
        return not self.non_differentiable and bool(np.all(np.abs(self.multipliers) + self.multiplier_errors < 1.0))

    @property
    def events(self) -> Signature:
        """The events of a period, by cause and contact."""
        return self.map.end.signature

    def __str__(self) -> str:
        """Return period, residual, multipliers and events."""
        model = self.family.model()
        pairs = zip(self.multipliers, self.multiplier_errors, strict=True)
        values = ", ".join(f"{value:.8g} (+-{error:.0e})" for value, error in pairs) or "none"
        without = ", ".join(point.direction for point in self.non_differentiable)
        rough = f"; no derivative along {without}" if without else ""
        passes = ", ".join(self.section.fixed(model))
        trivial = f" besides 1 along the motion, which the section of {passes} takes away" if passes else ""
        turned = "".join(f"; {name} by {angle:.9g} rad" for name, angle in self.turns.items())
        return (
            f"period {self.period:.9g} s, residual {self.residual:.1e}, multipliers {values}{trivial}{turned}{rough}; "
            f"events: {events_in_words(self.events, model)}"
        )

    def value(self, coordinate: str, at: float) -> float:
        """Return a coordinate or velocity of the orbit at the phase ``at`` [s], which is the time modulo the period.

        Raises
        ------
        UnknownName
            If no coordinate or velocity has this name.
        """
        model = self.family.model()
        there = state_at_phase(model, self.state, self.period, at)
        return float(values_of(there)[coordinate_number(model.system, coordinate)])

    def _smooth_part(self, matrix: Array) -> Array:
        kept = [name in self.smooth for name in self.map.chart.names]
        return np.asarray(matrix[np.ix_(kept, kept)])


def orbit(
    what: Varied,
    period: float | None = None,
    *,
    section: PoincareSection | None = None,
    at: float | None = None,
    settle: float = 0.0,
    start: State | None = None,
    within: Sequence[str] | None = None,
    symmetries: Sequence[Symmetry] = (),
    display: Display | None = None,
) -> Orbit:
    """Find the periodic orbit near a start, and its Floquet multipliers.

    A driven system is sampled once per period (stroboscopic section), by default far from all events.  If all contacts
    are open at some time of the first period after ``settle``, this is the time at which the smallest gap is largest.
    A contact that is closed at the section determines some coordinates and velocities; the search varies only the
    remaining ones.

    A system without a drive needs a Poincare section.  The search then also finds the period, and leaves out the
    multiplier 1 along the motion.

    Parameters
    ----------
    what : Scenario, System or Family
        The system.
    period : float, optional
        Period of the drive, or an integer multiple of it [s]; required for a driven system.
    section : PoincareSection, optional
        Section at which a period ends; required for a system without a drive.
    at : float, optional
        Time of the stroboscopic section after the start of each period [s]; by default far from all events, as above.
    settle : float
        Time of the transient before the search [s].
    start : State, optional
        Initial state; by default the initial state of the system.
    within : sequence of str, optional
        Names of coordinates and velocities that repeat ("z", or "ball.z" if bodies share a name); by default all.
        Leave out coordinates that drift.  For a plane motion, leave out all coordinates and velocities across the
        plane.
    symmetries : sequence of Symmetry, optional
        Rotations up to which the motion repeats.  After a period, the state may be rotated by any angle: :class:`Turn`
        rotates all bodies about the vertical, :class:`Spin` a symmetric body about its own axis.
    display : Display, optional
        Where the progress of ``settle`` is shown; on standard error by default, ``nonsmooth.progress.Quiet()`` shows
        nothing.

    Returns
    -------
    Orbit
        The orbit, with its period, state, multipliers and events.

    Raises
    ------
    InvalidInput
        If a number is not valid, ``period`` and ``section`` are both given or both left out, ``period`` is not a
        multiple of the period of the drive, or the motion does not pass the section.
    UnknownName
        If the system has no coordinate or velocity of a given name.
    NoOrbit
        If Newton's method does not converge.
    """
    if (period is None) == (section is None):
        remedy = "Give the period of the drive; of a system without one a section=PoincareSection(...)."
        rule = "must be given, or a section in its place, and not both"
        raise InvalidInput("orbit: period and section", rule, (period, section), remedy)
    if period is not None:
        check_positive("orbit: period", period, "Give it in [s].")
    if at is not None:
        check_phase("orbit: at", at, period)
    if not (is_finite(settle) and settle >= 0.0):
        raise InvalidInput("orbit: settle", "must not be negative", settle, "Give it in [s].")
    family, names = Family.of(what), None if within is None else tuple(within)
    model = family.model()
    begin = model.start if start is None else start
    if settle > 0.0:
        with meter(display) as shown:
            begin = model.run(begin.time + settle, start=begin, progress=TimeReached(shown)).state
    if section is not None:
        family = section.guarded(family)
        return close(family, section.first(family.model(), begin), _modulo(section, symmetries), names)
    assert period is not None
    state = clearest_state(model, begin, period) if at is None else state_at_phase(model, begin, period, at)
    return close(family, state, _modulo(StroboscopicSection(period), symmetries), names)


def _modulo(section: Section, symmetries: Sequence[Symmetry]) -> Section:
    return RelativeSection(section, tuple(symmetries)) if symmetries else section


def close(family: Family, state: State, section: Section, within: tuple[str, ...] | None) -> Orbit:
    """Find an orbit by Newton's method, from a state of the section near the orbit.

    ``within`` are the names of the coordinates and velocities that repeat, None for all.

    Raises
    ------
    NoOrbit
        If Newton's method does not converge.
    """
    model, residual = family.model(), np.inf
    section.check(model, state)
    step: float | None = None
    for i in range(_MOST):
        try:
            found = linear(model, state, section, within, step)
        except (InvalidInput, RunFailed) as error:
            if i == 0:
                raise
            # leave out value and remedy of the error: they concern a state of Newton's method, which the user did not
            # choose
            why = f"{error.thing} {error.rule}" if isinstance(error, InvalidInput) else str(error)
            raise NoOrbit(
                f"no orbit near the start: step {i} of Newton's method leads to a state from which no run comes back "
                f"to the section ({why}); begin nearer, take a longer settle, or choose another section"
            ) from error
        residual = float(np.max(np.abs(found.way), initial=0.0))
        if residual <= _CLOSE and step is not None:
            found = linear(model, state, section, within)
        if residual <= _CLOSE:
            _check_closed(model, state, found.end.state)
            _check_following(found, state)
            _check_again(model, found, section)
            return Orbit(family, state, section, within, residual, found)
        smooth = ~np.isnan(found.matrix[0]) if len(found.matrix) else np.zeros(0, dtype=bool)
        change = np.zeros(len(found.way))
        reduced = found.matrix[np.ix_(smooth, smooth)] - np.eye(int(np.sum(smooth)))
        # lstsq returns the shortest change, so the state does not drift along a continuum of orbits: directions in
        # which the period map and the identity differ by less than 1e-9, relative to the largest difference
        change[smooth] = np.linalg.lstsq(reduced, -found.way[smooth], rcond=1e-9)[0]
        state, step = found.chart.moved(model, state, change), found.step
    raise NoOrbit(f"no orbit near the start: after {_MOST} steps {residual:.2g} is left; {_advice(found)}")


def _check_closed(model: Model, start: State, end: State) -> None:
    """Check that the same contacts are closed at both ends of a period, and stick or slide alike.

    Raises
    ------
    NoOrbit
        If a contact has another mode at the end.
    """
    differ = np.flatnonzero(start.modes != end.modes).tolist()
    if not differ:
        return
    named = [
        f"{model.system.names.contacts[i]!r} is {_MODES[Mode(start.modes[i])]} at the start of the period and "
        f"{_MODES[Mode(end.modes[i])]} at its end"
        for i in differ[:_NAMED]
    ]
    more = f" (and {len(differ) - _NAMED} more)" if len(differ) > _NAMED else ""
    raise NoOrbit(
        f"no orbit near the start: {'; '.join(named)}{more}. Choose a section in flight. If feet take turns, let a "
        "period last until the first one is down again: PoincareSection(..., times=n), or n times the period"
    )


def _check_following(found: Linear, start: State) -> None:
    """Check that the coordinates which are determined by closed contacts repeat after a period.

    Closed contacts determine some coordinates from the others.  Newton's method only makes the others repeat.

    Raises
    ------
    NoOrbit
        If a coordinate differs after a period: it depends on coordinates that are not in ``within``.
    """
    off = float(np.max(np.abs(found.chart.following_between(start, found.end.state)), initial=0.0))
    if off > _HELD:
        raise NoOrbit(
            f"no orbit near the start: coordinates or velocities of `within` that closed contacts hold differ by "
            f"{off:.2g} of their scales after a period; choose another section, or add those that they depend on to "
            "`within`, as vx and vz of a body that rolls on a foot"
        )


def _advice(found: Linear) -> str:
    """Return why Newton's method may have failed: a multiplier 1, or a start that is too far."""
    known = ~np.isnan(found.matrix).any(axis=0)
    values = np.linalg.eigvals(found.matrix[np.ix_(known, known)])
    nearest = values[np.argmin(np.abs(values - 1.0))] if len(values) else np.inf
    if abs(nearest - 1.0) < _NEARLY_ONE:
        return (
            f"the map has a multiplier of {complex(nearest):.6g} there, so orbits may form a continuum or meet at a "
            "fold; change a parameter, or leave a coordinate out of `within`"
        )
    return "begin nearer: give another start, or a longer settle if the orbit attracts"


def _check_again(model: Model, found: Linear, section: Section) -> None:
    """Check that the state also repeats after a second period.

    If it does not, the given period is not a multiple of the period of the drive.

    Raises
    ------
    InvalidInput
        If the state differs after the second period.
    """
    end = found.end.state
    again = section.flow(model, end).state
    off = float(np.max(np.abs(found.chart.between(end, again)), initial=0.0))
    finite = found.matrix[np.isfinite(found.matrix)]
    if off > _AGAIN * max(1.0, float(np.linalg.norm(finite))):
        rule = (
            f"must be one of the system, but after a second one {off:.2g} is left of what repeats, in units of scales"
        )
        remedy = "A plate that vibrates has that of its motion, or multiples."
        raise InvalidInput("orbit: period", rule, float(f"{again.time - end.time:.9g}"), remedy)
