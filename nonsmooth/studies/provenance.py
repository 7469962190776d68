"""Where the last bits of a study come from."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from pathlib import Path

from nonsmooth.results.output import versions


def provenance() -> Mapping[str, str]:
    """Return the versions on which the last bits hang, and the processor of this machine."""
    return {**versions(), "processor": _processor()}


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:  # another system
        return platform.processor()
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), "")
