"""Loads a class by its name, from an installed plug-in or from a single Python file."""

from __future__ import annotations

import hashlib
import importlib.util
import inspect
import re
import sys
import threading
import traceback
from pathlib import Path
from types import ModuleType
from typing import Any

from nonsmooth.errors import InvalidInput, PluginError, UnknownName
from nonsmooth.plugins import registry

_FILE = re.compile(r"(?P<file>.*\.py):(?P<name>[^:]*)")
_KEY = re.compile(r".+_[0-9a-f]{8}")
_LOADING = threading.Lock()


def is_file(word: str) -> bool:
    """True if a word denotes a class of a file, ``path/to/file.py:Class``, and not an installed name."""
    return _FILE.fullmatch(word) is not None


def find(thing: str, group: str, base: type, word: str, folder: Path | None = None) -> Any:
    """Class of an installed name, or of ``file.py:Class``.

    Parameters
    ----------
    thing : str
        Option or entry that names the class, for messages ("--law friction").
    group : str
        Group of the installed names.
    base : type
        The interface that the class must implement.
    word : str
        An installed name, or ``file.py:Class``.
    folder : Path, optional
        Folder from which the path of a file starts; by default the working folder.

    Raises
    ------
    UnknownName
        If no class of this interface is installed under that name, or the file has no such class.
    InvalidInput
        If the file does not exist, or ``word`` names a file without a class.
    PluginError
        If the class cannot be loaded, or a class of a file does not implement the interface.
    """
    if is_file(word):
        return load(thing, (base,), word, folder)
    if word.endswith(".py"):
        raise InvalidInput(thing, "must name a class of the file", word, f"For example {word}:My{base.__name__}.")
    if word in registry.names(group):
        owner = registry.load(group, word)
        if issubclass(owner, base):
            return owner
    known = [name for name, owner in registry.load_all(group).items() if issubclass(owner, base)]
    raise UnknownName(thing, word, known, registry.kinds_named(word))


def load(thing: str, bases: tuple[type, ...], word: str, folder: Path | None = None) -> Any:
    """Class of ``file.py:Class`` that implements one of ``bases``; parameters and errors as of :func:`find`."""
    match = _FILE.fullmatch(word)
    if match is None:
        example = f"For example {word.partition(':')[0]}:My{bases[0].__name__}; a script is run by python itself."
        raise InvalidInput(thing, "must have the form file.py:Class", word, example)
    path = ((folder or Path()) / match["file"]).resolve()
    if not path.is_file():
        raise InvalidInput(thing, "must name a file that exists", match["file"], f"There is no {path}.")
    module, name = _module(thing, path), match["name"]
    known = [
        n for n, c in vars(module).items() if inspect.isclass(c) and c.__module__ == module.__name__ and _fits(c, bases)
    ]
    if name not in vars(module):
        raise UnknownName(f"{thing}: class of {path.name}", name, known)
    found = registry.fault(vars(module)[name], bases)
    if found is not None:
        raise PluginError(f"{thing}: {name} of {path} {found}")
    return vars(module)[name]


def _fits(owner: type, bases: tuple[type, ...]) -> bool:
    return issubclass(owner, bases) and not inspect.isabstract(owner)


def loaded() -> tuple[Path, ...]:
    """Files from which this process has loaded classes by :func:`load`."""
    files = {
        name: Path(str(vars(sys.modules[name]).get("__file__"))) for name in [*sys.modules] if _KEY.fullmatch(name)
    }
    return tuple(path for name, path in files.items() if name == _key(path))


def again(path: Path) -> None:
    """Load a Python file with classes in a worker process, as the main process did, unless it is loaded already.

    Raises
    ------
    PluginError
        If the file cannot be loaded.
    """
    with _LOADING:
        if _key(path) not in sys.modules:
            _module("worker", path)


def _key(path: Path) -> str:
    """Module name under which a file is loaded: its stem and a digest of its path, so that no package has this name."""
    return f"{path.stem}_{hashlib.sha256(str(path).encode()).hexdigest()[:8]}"


def _module(thing: str, path: Path) -> ModuleType:
    """Run a file as a module."""
    key = _key(path)
    specification = importlib.util.spec_from_file_location(key, path)
    if specification is None or specification.loader is None:
        raise InvalidInput(thing, "must name a Python file", str(path), "Its name must end in .py.")
    module = importlib.util.module_from_spec(specification)
    sys.modules[key] = module  # dataclasses and numba look modules up by name
    try:
        specification.loader.exec_module(module)
    except Exception as error:
        del sys.modules[key]
        raise PluginError(
            f"{thing}: {path}{_line(error, path)} cannot be loaded: {_reason(error).rstrip('.')}."
        ) from error
    return module


def _line(error: Exception, path: Path) -> str:
    if isinstance(error, SyntaxError) and error.lineno is not None:
        return f", line {error.lineno},"
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
    return f", line {lines[-1]}," if lines else ""


def _reason(error: Exception) -> str:
    return f"{type(error).__name__}: {error.msg if isinstance(error, SyntaxError) else error}"
