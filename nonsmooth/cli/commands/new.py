"""``nonsmooth new``: a package to start from."""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import keyword
import re
import sys
from importlib import metadata, resources
from pathlib import Path
from string import Template

from nonsmooth.cli.execute import outputs
from nonsmooth.cli.parse.options import Command, CommandGroup, Option
from nonsmooth.cli.report.messages import say
from nonsmooth.errors import InvalidInput
from nonsmooth.plugins import registry
from nonsmooth.storage.files import replacing

_FILES = {
    "pyproject.toml": "pyproject.toml.txt",
    "README.md": "README.md.txt",
    "{name}/__init__.py": "init.py.txt",
    "{name}/friction.py": "friction.py.txt",
    "{name}/scenario.py": "scenario.py.txt",
    "tests/test_friction.py": "test_friction.py.txt",
    "tests/test_scenario.py": "test_scenario.py.txt",
}
"""Path of a file within the new package -> name of the template of its text."""


_PLUGIN = (
    Option("name", "of the package and of its law, in lower case", metavar="NAME"),
    Option("--dir", "the folder to write it to, ./NAME by default", metavar="DIR", kind=Path),
)


def _execute(arguments: argparse.Namespace) -> bool:
    """Write the package; print the paths of its files."""
    name = arguments.name
    _check_name(name)
    folder = arguments.dir or Path(name)
    outputs.prepare_folder(folder, overwrite=False, remedy="Add --dir DIR.")
    words = {"name": name, "title": "".join(part.capitalize() for part in name.split("_"))}
    texts = resources.files("nonsmooth.templates") / "plugin"
    for place, source in _FILES.items():
        path = folder / place.format(name=name)
        text = Template((texts / source).read_text(encoding="utf-8")).substitute(words)
        with replacing(path) as part:
            part.write_text(text, encoding="utf-8")
        say(str(path))
    return True


def _check_name(name: str) -> None:
    remedy = "Take small letters, digits and underscores, a letter first: rubber_friction."
    if re.fullmatch(r"[a-z][a-z0-9_]*[a-z0-9]", name) is None or keyword.iskeyword(name):
        raise InvalidInput("new plugin: name", "must be that of a Python package", name, remedy)
    if holder := _holder(name):
        remedy = f"It is that of {holder}: take another."
        raise InvalidInput("new plugin: name", "must not be taken already", name, remedy)


def _holder(name: str) -> str:
    """Return what already has the name of a new plug-in, such as "a module of Python"; "" if the name is free."""
    if name in registry.names("laws"):
        return f"a law of {registry.source('laws', name)}"
    if name == "tests":
        return "the folder of its tests"
    if name in sys.stdlib_module_names:
        return "a module of Python"
    with contextlib.suppress(metadata.PackageNotFoundError):
        return f"the installed package {name} {metadata.version(name)}"
    found = importlib.util.find_spec(name)
    # a folder without __init__.py has a specification but no origin; it is no conflict, as any module hides it
    return f"the module {found.origin}" if found is not None and found.origin is not None else ""


_PARTS = {"plugin": Command(_execute, _PLUGIN, "a package with a friction law, a scenario, and their tests")}
COMMANDS = {"new": CommandGroup("kinds", "KIND", _PARTS)}
