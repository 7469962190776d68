"""The paper's starts and what they change, section 5.1."""

from __future__ import annotations

import math

GRAVITY = 9.81
"""[m/s^2]"""

COMMON = {"aspect_ratio": 3.9, "restitution": 0.65, "phase": 0.0, "vertical_velocity": 0.0, "pitch_rate": 0.0}

MODES: dict[str, dict[str, float]] = {
    "drift": {"beta0": math.radians(10.0)},
    "jump": {"beta0": 0.0},
    "flutter": {
        "aspect_ratio": 5.7,
        "restitution": 0.8,
        "phase": math.pi / 6.0,
        "beta0": math.radians(11.0),
        "vertical_velocity": 0.4,
        "pitch_rate": -9.6,
    },
    "free": {"beta0": math.radians(10.0)},
}


def defaults(mode: str, frequency: float, friction: float) -> dict[str, float]:
    """Return what a mode takes for the parameters that were left out, at a plate frequency [Hz] and a friction."""
    values = COMMON | MODES[mode] | {"static_friction": friction}
    if mode == "jump":
        values["vertical_velocity"] = GRAVITY / (2.0 * frequency)
    return values
