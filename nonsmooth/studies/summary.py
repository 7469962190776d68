"""What came of a study, in lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.studies.records.named import ALWAYS
from nonsmooth.studies.status import STATUSES, VALUED

if TYPE_CHECKING:
    import xarray


def summary(study: xarray.Dataset) -> str:
    """Return how many runs ended how, and the range or the counts of each record that is one number per run."""
    status = study.status.values
    valued = np.isin(status, VALUED)
    told = [f"  {name}: {of_record(one, valued)}" for name, one in records_of(study).items()]
    return "\n".join([f"{status.size} runs: {ends(status)}", *told])


def ends(status: NDArray[Any]) -> str:
    """Return how many runs ended how."""
    return ", ".join(
        f"{(status == i).sum()} {word.replace('_', ' ')}" for i, word in enumerate(STATUSES) if i in status
    )


def records_of(study: xarray.Dataset) -> dict[str, xarray.DataArray]:
    """Return the records that are one number, or one word, per run."""
    runs = study.status.dims
    return {str(name): one for name, one in study.data_vars.items() if one.dims == runs and name not in ALWAYS}


def of_record(record: xarray.DataArray, valued: NDArray[np.bool_]) -> str:
    """Return the range of the numbers, or how often each word comes, of the runs that have records."""
    values = record.values[valued]
    if words := record.attrs.get("flag_meanings"):
        counted = ((word, int((values == i).sum())) for i, word in enumerate(words.split(" ")))
        return ", ".join(f"{word} {n}" for word, n in counted if n) or "none"
    known = values[np.isfinite(values)]
    unit = record.attrs.get("units", "1")
    if not len(known):
        return "none"
    low, high = f"{known.min():.6g}", f"{known.max():.6g}"
    return f"{low if low == high else f'{low} to {high}'}{'' if unit == '1' else f' {unit}'}"
