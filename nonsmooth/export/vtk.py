"""VTK: a series of surfaces, for ParaView and pyvista."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, final
from xml.sax.saxutils import quoteattr

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.export.film import Film
from nonsmooth.parameters import Rule, check_number
from nonsmooth.storage.files import replacing

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

_COUNT = Rule("number of times that are stored, equally far apart", "1", minimum=2.0, maximum=1e5)
_NAMES = {np.dtype("<f4"): "Float32", np.dtype("<i4"): "Int32"}


@final
@dataclass(frozen=True)
class Vtk:
    """A file NAME.pvd, and next to it a folder NAME_vtp with a VTP file for each time.

    A VTP file has the surfaces of bodies, loads and joints.  For each triangle it has the number of the body, -1 for a
    load or a joint.

    Attributes
    ----------
    count : int
        Number of times, equally spaced from the beginning to the end of the run.
    """

    count: int = 201

    def __post_init__(self) -> None:
        check_number("export: count", self.count, _COUNT)

    def write(self, solution: Solution, path: Path) -> None:
        """Write a VTP file for each time, and the PVD file ``path`` that lists these files.

        The VTP files are in the folder beside ``path`` whose name ends with "_vtp".  Files of an earlier export remain
        until all new files are written, and are then replaced.
        """
        times = np.linspace(float(solution.track.time[0]), solution.t_end, int(self.count))
        film, folder = Film.of(solution, times), path.with_name(f"{path.stem}_vtp")
        width = len(str(len(times) - 1))
        names = [f"{path.stem}_{i:0{width}}.vtp" for i in range(len(times))]
        pairs = zip(times.tolist(), names, strict=True)
        listed = "".join(
            f'<DataSet timestep="{t!r}" file={quoteattr(f"{folder.name}/{name}")}/>\n' for t, name in pairs
        )
        text = f'<VTKFile type="Collection" version="1.0"><Collection>\n{listed}</Collection></VTKFile>\n'
        strange = [one.name for one in folder.glob("*") if one.suffix != ".vtp"]
        if strange:
            rule = "must have only VTP files, as it would be replaced"
            raise InvalidInput(f"export: {folder}", rule, strange[:3], "Choose another name.")
        with replacing(path) as part, replacing(folder) as parts:
            part.write_text(text, encoding="utf-8")
            parts.mkdir()
            for i, name in enumerate(names):
                (parts / name).write_bytes(_surfaces(film, i))


def _surfaces(film: Film, i: int) -> bytes:
    first = np.cumsum([0, *(len(piece.mesh.vertices) for piece in film.pieces)])
    points = [film.placed(piece, i) for piece in film.pieces]
    triangles = [piece.mesh.triangles + at for piece, at in zip(film.pieces, first[:-1].tolist(), strict=True)]
    bodies = [np.full(len(piece.mesh.triangles), piece.body) for piece in film.pieces]
    corners = np.concatenate([np.zeros((0, 3)), *triangles])
    arrays = {
        "Points": np.concatenate([np.zeros((0, 3)), *points]).astype("<f4"),
        "connectivity": corners.astype("<i4"),
        "offsets": (3 * np.arange(1, len(corners) + 1)).astype("<i4"),
        "body": np.concatenate([np.zeros(0), *bodies]).astype("<i4"),
    }
    told, blocks, at = dict[str, str](), list[bytes](), 0
    for name, array in arrays.items():
        width = 3 if name == "Points" else 1
        told[name] = (
            f'<DataArray type="{_NAMES[array.dtype]}" Name="{name}" NumberOfComponents="{width}" format="appended" '
            f'offset="{at}"/>'
        )
        blocks.append(np.uint64(array.nbytes).tobytes() + array.tobytes())
        at += len(blocks[-1])
    head = (
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64"><PolyData>'
        f'<Piece NumberOfPoints="{first[-1]}" NumberOfPolys="{len(corners)}"><Points>{told["Points"]}</Points>'
        f"<Polys>{told['connectivity']}{told['offsets']}</Polys><CellData>{told['body']}</CellData></Piece></PolyData>"
        '<AppendedData encoding="raw">_'
    )
    return head.encode("ascii") + b"".join(blocks) + b"</AppendedData></VTKFile>\n"
