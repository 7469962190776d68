"""What is imported by all commands is imported fast."""

from __future__ import annotations

import subprocess
import sys

import pytest

_SLOW = ("scipy.optimize", "scipy.stats", "scipy.interpolate", "scipy.spatial", "matplotlib", "distributed")


@pytest.mark.slow
def test_parts_that_take_seconds_are_imported_where_they_are_used() -> None:
    program = f"import sys, nonsmooth.studies, nonsmooth.cli.main; print([m for m in {_SLOW!r} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
