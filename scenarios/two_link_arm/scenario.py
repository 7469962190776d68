"""A two-link arm whose tip slides on a moving belt until an impact without collision throws it off."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import ConstantVelocity, Coordinate, DrivenBody, GeneralisedBody, Plane, Point, PointFrame
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from . import arm, painleve

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_GRAVITY = 9.8
_FRICTION: Mapping[str, Any] = {"minimum": 0.0, "usual": (0.01, 2.0), "law": "friction"}


@final
@dataclass(frozen=True)
class TwoLinkArm(Scenario):
    """A two-link arm drags its tip on a belt, jams and bounces: Painlevé's paradox.

    Above the critical friction no contact force exists while the tip slides: an impact without collision stops the
    slip.  Springs and dampers are those of Liu et al.  Their place at the elbow and the belt's speed are our choice.

    References
    ----------
    C. Liu, Z. Zhao, B. Chen, "The bouncing motion appearing in a robotic system with unilateral constraint",
    Nonlinear Dynamics 49 (2007) 217-232.
    """

    title: ClassVar[str] = "Two-link arm on a moving belt"
    samples: ClassVar[int] = 4000
    coordinate_units: ClassVar[Mapping[str, str]] = {"theta": "rad", "gap": "m"}
    units: ClassVar[Mapping[str, str]] = {"largest_gap": "m"}

    link_mass: float = parameter(1.0, doc="mass of a link", unit="kg", above=0.0, usual=(1e-3, 1e3))
    link_length: float = parameter(1.0, doc="length of a link", unit="m", above=0.0, usual=(1e-3, 1e2))
    height: float = parameter(5.0 / 3.0, doc="height of the pivot over the belt", unit="m", above=0.0)
    angle: float = parameter(0.7, doc="angle of the first link from the vertical at the start", unit="rad")
    friction: float = parameter(0.5, doc="kinetic friction coefficient mu", **_FRICTION)
    static_friction: float = parameter(0.8, doc="static friction coefficient mu_s", **_FRICTION)
    restitution: float = parameter(
        0.0, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, assumed=True, law="impact"
    )
    belt_speed: float = parameter(1.0, doc="speed of the belt towards -x", unit="m/s", usual=(1e-3, 1e2), assumed=True)
    spring: float = parameter(
        100.0, doc="torsional spring at the elbow, slack at the start", unit="N m/rad", minimum=0.0, usual=(1e-3, 1e6)
    )
    damping: float = parameter(
        0.1, doc="torsional damper at the elbow", unit="N m s/rad", minimum=0.0, usual=(1e-6, 1e4)
    )
    t_end: float = parameter(1.5, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    def _check(self) -> None:
        cosine = self.height / self.link_length - np.cos(self.angle)
        if not -1.0 < cosine < 1.0:
            raise InvalidInput(
                "TwoLinkArm.angle",
                f"must let the tip reach the belt {self.height:g} m below the pivot",
                self.angle,
                f"The second link would need the cosine {cosine:.6g}.",
            )

    @property
    def sizes(self) -> tuple[float, float, float]:
        """Height of the pivot over the length of a link, mass [kg] and length [m] of a link."""
        return self.height / self.link_length, self.link_mass, self.link_length

    @property
    def second_angle(self) -> float:
        """Angle of the second link at the start [rad]."""
        return painleve.second_angle(self.angle, self.height / self.link_length)

    @property
    def reduced_coefficient(self) -> float:
        """A = G_nn - mu G_nt at the start [1/kg]: normal acceleration of the sliding tip per normal force.

        G is the Delassus matrix of the tip (n normal, t tangent).  A is negative in Painleve's paradox.
        """
        return painleve.reduced_coefficient(self.angle, self.friction, *self.sizes)

    def build(self) -> System:
        """Return arm and belt at their start."""
        first, second = self.angle, self.second_angle
        body = GeneralisedBody(
            coordinates=(Coordinate("theta_1", "rad", first), Coordinate("theta_2", "rad", second)),
            mass=arm.mass,
            force=arm.force,
            potential=arm.potential,
            power=arm.power,
            drawn=arm.links,
            moving_frames=(PointFrame(arm.tip, arm.tip_jacobian, arm.tip_bias, (Point(),)),),
            constants=self.numbers() | {"elbow_angle": second - first},
        )
        belt = DrivenBody(ConstantVelocity(velocity=(-self.belt_speed, 0.0, 0.0)), (Plane(),))
        system = System([body, belt], gravity=_GRAVITY)
        friction = Coulomb(self.friction, self.static_friction)
        system.contact(body, belt, normal=Unilateral(), friction=friction, impact=EnergeticImpact(self.restitution))
        return system

    def gap(self, solution: Solution) -> Floats:
        """Return the height of the tip over the belt [m], shape [n_samples]."""
        cosines = np.cos(solution.q[:, 0]) + np.cos(solution.q[:, 1])
        return np.asarray(self.height - self.link_length * cosines)

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return both angles [rad] and the gap [m] over the samples."""
        return {"theta_1": solution.q[:, 0], "theta_2": solution.q[:, 1], "gap": self.gap(solution)}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}: the angles [rad] and their rates [rad/s] at the end."""
        return {"q": solution.q_end[:2].tolist(), "u": solution.u_end.tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the results of a run by name.

        ``reduced_coefficient`` is the normal acceleration of the sliding tip per normal force at the start [1/kg],
        ``impacts_without_collision`` the number of impacts that Painleve's paradox causes, ``impacts`` the number of
        other impacts, and ``largest_gap`` the largest gap between tip and belt [m].
        """
        return {
            "reduced_coefficient": self.reduced_coefficient,
            "impacts_without_collision": solution.events.count(Cause.PAINLEVE),
            "impacts": solution.events.count(Cause.IMPACT),
            "largest_gap": float(np.max(self.gap(solution))),
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return criteria.

        1. For the published sizes of the arm: least critical friction, and reduced coefficient of the published start.
        2. For a belt that moves: an impact without collision at the start if, and only if, it is in Painleve's paradox.
        3. If this impact occurs: its normal impulse.
        """
        found = []
        if self.sizes == (5.0 / 3.0, 1.0, 1.0):
            source = "Liu, Zhao, Chen (2007)"
            least, _ = painleve.least_critical_friction(*self.sizes)
            found.append(Criterion.near("least critical friction", least, 0.4807, 1e-4, source))
            if (self.angle, self.friction) == (0.7, 0.5):
                name = "reduced coefficient at the start [1/kg]"
                found.append(Criterion.near(name, self.reduced_coefficient, -0.0167, 5e-5, source))
        if self.belt_speed > 0.0:
            events = solution.events
            struck = float(len(events.cause) > 0 and events.cause[0] == Cause.PAINLEVE)
            source = "no force exists where G_nn - mu G_nt < 0"
            paradox = self.reduced_coefficient < 0.0
            found.append(Criterion.near("impacts without collision at the start", struck, float(paradox), 0.0, source))
            if paradox and struck:
                exact = painleve.impulse(self.angle, self.friction, self.restitution, self.belt_speed, *self.sizes)
                impulse = float(events.impulse[0, 0, 0])
                source = "one contact, slip then stick, in its normal impulse"
                found.append(Criterion.near("normal impulse of it [N s]", impulse, exact, 1e-5 * exact, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the gap over time."""
        found = self.summarise(solution)
        numbers = f"{found['impacts']} impacts, and {found['impacts_without_collision']} without collision (x)"
        return {"gap": _gaps([(self, solution)], f"{numbers}, with e = {self.restitution:g}")}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the critical friction over the postures, and the gap for the springs and dampers of the source."""
        arms = [cls(spring=spring, damping=damping) for damping in (0.1, 2.0) for spring in (100.0, 150.0)]
        claim = "An impact without collision (x) throws the tip off the belt; it bounces"
        return {
            "critical_friction": _critical_friction(cls()),
            "bouncing": _gaps([(one, run(one)) for one in arms], f"{claim}, with e = {cls().restitution:g}"),
        }


def _critical_friction(scenario: TwoLinkArm) -> Figure:
    """Draw the least friction of Painleve's paradox over the first link's angle; mark the start of the runs."""
    ratio = scenario.height / scenario.link_length
    low, high = math.acos(min(1.0, ratio)), math.acos(max(-1.0, ratio - 1.0))
    angles = np.linspace(low, high, 402)[1:-1]
    critical = np.array([painleve.critical_friction(x, *scenario.sizes) for x in angles])
    least, where = painleve.least_critical_friction(*scenario.sizes)
    figure = charts.comparison(
        {"critical friction": (angles, critical)},
        {
            f"least: {least:.4f} at {where:.3f} rad": ([where], [least]),
            "start of the runs": ([scenario.angle], [scenario.friction]),
        },
        "angle of the first link from the vertical [rad]",
        "friction coefficient",
        "Above the curve, friction pulls the sliding tip into the belt",
    )
    (ax,) = figure.axes
    ax.fill_between(angles, critical, 2.0, where=critical < 2.0, color="tab:red", alpha=0.15, linewidth=0.0)
    ax.text(0.85 * where, 1.2, "no force fulfils the laws", ha="center", fontsize=9, color="tab:red")
    ax.set_ylim(0.0, 1.5)
    return figure


def _gaps(runs: list[tuple[TwoLinkArm, Solution]], title: str) -> Figure:
    """Draw the gap of the tip over time, in a panel for each damper; crosses mark impacts without collision."""
    dampers = sorted({one.damping for one, _ in runs})
    size = (7.2, 1.2 + 2.2 * len(dampers))
    figure, axes = charts.panels(len(dampers), 1, title, size, sharex=True, sharey=True)
    for ax, damping in zip(axes, dampers, strict=True):
        own = [(one, solution) for one, solution in runs if one.damping == damping]
        gaps = {f"spring {one.spring:g} N m/rad": (found.t, 1e3 * one.gap(found)) for one, found in own}
        charts.histories({"gap [mm]": gaps}, xlabel="", axes=[ax])
        for place, (_, found) in enumerate(own):
            times, colour = found.events.time[found.events.cause == Cause.PAINLEVE], charts.COLOURS[place]
            ax.plot(times, np.zeros(len(times)), "x", color=colour, markersize=8, clip_on=False, zorder=3)
        ax.set_title(f"damper {damping:g} N m s/rad", fontsize=9, loc="right")
    axes[-1].set_xlabel("time [s]")
    charts.legend(figure)
    return figure
