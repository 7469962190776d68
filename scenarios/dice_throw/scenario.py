"""Dice thrown onto a table: they strike it and each other, and end on a face."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from bodies import BoxBody, Plate, Rest
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.parameters import parameter, rules
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

Floats = NDArray[np.float64]

_SAMPLES = 500
_GRAVITY = 9.81
EYES = np.array([[5, 3, 1], [2, 4, 6]])
"""Eyes on the faces against and along the three axes of a die; opposite ones make seven."""
_AT_REST = 1e-6
"""Speeds below which a die has come to rest [m/s and rad/s]."""


@final
@dataclass(frozen=True)
class DiceThrow(Scenario):
    """Cubes thrown together, rounded or sharp: vertices on the table, vertices on faces and edges on edges among them.

    ``throw`` numbers the throws: orientations and spins are drawn at random from it, and always the same.
    """

    title: ClassVar[str] = "Throw of dice"
    coordinate_units: ClassVar[Mapping[str, str]] = {"x": "m", "y": "m", "z": "m"}
    units: ClassVar[Mapping[str, str]] = {"last_event": "s"}

    number: float = parameter(3.0, doc="number of dice", minimum=1.0, maximum=20.0)
    throw: float = parameter(1.0, doc="number of the throw", minimum=0.0, maximum=1e9)
    edge: float = parameter(0.016, doc="edge of a die", unit="m", above=0.0, usual=(1e-3, 1.0))
    rounding: float = parameter(1e-3, doc="radius of the edges and vertices of a die", unit="m", minimum=0.0)
    density: float = parameter(1200.0, doc="density", unit="kg/m^3", above=0.0, usual=(10.0, 3e4))
    speed: float = parameter(0.6, doc="speed along the table", unit="m/s", minimum=0.0, usual=(1e-2, 1e2))
    spin: float = parameter(15.0, doc="usual angular velocity", unit="rad/s", minimum=0.0, usual=(1e-2, 1e3))
    restitution: float = parameter(
        0.5, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    friction: float = parameter(0.3, doc="friction coefficient mu", minimum=0.0, usual=(0.0, 2.0), law="friction")
    t_end: float = parameter(1.0, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    def _check(self) -> None:
        for name in ("number", "throw"):
            if getattr(self, name) != int(getattr(self, name)):
                raise InvalidInput(f"DiceThrow.{name}", "must be a whole number", getattr(self, name), "It counts.")
        _ = self.die

    def resolved(self) -> Mapping[str, Any]:
        """Return all parameters as given."""
        return {name: getattr(self, name) for name in rules(type(self))}

    @property
    def sample_interval(self) -> float:
        """A five-hundredth of the run [s]."""
        return self.t_end / _SAMPLES

    @property
    def die(self) -> BoxBody:
        """One of the dice."""
        half = 0.5 * self.edge
        return BoxBody(half, half, half, density=self.density, rounding=self.rounding)

    def build(self) -> System:
        """Return table and dice, in the air one over the other."""
        n = int(self.number)
        table, dice = Plate(Rest()), [self.die for _ in range(n)]
        system = System([table, *dice], gravity=_GRAVITY)
        for i, die in enumerate(dice):
            for other in [table, *dice[:i]]:
                system.contact(
                    other,
                    die,
                    normal=Unilateral(),
                    friction=Coulomb(self.friction),
                    impact=EnergeticImpact(self.restitution),
                )
        rng = np.random.default_rng(int(self.throw))
        for i, die in enumerate(dice):
            turn = rng.normal(size=4)
            aside = i - 0.5 * (n - 1)
            system.place(
                die,
                # farther from each other than the diagonals
                position=(0.0, 1.4 * self.edge * aside, (5.0 + 1.25 * i) * self.edge),
                orientation=turn / np.linalg.norm(turn),
                velocity=(self.speed, -0.4 * self.speed * aside, -0.5 * self.speed),
                angular_velocity=self.spin * rng.normal(size=3),
            )
        return system

    def upright(self, solution: Solution) -> Floats:
        """Return the vertical components of the axes of every die at the end [n, 3]."""
        a, b, c, d = solution.q_end.reshape(-1, 7)[:, 3:].T
        found: Floats = np.column_stack([2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d])
        return found

    def heights(self, solution: Solution) -> Floats:
        """Return the heights of the centres over the samples [m], shape [n_samples, n]."""
        return solution.q[:, 2::7]

    def eyes(self, solution: Solution) -> list[int]:
        """Return the eyes that each die shows at the end: of the face that looks up most."""
        upright = self.upright(solution)
        axes = np.argmax(np.abs(upright), axis=1)
        return [int(EYES[int(up[axis] > 0.0), axis]) for axis, up in zip(axes, upright, strict=True)]

    def on_a_face(self, solution: Solution) -> bool:
        """Whether all dice have come to rest on the table."""
        low = np.all(np.abs(self.heights(solution)[-1] - 0.5 * self.edge) < 1e-3 * self.edge)
        return bool(low and np.max(np.abs(solution.u_end)) < _AT_REST)

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return x, y and z of every die [m] over the samples."""
        q = solution.q.reshape(len(solution.t), -1, 7)
        return {f"{c}_{i + 1}": q[:, i, j] for i in range(q.shape[1]) for j, c in enumerate("xyz")}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}: positions [m], quaternions, velocities at the end."""
        return {"q": solution.q_end.tolist(), "u": solution.u_end.tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the eyes, whether all lie on a face, and the number of impacts."""
        return {
            "eyes": self.eyes(solution),
            "at_rest": self.on_a_face(solution),
            "impacts": solution.counters.impacts,
            "last_event": float(solution.events.time[-1]),
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return the books of the energy, and of dice at rest how flat they lie."""
        account = solution.energy
        start, end = account.kinetic_start + account.potential_start, account.kinetic_end + account.potential_end
        found = []
        if account.loss > 0.0:
            ratio = (start - end) / account.loss
            found.append(Criterion.near("energy lost over losses booked", ratio, 1.0, 1e-6, "balance of energy"))
        # by the formula of Steiner
        side, r = self.edge - 2.0 * self.rounding, self.rounding
        volume = side**3 + 6.0 * side**2 * r + 3.0 * math.pi * side * r**2 + 4.0 / 3.0 * math.pi * r**3
        weights = self.density * volume * _GRAVITY * float(np.sum(self.heights(solution)[0]))
        found.append(
            Criterion.near(
                "potential energy at the start over weights times heights",
                account.potential_start / weights,
                1.0,
                1e-9,
                "mass of a cube, rounded or not",
            )
        )
        if self.on_a_face(solution):
            lowest = float(np.max(np.abs(self.heights(solution)[-1] / (0.5 * self.edge) - 1.0)))
            tilt = float(np.max(1.0 - np.max(np.abs(self.upright(solution)), axis=1)))
            source = "a cube at rest on a plane lies on a face"
            found += [
                Criterion.near("height of a centre over half an edge, less 1", lowest, 0.0, 1e-9, source),
                Criterion.near("1 - cosine of the tilt", tilt, 0.0, 1e-12, source),
            ]
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the dice at some instants and their heights."""
        from scenarios.dice_throw.figures import throw

        return {"throw": throw(self, solution)}

    @property
    def diagonal(self) -> float:
        """Half the diagonal of a die, the most that its centre can be over a table that it touches [m]."""
        return 0.5 * math.sqrt(3.0) * self.edge
