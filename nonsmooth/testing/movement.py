"""Two moving frames as input of joints and loads, with poses, velocities and accelerations in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.engine.memory.blocks import ACCELERATION, FRAME, POSITION, ROTATION, SPIN, SPIN_ACCELERATION, VELOCITY
from nonsmooth.rotations import cross, rotation, turned
from nonsmooth.testing.inputs import Case, Drawn, DrawnNumber
from nonsmooth.types import Array

Frames = tuple[Array, Array]
"""The frame blocks of the first and of the second body, shape [24] each."""
_UNIT = (1.0, 0.0, 0.0, 0.0)
_PLACE = (0.31, -0.23, 0.37)
"""Place of the second frame in the simplest input of a check [m], off the axes of the first frame at the origin."""
_TURNS = {"a": (0.12, -0.05, 0.15), "b": (-0.1, 0.2, 0.08)}
"""Turns of both frames in the simplest input of a check [rad]: no axis of one frame is parallel to an axis of the
other."""
_TURN = 0.35
"""Largest component of a turn [rad]: the two frames then differ by less than 90 degrees, so angles are unique."""
STEP = 1e-3
"""Time step of the finite differences [s]: the frames move by some millimetres and milliradians in it."""
SHIFT, TURN = np.array([0.3, -0.2, 0.7]), rotation(turned(_UNIT, (0.4, -0.3, 0.5)))
"""Shift [m] and rotation matrix by which both bodies are moved together, to check that no result depends on it."""


def three(case: Case, name: str) -> Array:
    """Return a vector of an input, shape [3], by its name."""
    return np.array([case[f"{name}_{c}"] for c in "xyz"])


@final
@dataclass(frozen=True)
class Movement:
    """Two moving frames, as input of a check. ``case`` has the random numbers of the frames, such as "velocity_a_x".

    For each frame, "a" and "b", these are the turn [rad], and the velocities and accelerations at the start. The place
    of the second frame [m] is relative to the first one, which starts at the origin. :data:`MOVEMENT` draws them.
    """

    case: Case

    def at(self, dt: float = 0.0) -> Frames:
        """Return the numbers of frame a and of frame b at the time ``dt`` [s] after the drawn state.

        They are position, axes, velocities and accelerations, shape [FRAME] for each frame.
        """
        return self._block("a", np.zeros(3), dt), self._block("b", three(self.case, "place"), dt)

    @property
    def mirrored(self) -> Movement:
        """A second movement, which differs from this one in every number: x is replaced by 0.11 - 0.9 x.

        It is evaluated before this one, so that a number which a component leaves unwritten shows.
        """
        return Movement({name: -0.9 * value + 0.11 for name, value in self.case.items()})

    @property
    def still(self) -> Movement:
        """The two frames at the same places and turns, but at rest."""
        moves = ("velocity", "spin", "acceleration")
        return Movement({name: 0.0 if name.startswith(moves) else value for name, value in self.case.items()})

    def _block(self, side: str, start: Array, dt: float) -> Array:
        velocity, acceleration = three(self.case, f"velocity_{side}"), three(self.case, f"acceleration_{side}")
        spin, spin_up = three(self.case, f"spin_{side}"), three(self.case, f"spin_up_{side}")
        # the rotation matrix is R(dt^2 / 2 * spin_up) R(dt * spin) R(turn), where R turns by a rotation vector in world
        # axes. At dt = 0 the angular velocity is spin, and the angular acceleration is spin_up
        quickening = rotation(turned(_UNIT, 0.5 * dt * dt * spin_up))
        own = rotation(turned(turned(_UNIT, three(self.case, f"turn_{side}")), dt * spin))
        carried = quickening @ spin
        block = np.zeros(FRAME)
        block[POSITION:ROTATION] = start + dt * velocity + 0.5 * dt * dt * acceleration
        block[ROTATION:VELOCITY] = (quickening @ own).ravel()
        block[VELOCITY:SPIN], block[SPIN:ACCELERATION] = velocity + dt * acceleration, dt * spin_up + carried
        block[ACCELERATION:SPIN_ACCELERATION] = acceleration
        block[SPIN_ACCELERATION:] = spin_up + dt * cross(spin_up, carried)
        return block


def _numbers() -> list[DrawnNumber]:
    found = [DrawnNumber(f"place_{c}", -1.0, 1.0, part) for c, part in zip("xyz", _PLACE, strict=True)]
    for side, turn in _TURNS.items():
        found += [DrawnNumber(f"turn_{side}_{c}", -_TURN, _TURN, part) for c, part in zip("xyz", turn, strict=True)]
    for name, size in (("velocity", 1.0), ("spin", 2.0), ("acceleration", 1.0), ("spin_up", 2.0)):
        found += [DrawnNumber(f"{name}_{side}_{c}", -size, size) for side in "ab" for c in "xyz"]
    return found


MOVEMENT = Drawn(tuple(_numbers()), Movement)
"""Two moving frames about a metre apart."""


def moved(at: Frames) -> Frames:
    """Return the blocks of two frames after both are turned by :data:`TURN` and shifted by :data:`SHIFT`."""
    one, other = (_moved(block) for block in at)
    return one, other


def _moved(block: Array) -> Array:
    made = np.zeros(FRAME)
    made[POSITION:ROTATION] = TURN @ block[POSITION:ROTATION] + SHIFT
    made[ROTATION:VELOCITY] = (TURN @ block[ROTATION:VELOCITY].reshape(3, 3)).ravel()
    made[VELOCITY:] = (block[VELOCITY:].reshape(4, 3) @ TURN.T).ravel()
    return made


def shared(at: Frames, velocity: Array, spin: Array) -> Frames:
    """Return the blocks of two frames to whose velocities a common rigid motion is added."""
    one, other = (block.copy() for block in at)
    for block in (one, other):
        block[VELOCITY:SPIN] += velocity + cross(spin, block[POSITION:ROTATION])
        block[SPIN:ACCELERATION] += spin
    return one, other
