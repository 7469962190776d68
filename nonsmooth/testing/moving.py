"""Two frames that move as an input says, with everything that their blocks hold in closed form."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.rotations import cross, rotation, turned
from nonsmooth.testing.draws import Case, Variable

Array = NDArray[np.float64]
Frames = tuple[Array, Array]
"""The blocks of the first and of the second body's frame."""
_UNIT = (1.0, 0.0, 0.0, 0.0)
_PLACE = (0.31, -0.23, 0.37)
"""Where the second frame is in the simplest input [m]: on no axis of the first."""
_TURNS = {"a": (0.12, -0.05, 0.15), "b": (-0.1, 0.2, 0.08)}
"""How the frames are turned in the simplest input [rad]: no axis of one is parallel to one of the other."""
_TURN = 0.35
"""Largest part of a turn [rad]: two of them stay below a right angle, within which angles have one meaning."""
STEP = 1e-3
"""Step of the differences [s], in which the frames move by some thousandths."""


def space() -> list[Variable]:
    """Return numbers that make two moving frames, in metres and seconds."""
    found = [Variable(f"place_{c}", -1.0, 1.0, part) for c, part in zip("xyz", _PLACE, strict=True)]
    for side, turn in _TURNS.items():
        found += [Variable(f"turn_{side}_{c}", -_TURN, _TURN, part) for c, part in zip("xyz", turn, strict=True)]
    for name, size in (("velocity", 1.0), ("spin", 2.0), ("acceleration", 1.0), ("spin_up", 2.0)):
        found += [Variable(f"{name}_{side}_{c}", -size, size) for side in "ab" for c in "xyz"]
    return found


def _three(case: Case, name: str) -> Array:
    return np.array([case[f"{name}_{c}"] for c in "xyz"])


def _block(case: Case, side: str, start: Array, dt: float) -> Array:
    velocity, acceleration = _three(case, f"velocity_{side}"), _three(case, f"acceleration_{side}")
    spin, spin_up = _three(case, f"spin_{side}"), _three(case, f"spin_up_{side}")
    # the turn by the spin, and over it a turn that quickens: its rate is spin_up dt about an axis that stays
    quickening = rotation(turned(_UNIT, 0.5 * dt * dt * spin_up))
    own = rotation(turned(turned(_UNIT, _three(case, f"turn_{side}")), dt * spin))
    carried = quickening @ spin
    block = np.zeros(FRAME)
    block[:3] = start + dt * velocity + 0.5 * dt * dt * acceleration
    block[3:12] = (quickening @ own).ravel()
    block[12:15], block[15:18] = velocity + dt * acceleration, dt * spin_up + carried
    block[18:21], block[21:24] = acceleration, spin_up + dt * cross(spin_up, carried)
    return block


def frames(case: Case, dt: float = 0.0) -> Frames:
    """Return the two frames of an input, a while later."""
    return _block(case, "a", np.zeros(3), dt), _block(case, "b", _three(case, "place"), dt)


def moved(block: Array, axes: Array, shift: Array) -> Array:
    """Return a frame as it is after everything has been turned and shifted."""
    made = np.zeros(FRAME)
    made[:3] = axes @ block[:3] + shift
    made[3:12] = (axes @ block[3:12].reshape(3, 3)).ravel()
    for at in (12, 15, 18, 21):
        made[at : at + 3] = axes @ block[at : at + 3]
    return made


def shared(block: Array, velocity: Array, spin: Array) -> Array:
    """Return a frame whose velocities are those that it has and those of a rigid motion of all space."""
    made = block.copy()
    made[12:15] += velocity + cross(spin, block[:3])
    made[15:18] += spin
    return made


SHIFT, TURN = np.array([0.3, -0.2, 0.7]), rotation(turned(_UNIT, (0.4, -0.3, 0.5)))
"""Where both bodies are put together, to see whether anything depends on it."""


def slope(value: Callable[[float], Any], dt: float = STEP) -> tuple[Array, float]:
    """Return the derivative of a value at 0 by differences of fourth order, and how well it is known."""
    at = {i: np.asarray(value(i * dt), dtype=float) for i in (-4, -2, -1, 1, 2, 4)}
    fine = (8.0 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12.0 * dt)
    coarse = (8.0 * (at[2] - at[-2]) - (at[4] - at[-4])) / (24.0 * dt)
    noise = 1e-14 * max(float(np.max(np.abs(values), initial=0.0)) for values in at.values()) / dt
    return np.asarray(fine), float(np.max(np.abs(fine - coarse), initial=0.0)) + noise
