"""Poses: where the frames of a body are over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.datasets import Told, dataset
from nonsmooth.histories.arrays import Floats
from nonsmooth.histories.states import States
from nonsmooth.histories.times import of_one, read_times, spoken
from nonsmooth.interfaces import Body
from nonsmooth.queries.places import BodyFrames
from nonsmooth.system.lookup import body_number

if TYPE_CHECKING:
    import xarray

    from nonsmooth.solution.solution import Solution

_TOLD: Told = {
    "origin": (("frame", "axis"), "m", "origins of the frames"),
    "rotation": (("frame", "axis", "column"), "1", "axes of the frames as columns"),
}


@final
@dataclass(frozen=True, eq=False)
class Poses:
    """Poses of all frames of a body; of a single time the arrays lack the axis n.

    Attributes
    ----------
    time : array
        [s], shape [n].
    origin : array
        Origins of the frames [m], shape [n, n_frames, 3].
    rotation : array
        Their axes as columns, shape [n, n_frames, 3, 3]: ``origin + rotation @ x`` is the place of a point x of the
        frame.
    body : str
        Name of the body.
    """

    time: Floats
    origin: Floats
    rotation: Floats
    body: str

    def __repr__(self) -> str:
        """Return of which times it is, and how much there is of it."""
        return f"Poses({spoken(self.time)}; {self.origin.shape[-2]} frames)"

    def to_xarray(self) -> xarray.Dataset:
        """Return them as a dataset with names and units."""
        frames = [f"frame {number}" for number in range(self.origin.shape[-2])]
        return dataset(self, self.time, _TOLD, {"frame": frames}, body=self.body)

    @classmethod
    def of(cls, solution: Solution, asked: Body | str, times: ArrayLike | None = None) -> Poses:
        """Return the poses of a body in a run (:meth:`nonsmooth.Solution.poses`)."""
        body = solution.system.bodies[body_number("Solution.poses", asked, solution.system)]
        given = read_times("Solution.poses", solution, times)
        states = States.of(solution, np.atleast_1d(given))
        i_q, i_u = solution.offsets(body)
        q, u = states.q[:, i_q : i_q + body.n_q], states.u[:, i_u : i_u + body.n_u]
        frames = BodyFrames(body, solution.system.gravity)
        origin, rotation = np.zeros((len(q), len(body.frames), 3)), np.zeros((len(q), len(body.frames), 3, 3))
        for i, t in enumerate(states.time.tolist()):
            for frame, place in enumerate(frames.at(t, q[i], u[i])):
                origin[i, frame], rotation[i, frame] = place
        found = cls(states.time, origin, rotation, solution.system.name_of(body))
        return found if given.ndim else of_one(found)
