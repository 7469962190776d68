"""The scenes whose speed is compared are systems of this commit."""

from __future__ import annotations

import pytest

from tests.benchmarks.against.speed import scenes
from tests.benchmarks.against.start import _SCENE
from tests.benchmarks.described.components import component
from tests.benchmarks.described.systems import contact_laws

_SCENES = scenes()


def test_each_scene_has_a_name_of_its_own_and_the_first_run_is_one_of_them() -> None:
    assert len(_SCENES) == 10
    assert _SCENE in _SCENES


@pytest.mark.parametrize("name", _SCENES)
def test_the_vocabulary_has_all_words_of_a_scene(name: str) -> None:
    scene = _SCENES[name]
    assert len(component(scene["bodies"])) == len(scene["starts"])
    assert len(contact_laws(scene)) == len(scene["laws"])
