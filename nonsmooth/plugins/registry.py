"""Registry of installed components: built-ins and plug-ins, found by entry points, imported on first use."""

from __future__ import annotations

import contextlib
import difflib
import functools
import importlib.util
import inspect
import site
import sys
import sysconfig
from collections.abc import Iterable
from importlib.metadata import Distribution, EntryPoint, entry_points
from pathlib import Path
from typing import Any

from nonsmooth.errors import NonsmoothWarning, PluginError, UnknownName
from nonsmooth.interfaces import (
    Body,
    ContactKinematics,
    DistanceBackend,
    Engine,
    Guard,
    ImpactLaw,
    Joint,
    Load,
    Motion,
    NormalLaw,
    Scenario,
    Shape,
    TangentialLaw,
)
from nonsmooth.notices import warn
from nonsmooth.parameters import Component

_GROUPS: dict[str, tuple[str, tuple[type, ...]]] = {
    "bodies": ("body", (Body,)),
    "laws": ("law", (NormalLaw, TangentialLaw, ImpactLaw)),
    "scenarios": ("scenario", (Scenario,)),
    "kinematics": ("contact kinematics", (ContactKinematics,)),
    "joints": ("joint", (Joint,)),
    "loads": ("load", (Load,)),
    "shapes": ("shape", (Shape,)),
    "motions": ("motion", (Motion,)),
    "guards": ("guard", (Guard,)),
    "distances": ("library for distances", (DistanceBackend,)),
    "engines": ("engine", (Engine,)),
}
GROUPS = {group: interfaces for group, (_, interfaces) in _GROUPS.items()}
"""Entry-point groups ``nonsmooth.<name>`` and the interfaces that their members implement."""
KINDS = {group: kind for group, (kind, _) in _GROUPS.items()}
"""Group of entry points -> word for a component of the group, for messages, such as "laws" -> "law"."""
_LAWS = {NormalLaw: "normal law", TangentialLaw: "friction law", ImpactLaw: "impact law"}
"""Interface of a law -> word for such a law, for messages."""


class BrokenPlugin(NonsmoothWarning):
    """An installed plug-in that cannot be used."""


@functools.cache
def _points(group: str) -> dict[str, EntryPoint]:
    found: dict[str, EntryPoint] = {}
    # built-ins first, so that no plug-in takes their names
    points = [point for point in entry_points(group=f"nonsmooth.{group}") if _is_installed(point)]
    for point in sorted(points, key=lambda p: (not _is_ours(p), p.name, p.value)):
        first = found.setdefault(point.name, point)
        if (first.value, _distribution(first)) != (point.value, _distribution(point)):
            warn(
                f"{KINDS[group]} {point.name!r} is claimed by {_origin(first)} and by {_origin(point)}; "
                "the first is used: rename the other, or uninstall one of the two.",
                BrokenPlugin,
            )
    return dict(sorted(found.items()))


def _is_installed(point: EntryPoint) -> bool:
    """True if an entry point belongs to an installed package, False for metadata next to files of the user."""
    return point.dist is None or _is_installed_in(str(point.dist.locate_file("")))


@functools.cache
def _is_installed_in(place: str) -> bool:
    sites = (*sysconfig.get_paths().values(), *site.getsitepackages(), site.getusersitepackages())
    found = Path(place).resolve()
    return found not in _own_folders() or found in {Path(one).resolve() for one in sites}


def _own_folders() -> set[Path]:
    """Folders from which Python imports without an installation: the working folder and that of the script.

    They may hold files of other users.
    """
    script = vars(sys.modules["__main__"]).get("__file__")
    return {*_BEGAN_IN, *_working_folder(), *([Path(script).resolve().parent] if script else [])}


def _working_folder() -> tuple[Path, ...]:
    """The working folder; empty if it was removed."""
    with contextlib.suppress(FileNotFoundError):
        return (Path.cwd(),)
    return ()


_BEGAN_IN = _working_folder()
"""Working folder when the program began. ``python -m`` imports from it, even if the program changes its folder."""


@functools.cache
def packages() -> frozenset[str]:
    """Names of the packages and modules that contain installed components. No component is imported.

    Namespace packages are left out, because a folder of the same name in the working folder belongs to them.
    """
    modules = {point.module for group in GROUPS for point in _points(group).values()}
    parents = {module.rpartition(".")[0] for module in modules if "." in module}
    return frozenset(modules | {parent for parent in parents if not _is_namespace(parent.partition(".")[0])})


def _is_namespace(package: str) -> bool:
    try:
        spec = importlib.util.find_spec(package)
    # a module that a program created without an import has no specification: treat it as a namespace package
    except ValueError:
        return True
    return spec is None or spec.origin is None


@functools.cache
def _name_and_version(distribution: Distribution) -> tuple[str, str]:
    # cached, because either attribute reads and parses a file
    return distribution.name, distribution.version


def _is_ours(point: EntryPoint) -> bool:
    return point.dist is not None and _name_and_version(point.dist)[0] == "nonsmooth"


def _distribution(point: EntryPoint) -> str:
    return " ".join(_name_and_version(point.dist)) if point.dist else "unknown distribution"


def _origin(point: EntryPoint) -> str:
    return f"{_distribution(point)} ({point.value})"


