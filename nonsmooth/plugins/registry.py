"""What is installed: built-ins and plug-ins alike, found by entry points, loaded when asked for."""

from __future__ import annotations

import dataclasses
import functools
import importlib.util
import inspect
import warnings
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any

from nonsmooth.errors import PluginError, UnknownName
from nonsmooth.interfaces import Body, ContactKinematics, FrictionLaw, ImpactLaw, Joint, Load, NormalLaw, Scenario

GROUPS: dict[str, tuple[type, ...]] = {
    "bodies": (Body,),
    "laws": (NormalLaw, FrictionLaw, ImpactLaw),
    "scenarios": (Scenario,),
    "kinematics": (ContactKinematics,),
    "joints": (Joint,),
    "loads": (Load,),
}
"""Entry-point groups ``nonsmooth.<name>`` and the interfaces that their members implement."""

KINDS = {
    "bodies": "body",
    "laws": "law",
    "scenarios": "scenario",
    "kinematics": "contact kinematics",
    "joints": "joint",
    "loads": "load",
}
"""What one member of a group is called."""

_HOME = Path(__file__).resolve().parents[2]
_BUILT_IN = ("bodies", "laws", "scenarios")


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
        raise UnknownName(KINDS[group], name, names(group))
    point = _points(group)[name]
    try:
        loaded = point.load()
    except Exception as error:
        reason = f"{type(error).__name__}: {error}"
        raise PluginError(" ".join([f"{_title(group, name)} cannot be loaded: {reason}.", *_hidden()])) from error
    if not (isinstance(loaded, type) and issubclass(loaded, GROUPS[group])):
        wanted = " or ".join(base.__name__ for base in GROUPS[group])
        raise PluginError(f"{_title(group, name)} must be a subclass of {wanted}, not {loaded!r}.")
    if inspect.isabstract(loaded):
        missing = ", ".join(sorted(vars(loaded)["__abstractmethods__"]))
        raise PluginError(f"{_title(group, name)} must define {missing}.")
    if not dataclasses.is_dataclass(loaded):
        raise PluginError(
            f"{_title(group, name)} must be a dataclass: write @dataclass(frozen=True) above {loaded.__name__}."
        )
    return loaded


def _title(group: str, name: str) -> str:
    return f"{KINDS[group]} {name!r} ({_points(group)[name].value}, from {source(group, name)})"


def load_all(group: str) -> dict[str, Any]:
    """Return all usable classes of a group by name; a broken one is a warning that names it."""
    loaded = {}
    for name in names(group):
        try:
            loaded[name] = load(group, name)
        except PluginError as error:
            warnings.warn(str(error), BrokenPlugin, stacklevel=2)
    return loaded


def _hidden() -> list[str]:
    """Say which files of the user hide packages that come with nonsmooth, as a laws.py in the working folder does."""
    found = {}
    for package in _BUILT_IN:
        try:
            spec = importlib.util.find_spec(package)
        except ValueError:  # a module put together by hand, without a specification
            continue
        if spec is not None and spec.origin is not None:
            found[package] = Path(spec.origin).resolve()
    return [
        f"The file {file} hides the package {package!r} that comes with nonsmooth: rename it."
        for package, file in found.items()
        if file.parent != _HOME / package
    ]
