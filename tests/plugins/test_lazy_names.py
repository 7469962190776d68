"""Names of packages that are imported on first use: all are there, and a package itself imports next to nothing."""

from __future__ import annotations

import importlib.metadata
import pkgutil
import subprocess
import sys
from types import ModuleType

import pytest

import bodies
import laws
import nonsmooth

PACKAGES = pytest.mark.parametrize("package", [nonsmooth, bodies, laws], ids=lambda package: package.__name__)


@PACKAGES
def test_each_name_is_there_and_listed(package: ModuleType) -> None:
    """In the order of the alphabet; a name is imported once."""
    assert package.__all__ == sorted(package.__all__)
    assert {*package.__all__} <= {*dir(package)}
    for name in package.__all__:
        assert getattr(package, name) is getattr(package, name)


@PACKAGES
def test_dir_shows_public_names_only(package: ModuleType) -> None:
    """The other names are those that Python gives to every module."""
    shown = {name for name in dir(package) if not (name.startswith("__") and name.endswith("__"))}
    assert shown == {*package.__all__}
    assert {"__all__", "__doc__", "__name__"} <= {*dir(package)}


@PACKAGES
def test_no_name_is_a_module_too(package: ModuleType) -> None:
    """An import of the module would replace what the name stands for."""
    modules = {module.name for module in pkgutil.iter_modules(package.__path__)}
    assert modules.isdisjoint(package.__all__)


@PACKAGES
def test_an_unknown_name_is_told(package: ModuleType) -> None:
    """As of any module, so that ``hasattr`` works."""
    assert not hasattr(package, "Sfere")
    with pytest.raises(ImportError, match="cannot import name 'Sfere'"):
        exec(f"from {package.__name__} import Sfere")


def test_the_version_is_that_of_the_metadata() -> None:
    """It is read on first use."""
    assert nonsmooth.__version__ == importlib.metadata.version("nonsmooth")


@pytest.mark.parametrize(
    ("text", "unused"),
    [
        ("import nonsmooth", "numpy numba llvmlite importlib.metadata nonsmooth.engine nonsmooth.interfaces"),
        ("from bodies import Ball, Plate", "numba scipy trimesh bodies.box_body bodies.contacts.plane bodies.meshes"),
        ("from laws import Coulomb, Unilateral", "numba scipy laws.impact"),
        (
            "import nonsmooth as ns; from bodies import Ball, Plate; from laws import *; ball = Ball(0.1); "
            "system = ns.System([Plate(), ball]); "
            "system.contact_all(ns.ContactLaws(Unilateral(), Frictionless(), EnergeticImpact(0.5)))",
            "numba scipy trimesh yaml bodies.contacts.frustum bodies.contacts.mesh bodies.contacts.polyhedron",
        ),
    ],
    ids=["nonsmooth", "bodies", "laws", "contacts"],
)
def test_what_is_not_used_is_not_imported(text: str, unused: str) -> None:
    """In a process of its own."""
    text = f"{text}\nimport sys\nprint([name for name in {unused.split()} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
