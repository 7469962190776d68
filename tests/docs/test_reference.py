"""The reference has every public name once for users, every other module once for developers, the navigation all."""

from __future__ import annotations

import ast
import re
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
PAGES = ROOT / "docs" / "pages"
PACKAGES = (
    *("nonsmooth", "bodies", "laws", "nonsmooth.interfaces", "nonsmooth.plot", "nonsmooth.testing"),
    *(f"nonsmooth.studies{part}" for part in ("", ".attractors", ".derivatives", ".orbits")),
)
"""Packages whose ``__all__`` is public."""
SECOND_NAMES = {"nonsmooth.bodies", "nonsmooth.laws", "nonsmooth.scenarios"}


def _listed(folder: str) -> list[str]:
    texts = [page.read_text(encoding="utf-8") for page in sorted((PAGES / folder).glob("*.md"))]
    return [name for text in texts for name in re.findall(r"^::: (\S+)$", text, re.MULTILINE)]


def _defined(name: str) -> str:
    """Name of an object where it is defined; constants have only the name by which they are public."""
    package, _, last = name.rpartition(".")
    value: Any = getattr(import_module(package), last, None) if package else import_module(name)
    if value is None:
        value = import_module(name)
    if isinstance(value, ModuleType):
        name = value.__name__
    elif hasattr(value, "__qualname__"):
        name = f"{value.__module__}.{value.__qualname__}"
    return re.sub(r"^nonsmooth\.(bodies|laws|scenarios)\.", r"\1.", name)


@pytest.fixture(scope="module")
def for_users() -> list[str]:
    """Return where the names on the pages for users are defined."""
    return [_defined(name) for name in _listed("reference")]


@pytest.mark.parametrize("package", PACKAGES)
def test_every_public_name_is_on_one_page_for_users(package: str, for_users: list[str]) -> None:
    for name in import_module(package).__all__:
        count = for_users.count(_defined(f"{package}.{name}"))
        assert count == 1, f"{package}.{name} is {count} times on the pages for users"


def test_no_name_is_on_two_pages_for_users(for_users: list[str]) -> None:
    assert sorted(for_users) == sorted({*for_users})


def _public_names(file: Path) -> set[str]:
    """Classes and functions of a module that a page would show."""
    kinds = (ast.ClassDef, ast.FunctionDef)
    parts = [one for one in ast.parse(file.read_text(encoding="utf-8")).body if isinstance(one, kinds)]
    return {one.name for one in parts if not one.name.startswith("_") and ast.get_docstring(one)}


def test_every_other_module_is_on_one_page_for_developers(for_users: list[str]) -> None:
    """A module is listed, or its package with all that it holds; or all its names are on pages for users."""
    listed = _listed("developers")
    for package in ("nonsmooth", "bodies", "laws", "scenarios"):
        for file in (ROOT / package).rglob("*.py"):
            module = ".".join(file.relative_to(ROOT).with_suffix("").parts)
            if file.stem.startswith("_") or module in SECOND_NAMES:
                continue
            found = [name for name in listed if module == name or module.startswith(f"{name}.")]
            names = _public_names(file)
            covered = module in for_users or (names and all(f"{module}.{name}" in for_users for name in names))
            assert len(found) == 1 or (covered and not found), f"{module} is on the pages for developers as {found}"


def test_every_page_is_in_the_navigation() -> None:
    """What is not listed cannot be found."""
    navigation = set(re.findall(r": (\S+\.md)$", (ROOT / "docs" / "mkdocs.yml").read_text(encoding="utf-8"), re.M))
    assert navigation == {page.relative_to(PAGES).as_posix() for page in PAGES.rglob("*.md")}
