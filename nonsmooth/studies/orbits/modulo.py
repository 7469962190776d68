"""Sections modulo symmetries: where a motion repeats but for turns, as one that circles."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.coordinates import quaternions_of
from nonsmooth.studies.derivatives.passage import Passage
from nonsmooth.studies.orbits.sections import Section
from nonsmooth.studies.orbits.symmetries import Symmetry

Floats = NDArray[np.float64]
_TRIED, _SAME = 1.0, 1e-6
"""Angle by which a symmetry is tried [rad], and what may differ then for round-off, in units of scales."""
_GUESSES, _MOST, _CLOSE = 5, 20, 1e-9
"""Angles a turn that are tried first; steps of Newton's method behind the best, and the last of them [rad]: what is
left counts for nothing, as it is along the symmetries."""


@final
@dataclass(frozen=True)
class Modulo(Section):
    """Turns every end of a period back to where it is nearest to the start.

    Attributes
    ----------
    section : Section
        Where a period ends.
    symmetries : tuple of Symmetry
        What a motion may do besides repeating.
    """

    section: Section
    symmetries: tuple[Symmetry, ...]

    def passage(self, model: Model, start: State) -> Passage:
        """Run to the next end of a period, and turn it back.

        Raises
        ------
        InvalidInput
            If a contact is closed there, whose state has directions in space.
        """
        piece = self.section.passage(model, start)
        if np.any(piece.state.modes):
            remedy = "Choose another time in the period, or leave the symmetries out."
            raise InvalidInput("section: symmetries", "need a section with all contacts open", "closed", remedy)
        return replace(piece, state=self._back(model, piece.state, self._angles(model, start, piece.state)))

    def without(self, model: Model) -> tuple[str, ...]:
        """Return what the section takes away."""
        return self.section.without(model)

    def ignored(self, model: Model, state: State) -> Floats:
        """Return the directions of the symmetries."""
        return np.column_stack([one.direction(model.system, state) for one in self.symmetries])

    def check(self, model: Model, start: State) -> None:
        """Look whether a state that is turned before a period comes to where it is turned to behind it.

        Raises
        ------
        InvalidInput
            If the system lacks a symmetry.
        """
        end = self.section.passage(model, start).state
        sizes = np.concatenate([body.scales[i] for i in (0, 1) for body in model.system.bodies])
        for one in self.symmetries:
            behind, turned = one.turned(model.system, end, _TRIED), one.turned(model.system, start, _TRIED)
            try:
                there = self.section.passage(model, turned).state
                off = float(np.max(np.abs(np.concatenate([there.q - behind.q, there.u - behind.u]) / sizes)))
                found = f"a period ends {off:.2g} elsewhere, in units of scales" if off > _SAME else ""
            except (InvalidInput, RunFailed) as error:
                found = f"there is no period ({error})"
            if found:
                rule = f"must be one of the system, but turned by {_TRIED:g} rad {found}"
                raise InvalidInput("orbit: symmetries", rule, str(one), "Leave it out.")

    def turns(self, model: Model, start: State) -> dict[str, float]:
        """Return by how much the next period turns a state [rad], within half a turn."""
        angles = self._angles(model, start, self.section.passage(model, start).state)
        return dict(zip(map(str, self.symmetries), angles.tolist(), strict=True))

    def lasting(self, period: float) -> Modulo:
        """Return the same of a section with another period [s]."""
        return replace(self, section=self.section.lasting(period))

    def _back(self, model: Model, state: State, angles: Floats) -> State:
        for one, angle in zip(self.symmetries, angles.tolist(), strict=True):
            state = one.turned(model.system, state, -angle)
        return state

    def _angles(self, model: Model, start: State, end: State) -> Floats:
        """Return the angles by which the end is turned: orientations and velocities are nearest to those before."""
        scales = np.concatenate([body.scales[1] for body in model.system.bodies])
        rows = [slice(at, at + 4) for at in quaternions_of(model.system)[1]]

        def seen(state: State) -> Floats:
            # of the two quaternions of an orientation the one that is nearer to the start
            turns = [state.q[at] * (1.0 if state.q[at] @ start.q[at] >= 0.0 else -1.0) for at in rows]
            return np.concatenate([*turns, state.u / scales])

        def left(angles: Floats) -> Floats:
            return seen(self._back(model, end, angles)) - seen(start)

        tried = np.linspace(-np.pi, np.pi, _GUESSES, endpoint=False)
        guesses = [np.array(angles) for angles in itertools.product(tried, repeat=len(self.symmetries))]
        angles = min(guesses, key=lambda one: float(np.linalg.norm(left(one))))
        for _ in range(_MOST):
            slopes = np.column_stack(
                [(left(angles + h) - left(angles - h)) / 2e-6 for h in 1e-6 * np.eye(len(self.symmetries))]
            )
            change = np.linalg.lstsq(slopes, -left(angles), rcond=1e-8)[0]
            angles = angles + change
            if np.max(np.abs(change)) <= _CLOSE:
                break
        return np.asarray((angles + np.pi) % (2.0 * np.pi) - np.pi)
