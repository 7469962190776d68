"""Orbits that repeat after a period: Newton's method on the map from section to section, Floquet multipliers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import is_finite
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.errors import InvalidInput, NonsmoothError, RunFailed
from nonsmooth.progress import Display, Pace, TimeReached
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.coordinates import coordinate_number
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.derivatives.passage import Signature, named
from nonsmooth.studies.displays import display_of
from nonsmooth.studies.orbits.choosing import at_phase, chosen
from nonsmooth.studies.orbits.eigenvalues import eigenvalues, with_error
from nonsmooth.studies.orbits.linear import Corner, Linear, linear
from nonsmooth.studies.orbits.modulo import Modulo
from nonsmooth.studies.orbits.sections import Crossing, Section, Strobe
from nonsmooth.studies.orbits.symmetries import Symmetry

Floats = NDArray[np.float64]
_CLOSE = 1e-12
"""What is left of an orbit that has been found, in units of scales."""
_AGAIN = 1e-8
"""What may be left of it after another period, for a map that stretches by 1."""
_MOST = 30
"""Steps of Newton's method."""
_HELD = 1e-6
"""Largest difference of what closed contacts hold after a period, in units of scales."""
_MODES = {Mode.OPEN: "open", Mode.STICK: "closed and sticks", Mode.SLIDE: "closed and slides"}
_TOLD = 3
"""Contacts that a message names at most."""
_NEARLY_ONE = 1e-3
"""Distance of a multiplier from 1 below which Newton's method divides by less than a thousandth."""


class NoOrbit(NonsmoothError):
    """No orbit was found, or none that has a derivative."""


@final
@dataclass(frozen=True)
class Orbit:
    """A motion that repeats, but for coordinates that were left out, as those along which it drifts.

    Attributes
    ----------
    family : Family
        What it is an orbit of, at its values; where a coordinate that passes a level ends a period, so do its runs.
    state : State
        Where it is at the section.
    section : Section
        Where a period ends.
    within : tuple of str or None
        The coordinates and velocities that repeat.
    residual : float
        What is left of the difference between end and start, in units of scales.
    map : Linear
        The map of one period about it; its matrix is the monodromy matrix.
    """

    family: Family
    state: State
    section: Section
    within: tuple[str, ...] | None
    residual: float
    map: Linear

    @property
    def period(self) -> float:
        """[s]."""
        return self.map.end.state.time - self.state.time

    @property
    def turns(self) -> dict[str, float]:
        """By how much a period turns the motion [rad], by the name of the symmetry."""
        return self.section.turns(self.family.model(), self.state)

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
        return eigenvalues(self.monodromy, np.zeros_like(self.monodromy))[0]

    @property
    def multiplier_errors(self) -> Floats:
        """Bounds of the errors of the multipliers, in their order, from those of the derivatives; shape [m]."""
        kept = [name in self.smooth for name in self.map.chart.names]
        return eigenvalues(self.monodromy, self.map.error[np.ix_(kept, kept)])[1]

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie within the unit circle by more than their errors, and there are no corners."""
        return not self.corners and bool(np.all(np.abs(self.multipliers) + self.multiplier_errors < 1.0))

    @property
    def events(self) -> Signature:
        """The events of a period, by cause and contact."""
        return self.map.end.signature

    def __str__(self) -> str:
        """Return period, residual, multipliers and events."""
        model = self.family.model()
        values = ", ".join(map(with_error, self.multipliers, self.multiplier_errors)) or "none"
        rough = f"; no derivative along {', '.join(c.direction for c in self.corners)}" if self.corners else ""
        passes = ", ".join(self.section.without(model))
        trivial = f" besides 1 along the motion, which the section of {passes} takes away" if passes else ""
        turned = "".join(f"; {name} by {angle:.9g} rad" for name, angle in self.turns.items())
        return (
            f"period {self.period:.9g} s, residual {self.residual:.1e}, multipliers {values}{trivial}{turned}{rough}; "
            f"events: {named(self.events, model)}"
        )

    def value(self, coordinate: str, at: float) -> float:
        """Return a coordinate or velocity at a time within each period [s].

        Raises
        ------
        UnknownName
            If there is none of that name.
        """
        model = self.family.model()
        there = at_phase(model, self.state, self.period, at)
        return float(np.concatenate([there.q, there.u])[coordinate_number(model.system, coordinate)])


def orbit(
    what: Varied,
    period: float | None = None,
    *,
    section: Crossing | None = None,
    at: float | None = None,
    settle: float = 0.0,
    start: State | None = None,
    within: Sequence[str] | None = None,
    symmetries: Sequence[Symmetry] = (),
    display: Display | None = None,
) -> Orbit:
    """Find the orbit near a start.

    Of a system that has a period the section is a time in it; by default, in the period behind ``settle``, the one at
    which the least of all gaps is largest: where no contact is closed all coordinates are free.  Where one is closed,
    the coordinates and velocities that it holds follow the others.  A system without a period of its own needs a
    section that its motion passes; the period is found, and the multiplier 1, along the motion, is left out.

    Parameters
    ----------
    what : Scenario, System or Family
        The system.
    period : float, optional
        Period of what drives the system, or a multiple [s].
    section : Crossing, optional
        Where a period ends, in place of that.
    at : float, optional
        When in each period the section is [s].
    settle : float
        Time to run before, from the start [s]; attracting orbits come closer in it.
    start : State, optional
        Where to begin; by default as the system is placed.
    within : sequence of str, optional
        Names of coordinates and velocities that repeat ("z", or "ball.z" where bodies share a name); by default all.
        Leave out those along which the motion drifts, and all out of a plane that it stays in.
    symmetries : sequence of Symmetry, optional
        By which the motion may turn in a period, as one that circles: :class:`Turn` about the vertical, :class:`Spin`
        of a symmetric body about its own axis.
    display : Display, optional
        Where it is shown how far the time before is; on standard error by default, ``nonsmooth.progress.Quiet()`` shows
        nothing.

    Raises
    ------
    InvalidInput
        If a number is not valid, the system does not have the period, or the motion does not pass the section.
    UnknownName
        If a coordinate has no such name.
    NoOrbit
        If Newton's method does not arrive.
    """
    if (period is None) == (section is None):
        remedy = "Give the period of what drives the system; of a system without one a section=Crossing(...)."
        rule = "must be given, or a section in its place, and not both"
        raise InvalidInput("orbit: period and section", rule, (period, section), remedy)
    if period is not None and not (is_finite(period) and period > 0.0):
        raise InvalidInput("orbit: period", "must be positive and finite", period, "Give it in [s].")
    if at is not None and not (period is not None and is_finite(at) and 0.0 <= at < period):
        raise InvalidInput("orbit: at", "must be a time within a period", at, "Give it in [s].")
    if not (is_finite(settle) and settle >= 0.0):
        raise InvalidInput("orbit: settle", "must not be negative", settle, "Give it in [s].")
    family, names = Family.of(what), None if within is None else tuple(within)
    model = family.model()
    begin = model.start if start is None else start
    if settle > 0.0:
        with Pace(display_of(display)) as pace:
            begin = model.run(begin.time + settle, start=begin, progress=TimeReached(pace)).state
    if section is not None:
        watched = section.watched(family)
        return close(watched, section.entered(watched.model(), begin), _modulo(section, symmetries), names)
    assert period is not None
    state = chosen(model, begin, period) if at is None else at_phase(model, begin, period, at)
    return close(family, state, _modulo(Strobe(period), symmetries), names)


def _modulo(section: Section, symmetries: Sequence[Symmetry]) -> Section:
    return Modulo(section, tuple(symmetries)) if symmetries else section


def close(family: Family, state: State, section: Section, within: tuple[str, ...] | None) -> Orbit:
    """Return the orbit near a state of the section.

    Raises
    ------
    NoOrbit
        If Newton's method does not arrive.
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
            # values and remedies of the run are of a state that nobody asked for
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
        # along directions of symmetry nothing is to be changed: the least change of all
        change[smooth] = np.linalg.lstsq(reduced, -found.way[smooth], rcond=1e-9)[0]
        state, step = found.chart.moved(model, state, change), found.step
    raise NoOrbit(f"no orbit near the start: after {_MOST} steps {residual:.2g} is left; {_advice(found)}")


