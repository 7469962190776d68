"""Engines that break their contract, each in one way, with the beginning of what is said of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import nonsmooth as ns
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import DONE, PAUSED
from nonsmooth.interfaces import Engine
from nonsmooth.parameters import parameter
from nonsmooth.steps import Arrays, per
from tests.runs.own_engine import Midpoint


@dataclass(frozen=True)
class Blind(Engine):
    """The midpoint rule, which lets bodies fall through each other."""

    step: float = parameter(1e-3, doc="step", unit="s", above=0.0)

    @property
    def layers(self) -> tuple[str, ...]:
        return ()

    def check(self, system: ns.System) -> None:
        pass

    def counts(self, n_slots: int) -> Mapping[str, int]:
        return {}

    def settings(self, time_scale: float) -> Mapping[str, float]:
        return {"rtol": 1e-5, "impact_rtol": 1e-5}

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        return Midpoint(self.step).advance(call, memory, most_steps, wary)


class WrongLayer(Blind):
    @property
    def layers(self) -> tuple[str, ...]:
        return ("nonsense",)


class WrongSetting(Blind):
    def settings(self, time_scale: float) -> Mapping[str, float]:
        return {"nonsense": 1.0}


class SetsOffset(Blind):
    def settings(self, time_scale: float) -> Mapping[str, float]:
        return {"y": 1.0}


class SetsWord(Blind):
    def settings(self, time_scale: float) -> Mapping[str, Any]:
        return {"rtol": "small"}


class WrongCount(Blind):
    def counts(self, n_slots: int) -> Mapping[str, int]:
        return {"nonsense": 1}


class TakenCount(Blind):
    def counts(self, n_slots: int) -> Mapping[str, int]:
        return {"n_bodies": 1}


class NegativeCount(Blind):
    def counts(self, n_slots: int) -> Mapping[str, int]:
        return {"n_pivoted": -1}


class TakenName(Blind):
    @property
    def own(self) -> Arrays:
        return Arrays(floats={"y": per(1, "n_y")})


class WrongLength(Blind):
    @property
    def own(self) -> Arrays:
        return Arrays(floats={"room": per(1, "nonsense")})


class WrongStatus(Blind):
    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        return 77


class NoStatus(Blind):
    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> Any:
        return None


class WrongEntry(Blind):
    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        return int(call("nonsense"))


class DoneAtOnce(Blind):
    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        return DONE


class WithoutSamples(Blind):
    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        memory[owners.Island.time] = memory[owners.Request.t_end]
        return DONE


class Idle(Blind):
    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        call("evaluate_at")
        return PAUSED


FAULTS: tuple[tuple[type[Engine], str], ...] = (
    (WrongLayer, "layers must be a known one, but it is 'nonsense'.*Known: .*flow"),
    (WrongSetting, "settings must be a known one, but it is 'nonsense'.*Known: acceleration_scale"),
    (SetsOffset, "settings must be a known one, but it is 'y'"),
    (SetsWord, "settings: rtol must be a number, but it is 'small'"),
    (WrongCount, "counts must be a known one, but it is 'nonsense'.*Known: n_pivoted"),
    (TakenCount, "counts must be a known one, but it is 'n_bodies'"),
    (NegativeCount, "counts: n_pivoted must be a whole number, not negative, but it is -1"),
    (TakenName, "own must be names in Python that no scalar.* has, but it is 'y'"),
    (WrongLength, "own: room: count must be a known one, but it is 'nonsense'"),
    (WrongStatus, "advance: its status must be DONE.*but it is 77"),
    (NoStatus, "advance: its status must be DONE.*but it is None"),
    (WrongEntry, "advance: entry point must be a known one, but it is 'nonsense'"),
    (DoneAtOnce, "advance: S.t must be at the end time 0.1 s where it is DONE, but it is 0"),
    (WithoutSamples, "advance must append all samples.*but it is 'none for t = 0 s'"),
    (Idle, "advance must do a step.*but it is 'nothing done at t = 0 s'"),
)
