"""Report of a periodic orbit: its verdict, its numbers, and a table of its multipliers."""

from __future__ import annotations

import numpy as np

from nonsmooth.cli.report.table import folded, lines
from nonsmooth.studies.derivatives.flow import named
from nonsmooth.studies.orbits import Orbit


def verdict(orbit: Orbit) -> str:
    """Return the stability of an orbit as text, with its largest multiplier by magnitude.

    An example is "stable, largest multiplier 0.613".
    """
    sizes, errors = np.abs(orbit.multipliers), orbit.multiplier_errors
    largest = f"largest multiplier {np.max(sizes):.3g}" if len(sizes) else "no multipliers"
    if orbit.stable:
        return f"stable, {largest}"
    if np.any(sizes - errors > 1.0):
        return f"unstable, {largest}"
    reason = "the map has no derivative along some directions" if orbit.non_differentiable else "1 is within its error"
    return f"undecided, {largest}: {reason}"


def as_text(orbit: Orbit) -> str:
    """Return the report on an orbit: its stability, a table of period, residual and events, a table of multipliers."""
    model = orbit.family.model()
    rows = [("period", f"{orbit.period:.9g} s"), ("residual", f"{orbit.residual:.1e}")]
    rows += [(f"turn by {name}", f"{angle:.9g} rad") for name, angle in orbit.turns.items()]
    rows += [("events", named(orbit.events, model))]
    if passes := orbit.section.fixed(model):
        rows += [("left out", f"multiplier 1 along the motion, which the section of {', '.join(passes)} takes away")]
    if orbit.non_differentiable:
        rows += [("no derivative", ", ".join(point.direction for point in orbit.non_differentiable))]
    found = [verdict(orbit), *folded(rows)]
    if len(orbit.multipliers):
        cells = [("multiplier", "magnitude", "error")]
        pairs = zip(orbit.multipliers.tolist(), orbit.multiplier_errors.tolist(), strict=True)
        cells += [(_number(value), f"{abs(value):.6g}", f"{error:.0e}") for value, error in pairs]
        found += ["", *lines(cells)]
    return "\n".join(found)


def _number(value: complex) -> str:
    """Return a multiplier as text, without an imaginary part that is zero."""
    return f"{value:.8g}" if value.imag else f"{value.real:.8g}"
