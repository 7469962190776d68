"""Case: a system as data, which is built, written as a script and made smaller."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import nonsmooth as ns
from nonsmooth.interfaces import Body, Joint


@dataclass(frozen=True)
class Start:
    """How a body is placed: the function of the package, and its arguments."""

    how: str
    arguments: tuple[tuple[str, Any], ...]

    def apply(self, system: ns.System, body: Body) -> None:
        """Place the body."""
        if self.how == "place":
            system.place(body, **dict(self.arguments))
        else:
            getattr(ns, self.how)(system, body, **dict(self.arguments))

    def text(self, body: str) -> str:
        """Return the line of a script."""
        words = ", ".join(f"{name}={value!r}" for name, value in self.arguments)
        return f"system.place({body}, {words})" if self.how == "place" else f"ns.{self.how}(system, {body}, {words})"

    @property
    def given(self) -> Start:
        """The place as it is given, before the body is moved from there."""
        return Start("place", tuple(row for row in self.arguments if row[0] != "height"))


@dataclass(frozen=True)
class Case:
    """Bodies with their starts, contacts and joints by the numbers of the bodies."""

    bodies: tuple[Body, ...]
    starts: tuple[Start | None, ...]
    contacts: tuple[tuple[int, int, ns.ContactLaws], ...]
    joints: tuple[tuple[int, int, Joint], ...] = ()
    gravity: float = 9.81
    t_end: float = 0.2
    sample_interval: float = 5e-4

    def build(self) -> ns.System:
        """Return the system, every body placed."""
        system = ns.System(list(self.bodies), gravity=self.gravity)
        for one, other, laws in self.contacts:
            system.contact(
                self.bodies[one], self.bodies[other], normal=laws.normal, friction=laws.friction, impact=laws.impact
            )
        for one, other, joint in self.joints:
            system.joint(joint, self.bodies[one], self.bodies[other])
        for start, body in self._moves:
            start.apply(system, self.bodies[body])
        return system

    @property
    def _moves(self) -> list[tuple[Start, int]]:
        """All bodies as given first, as a body is moved until it touches any of the others; then those that are."""
        starts = [(start, k) for k, start in enumerate(self.starts) if start is not None]
        return [(start.given, k) for start, k in starts] + [row for row in starts if row[0].how != "place"]

    def without(self, number: int) -> Case:
        """Return the case without one of the bodies and all that belongs to it."""

        def renumbered(rows: tuple[tuple[int, int, Any], ...]) -> tuple[tuple[int, int, Any], ...]:
            return tuple((i - (i > number), j - (j > number), what) for i, j, what in rows if number not in (i, j))

        kept = [k for k in range(len(self.bodies)) if k != number]
        return replace(
            self,
            bodies=tuple(self.bodies[k] for k in kept),
            starts=tuple(self.starts[k] for k in kept),
            contacts=renumbered(self.contacts),
            joints=renumbered(self.joints),
        )

    def script(self, title: str) -> str:
        """Return a program that builds and runs the case."""
        names = [f"b{k}" for k in range(len(self.bodies))]
        lines = [f'"""{title}"""', "import nonsmooth as ns", "from bodies import *", "from laws import *", ""]
        lines += [f"{name} = {body!r}" for name, body in zip(names, self.bodies, strict=True)]
        lines += [f"system = ns.System([{', '.join(names)}], gravity={self.gravity!r})"]
        kinds = list(dict.fromkeys(repr(laws) for _, _, laws in self.contacts))
        for k, (one, other, laws) in enumerate(self.contacts):
            number = kinds.index(repr(laws))
            if repr(laws) not in [repr(row[2]) for row in self.contacts[:k]]:
                words = f"normal={laws.normal!r}, friction={laws.friction!r}, impact={laws.impact!r}"
                lines.append(f"laws{number} = dict({words})")
            lines.append(f"system.contact({names[one]}, {names[other]}, **laws{number})")
        lines += [f"system.joint({joint!r}, {names[i]}, {names[j]})" for i, j, joint in self.joints]
        lines += [start.text(names[k]) for start, k in self._moves]
        lines += [
            "try:",
            f"    solution = ns.simulate(system, {self.t_end!r}, sample_interval={self.sample_interval!r})",
        ]
        lines += ['    print(solution.status, "energy residual", solution.energy.residual)']
        lines += ["except ns.NonsmoothError as error:", "    print(type(error).__name__, error)"]
        return "\n".join(lines) + "\n"
