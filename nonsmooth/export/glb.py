"""GLB: a scene with animation, and arrows of impulses, for browsers, Blender and game engines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.export.film import Film
from nonsmooth.export.gltf import Tree
from nonsmooth.export.meshes import along_axes, arrow
from nonsmooth.histories.arrays import Floats
from nonsmooth.histories.impulses import Impulses
from nonsmooth.histories.request import HistoryRequest
from nonsmooth.parameters import Rule, check_number
from nonsmooth.scene.scene import knots, sides
from nonsmooth.storage.files import replacing

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

_SEEN = 0.05
"""Time for which an arrow is shown [s], unless the next arrow of the same contact begins earlier."""


@final
@dataclass(frozen=True, eq=False)
class Arrows:
    """Arrows of the impulses of one contact over time; an entry holds from its time to the time of the next.

    Attributes
    ----------
    contact : str
        Name of the contact.
    times : array
        Times [s], shape [n].
    origin : array
        Points at which the arrows begin [m], shape [n, 3].
    axes : array
        Axes as columns, of which the first points along the arrow, shape [n, 3, 3].
    size : array
        Impulse relative to the strongest impulse of the run, 0 if no arrow is shown, shape [n].
    """

    contact: str
    times: Floats
    origin: Floats
    axes: Floats
    size: Floats


def arrows(solution: Solution) -> Iterator[Arrows]:
    """Yield for each contact with impacts the arrows that show its impulses [N s].

    An arrow shows the impulse on the contact's second body, or on the first body if only the first one is movable.
    """
    # `recorded` also accepts an engine that records no contacts; it then gives no arrows
    found = Impulses.recorded(HistoryRequest(solution, np.zeros(0)))
    side = sides(solution.system)[found.impulse_contact][:, None]
    push = side * (found.normal_impulse[:, None] * found.impulse_normal + found.friction_impulse)
    size = np.linalg.norm(push, axis=1)
    hits = np.flatnonzero((found.normal_impulse > 0.0) & np.isfinite(size))
    for contact in np.unique(found.impulse_contact[hits]).tolist():
        own = hits[found.impulse_contact[hits] == contact]
        begin = found.time[own]
        # an arrow begins at its time, and ends some time later or when the next one begins
        until = np.minimum(begin + _SEEN, np.append(begin[1:], np.inf))
        times = np.concatenate([solution.track.time[:1], np.column_stack([begin, until]).ravel()])
        strength = np.column_stack([size[own] / np.max(size[hits]), np.zeros(len(own))])
        rows = np.concatenate([own[:1], np.repeat(own, 2)])
        last = np.append(np.diff(times) > 0.0, True)
        yield Arrows(
            solution.system.contacts[contact].name,
            times[last],
            found.impulse_point[rows].mean(axis=1)[last],
            along_axes(push[rows])[last],
            np.concatenate([[0.0], strength.ravel()])[last],
        )


_KNOTS = Rule("most times that are stored, besides the instants of events", "1", minimum=2.0, maximum=1e6)
_IMPULSE, _ARM = "#d55e00", 1.6
"""Colour of the arrows that show impulses (hexadecimal RGB), and length of the longest arrow relative to ``Film.unit``,
respectively.  The longest arrow shows the strongest impulse of the run."""


@final
@dataclass(frozen=True)
class Glb:
    """A GLB file (glTF 2.0): a node for each frame, with tracks of translation and rotation, and meshes below it.

    Loads, joints and links of mechanisms have tracks of scale, too.  So has the arrow of each contact, whose length is
    proportional to the impulse for 50 ms after an impact.  Times count from the beginning of the run.  They are 32-bit
    floats that increase strictly; of instants with the same 32-bit time, only the last one is stored.

    Attributes
    ----------
    most_knots : int
        Largest number of times at which tracks have a key, in addition to the instants of events.
    """

    most_knots: int = 4000

    def __post_init__(self) -> None:
        check_number("export: most_knots", self.most_knots, _KNOTS)

    def write(self, solution: Solution, path: Path) -> None:
        """Write the file of a run."""
        times = knots(solution, int(self.most_knots))
        keys = (times - times[0]).astype(np.float32)
        kept = np.append(np.diff(keys) > 0.0, True)
        content = _packed(Film.of(solution, times[kept]), keys[kept], arrows(solution))
        with replacing(path) as part:
            part.write_bytes(content)


def _packed(film: Film, keys: NDArray[np.float32], impulses: Iterable[Arrows]) -> bytes:
    tree, roots = Tree(), dict[int, int]()
    time, turns = tree.keys(keys), quaternions(film.axes)
    for piece in film.pieces:
        track = piece.track
        if track not in roots:
            roots[track] = tree.node(piece.name, children=[])
            stretch = np.column_stack([film.scale[:, track], np.ones((len(keys), 2))])
            places = {"translation": film.origin[:, track], "rotation": turns[:, track], "scale": stretch}
            tree.move(roots[track], time, "LINEAR", **places)
        mesh = tree.mesh(piece.mesh, piece.colour)
        tree.nodes[roots[track]]["children"].append(tree.node(piece.name, mesh=mesh))
    pushes, shape = list[int](), arrow()
    for one in impulses:
        own = (one.times - film.times[0]).astype(np.float32)
        last = np.append(np.diff(own) > 0.0, True)
        size = _ARM * film.unit * one.size[last, None] * np.ones(3)
        places = {"translation": one.origin[last], "rotation": quaternions(one.axes[last, None])[:, 0], "scale": size}
        pushes.append(tree.node(f"impulse {one.contact}", mesh=tree.mesh(shape, _IMPULSE)))
        tree.move(pushes[-1], tree.keys(own[last]), "STEP", **places)
    return tree.packed([*roots.values(), *pushes])


def quaternions(axes: Floats) -> Floats:
    """Unit quaternions, scalar last, shape [n, m, 4], of axes of shape [n, m, 3, 3].

    The quaternions q and -q are the same rotation.  The signs are chosen so that q changes little from each time to the
    next one, because viewers interpolate between times.
    """
    from scipy.spatial.transform import Rotation

    found = np.asarray(Rotation.from_matrix(axes.reshape(-1, 3, 3)).as_quat()).reshape(*axes.shape[:2], 4)
    turned = np.einsum("ijk,ijk->ij", found[1:], found[:-1]) < 0.0
    found[1:] *= np.where(np.cumsum(turned, axis=0) % 2, -1.0, 1.0)[:, :, None]
    return found
