"""Flush boxes on springs carry each other: their heights are those of rigid boxes, but for the indentations."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
import pytest
import trimesh

import nonsmooth as ns
from bodies import BoxBody, HullBody, MeshBody, Plate, Triangles
from laws import Bristle, Frictionless, HuntCrossley
from nonsmooth.interfaces import Body

HALF = 0.02
"""Half of a side [m]."""
INDENTED = 1e-4
"""Largest indentation of both contacts together [m]: 5 N on 1e5 N/m is half of it."""
Make = Callable[[], Body]


def _box() -> Body:
    return BoxBody(HALF, HALF, HALF)


def _hull() -> Body:
    return HullBody([(x, y, z) for x, y, z in itertools.product((-HALF, HALF), repeat=3)])


def _mesh() -> Body:
    made = trimesh.creation.box((2.0 * HALF,) * 3)
    return MeshBody(Triangles(made.vertices, made.faces))


def _wide(x: float, y: float) -> Make:
    return lambda: BoxBody(x, y, HALF)


PAIRS: dict[str, tuple[Make, Make]] = {
    "boxes": (_box, _box),
    "hulls": (_hull, _hull),
    "meshes": (_mesh, _mesh),
    "box on hull": (_hull, _box),
    "rounded boxes": (lambda: BoxBody(HALF, HALF, HALF, rounding=1e-3),) * 2,
    "smaller on larger": (_box, lambda: BoxBody(0.019, 0.019, HALF)),
    "flush in one direction": (_wide(0.03, HALF), _box),
}
"""Lower and upper body, both 4 cm high."""


def heights(name: str, shift: float = 0.0, turn: float = 0.0, bristles: bool = False) -> list[float]:
    """Return the heights of the mass centres 0.5 s after the upper body fell by 0.1 mm [m]."""
    floor, bodies = Plate(), [make() for make in PAIRS[name]]
    friction = Bristle(friction=0.4, static_friction=0.4) if bristles else Frictionless()
    system = ns.System([floor, *bodies])
    system.contact_all(ns.ContactLaws(HuntCrossley(stiffness=1e5, exponent=1.0, dissipation=0.5), friction))
    system.place(bodies[0], position=(0.0, 0.0, HALF))
    turned = ns.turned_about((0.0, 0.0, 1.0), turn)
    system.place(bodies[1], position=(shift, 0.0, 3.0 * HALF + 1e-4), orientation=turned)
    solution = ns.simulate(system, 0.5)
    assert solution.status == "done"
    return [float(solution.of(body)[0][-1, 2]) for body in bodies]


CARRIED = [(name, 0.0, 0.0) for name in PAIRS]
CARRIED += [("boxes", 1e-3, 0.0), ("boxes", 0.0, 0.5 * np.pi), ("hulls", 1e-3, 0.0)]
CARRIED += [(name, 0.0, turn) for name in ("boxes", "hulls", "meshes") for turn in (1e-9, 1e-6, 1e-3, 0.3)]
CARRIED += [(name, shift, 0.0) for name in ("boxes", "hulls", "meshes") for shift in (1e-12, 1e-9, 1e-6)]
CARRIED += [("smaller on larger", 1e-3, 0.0), ("flush in one direction", 0.0, 1e-6)]
"""Pair, shift [m] and turn [rad] of the upper body."""


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize(("name", "shift", "turn"), CARRIED)
def test_the_upper_body_is_carried(name: str, shift: float, turn: float) -> None:
    assert heights(name, shift, turn) == pytest.approx([HALF, 3.0 * HALF], abs=INDENTED)


@pytest.mark.slow
def test_the_upper_body_is_carried_on_bristles() -> None:
    assert heights("boxes", bristles=True) == pytest.approx([HALF, 3.0 * HALF], abs=INDENTED)
