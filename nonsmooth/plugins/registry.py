"""What is installed: built-ins and plug-ins alike, found by entry points, loaded when asked for."""

from __future__ import annotations

import contextlib
import difflib
import functools
import importlib.util
import inspect
import site
import sys
import sysconfig
import warnings
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
from nonsmooth.plugins.hiding import hidden_packages

GROUPS: dict[str, tuple[type, ...]] = {
    "bodies": (Body,),
    "laws": (NormalLaw, TangentialLaw, ImpactLaw),
    "scenarios": (Scenario,),
    "kinematics": (ContactKinematics,),
    "joints": (Joint,),
    "loads": (Load,),
    "shapes": (Shape,),
    "motions": (Motion,),
    "guards": (Guard,),
    "distances": (DistanceBackend,),
    "engines": (Engine,),
}
"""Entry-point groups ``nonsmooth.<name>`` and the interfaces that their members implement."""

KINDS = {
    "bodies": "body",
    "laws": "law",
    "scenarios": "scenario",
    "kinematics": "contact kinematics",
    "joints": "joint",
    "loads": "load",
    "shapes": "shape",
    "motions": "motion",
    "guards": "guard",
    "distances": "library for distances",
    "engines": "engine",
}
"""What one member of a group is called."""

_LAWS = {NormalLaw: "normal law", TangentialLaw: "friction law", ImpactLaw: "impact law"}
"""What a law is called where the laws of another kind are asked for."""


class BrokenPlugin(NonsmoothWarning):
    """An installed plug-in that cannot be used."""


@functools.cache
def _points(group: str) -> dict[str, EntryPoint]:
    found: dict[str, EntryPoint] = {}
    # built-ins first, so that nothing installed later takes their names
    points = [point for point in entry_points(group=f"nonsmooth.{group}") if _is_installed(point)]
    for point in sorted(points, key=lambda p: (not _is_ours(p), p.name, p.value)):
        first = found.setdefault(point.name, point)
        if (first.value, _distribution(first)) != (point.value, _distribution(point)):
            warnings.warn(
                f"{KINDS[group]} {point.name!r} is claimed by {_origin(first)} and by {_origin(point)}; "
                "the first is used: rename the other, or uninstall one of the two.",
                BrokenPlugin,
                stacklevel=3,
            )
    return dict(sorted(found.items()))


def _is_installed(point: EntryPoint) -> bool:
    """Return whether a point is of an installed package, and not of metadata beside the user's own files."""
    return point.dist is None or _is_installed_in(str(point.dist.locate_file("")))


@functools.cache
def _is_installed_in(place: str) -> bool:
    sites = (*sysconfig.get_paths().values(), *site.getsitepackages(), site.getusersitepackages())
    found = Path(place).resolve()
    return found not in _own_folders() or found in {Path(one).resolve() for one in sites}


def _own_folders() -> set[Path]:
    """Return where Python imports from although nobody installed what lies there: working folder, that of the script.

    Files of other persons lie there, too.
    """
    script = vars(sys.modules["__main__"]).get("__file__")
    return {*_BEGAN_IN, *_working_folder(), *([Path(script).resolve().parent] if script else [])}


def _working_folder() -> tuple[Path, ...]:
    """Return the working folder, nothing where somebody has removed it."""
    with contextlib.suppress(FileNotFoundError):
        return (Path.cwd(),)
    return ()


_BEGAN_IN = _working_folder()
"""The working folder of ``python -m``, also after the process has gone to another one."""


@functools.cache
def packages() -> frozenset[str]:
    """Return the packages and modules in which what is installed stands, importing nothing.

    A namespace package is none of them: a folder of its name in the working folder is a part of it.
    """
    modules = {point.module for group in GROUPS for point in _points(group).values()}
    parents = {module.rpartition(".")[0] for module in modules if "." in module}
    return frozenset(modules | {parent for parent in parents if not _is_namespace(parent.partition(".")[0])})


def _is_namespace(package: str) -> bool:
    try:
        spec = importlib.util.find_spec(package)
    except ValueError:  # a module put together by hand, without a specification
        return True
    return spec is None or spec.origin is None


@functools.cache
def _name_and_version(distribution: Distribution) -> tuple[str, str]:
    # either of them reads and parses a file
    return distribution.name, distribution.version


def _is_ours(point: EntryPoint) -> bool:
    return point.dist is not None and _name_and_version(point.dist)[0] == "nonsmooth"


def _distribution(point: EntryPoint) -> str:
    return " ".join(_name_and_version(point.dist)) if point.dist else "unknown distribution"


def _origin(point: EntryPoint) -> str:
    return f"{_distribution(point)} ({point.value})"


