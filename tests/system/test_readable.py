"""`help()` and completion of classes that users make: what they need, and no machinery of Python."""

from __future__ import annotations

import inspect
import pydoc

import pytest

import nonsmooth as ns
from nonsmooth.bodies import Ball, BoxBody
from nonsmooth.laws import Coulomb
from nonsmooth.parameters import Component, rules
from scenarios.bouncing_ball import BouncingBall

MACHINERY = "__dataclass", "__init__", "__eq__", "__annotations__", "_DataclassParams", "mappingproxy", "_abc_impl"


def _help(owner: type) -> str:
    """Text of ``help(owner)`` without bold letters."""
    return pydoc.plain(pydoc.render_doc(owner))


@pytest.mark.parametrize("owner", [Ball, BoxBody, Coulomb, BouncingBall, ns.Solution, ns.System])
def test_help_has_no_machinery(owner: type) -> None:
    text = _help(owner)
    assert not [word for word in MACHINERY if word in text]
    assert not [name for name in dir(owner) if name.startswith("_")]


@pytest.mark.parametrize("owner", [Ball, BoxBody, Coulomb, BouncingBall])
def test_help_describes_each_parameter(owner: type[Component]) -> None:
    """With its type, unit and range, and in the signature, from which editors complete."""
    text, signature = _help(owner), inspect.signature(owner)
    for name, (_, rule) in rules(owner).items():
        assert name in signature.parameters
        assert f"{name} : " in text
        assert rule.doc in text
        assert rule.describe() in text


def test_place_names_its_keywords() -> None:
    assert {"position", "orientation", "velocity", "angular_velocity"} <= {
        *inspect.signature(ns.System.place).parameters
    }
