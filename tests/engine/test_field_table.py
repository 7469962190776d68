"""The field table: each number of the engine is declared once, and all who read it by its name read the same number."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from enum import IntEnum
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth
from nonsmooth.engine.memory.declare import Declaration, Life, Singleton, declarations
from nonsmooth.engine.memory.memory import Memory, allocate
from nonsmooth.engine.memory.owners import (
    Island,
    OutputNumbers,
    Problem,
)
from nonsmooth.engine.memory.tables import COUNTS
from nonsmooth.engine.memory.workspace import PARTS, RECORDS
from nonsmooth.engine.native import plain
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.steps import FloatRow, array, fixed, step

OWNERS = {**PARTS, **RECORDS}
DECLARED = [(name, one) for name, owner in OWNERS.items() for one in declarations(owner).values()]
UNITS = {"", "1", "s", "m", "J", "N", "W", "m/s", "m/s^2", "N s", "1/s", "1/s^2", "1/kg"}
ENGINE = Path(nonsmooth.__file__).parent / "engine"
COUNT = 3
"""Number of bodies, contacts and all else in the workspace of these tests."""
NUMBER = COUNT - 1
"""The record that is read."""
MOST = 4000


class Seen(Singleton, key="seen"):
    """What a compiled step has read."""

    numbers: FloatRow = array(Life.OUTPUT, fixed(MOST), float, "", "Numbers, one after another.")


@pytest.mark.parametrize("name", OWNERS)
def test_each_number_has_a_life_a_unit_and_a_sentence(name: str) -> None:
    """An integer, a boolean and a member of an enumeration have no unit."""
    for one in declarations(OWNERS[name]).values():
        assert isinstance(one.life, Life), one.name
        assert set(one.unit.split(", ")) <= UNITS, one.name
        assert one.kind is float or one.unit == "", one.name
        assert one.kind in (float, int, bool) or issubclass(one.kind, IntEnum), one.name
        assert re.fullmatch(r"\S.+\.", one.sentence), one.name


def test_each_number_is_stored_once() -> None:
    """A number is stored under a key of its own, or is part of another one, within its bounds."""
    stored = {one.key: one for _, one in DECLARED if not one.inside[0]}
    assert len(stored) == sum(1 for _, one in DECLARED if not one.inside[0])
    for _, one in DECLARED:
        if one.inside[0]:
            storage = stored[one.key]
            length = storage.numbers if storage.size is None else storage.size(dict.fromkeys(COUNTS, 1))
            assert one.inside[1] + one.numbers <= length + storage.has_end, one.key
            assert one.is_float == storage.is_float, one.key


def test_the_state_is_in_a_checkpoint() -> None:
    """All that a later step reads comes before the buffers of the output, which a checkpoint leaves out."""
    memory = _memory()
    first = {True: memory.start(OutputNumbers.event_numbers), False: memory.start(OutputNumbers.event_codes)}
    for _, one in DECLARED:
        is_scalar = one.size is None and issubclass(one.owner, Singleton)
        if one.life is Life.STATE and not is_scalar:
            assert memory.record[one.key] < first[one.is_float], one.key


def test_entry_points_take_the_workspace_and_numbers() -> None:
    """Python hands over no array; a kernel that has the workspace reads the integers of it by their names."""
    found = [
        (kind, given)
        for path in ENGINE.rglob("*.py")
        for kind, given in re.findall(r'^@(kernel|entry_point)\("\w+\(([^)"]*)\)"\)$', path.read_text(), re.M)
    ]
    assert len(found) > 300
    for kind, given in found:
        types = given.split(", ")
        assert not {"S", "I"} & {*types}, given
        if kind == "entry_point":
            assert types[0] == "ws", given
            assert "F" not in types, given


def _memory() -> Memory:
    """Return a workspace in which all numbers of the table differ as far as they can."""
    memory = allocate(dict.fromkeys(COUNTS, COUNT), (Seen,))
    random = np.random.default_rng(1)
    for _, one in DECLARED:
        if one.inside[0] or one.owner.key == "model":
            continue
        is_scalar = one.size is None and issubclass(one.owner, Singleton)
        shape = () if is_scalar else memory[one].shape
        if one.kind is float:
            memory[one] = random.normal(size=shape)
        elif one.kind is int:
            memory[one] = random.integers(1, 10**9, size=shape)
        elif issubclass(one.kind, IntEnum):
            memory[one] = random.choice([*one.kind], size=shape)
        else:
            memory[one] = random.integers(0, 2, size=shape)
    # the first record of a group is the first of all
    memory[Problem.first_grouped] = 0
    return memory


def _places(name: str, one: Declaration) -> Iterator[tuple[str, tuple[int, ...]]]:
    """Yield how a step writes the first and the last number of a declaration, and where they are in its view."""
    if name in RECORDS:
        text = f"ws.{name}[{NUMBER}].{one.name}"
        if one.numbers == 1:
            yield text, (NUMBER,)
        else:
            yield from ((f"{text}[{i}]", (NUMBER, i)) for i in (0, one.numbers - 1))
    elif one.size is None:
        yield f"ws.{name}.{one.name}", ()
    elif (length := one.size(dict.fromkeys(COUNTS, COUNT))) > 0:
        yield from ((f"ws.{name}.{one.name}[{i}]", (i,)) for i in (0, length - 1))


def _as_float(one: Declaration, text: str) -> str:
    """Return the text of a number as a float."""
    if one.kind is bool:
        return f"1.0 if {text} else 0.0"
    return f"float({text}.value)" if issubclass(one.kind, IntEnum) else f"float({text})"


def _expected(memory: Memory, one: Declaration, place: tuple[int, ...]) -> float:
    numbers = np.asarray(memory[one])
    number = float(numbers[place]) if numbers.ndim == len(place) else float(numbers[place[:1]])
    return float(number != 0.0) if one.kind is bool else number


def _step(name: str, lines: list[str]) -> Callable[..., Any]:
    """Return a function of the workspace that consists of some lines."""
    scope: dict[str, Any] = {}
    exec("\n    ".join([f"def {name}(ws):", *lines]), scope)
    found: Callable[..., Any] = scope[name]
    return found


@pytest.mark.parametrize("name", OWNERS)
def test_all_who_read_a_number_by_its_name_read_the_same(name: str) -> None:
    """Python by the declaration, a compiled step, and the engine as ordinary Python."""
    memory = _memory()
    read = [(text, one, place) for owner, one in DECLARED if owner == name for text, place in _places(name, one)]
    function = _step(
        f"read_{name}", [f"ws.seen.numbers[{i}] = {_as_float(one, text)}" for i, (text, one, _) in enumerate(read)]
    )
    expected = [_expected(memory, one, place) for _, one, place in read]
    texts = [text for text, *_ in read]
    call_entry(step(Seen)(function), memory)
    assert dict(zip(texts, memory[Seen.numbers].tolist(), strict=False)) == dict(zip(texts, expected, strict=True))
    memory[Seen.numbers] = 0.0
    workspace = plain.PlainWorkspace(memory)
    function(workspace)
    workspace.write_back(memory)
    assert memory[Seen.numbers][: len(read)].tolist() == expected


@pytest.mark.parametrize("name", ["contacts", "island", "problem"])
def test_a_number_is_written_where_it_is_read(name: str) -> None:
    """By a compiled step and by the engine as ordinary Python; nothing else changes."""
    written = [
        (text, one, place)
        for owner, one in DECLARED
        if owner == name and one.kind is float and not one.inside[0] and not one.is_vector
        for text, place in _places(name, one)
    ]
    function = _step(f"write_{name}", [f"{text} = {i}.5" for i, (text, *_) in enumerate(written)])
    memory, other = _memory(), _memory()
    call_entry(step(Seen)(function), memory)
    workspace = plain.PlainWorkspace(other)
    function(workspace)
    workspace.write_back(other)
    for heap in ("scalars", "floats", "integers"):
        np.testing.assert_array_equal(getattr(memory, heap), getattr(other, heap))
    found = {text: _expected(memory, one, place) for text, one, place in written}
    # the first and the last of one number are the same
    assert found == {text: i + 0.5 for i, (text, *_) in enumerate(written)}
    assert memory[Island.n_groups] == _memory()[Island.n_groups]
