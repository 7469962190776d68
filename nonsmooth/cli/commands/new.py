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
from typing import Any

from nonsmooth.cli.asking import outputs
from nonsmooth.cli.telling.messages import say
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
"""Where each text goes."""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("new", help="write a package to start from", allow_abbrev=False)
    kinds = command.add_subparsers(title="kinds", required=True, metavar="KIND")
    plugin = kinds.add_parser(
        "plugin", help="a package with a friction law, a scenario, and their tests", allow_abbrev=False
    )
    plugin.add_argument("name", metavar="NAME", help="of the package and of its law, in lower case")
    plugin.add_argument("--dir", type=Path, metavar="DIR", help="the folder to write it to, ./NAME by default")
    plugin.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace) -> bool:
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
    holder = _holder(name)
    if holder:
        raise InvalidInput(
            "new plugin: name", "must not be taken already", name, f"It is that of {holder}: take another."
        )


def _holder(name: str) -> str:
    """Return what has the name already, that the package would hide or replace; nothing where it is free."""
    if name in registry.names("laws"):
        return f"a law of {registry.source('laws', name)}"
    if name == "tests":
        return "the folder of its tests"
    if name in sys.stdlib_module_names:
        return "a module of Python"
    with contextlib.suppress(metadata.PackageNotFoundError):
        return f"the installed package {name} {metadata.version(name)}"
    found = importlib.util.find_spec(name)
    # a folder without __init__.py has a specification, too, but no origin, and is hidden by anything
    return f"the module {found.origin}" if found is not None and found.origin is not None else ""
