"""The words and arrays of a page, read by other means than the player's."""

from __future__ import annotations

import base64
import gzip
import json
import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

_TYPES = {"f8": np.float64, "f4": np.float32, "i4": np.int32, "i2": np.int16, "u1": np.uint8}


def decoded(page: str) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Return what a page says of a run."""
    told = json.loads(_script(page, "told"))
    blob = gzip.decompress(base64.b64decode(_script(page, "arrays")))
    arrays = {}
    for entry in told["directory"]:
        kind = np.dtype(_TYPES[entry["type"]])
        block = np.frombuffer(blob, np.uint8, entry["bytes"], entry["at"]).reshape(kind.itemsize, -1)
        arrays[entry["name"]] = np.ascontiguousarray(block.T).reshape(-1).view(kind).reshape(entry["shape"])
    return told, arrays


def _script(page: str, name: str) -> str:
    found = re.search(rf'<script type="[a-z/-]*" id="{name}">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    return found.group(1)
