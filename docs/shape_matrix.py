"""Write the matrix of shapes that touch each other: ``python docs/shape_matrix.py`` makes docs/parts/shapes.md.

The registered contact kinematics declare the contacts of every two shapes. A cell of the matrix is their number, or the
reason why there is none.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from parameter_tables import markdown

import bodies
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Shape
from nonsmooth.system.pairing import installed_pair

PART = Path(__file__).parent / "parts" / "shapes.md"
SIZE = 0.01
"""Half of the size of a shape [m]."""
FEET = 1e-4 * SIZE
"""Height of the feet of the named bodies by default [m]."""
TEETH = 100
"""Teeth of the gear."""
LEGEND = (
    "A column is the shape whose row has its number. **none**: the pair needs a contact kinematics. **refused**: the "
    "message names the rule. **≤**: a search lists the pairs of features near each other. "
    "`docs/shape_matrix.py` writes this table."
)


def shapes() -> dict[str, Shape]:
    """Return one shape for each row of the matrix, by its name."""
    l_outline = SIZE * np.array([(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)])
    angle = np.pi * np.arange(2 * TEETH) / TEETH
    radius = np.where(np.arange(2 * TEETH) % 2 == 0, SIZE, 0.95 * SIZE)
    gear_outline = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    return {
        "plane": bodies.Plane(),
        "point": bodies.Point(),
        "sphere": bodies.Sphere(SIZE),
        "ellipsoid": bodies.Ellipsoid(SIZE, SIZE, 2.0 * SIZE),
        "egg": bodies.MovedShape(bodies.Egg(SIZE)),
        "superellipsoid, 0.5 and 0.5": bodies.Superellipsoid(SIZE, SIZE, SIZE, 0.5, 0.5),
        "superellipsoid, 1.5 and 0.5": bodies.Superellipsoid(SIZE, SIZE, SIZE, 1.5, 0.5),
        "capsule": bodies.Capsule(SIZE, SIZE),
        "box": bodies.Box(SIZE, SIZE, SIZE),
        "rounded box": bodies.Box(SIZE, SIZE, SIZE, rounding=0.1 * SIZE),
        "cylinder": bodies.Cylinder(SIZE, SIZE, foot_height=FEET),
        "cone": bodies.Cone(SIZE, SIZE, foot_height=FEET),
        "disc": bodies.Disc(SIZE, foot_height=FEET),
        "L": bodies.TriangleMesh(prism(l_outline, 0.5 * SIZE * np.ones(2))),
        f"gear of {TEETH} teeth": bodies.TriangleMesh(prism(gear_outline, np.zeros(2))),
    }


def prism(outline: NDArray[np.float64], centre: NDArray[np.float64]) -> bodies.Triangles:
    """Return a prism over an outline of which every point is seen from a centre."""
    n = len(outline)
    points = np.concatenate([outline, [centre]])
    low, high = (np.column_stack([points, np.full(n + 1, z)]) for z in (-SIZE, SIZE))
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [(n, j, i), (n + n + 1, i + n + 1, j + n + 1), (i, j, j + n + 1), (i, j + n + 1, i + n + 1)]
    return bodies.Triangles(np.concatenate([low, high]), faces)


def cell(first: Shape, second: Shape) -> str:
    """Return the number of contacts that the registered kinematics declare between two shapes."""
    found = installed_pair(first, second)
    if found is None:
        return "none"
    kinematics, in_order = found
    try:
        contacts = kinematics.between(*((first, second) if in_order else (second, first)))
    except InvalidInput:
        return "refused"
    is_searched = any(contact.candidates is not None for contact in contacts)
    return f"≤ {len(contacts)}" if is_searched else str(len(contacts))


def matrix() -> str:
    """Return the matrix as a table of Markdown. Its columns have the numbers of its rows."""
    given = shapes()
    names = list(given)
    head = ["contacts between", *(str(i) for i in range(1, len(names) + 1))]
    rows = [
        [f"{i}  {name}", *(cell(given[name], given[other]) for other in names[:i]), *[""] * (len(names) - i)]
        for i, name in enumerate(names, 1)
    ]
    return markdown([head, *rows])


def main() -> None:
    """Write the part."""
    PART.parent.mkdir(exist_ok=True)
    PART.write_text(f"{matrix()}\n\n{LEGEND}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