def _check_closed(model: Model, start: State, end: State) -> None:
    """Check that the same contacts are closed at both ends of a period, and stick or slide alike.

    Raises
    ------
    NoOrbit
        If they are not.
    """
    differ = np.flatnonzero(start.modes != end.modes).tolist()
    if not differ:
        return
    told = [
        f"{model.system.names.contacts[i]!r} is {_MODES[Mode(start.modes[i])]} at the start of the period and "
        f"{_MODES[Mode(end.modes[i])]} at its end"
        for i in differ[:_TOLD]
    ]
    more = f" (and {len(differ) - _TOLD} more)" if len(differ) > _TOLD else ""
    raise NoOrbit(
        f"no orbit near the start: {'; '.join(told)}{more}. Choose a section in flight. If feet take turns, let a "
        "period last until the first one is down again: Crossing(..., times=n), or n times the period"
    )


def _check_following(found: Linear, start: State) -> None:
    """Check that coordinates of ``within`` that closed contacts hold repeat, too.

    Raises
    ------
    NoOrbit
        If they do not: they depend on coordinates that were left out.
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
    """Look whether the end of a period leads to itself as the start does: else the system has another period.

    Raises
    ------
    InvalidInput
        If it does not.
    """
    end = found.end.state
    again = section.passage(model, end).state
    off = float(np.max(np.abs(found.chart.between(end, again)), initial=0.0))
    finite = found.matrix[np.isfinite(found.matrix)]
    if off > _AGAIN * max(1.0, float(np.linalg.norm(finite))):
        rule = (
            f"must be one of the system, but after a second one {off:.2g} is left of what repeats, in units of scales"
        )
        remedy = "A plate that vibrates has that of its motion, or multiples."
        raise InvalidInput("orbit: period", rule, float(f"{again.time - end.time:.9g}"), remedy)
