"""How many triangles a file holds, told from its header or by counting lines, before anything is loaded."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from pathlib import Path

from nonsmooth.errors import InvalidInput
from nonsmooth.notices import warn
from nonsmooth.parameters import UnusualValue

LARGEST = 1_000_000
"""Number of triangles above which a mesh is refused unless the user raises the bound."""
MANY = 200_000
"""Number above which a warning says that it will take long."""

_CHUNK = 1 << 22


def check_count(thing: str, count: int, largest: int = LARGEST) -> None:
    """Refuse or warn of a number of triangles.

    Raises
    ------
    InvalidInput
        If it is above ``largest``.
    """
    remedy = "Simplify the mesh; the motion of a rigid body does not depend on so fine a surface."
    if count > largest:
        raise InvalidInput(
            thing,
            f"must have at most {largest} triangles",
            count,
            f"{remedy} Or raise the bound with largest={count}: loading and checks take minutes.",
        )
    if count > MANY:
        warn(
            f"{thing} has {count} triangles: loading and checks take {count / 5e4:.0f} s or more. {remedy}",
            UnusualValue,
        )


def count_triangles(path: Path) -> int | None:
    """Return how many triangles a file says that it holds, at least; None for a format not known here."""
    count = _COUNTERS.get(path.suffix.lower())
    return None if count is None else count(path)


def _stl(path: Path) -> int:
    with path.open("rb") as file:
        head = file.read(84)
    size = path.stat().st_size
    if len(head) == 84:
        (count,) = struct.unpack("<I", head[80:])
        if size == 84 + 50 * count:
            return int(count)
    if head.lstrip()[:5].lower() == b"solid":
        return _occurrences(path, b"endfacet")
    return max(size - 84, 0) // 50


def _ply(path: Path) -> int | None:
    with path.open("rb") as file:
        for line in file.read(1 << 16).split(b"end_header")[0].splitlines():
            words = line.split()
            if words[:2] == [b"element", b"face"] and len(words) == 3 and words[2].isdigit():
                return int(words[2])
    return None


def _off(path: Path) -> int | None:
    with path.open("rb") as file:
        lines = file.read(1 << 16).splitlines()
    words = [word for line in lines for word in line.split(b"#")[0].split()]
    words = words[1:] if words and words[0].upper().endswith(b"OFF") else words
    return int(words[1]) if len(words) > 1 and words[1].isdigit() else None


def _obj(path: Path) -> int:
    return _occurrences(path, b"\nf ")


def _glb(path: Path) -> int | None:
    """Every mesh once, however many nodes show it."""
    with path.open("rb") as file:
        head = file.read(20)
        if len(head) < 20 or head[:4] != b"glTF":
            return None
        text = file.read(struct.unpack("<I", head[12:16])[0])
    return _gltf_count(text)


def _gltf(path: Path) -> int | None:
    return _gltf_count(path.read_bytes())


def _gltf_count(text: bytes) -> int | None:
    try:
        tree = json.loads(text)
        accessors, count = tree["accessors"], 0
        for mesh in tree["meshes"]:
            for part in mesh["primitives"]:
                points = part["indices"] if "indices" in part else part["attributes"]["POSITION"]
                count += accessors[points]["count"] // 3
    except (ValueError, KeyError, IndexError, TypeError):
        return None
    return int(count)


def _occurrences(path: Path, word: bytes) -> int:
    count, rest = 0, b""
    with path.open("rb") as file:
        while chunk := file.read(_CHUNK):
            text = rest + chunk
            count += text.count(word)
            rest = text[-(len(word) - 1) :]
    return count


_COUNTERS: dict[str, Callable[[Path], int | None]] = {
    ".stl": _stl,
    ".ply": _ply,
    ".off": _off,
    ".obj": _obj,
    ".glb": _glb,
    ".gltf": _gltf,
}