def check_groups() -> None:
    """Warn of unknown groups of entry points that begin with "nonsmooth.", because no part of nonsmooth reads them."""
    known = [f"nonsmooth.{group}" for group in GROUPS]
    for group in sorted(entry_points().groups):
        if group.startswith("nonsmooth.") and group not in known:
            origins = ", ".join(sorted(_origin(point) for point in entry_points(group=group)))
            near = difflib.get_close_matches(group, known, n=1)
            hint = f"Did you mean {near[0]!r}?" if near else f"Known: {', '.join(known)}."
            warn(
                f"The entry-point group {group!r} of {origins} is unknown. {hint}",
                BrokenPlugin,
            )


def names(group: str) -> tuple[str, ...]:
    """Names of the installed components of a group. Nothing is imported."""
    return tuple(_points(group))


def source(group: str, name: str) -> str:
    """Distribution that a component comes from, with its version."""
    return _distribution(_points(group)[name])


def imported(group: str, name: str) -> str:
    """Line of Python that imports the class of a component."""
    point = _points(group)[name]
    return f"from {point.module} import {point.attr}"


def called(word: str, groups: Iterable[str]) -> list[tuple[str, str]]:
    """Group and name of each component that has the name ``word``, or whose class has it. Nothing is imported.

    The name of a class may be in lower case with underscores: BoxBody, box_body.

    Raises
    ------
    UnknownName
        If no component has the name.
    """
    known = [(group, name) for group in groups for name in names(group)]
    bare = word.replace("_", "").lower()
    found = [(group, name) for group, name in known if name == word]
    found = found or [(group, name) for group, name in known if _points(group)[name].attr.lower() == bare]
    if not found:
        remedy = "A new component of a package of yours is known once the package is installed again."
        raise UnknownName("component", word, {name for _, name in known}, remedy=remedy)
    return found


def load(group: str, name: str) -> Any:
    """Class of a component.

    Raises
    ------
    UnknownName
        If the group has no component of this name.
    PluginError
        If the class cannot be imported, or does not implement the interface of the group.
    """
    if name not in _points(group):
        raise UnknownName(KINDS[group], name, names(group), kinds_named(name))
    return _usable(_points(group)[name], group)


@functools.cache
def _usable(point: EntryPoint, group: str) -> Any:
    """Class of an entry point, checked and cached, because systems load the same kinematics many times."""
    try:
        loaded = point.load()
    except Exception as error:
        reason = f"{type(error).__name__}: {error}"
        raise PluginError(f"{_title(group, point.name)} cannot be loaded: {reason}.") from error
    found = fault(loaded, GROUPS[group])
    if found is not None:
        raise PluginError(f"{_title(group, point.name)} {found}")
    return loaded


INTERFACES = tuple(base for bases in GROUPS.values() for base in bases)
"""Interfaces that a plug-in may implement."""


def kind_of(owner: type) -> str:
    """Word for the kind of a component class, such as "law" or "body", for messages."""
    return next(KINDS[group] for group, bases in GROUPS.items() if issubclass(owner, bases))


def kinds_named(name: str) -> str:
    """Kinds of the components with a name, in all groups, as in "a friction law and a body"; "" without any."""
    found: dict[str, None] = {}
    for group in GROUPS:
        if name in names(group) and (owner := _loaded(group, name)) is not None:
            kind = next((words for base, words in _LAWS.items() if issubclass(owner, base)), KINDS[group])
            found[f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"] = None
    return " and ".join(found)


def fault(loaded: Any, bases: tuple[type, ...]) -> str | None:
    """Reason why an object is no usable component of a plug-in; None for a class that implements one of ``bases``.

    The reason continues a sentence that begins with the name of the object.
    """
    if not (isinstance(loaded, type) and issubclass(loaded, bases)):
        wanted = " or ".join(base.__name__ for base in bases)
        return f"must be a subclass of {wanted}, not {loaded!r}."
    if inspect.isabstract(loaded):
        missing = ", ".join(sorted(vars(loaded)["__abstractmethods__"]))
        return f"must define {missing}."
    if "__dataclass_fields__" not in vars(loaded) and issubclass(loaded, Component):
        return f"must be a dataclass: write @dataclass(frozen=True) above {loaded.__name__}."
    return None


def _title(group: str, name: str) -> str:
    return f"{KINDS[group]} {name!r} ({_points(group)[name].value}, from {source(group, name)})"


def name_of(owner: type) -> str | None:
    """Name under which a class is installed, or None."""
    for group, bases in GROUPS.items():
        if issubclass(owner, bases):
            for name, point in _points(group).items():
                # compare the class itself, because another class may have the same name
                if point.attr == owner.__name__ and _loaded(group, name) is owner:
                    return name
    return None


def _loaded(group: str, name: str) -> Any:
    try:
        return load(group, name)
    except PluginError:
        return None


def load_all(group: str, some: Iterable[str] | None = None) -> dict[str, Any]:
    """Usable classes of a group by name: all, or those with the names ``some``. A warning names each broken class."""
    loaded = {}
    for name in names(group) if some is None else some:
        try:
            loaded[name] = load(group, name)
        except PluginError as error:
            warn(str(error), BrokenPlugin)
    return loaded
