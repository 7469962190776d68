"""Folders of other people, and damaged ones: what no run has written, under a checksum that is right."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from nonsmooth.storage.array_folder import ArrayFolder, _checksum


def opened(folder: Path) -> ArrayFolder:
    """Open a folder of a run or a study."""
    return ArrayFolder.opened(folder, "must be a folder of results", "Name another.")


def say(folder: Path, **attributes: Any) -> None:
    """Write attributes in place of those of the folder, None for no attribute."""
    arrays = opened(folder)
    arrays.attributes.update(attributes)
    for name in [name for name, value in attributes.items() if value is None]:
        del arrays.attributes[name]
    arrays.commit(safely=False)


def forge(folder: Path, change: Callable[[dict[str, Any]], object]) -> None:
    """Change the metadata of a folder, and give them the checksum that belongs to them."""
    path = folder / "zarr.json"
    content = json.loads(path.read_text())
    change(content)
    content["attributes"]["checksum"] = _checksum(content)
    path.write_text(json.dumps(content))
