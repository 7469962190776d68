"""How far a body can move along a line until it meets something."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector
from nonsmooth.model.overlaps import placed_pairs
from nonsmooth.placing.probe import Probe
from nonsmooth.solids.passage import Passage

_STEPS = 5000
_FARTHEST = 1e6
_ROUND_OFF = 1e-9
_NEAR = 1e-7
"""Gap up to which a contact decides the place at which two bodies touch, relative to the size of the contact.

The place found from the convex parts is corrected until this gap is 0. A larger gap shows that the contact's features
do not face each other, so the place is not corrected. Feet are added: they are parts, but some contacts ignore them.
"""
_STRAIGHT = 1e-6
"""Deviation from a translation that is round-off, relative to the motion."""
_GRAZING = 1e4
"""Largest correction, along the line, of the place at which the bodies touch, relative to the error of the gap.

If no correction up to this size brings the gap to 0, the place is not corrected. This occurs in grazing motion, in
which the gap hardly changes along the line.
"""


class Line:
    """The line along which a body can move without being turned.

    If both shapes of a contact are bounded and have convex parts or a surface, a :class:`Passage` finds the place at
    which they touch.  For other contacts the body moves forward by the least gap, again and again, until this gap is
    zero.  The body cannot pass through another body, because a gap changes no faster than the body moves.

    Parameters
    ----------
    probe : Probe
        The body where it starts.
    way : Vector
        Unit vector along which the body is to move, shape [3]; the body moves in the nearest direction that it can.
    height : float
        Gap that is left between the body and the body that it meets [m].

    Raises
    ------
    InvalidInput
        If the body cannot move this way without being turned.
    """

    def __init__(self, probe: Probe, way: Vector, height: float) -> None:
        self._probe, self._asked, self._height = probe, way, height
        self._q = probe.q.copy()
        self._rates, self._way = self._motion()
        self._size = max(row.size for row in probe.contacts.rows)
        pairs = list(placed_pairs(probe.model, range(len(probe.contacts))))
        # both shapes of a row may be the same object
        rows = [[shape.solid.set_back for shape in row.shapes if shape.solid] for row in probe.contacts.rows]
        self._slack = max(map(sum, rows), default=0.0)
        self._passages = [
            Passage(one.moved(-one.position), two.moved(-one.position), self._way, height)
            for one, two in (
                (first, second) if probe.contacts[numbers[0]].first is probe.body else (second, first)
                for numbers, first, second in pairs
            )
        ]
        measured = {number for numbers, *_ in pairs for number in numbers}
        self._by_gap = [number for number in range(len(probe.contacts)) if number not in measured]

    def met(self) -> Vector:
        """Coordinates q of the body at its first contact with another body along the line, shape [n_q].

        If the ``height`` of the line is positive, the body stops before the contact, at this gap [m].  A body that
        overlaps another body at its start is moved back along the line until it overlaps no body.

        Raises
        ------
        InvalidInput
            If the body meets nothing, or does not move along a straight line.
        """
        free = self._clear(0.0)
        distance = self._ahead() if free else self._back()
        if not abs(distance) < self._farthest:
            raise InvalidInput(
                f"placing {self._probe.name!r}",
                f"must find something to touch along {(self._asked if free else -self._asked).tolist()}",
                float(np.min(self._gaps(0.0))),
                "This is the smallest gap less the height at the start [m]; give another start or direction.",
            )
        distance = self._exact(distance)
        if not self._is_straight(distance):
            self._refuse()
        return self._at(distance)

    @property
    def _farthest(self) -> float:
        return _FARTHEST * (float(np.max(np.abs(self._gaps(0.0)))) + self._size)

    def _at(self, distance: float) -> Vector:
        return self._q + distance * self._rates

    def _gaps(self, distance: float) -> Vector:
        self._probe.q[:] = self._at(distance)
        return self._probe.gaps() - self._height

    def _least_gap(self, distance: float) -> float:
        """Least value of gap - ``height`` [m] after a move by ``distance`` [m] along the line; 0 is the goal.

        Only contacts without a :class:`Passage` are taken into account; without such contacts it is inf.
        """
        return float(np.min(self._gaps(distance)[self._by_gap])) if self._by_gap else np.inf

    def _at_distance(self, distance: float) -> list[Passage]:
        way = distance * self._way
        return [replace(passage, one=passage.one.moved(way)) for passage in self._passages]

    def _clear(self, distance: float) -> bool:
        is_clear = all(passage.clear for passage in self._at_distance(distance))
        return is_clear and self._least_gap(distance) >= -_ROUND_OFF * self._size

    def _ahead(self) -> float:
        reach = min((passage.ahead() for passage in self._passages), default=np.inf)
        distance = 0.0
        for _ in range(_STEPS if self._by_gap else 0):
            gap = self._least_gap(distance)
            if gap <= _ROUND_OFF * self._size or distance > min(reach, self._farthest):
                return float(min(distance, reach))
            distance += gap
        return float(reach)

    def _back(self) -> float:
        distance = 0.0
        for _ in range(_STEPS):
            gap = self._least_gap(distance)
            steps = [passage.back() for passage in self._at_distance(distance) if not passage.clear]
            if gap < -_ROUND_OFF * self._size:
                steps.append(-gap)
            if not steps:
                return distance
            distance -= max(steps)
        return np.inf

    def _exact(self, distance: float) -> float:
        """Distance along the line at which the least gap of all contacts is the gap to be reached, ``height`` [m].

        It is searched near ``distance``, at which the shapes have this gap. If the search fails, it is ``distance``.
        """
        from scipy.optimize import brentq

        def over(place: float) -> float:
            return float(np.min(self._gaps(place)))

        gap, slack = over(distance), 2.0 * _ROUND_OFF * self._size + self._slack
        if gap == 0.0 or abs(gap) > _NEAR * self._size + self._slack:
            # the features do not face each other, so their gap has no meaning: the distance of the shapes is the result
            return distance
        step = np.copysign(max(abs(gap), 1e-16 * self._size), gap)
        while abs(step) < _GRAZING * slack:
            if np.sign(over(distance + step)) != np.sign(gap):
                low, high = sorted((distance, distance + step))
                tolerances = {"xtol": 1e-16 * _ROUND_OFF * self._size, "rtol": 4.0 * np.finfo(float).eps}
                return float(brentq(over, low, high, **tolerances))
            step *= 2.0
        return distance

    def _motion(self) -> tuple[Vector, Vector]:
        """Coordinate rates dq/dt of a translation at 1 m/s, shape [n_q], and the unit vector of its direction.

        It is the direction nearest to ``way`` in which the body can move.
        """
        probe = self._probe
        probe.frame(0)
        u = np.linalg.lstsq(probe.jacobian(0), np.concatenate([self._asked, np.zeros(3)]), rcond=None)[0]
        twists = np.array([probe.jacobian(i) @ u for i in range(len(probe.body.frames))])
        speed = float(np.linalg.norm(twists[0, :3]))
        scale = np.repeat([1.0, max(probe.body.scales[0])], 3)
        along = np.concatenate([twists[0, :3], np.zeros(3)])
        if speed < _STRAIGHT or float(np.max(np.linalg.norm((twists - along) * scale, axis=1))) > _STRAIGHT * speed:
            self._refuse()
        return probe.coordinate_rates(u / speed), twists[0, :3] / speed

    def _is_straight(self, distance: float) -> bool:
        frames = []
        for place in (0.0, distance):
            self._probe.q[:] = self._at(place)
            frames.append(np.array([self._probe.frame(i)[:12] for i in range(len(self._probe.body.frames))]))
        moved = frames[1] - frames[0]
        moved[:, :3] -= distance * self._way
        far = self._size + abs(distance)
        return bool(np.all(np.abs(moved) <= _STRAIGHT * np.repeat([far, 1.0], (3, 9))))

    def _refuse(self) -> None:
        raise InvalidInput(
            f"placing {self._probe.name!r}",
            "must be able to move along the direction without turning",
            self._asked.tolist(),
            "Give another direction.",
        )
