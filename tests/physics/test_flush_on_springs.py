"""Flush boxes on springs carry each other: their heights are those of rigid boxes, but for the indentations."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
import pytest
import trimesh

import nonsmooth as ns
from bodies import BoxBody, CylinderBody, HullBody, MeshBody, Plate, Triangles
from laws import Bristle, Frictionless, HuntCrossley
from nonsmooth.interfaces import Body
from tests.bodies.meshes import parts

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


def _shaped(mesh: parts.Mesh) -> Make:
    return lambda: MeshBody(Triangles(mesh[0].tolist(), mesh[1].tolist()))


def _wide(x: float, y: float, rounding: float = 0.0) -> Make:
    return lambda: BoxBody(x, y, HALF, rounding=rounding)


PAIRS: dict[str, tuple[Make, Make]] = {
    "boxes": (_box, _box),
    "hulls": (_hull, _hull),
    "meshes": (_mesh, _mesh),
    "box on hull": (_hull, _box),
    "rounded boxes": (_wide(HALF, HALF, 1e-3),) * 2,
    "smaller on larger": (_box, lambda: BoxBody(0.019, 0.019, HALF)),
    "flush in one direction": (_wide(0.03, HALF), _box),
    "rounded, flush in one direction": (_wide(0.03, HALF, 1e-3), _wide(HALF, HALF, 1e-3)),
    "rounded on mesh": (_mesh, _wide(HALF, HALF, 1e-3)),
    "L on L": (_shaped(parts.bracket(2.0 * HALF)),) * 2,
    "U on U": (_shaped(parts.channel(2.0 * HALF)),) * 2,
    "box on U": (_shaped(parts.channel(2.0 * HALF)), _shaped(parts.box(0.03, 0.03, 2.0 * HALF))),
    "rounded on cylinder": (lambda: CylinderBody(0.04, HALF), _wide(HALF, HALF, 1e-3)),
}
"""Lower and upper body, both 4 cm high."""


def heights(
    name: str,
    shift: float = 0.0,
    turn: float = 0.0,
    bristles: bool = False,
    height: float = 1e-4,
    t_end: float = 0.5,
    n: int = 2,
) -> list[float]:
    """Return the heights of the mass centres of stacked bodies at the time ``t_end`` [m].

    Each body falls by ``height`` [m] onto the body below. ``n`` is the number of bodies: the lower body of the pair,
    and copies of the upper one. The run must be done with an energy residual below 1e-6.
    """
    lowest, upper = PAIRS[name]
    floor, bodies = Plate(), [lowest(), *(upper() for _ in range(n - 1))]
    friction = Bristle(friction=0.4, static_friction=0.4) if bristles else Frictionless()
    system = ns.System([floor, *bodies])
    system.contact_all(ns.ContactLaws(HuntCrossley(stiffness=1e5, exponent=1.0, dissipation=0.5), friction))
    for i, body in enumerate(bodies):
        turned = ns.turned_about((0.0, 0.0, 1.0), i * turn)
        system.place(body, position=(i * shift, 0.0, (2 * i + 1) * HALF + i * height), orientation=turned)
    solution = ns.simulate(system, t_end)
    assert solution.status == "done"
    assert solution.energy.residual < 1e-6
    return [float(solution.of(body)[0][-1, 2]) for body in bodies]


SHIFTS = (1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4, 1e-3)
"""Shifts of an upper body along x, relative to the body below [m]."""
TURNS = (1e-9, 1e-6, 1e-3, 0.01, 0.3)
"""Turns of an upper body about the vertical, relative to the body below [rad]."""
ALIKE = (
    "rounded boxes",
    "boxes",
    "hulls",
    "meshes",
    "flush in one direction",
    "rounded, flush in one direction",
    "smaller on larger",
    "L on L",
    "U on U",
    "box on U",
)
CARRIED = [(name, 0.0, 0.0) for name in PAIRS]
CARRIED += [(name, shift, 0.0) for name in ALIKE for shift in SHIFTS]
CARRIED += [(name, 0.0, turn) for name in ALIKE for turn in TURNS]
CARRIED += [("rounded on mesh", 1e-3, 0.0), ("rounded on cylinder", 1e-3, 0.0), ("boxes", 0.0, 0.5 * np.pi)]
"""Pair, shift [m] and turn [rad] of the upper body."""


@pytest.mark.fast_cases(10)
@pytest.mark.parametrize(("name", "shift", "turn"), CARRIED)
def test_the_upper_body_is_carried(name: str, shift: float, turn: float) -> None:
    assert heights(name, shift, turn) == pytest.approx([HALF, 3.0 * HALF], abs=INDENTED)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["rounded boxes", "boxes", "hulls"])
@pytest.mark.parametrize(("shift", "turn"), [(0.0, 0.0), (1e-6, 0.0), (0.0, 1e-9), (0.0, 1e-3)])
def test_a_body_that_falls_by_millimetres_is_carried(name: str, shift: float, turn: float) -> None:
    assert heights(name, shift, turn, height=3e-3, t_end=1.0) == pytest.approx([HALF, 3.0 * HALF], abs=INDENTED)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["rounded boxes", "boxes", "hulls"])
@pytest.mark.parametrize("shift", [0.0, 1e-9, 1e-6, 1e-3])
def test_bodies_stay_for_seconds(name: str, shift: float) -> None:
    assert heights(name, shift, t_end=2.0) == pytest.approx([HALF, 3.0 * HALF], abs=INDENTED)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["rounded boxes", "boxes", "hulls"])
@pytest.mark.parametrize("shift", [0.0, 1e-9, 1e-6, 1e-3])
def test_three_bodies_carry_each_other(name: str, shift: float) -> None:
    # the lowest contacts carry the weight of three bodies
    assert heights(name, shift, n=3) == pytest.approx([HALF, 3.0 * HALF, 5.0 * HALF], abs=3.0 * INDENTED)


@pytest.mark.slow
def test_the_upper_body_is_carried_on_bristles() -> None:
    assert heights("boxes", bristles=True) == pytest.approx([HALF, 3.0 * HALF], abs=INDENTED)
