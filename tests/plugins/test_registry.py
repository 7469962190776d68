"""The registry: names, sources, and what is wrong with a plug-in."""

from __future__ import annotations

import importlib.metadata
import re
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from nonsmooth.errors import PluginError, UnknownName
from nonsmooth.plugins import registry

Install = Callable[..., None]

_GOOD = """
from dataclasses import dataclass
from nonsmooth.interfaces import RigidNormalLaw

@dataclass(frozen=True)
class Good(RigidNormalLaw):
    '''A law that accepts everything.'''

    def is_fulfilled(self, acceleration, force, tolerance):
        return True
"""


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Return a function that installs a distribution: name, entry points of nonsmooth.laws, modules."""

    def run(name: str, entries: str, **modules: str) -> None:
        folder = tmp_path / name
        info = folder / f"{name}-1.2.dist-info"
        info.mkdir(parents=True)
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.2\n")
        (info / "entry_points.txt").write_text(f"[nonsmooth.laws]\n{entries}\n")
        for module, content in modules.items():
            (folder / f"{module}.py").write_text(content)
        monkeypatch.syspath_prepend(str(folder))
        registry._points.cache_clear()

    yield run
    registry._points.cache_clear()


@pytest.mark.parametrize("group", list(registry.GROUPS))
def test_every_built_in_loads(group: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        loaded = registry.load_all(group)
    assert tuple(loaded) == registry.names(group)
    assert all(issubclass(owner, registry.GROUPS[group]) for owner in loaded.values())


def test_what_is_known_is_loaded_without_reading_files(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every contact of a system asks for all kinematics: to parse a distribution each time would take most of it."""
    known = registry.load_all("kinematics")

    def read(*_: object) -> None:
        raise AssertionError("the metadata of a distribution is read again")

    monkeypatch.setattr(importlib.metadata.Distribution, "metadata", property(read))
    assert registry.load_all("kinematics") == known


def test_a_plug_in_is_found_with_its_source(install: Install) -> None:
    install("plug_good", "good = plug_good:Good", plug_good=_GOOD)
    assert "good" in registry.names("laws")
    assert registry.source("laws", "good") == "plug_good 1.2"
    assert registry.load("laws", "good").__name__ == "Good"


def test_an_unknown_name_is_answered_with_the_nearest() -> None:
    with pytest.raises(UnknownName, match=r"Unknown law .columb.\. Did you mean .coulomb."):
        registry.load("laws", "columb")


@pytest.mark.parametrize(
    ("number", "target", "content", "told"),
    [
        (1, "Missing", _GOOD, "cannot be loaded: AttributeError"),
        (2, "Good", "1 +", "cannot be loaded: SyntaxError"),
        (3, "Good", "raise KeyError('x')", "cannot be loaded: KeyError"),
        (4, "Good", "Good = 3", "must be a subclass of NormalLaw or TangentialLaw or ImpactLaw, not 3"),
        (5, "Good", "class Good: pass", "must be a subclass of NormalLaw"),
        (6, "Good", _GOOD.replace("def is_fulfilled", "def fulfils"), "must define is_fulfilled"),
        (7, "Good", _GOOD.replace("@dataclass(frozen=True)", ""), "must be a dataclass: write @dataclass"),
    ],
)
def test_a_broken_plug_in_is_named_with_its_mistake(
    install: Install, number: int, target: str, content: str, told: str
) -> None:
    module = f"plug_broken_{number}"
    install(module, f"bad = {module}:{target}", **{module: content})
    with pytest.raises(PluginError, match=told) as raised:
        registry.load("laws", "bad")
    assert f"law 'bad' ({module}:{target}, from {module} 1.2)" in str(raised.value)
    assert "hides" not in str(raised.value)
    with pytest.warns(registry.BrokenPlugin, match=told):
        loaded = registry.load_all("laws")
    assert "bad" not in loaded
    assert "coulomb" in loaded


def test_two_claims_to_a_name_are_told(install: Install) -> None:
    install("plug_rival", "coulomb = plug_rival:Good", plug_rival=_GOOD)
    with pytest.warns(
        registry.BrokenPlugin,
        match=r"'coulomb' is claimed by nonsmooth .* \(\S+.laws:Coulomb\) and by plug_rival 1.2 \(plug_rival:Good\)",
    ):
        assert registry.load("laws", "coulomb").__name__ == "Coulomb"


def test_a_built_in_keeps_its_name_whatever_a_rival_is_called(install: Install) -> None:
    install("a_rival", "coulomb = a_rival:Good", a_rival=_GOOD)  # sorts before ours
    with pytest.warns(registry.BrokenPlugin, match=r"is claimed by nonsmooth .* and by a_rival 1.2 \(a_rival:Good\)"):
        assert registry.load("laws", "coulomb").__name__ == "Coulomb"


def test_the_name_of_a_class_is_found() -> None:
    assert registry.name_of(registry.load("laws", "newton")) == "newton"
    assert registry.name_of(registry.load("shapes", "box")) == "box"
    assert registry.name_of(type("Coulomb", (registry.load("laws", "coulomb"),), {})) is None
    assert registry.name_of(dict) is None


def test_a_group_that_nobody_reads_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    info = tmp_path / "slip-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: slip\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[nonsmooth.law]\nwax = wax:Wax\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.warns(registry.BrokenPlugin, match=r"'nonsmooth.law' of slip 1.0 \(wax:Wax\) is unknown. Did you mean"):
        registry.check_groups()


def test_kinematics_are_named_by_their_shapes() -> None:
    """A name with a hyphen tells for which shapes the class is imported; a wrong one would hide it."""
    for name, kinematics in registry.load_all("kinematics").items():
        words = [re.sub(r"(?<!^)(?=[A-Z])", "_", shape.__name__).lower() for shape in kinematics.pair]
        assert name == "-".join(words)
