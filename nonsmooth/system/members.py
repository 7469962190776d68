"""Members of a system: its bodies, with their numbers and names."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import Any, final

from nonsmooth.checks import check_pair
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body
from nonsmooth.system.input_checks import stranger
from nonsmooth.system.names import Naming


@final
class Members:
    """The bodies of a system. Bodies are distinguished as objects, even if their values are equal.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies, in the order of the system.
    """

    def __init__(self, bodies: Sequence[Body]) -> None:
        self.__setstate__({"bodies": tuple(bodies), "naming": Naming(bodies)})

    def __getstate__(self) -> dict[str, Any]:
        return {"bodies": self.bodies, "naming": copy.copy(self.naming)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.bodies: tuple[Body, ...] = state["bodies"]
        self.naming: Naming = state["naming"]
        # computed for each copy of the system, because the copy of a body has another identity
        self._numbers = {id(body): number for number, body in enumerate(self.bodies)}

    def number(self, where: str, body: Body) -> int:
        """Number of a body; InvalidInput if it is not of this system."""
        if id(body) not in self._numbers:
            raise stranger(where, body)
        return self._numbers[id(body)]

    def name(self, where: str, body: Body) -> str:
        """Name of a body; InvalidInput if it is not of this system."""
        return self.naming.bodies[self.number(where, body)]

    def pair(self, where: str, first: Body, second: Body) -> frozenset[int]:
        """Numbers of two bodies; InvalidInput if one is not of this system."""
        return frozenset((self.number(where, first), self.number(where, second)))

    def names(self, where: str, first: Body, second: Body) -> tuple[str, str]:
        """Names of two bodies.

        Raises
        ------
        InvalidInput
            If a body is not of this system, or they are the same.
        """
        found = self.name(where, first), self.name(where, second)
        if first is second:
            raise InvalidInput(where, "needs two different bodies", found[0], "Name the other body.")
        return found

    def check_frames(self, where: str, first: Body, second: Body, frames: tuple[int, int]) -> None:
        """Check that two different bodies of the system have the frames with these numbers.

        Raises
        ------
        InvalidInput
            If a body is not of this system, both are the same, or a body has no frame with the number.
        """
        names = self.names(where, first, second)
        check_pair(f"{where}: frames", frames)
        for body, name, frame in zip((first, second), names, frames, strict=True):
            if frame not in range(len(body.frames)):
                rule = f"must be below {len(body.frames)} for {name}"
                raise InvalidInput(f"{where}: frames", rule, frame, "Count from 0.")
