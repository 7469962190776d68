"""Load by a function of the user's."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, final

from nonsmooth.engine.memory.blocks import LOAD_MOMENT, LOAD_POINT, POSITION
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Load
from nonsmooth.parameters import Value
from nonsmooth.types import Floats


def _pull(t: float, a: Floats, b: Floats, out: Floats, force: float) -> None:
    distance = math.sqrt(
        (b[POSITION] - a[POSITION]) ** 2
        + (b[POSITION + 1] - a[POSITION + 1]) ** 2
        + (b[POSITION + 2] - a[POSITION + 2]) ** 2
    )
    for i in range(3):
        out[i] = -force * (b[i] - a[i]) / distance
        out[LOAD_POINT + i] = b[i]
        out[LOAD_MOMENT + i] = 0.0


@final
@dataclass(frozen=True)
class FunctionLoad(Load):
    """Whatever a plain function ``evaluate(t, a, b, out, ...)`` says.

    It gets time [s] and the frame blocks of the two bodies, and writes ``out[0:3]`` force on the second body [N],
    ``out[3:6]`` where it acts [m], ``out[6:9]`` moment [N m], all in world axes.

    Attributes
    ----------
    function : callable
        The function.
    constants : mapping of str to float or tuple of float
        Its further arguments by name.
    """

    function: Callable[..., None]
    constants: Mapping[str, Value] = field(default_factory=dict)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a force that pulls the two frames together."""
        return {"function": _pull, "constants": {"force": 2.0}}

    def _check(self) -> None:
        if not callable(self.function):
            raise InvalidInput("FunctionLoad.function", "must be a function", self.function, "Give a plain function.")

    def parameters(self) -> Mapping[str, Value]:
        """Return the constants."""
        return self.constants

    @property
    def evaluator(self) -> Callable[..., None]:
        """The function."""
        return self.function
