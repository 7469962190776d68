"""Equal balls fall into an open box, collide, and settle on its floor."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import Ball, Plate, Rest
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.materials import ContactLaws, Materials
from nonsmooth.system.system import System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_GRAVITY = 9.81
_LAYER = 2.6
"""Distance of neighbouring layers of balls at the start, relative to the radius: more than 2, so that none overlap."""
_PLAY = 0.45
"""Largest random shift of a ball at the start, relative to the free length in its cell: below 0.5, it stays inside."""
_ROOT = math.sqrt(0.5)
_TURNS = ((_ROOT, 0.0, _ROOT, 0.0), (_ROOT, 0.0, -_ROOT, 0.0), (_ROOT, -_ROOT, 0.0, 0.0), (_ROOT, _ROOT, 0.0, 0.0))
"""Unit quaternions that turn the normal of a plate to +x, -x, +y, -y."""


@final
@dataclass(frozen=True)
class BallBox(Scenario):
    """Equal balls drop into an open box, collide, and end up rolling on its floor.

    Nothing resists rolling: balls on the floor lose their speed in collisions with each other and with the walls only.
    """

    title: ClassVar[str] = "Balls in a box"
    coordinate_units: ClassVar[Mapping[str, str]] = {"kinetic_energy": "J", "height": "m"}
    units: ClassVar[Mapping[str, str]] = {"settled_at": "s", "height": "m"}

    n_balls: int = parameter(10, doc="number of balls", minimum=1, maximum=300, integer=True)
    radius: float = parameter(0.01, doc="radius of the balls", unit="m", above=0.0, usual=(1e-4, 1.0))
    density: float = parameter(2500.0, doc="density of the balls", unit="kg/m^3", above=0.0, usual=(10.0, 3e4))
    restitution: float = parameter(
        0.5, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    friction: float = parameter(
        0.3, doc="friction coefficient between balls", minimum=0.0, maximum=10.0, law="friction"
    )
    wall_friction: float = parameter(
        0.3, doc="friction coefficient of a ball on floor and walls", minimum=0.0, maximum=10.0, law="friction"
    )
    box_width: float = parameter(0.15, doc="inner width of the box", unit="m", above=0.0, usual=(1e-4, 10.0))
    drop_height: float = parameter(
        0.02, doc="height of the lowest balls above the floor", unit="m", above=0.0, usual=(1e-4, 10.0)
    )
    speed: float = parameter(
        0.3, doc="largest speed at the start along each axis, at random", unit="m/s", minimum=0.0, usual=(1e-3, 10.0)
    )
    contact_time: float = parameter(
        1e-4, doc="contact time T_c that ends an accumulation", unit="s", above=0.0, usual=(1e-12, 1e-2), law="impact"
    )
    seed: int = parameter(0, doc="seed of the random places and velocities", minimum=0, maximum=1e9, integer=True)
    t_end: float = parameter(4.0, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    def _check(self) -> None:
        if self.box_width <= 2.0 * self.radius:
            raise InvalidInput(
                "BallBox.box_width",
                f"must be above the diameter {2.0 * self.radius:g} [m]",
                self.box_width,
                "Make the box wider or the balls smaller.",
            )

    @property
    def mass(self) -> float:
        """Mass of a ball [kg]."""
        return Ball(self.radius, self.density).total_mass

    @property
    def materials(self) -> Materials:
        """Laws of a ball with a ball and with the box."""
        return Materials({("ball", "ball"): self._laws(self.friction), ("ball", "box"): self._laws(self.wall_friction)})

    def _laws(self, friction: float) -> ContactLaws:
        impact = EnergeticImpact(self.restitution, duration=self.contact_time)
        return ContactLaws(Unilateral(), Coulomb(friction) if friction > 0.0 else Frictionless(), impact)

    def places(self) -> Floats:
        """Return the balls' centres at the start [m], shape [n_balls, 3]: square layers, shifted at random."""
        random = np.random.default_rng(self.seed)
        n, r = self.n_balls, self.radius
        a_side = max(1, min(int(self.box_width / (2.2 * r)), math.ceil(n ** (1.0 / 3.0))))
        cell = self.box_width / a_side
        places = []
        for number in range(n):
            layer, rest = divmod(number, a_side**2)
            if rest == 0:
                order = random.permutation(a_side**2)
            i, j = divmod(int(order[rest]), a_side)
            free = np.array([cell - 2.0 * r, cell - 2.0 * r, (_LAYER - 2.0) * r])
            x, y = ((k + 0.5) * cell - 0.5 * self.box_width for k in (i, j))
            z = self.drop_height + r + (layer + 0.5 * (_LAYER - 2.0) / _LAYER) * _LAYER * r
            places.append(np.array([x, y, z]) + random.uniform(-_PLAY, _PLAY, 3) * free)
        return np.array(places)

    def build(self) -> System:
        """Return box and balls at their start."""
        half = 0.5 * self.box_width
        sides = ((-half, 0.0, 0.0), (half, 0.0, 0.0), (0.0, -half, 0.0), (0.0, half, 0.0))
        walls = [Plate(Rest(position=p, orientation=q)) for p, q in zip(sides, _TURNS, strict=True)]
        box = [Plate(), *walls]
        balls = [Ball(self.radius, self.density) for _ in range(self.n_balls)]
        system = System([*box, *balls], gravity=_GRAVITY)
        system.contact_all(self.materials, {"box": box, "ball": balls})
        random = np.random.default_rng([self.seed, 1])
        for ball, place in zip(balls, self.places(), strict=True):
            velocity = random.uniform(-self.speed, self.speed, 3)
            system.place(ball, position=tuple(place), velocity=tuple(velocity))
        return system

    def positions(self, solution: Solution) -> Floats:
        """Return the balls' centres [m], shape [n_samples, n_balls, 3]."""
        return solution.q.reshape(len(solution.t), -1, 7)[:, :, :3]

    def kinetic_energy(self, solution: Solution) -> Floats:
        """Return the kinetic energy of all balls over the samples [J], shape [n_samples]."""
        return self._kinetic(solution.u)

    def _kinetic(self, u: Floats) -> Floats:
        weights = 0.5 * self.mass * np.array([1.0, 1.0, 1.0, *(3 * [0.4 * self.radius**2])])
        return np.asarray(np.sum(u.reshape(len(u), -1, 6) ** 2 * weights, axis=(1, 2)))

    def closed_contacts(self, solution: Solution) -> NDArray[np.int64]:
        """Return the number of closed contacts after each event, shape [n_events]."""
        events = solution.events
        event = np.repeat(np.arange(len(events)), np.diff(events.first))
        return np.bincount(event, weights=events.codes >> 6 & 1, minlength=len(events)).astype(np.int64)

    @property
    def fall_energy(self) -> float:
        """Potential energy that the balls lose on their fall to the floor [J]."""
        return float(self.mass * _GRAVITY * np.sum(self.places()[:, 2] - self.radius))

    def settled(self, solution: Solution) -> float | None:
        """Return the time from which the kinetic energy is below 1e-6 of the energy of the fall [s], or None."""
        moving = np.flatnonzero(self.kinetic_energy(solution) > 1e-6 * self.fall_energy)
        last = int(moving[-1]) + 1 if len(moving) > 0 else 0
        return float(solution.t[last]) if last < len(solution.t) else None

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return kinetic energy [J] and height of the highest ball's top [m] over the samples."""
        top = np.max(self.positions(solution)[:, :, 2], axis=1) + self.radius
        return {"kinetic_energy": self.kinetic_energy(solution), "height": top}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}: centres [m] and velocities [m/s] of the balls at the end, one after another."""
        q, u = solution.q_end.reshape(-1, 7)[:, :3], solution.u_end.reshape(-1, 6)[:, :3]
        return {"q": q.ravel().tolist(), "u": u.ravel().tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the results of a run: numbers of events, of impacts, and of contacts that are closed at the end.

        Also ``kinetic_share``, the kinetic energy at the end relative to the energy of the fall, ``settled_at``, the
        time at which the balls have settled [s], and ``height``, the top of the highest ball at the end [m].
        """
        return {
            "events": len(solution.events),
            "impacts": solution.counters.impacts,
            "closed_contacts": int(self.closed_contacts(solution)[-1]),
            "kinetic_share": float(self._kinetic(solution.u_end[None])[0]) / self.fall_energy,
            "settled_at": self.settled(solution),
            "height": float(np.max(solution.q_end.reshape(-1, 7)[:, 2])) + self.radius,
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return two criteria: the least distance of bodies over all samples, and the balance of energy."""
        account, r = solution.energy, self.radius
        q_end, u_end = solution.q_end.reshape(-1, 7), solution.u_end[None]
        fallen = self.mass * _GRAVITY * float(np.sum(self.places()[:, 2] - q_end[:, 2]))
        given = fallen + float(self.kinetic_energy(solution)[0] - self._kinetic(u_end)[0])
        apart = min(self._least_distance(places) for places in self.positions(solution))
        name = "losses over the energy that heights and speeds gave"
        return (
            Criterion("least distance of two bodies over the radius", apart / r, -1e-6, math.inf, "unilateral contact"),
            Criterion.near(name, account.loss / given, 1.0, 1e-6, "balance of energy"),
        )

    def _least_distance(self, places: Floats) -> float:
        """Return the least distance of balls, floor and walls at one instant [m]."""
        one, two = np.triu_indices(len(places), 1)
        balls = np.linalg.norm(places[one] - places[two], axis=1) - 2.0 * self.radius
        walls = 0.5 * self.box_width - self.radius - np.abs(places[:, :2])
        floor = places[:, 2] - self.radius
        return float(min(np.min(balls, initial=math.inf), np.min(walls), np.min(floor)))

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the pile at the start and the end, and energy and contacts over time."""
        return {"pile": _pile(self, solution), "history": _history({"": (self, solution)})}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the pile of the default run, and the history of runs with two coefficients of restitution."""
        boxes = {f"e = {e:g}": cls(restitution=e) for e in (0.5, 0.8)}
        runs = {label: (box, run(box)) for label, box in boxes.items()}
        return {"pile": _pile(*runs["e = 0.5"]), "history": _history(runs)}


def _pile(scenario: BallBox, solution: Solution) -> Figure:
    """Draw the balls at the start and at the end, from the side and from above; nearer balls are lighter."""
    from matplotlib.patches import Circle

    places, closed = scenario.positions(solution), int(scenario.closed_contacts(solution)[-1])
    half, top = 500.0 * scenario.box_width, 1e3 * (np.max(places[0, :, 2]) + 1.5 * scenario.radius)
    share = float(scenario.kinetic_energy(solution)[-1]) / scenario.fall_energy
    title = f"{scenario.n_balls} balls have {share:.1e} of the energy of their fall left, and {closed} closed contacts"
    figure, axes = charts.panels(2, 2, title, (7.2, 5.6), sharex=True, height_ratios=[top, 2.0 * half])
    instants = (places[0], "start"), (places[-1], f"t = {solution.t[-1]:g} s")
    views = ("from the side", "z [mm]", 2, (0.0, top)), ("from above", "y [mm]", 1, (-half, half))
    cells = ((*view, *instant) for view in views for instant in instants)
    for ax, (view, label, up, limits, centres, name) in zip(axes, cells, strict=True):
        depth = centres[:, 2] if up == 1 else -centres[:, 1]
        for i in np.argsort(depth):  # the ball nearest to the eye is drawn last
            near = (depth[i] - np.min(depth)) / max(float(np.ptp(depth)), scenario.radius)
            place, shade = (1e3 * centres[i, 0], 1e3 * centres[i, up]), str(0.6 + 0.35 * near)
            ax.add_patch(Circle(place, 1e3 * scenario.radius, facecolor=shade, edgecolor="black", linewidth=0.8))
        ax.set(aspect="equal", xlim=(-half, half), ylim=limits, xlabel="x [mm]", ylabel=label)
        ax.set_title(f"{view}, {name}", fontsize=10)
        ax.label_outer()
    return figure


def _history(runs: Mapping[str, tuple[BallBox, Solution]]) -> Figure:
    """Draw the kinetic energy, relative to the energy of the fall, and the number of closed contacts, over time."""
    energies, closed = {}, {}
    for name, (scenario, solution) in runs.items():
        energies[name] = solution.t, scenario.kinetic_energy(solution) / scenario.fall_energy
        counts = scenario.closed_contacts(solution)
        closed[name] = np.append(solution.events.time, solution.t_end), np.append(counts, counts[-1])
    panels = {"kinetic energy /\nenergy of the fall": energies, "closed contacts": closed}
    figure = charts.histories(panels, "Collisions take the energy; what rolls on keeps it")
    energy, contacts = figure.axes
    energy.set_yscale("log")
    contacts.locator_params(axis="y", integer=True)
    for line in contacts.lines:
        line.set_drawstyle("steps-post")
    return figure