def check_groups() -> None:
    """Warn of installed entry-point groups that are none of ours but begin like them: nobody would read them."""
    known = [f"nonsmooth.{group}" for group in GROUPS]
    for group in sorted(entry_points().groups):
        if group.startswith("nonsmooth.") and group not in known:
            origins = ", ".join(sorted(_origin(point) for point in entry_points(group=group)))
            near = difflib.get_close_matches(group, known, n=1)
            hint = f"Did you mean {near[0]!r}?" if near else f"Known: {', '.join(known)}."
            warnings.warn(
                f"The entry-point group {group!r} of {origins} is unknown. {hint}", BrokenPlugin, stacklevel=2
            )


def names(group: str) -> tuple[str, ...]:
    """Return the names installed in a group, loading nothing."""
    return tuple(_points(group))


def source(group: str, name: str) -> str:
    """Return the distribution that a name comes from."""
    return _distribution(_points(group)[name])


def imported(group: str, name: str) -> str:
    """Return the line of Python that imports the class of that name."""
    point = _points(group)[name]
    return f"from {point.module} import {point.attr}"


def called(word: str, groups: Iterable[str]) -> list[tuple[str, str]]:
    """Return group and name of all that is installed under a name, or of the class that the word is, loading nothing.

    A class is meant by its name in Python, also in lower case with underscores: BoxBody, box_body.

    Raises
    ------
    UnknownName
        If there is none.
    """
    known = [(group, name) for group in groups for name in names(group)]
    bare = word.replace("_", "").lower()
    found = [(group, name) for group, name in known if name == word]
    found = found or [(group, name) for group, name in known if _points(group)[name].attr.lower() == bare]
    if not found:
        raise UnknownName("component", word, {name for _, name in known})
    return found


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
        raise UnknownName(KINDS[group], name, names(group), kinds_named(name))
    return _usable(_points(group)[name], group)


@functools.cache
def _usable(point: EntryPoint, group: str) -> Any:
    """Return a class; kept, as every contact of a system asks for all kinematics."""
    try:
        loaded = point.load()
    except Exception as error:
        reason = f"{type(error).__name__}: {error}"
        raise PluginError(
            " ".join([f"{_title(group, point.name)} cannot be loaded: {reason}.", *hidden_packages()])
        ) from error
    found = fault(loaded, GROUPS[group])
    if found is not None:
        raise PluginError(f"{_title(group, point.name)} {found}")
    return loaded


INTERFACES = tuple(base for bases in GROUPS.values() for base in bases)
"""What a plug-in may implement."""


def kind_of(owner: type) -> str:
    """Return in words what a class is."""
    return next(KINDS[group] for group, bases in GROUPS.items() if issubclass(owner, bases))


def kinds_named(name: str) -> str:
    """Kinds of the components of a name, in all groups: "a friction law and a body"; "" if there is none."""
    found: dict[str, None] = {}
    for group in GROUPS:
        if name in names(group) and (owner := _loaded(group, name)) is not None:
            kind = next((words for base, words in _LAWS.items() if issubclass(owner, base)), KINDS[group])
            found[f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"] = None
    return " and ".join(found)


def fault(loaded: Any, bases: tuple[type, ...]) -> str | None:
    """Return why what a plug-in gives cannot be used: None if it is a dataclass that implements one of the bases."""
    if not (isinstance(loaded, type) and issubclass(loaded, bases)):
        wanted = " or ".join(base.__name__ for base in bases)
        return f"must be a subclass of {wanted}, not {loaded!r}."
    if inspect.isabstract(loaded):
        missing = ", ".join(sorted(vars(loaded)["__abstractmethods__"]))
        return f"must define {missing}."
    if "__dataclass_fields__" not in vars(loaded):
        return f"must be a dataclass: write @dataclass(frozen=True) above {loaded.__name__}."
    return None


def _title(group: str, name: str) -> str:
    return f"{KINDS[group]} {name!r} ({_points(group)[name].value}, from {source(group, name)})"


def name_of(owner: type) -> str | None:
    """Return the name under which a class is installed, None if it is not."""
    for group, bases in GROUPS.items():
        if issubclass(owner, bases):
            for name, point in _points(group).items():
                # a module may show a class that lives in another one
                if point.attr == owner.__name__ and _loaded(group, name) is owner:
                    return name
    return None


def _loaded(group: str, name: str) -> Any:
    try:
        return load(group, name)
    except PluginError:
        return None


def load_all(group: str, some: Iterable[str] | None = None) -> dict[str, Any]:
    """Usable classes of a group by name: all of them, or ``some``. A broken one is a warning that names it."""
    loaded = {}
    for name in names(group) if some is None else some:
        try:
            loaded[name] = load(group, name)
        except PluginError as error:
            warnings.warn(str(error), BrokenPlugin, stacklevel=2)
    return loaded
