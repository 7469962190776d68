"""Engines that break their contract, each in one way, with the beginning of what is said of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import nonsmooth as ns
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import Status
from nonsmooth.engine.memory.owners import (
    ContactRecord,
    Island,
    ModelNumbers,
    Request,
    Tolerance,
)
from nonsmooth.interfaces import Engine, Scales
from nonsmooth.parameters import parameter
from nonsmooth.steps import FloatRow, Life, Singleton, array, per
from tests.runs.own_engine import Midpoint


@dataclass(frozen=True)
class Blind(Engine):
    """The midpoint rule, which lets bodies fall through each other."""

    step: float = parameter(1e-3, doc="step", unit="s", above=0.0)

    def check(self, system: ns.System) -> None:
        pass

    def counts(self, n_slots: int) -> Mapping[str, int]:
        return {}

    def settings(self, scales: Scales) -> Mapping[Any, float]:
        return {Tolerance.relative: 1e-5, Tolerance.impact: 1e-5}

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        return Midpoint(self.step).advance(call, memory, most_steps, pauses_before_end)


class WrongSetting(Blind):
    def settings(self, scales: Scales) -> Mapping[Any, float]:
        return {"nonsense": 1.0}


class SetsArray(Blind):
    def settings(self, scales: Scales) -> Mapping[Any, float]:
        return {Island.y: 1.0}


class SetsContact(Blind):
    def settings(self, scales: Scales) -> Mapping[Any, float]:
        return {ContactRecord.gap: 1.0}


class SetsCount(Blind):
    def settings(self, scales: Scales) -> Mapping[Any, float]:
        return {ModelNumbers.n_bodies: 1.0}


class SetsWord(Blind):
    def settings(self, scales: Scales) -> Mapping[Any, Any]:
        return {Tolerance.relative: "small"}


class WrongCount(Blind):
    def counts(self, n_slots: int) -> Mapping[str, int]:
        return {"nonsense": 1}


class TakenCount(Blind):
    def counts(self, n_slots: int) -> Mapping[str, int]:
        return {"n_bodies": 1}


class NegativeCount(Blind):
    def counts(self, n_slots: int) -> Mapping[str, int]:
        return {"n_pivoted": -1}


class _Taken(Singleton, key="island"):
    room: FloatRow = array(Life.STEP, per(1, "n_y"), float, "", "Room.")


class _Endless(Singleton, key="endless"):
    room: FloatRow = array(Life.STEP, per(1, "nonsense"), float, "", "Room.")


class _Negative(Singleton, key="negative"):
    room: FloatRow = array(Life.STEP, lambda counts: -1, float, "", "Room.")


class NoPart(Blind):
    @property
    def own(self) -> Any:
        return {"room": 1}


class TakenName(Blind):
    @property
    def own(self) -> type[Singleton]:
        return _Taken


class WrongLength(Blind):
    @property
    def own(self) -> type[Singleton]:
        return _Endless


class NegativeLength(Blind):
    @property
    def own(self) -> type[Singleton]:
        return _Negative


class WrongStatus(Blind):
    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        return 77


class NoStatus(Blind):
    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> Any:
        return None


class WrongEntry(Blind):
    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        return int(call("nonsense"))


class DoneAtOnce(Blind):
    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        return Status.DONE


class WithoutSamples(Blind):
    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        memory[Island.time] = memory[Request.t_end]
        return Status.DONE


class Idle(Blind):
    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, pauses_before_end: bool) -> int:
        call("evaluate_at")
        return Status.PAUSED


FAULTS: tuple[tuple[type[Engine], str], ...] = (
    (WrongSetting, "settings must have scalars of the workspace for its keys, but it is 'nonsense'"),
    (SetsArray, "settings must have scalars of the workspace for its keys, but it is .*'y'"),
    (SetsContact, "settings must have scalars of the workspace for its keys, but it is .*'gap'"),
    (SetsCount, r"settings: model\.n_bodies must not be the size of an array"),
    (SetsWord, r"settings: tolerance\.relative must be a number, but it is 'small'"),
    (WrongCount, "counts 'nonsense'.*Known: n_pivoted"),
    (TakenCount, "counts 'n_bodies'"),
    (NegativeCount, "counts: n_pivoted must be an integer, not negative, but it is -1"),
    (NoPart, "own must be a class of declarations, a Singleton, but it is {'room': 1}"),
    (TakenName, "own: key must be a name in Python that no other owner has, but it is 'island'"),
    (WrongLength, "own: room: unknown count 'nonsense'"),
    (NegativeLength, "own: room must have an integer as its length, not negative, but it is -1"),
    (WrongStatus, "advance: its status must be DONE.*but it is 77"),
    (NoStatus, "advance: its status must be DONE.*but it is None"),
    (WrongEntry, "advance: unknown entry point 'nonsense'"),
    (DoneAtOnce, r"advance: ws\.island\.time must be the end time 0.1 s if the status is DONE, but it is 0"),
    (WithoutSamples, "advance must append all samples.*but it is 'none for t = 0 s'"),
    (Idle, "advance must do a step.*but it is 'nothing done at t = 0 s'"),
)
