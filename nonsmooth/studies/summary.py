"""What came of a study, in lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.studies.status import STATUSES

if TYPE_CHECKING:
    import xarray


def summary(study: xarray.Dataset) -> str:
    """Return how many runs ended how, and the range or the counts of each record that is one number per run."""
    status = study.status.values.ravel()
    counts = ", ".join(
        f"{(status == i).sum()} {word.replace('_', ' ')}" for i, word in enumerate(STATUSES) if i in status
    )
    lines = [f"{status.size} runs: {counts}"]
    for name, one in study.data_vars.items():
        if one.dims == study.status.dims and name not in ("status", "reason"):
            lines.append(f"  {name}: {_of(one)}")
    return "\n".join(lines)


def _of(record: xarray.DataArray) -> str:
    values = record.values.ravel()
    if words := record.attrs.get("flag_meanings"):
        counted = ((word, int((values == i).sum())) for i, word in enumerate(words.split(" ")))
        return ", ".join(f"{word} {n}" for word, n in counted if n) or "none"
    known = values[np.isfinite(values)]
    unit = record.attrs.get("units", "1")
    return f"{known.min():.6g} to {known.max():.6g}{'' if unit == '1' else f' {unit}'}" if len(known) else "none"
