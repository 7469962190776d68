"""The page: one HTML file with the player and a run, whose arrays are packed as text."""

from __future__ import annotations

import base64
import gzip
import html
import json
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.parameters import Rule, check_number
from nonsmooth.viewer.record import record

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

TYPES = {"f8": "<f8", "f4": "<f4", "i4": "<i4", "i2": "<i2", "u1": "|u1"}
"""Name of a type of numbers in the player -> type of numpy with the same bytes, the lowest byte first."""
_KNOTS = Rule("most times that are drawn, besides the instants of events", "1", minimum=2.0, maximum=1e6)
_MOST_KINDS = 4
"""Largest number of kinds of bodies in a title."""
_POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:"
_PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<title>{title}</title>
<link rel="icon" href="data:,">
<style>{style}</style>
</head>
<body>
<p id="cut">This file is cut short, or the browser runs no scripts.</p>
<script type="application/json" id="told">{told}</script>
<script>{player}</script>
<script type="application/octet-stream" id="arrays">{arrays}</script>
</body>
</html>
"""


def page(solution: Solution, title: str, most_knots: int) -> str:
    """Page of a run as HTML, with at most ``most_knots`` times besides the instants of events."""
    check_number("to_html: most_knots", most_knots, _KNOTS)
    told, arrays = record(solution, title or _named(solution.system.names.bodies), int(most_knots))
    told["directory"], text = pack(arrays)
    ours = files("nonsmooth.viewer")
    return _PAGE.format(
        policy=_POLICY,
        title=html.escape(str(told["title"])),
        style=(ours / "viewer.css").read_text(encoding="utf-8"),
        # within a script element "<" might end it
        told=json.dumps(told, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"),
        arrays=text,
        player=(ours / "viewer.js").read_text(encoding="utf-8").replace("</script", "<\\/script"),
    )


def _named(bodies: Sequence[str]) -> str:
    """Title from the names of bodies; names that differ by a number only are put together, as in "3 x ball"."""
    kinds = Counter(re.sub(r" \d+$", "", name) for name in bodies)
    words = [kind if count == 1 else f"{count}\u00a0\u00d7\u00a0{kind}" for kind, count in kinds.items()]
    return ", ".join(words[:_MOST_KINDS] + ["…"] * (len(words) > _MOST_KINDS))


def pack(arrays: Mapping[str, tuple[str, NDArray[Any]]]) -> tuple[list[dict[str, Any]], str]:
    """Pack named arrays, each with its type (:data:`TYPES`), for the page: a directory and one text with all numbers.

    The directory has the name, type, shape, offset and number of bytes of each array.  The text is the base64 code of
    the bytes of all arrays, compressed by gzip.  An array of n numbers of b bytes is stored as b rows of n bytes: the
    rows of high bytes change little, so gzip compresses them well.  Equal arrays give equal text.
    """
    directory, blocks, at = [], list[bytes](), 0
    for name, (kind, array) in arrays.items():
        block = np.ascontiguousarray(array, dtype=TYPES[kind])
        shuffled = block.reshape(-1).view(np.uint8).reshape(-1, block.itemsize).T.tobytes()
        directory.append({"name": name, "type": kind, "shape": list(block.shape), "at": at, "bytes": len(shuffled)})
        blocks.append(shuffled)
        at += len(shuffled)
    return directory, base64.b64encode(gzip.compress(b"".join(blocks), 9, mtime=0)).decode("ascii")
