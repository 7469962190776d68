"""The matrices of a feature of a surface, and which way is out of it."""

from __future__ import annotations

from bodies.contacts.features.curvature import write_flat, write_principal, write_round
from bodies.contacts.features.frames import vector_in_world
from bodies.contacts.surface.surface_search import ON_EDGE, ON_FACE, Found
from bodies.contacts.surface.surface_tables import EDGE, EDGES, FACE, FACES, N_EDGES, N_FACES
from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE
from nonsmooth.types import Floats


@compiled
def out_of_surface(
    frame: Floats, surface: Floats, found: Found, past: float, x: float, y: float, z: float
) -> tuple[float, float, float]:
    """Return the unit vector of the world to the point (x, y, z) of the body frame from what is nearest to it."""
    distance, _, kind, number, px, py, pz = found
    if kind == ON_FACE and (past <= 0.0 or distance == 0.0):
        f = int(surface[FACES]) + FACE * number
        nx, ny, nz = surface[f], surface[f + 1], surface[f + 2]
    else:
        nx, ny, nz = (x - px) / distance, (y - py) / distance, (z - pz) / distance
    nx, ny, nz = vector_in_world(frame, nx, ny, nz)
    return nx, ny, nz


@compiled
def write_feature(frame: Floats, out: Floats, side: int, surface: Floats, kind: int, number: int) -> None:
    """Write a face, an edge or a corner, and its number among all, faces first; normal and tangent stand there."""
    out[FEATURE] = float(number)
    if kind == ON_FACE:
        write_flat(out, side)
    elif kind == ON_EDGE:
        e = int(surface[EDGES]) + EDGE * number
        x, y, z = vector_in_world(frame, surface[e + 3], surface[e + 4], surface[e + 5])
        write_principal(out, side, x, y, z, 0.0, 1.0, 1.0, 0.0)
        out[FEATURE] += surface[N_FACES]
    else:
        write_round(out, side, 0.0)
        out[FEATURE] += surface[N_FACES] + surface[N_EDGES]
