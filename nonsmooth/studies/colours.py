"""The colours of classes: the same in maps, lines and bars."""

from __future__ import annotations

from nonsmooth.charts import COLOURS


def class_colours(n: int) -> list[str]:
    """Return a colour for each of n classes: those of lines, then a row of hues."""
    # black is the last of them: areas of it outshine the others
    first, more = (*COLOURS[1:], COLOURS[0]), n - len(COLOURS)
    if more <= 0:
        return list(first[:n])
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    return [*first, *(to_hex(colour) for colour in colormaps["turbo"].resampled(more)(range(more)))]
