"""What is installed: built-ins and plug-ins alike, found by entry points, loaded when asked for."""

from __future__ import annotations

import functools
import importlib
import warnings
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any

from nonsmooth.errors import PluginError, UnknownName
from nonsmooth.interfaces import Body, ContactKinematics, FrictionLaw, ImpactLaw, NormalLaw, Scenario

GROUPS: dict[str, tuple[type, ...]] = {
    "bodies": (Body,),
    "laws": (NormalLaw, FrictionLaw, ImpactLaw),
    "scenarios": (Scenario,),
    "kinematics": (ContactKinematics,),
}
"""Entry-point groups ``nonsmooth.<name>`` and the interfaces that their members implement."""


class BrokenPlugin(UserWarning):
    """An installed plug-in that cannot be used."""


@functools.cache
def _points(group: str) -> dict[str, EntryPoint]:
    found: dict[str, EntryPoint] = {}
    for point in sorted(entry_points(group=f"nonsmooth.{group}"), key=lambda p: (p.name, p.value)):
        if point.name in found and found[point.name].value != point.value:
            warnings.warn(
                f"{point.name} of nonsmooth.{group} is claimed by {found[point.name].value} and by {point.value}; "
                "the first is used",
                BrokenPlugin,
                stacklevel=3,
            )
            continue
        found[point.name] = point
    return found


def names(group: str) -> tuple[str, ...]:
    """Return the names installed in a group, loading nothing."""
    return tuple(_points(group))


def source(group: str, name: str) -> str:
    """Return the distribution that a name comes from."""
    distribution = _points(group)[name].dist
    return f"{distribution.name} {distribution.version}" if distribution else "unknown distribution"


def load(group: str, name: str) -> Any:
    """Return the class of that name.

    Raises
    ------
    UnknownName
        If nothing of that name is installed in the group.
    PluginError
        If it cannot be imported or is not what the group asks for.
    """
    if name not in _points(group):
        raise UnknownName(f"{group}", name, names(group))
    point = _points(group)[name]
    try:
        loaded = point.load()
    except Exception as error:
        raise PluginError(f"{name} ({point.value}) cannot be loaded: {error}. {_shadow(point)}") from error
    if not (isinstance(loaded, type) and issubclass(loaded, GROUPS[group])):
        wanted = " or ".join(base.__name__ for base in GROUPS[group])
        raise PluginError(f"{name} ({point.value}) of nonsmooth.{group} must be a subclass of {wanted}, not {loaded!r}.")
    return loaded


def load_all(group: str) -> dict[str, Any]:
    """Return all usable classes of a group by name; a broken one is a warning that names it."""
    loaded = {}
    for name in names(group):
        try:
            loaded[name] = load(group, name)
        except PluginError as error:
            warnings.warn(str(error), BrokenPlugin, stacklevel=2)
    return loaded


def _shadow(point: EntryPoint) -> str:
    """Say which file of the user hides the package that the entry point means."""
    top = point.value.partition(":")[0].partition(".")[0]
    try:
        found = importlib.import_module(top).__file__ or ""
    except ImportError:
        return ""
    if top in ("bodies", "laws", "scenarios") and Path(found).parent.name != top:
        return f"The file {found} hides the package {top!r} of nonsmooth: rename it."
    return ""
