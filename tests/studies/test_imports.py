"""What every command imports is imported fast, without packages that only a part of it needs."""

from __future__ import annotations

import subprocess
import sys

import pytest

_LIGHT = (
    "bodies",
    "nonsmooth.cli.main",
    "nonsmooth.plot.overview",
    "nonsmooth.solution.draw_graph",
    "nonsmooth.solution.exports",
    "nonsmooth.studies",
)
_SLOW = (
    *("scipy.optimize", "scipy.stats", "scipy.interpolate", "scipy.spatial", "distributed"),
    *("matplotlib", "PIL", "rich", "xarray", "coal", "fcl", "trimesh", "vhacdx", "zarr", "numcodecs", "filelock"),
)
_PROGRAM = f"""
import importlib, sys
for name in {_LIGHT!r}:
    importlib.import_module(name)
    print(name, [slow for slow in {_SLOW!r} if slow in sys.modules])
"""


@pytest.mark.slow
def test_slow_packages_are_imported_where_they_are_used() -> None:
    """A process of its own, because this one has imported them already."""
    done = subprocess.run([sys.executable, "-c", _PROGRAM], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == [f"{name} []" for name in _LIGHT]
