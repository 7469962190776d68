"""Run one case and say how it ended."""

from __future__ import annotations

import math
import re
import time
import warnings
from dataclasses import asdict, dataclass

import numpy as np

import nonsmooth as ns
from nonsmooth.interfaces import Body
from tests.benchmarks.random_systems.case import Case
from tests.benchmarks.random_systems.checks import findings, jumps
from tests.benchmarks.random_systems.gaps import distance
from tests.benchmarks.random_systems.pieces import poses_of

NO_ANSWER = "law is that of one contact", "No rigid contact allows that"
"""What a run says that ends at an impact or a jam to which its laws have no answer."""
TOUCHES = 1e-6
"""Distance [m] up to which a body counts as touching."""


@dataclass(frozen=True)
class Outcome:
    """How a case ended.

    Attributes
    ----------
    end : str
        "done", "refused", "failed", "time-out", another status of a solution, or "exception", which is no
        NonsmoothError.
    cause : str
        What was said, without numbers.
    found : tuple of str
        What the checks found in all that was computed.
    seconds : float
        Processor time [s].
    message : str
        What was said, in full.
    """

    end: str
    cause: str = ""
    found: tuple[str, ...] = ()
    seconds: float = 0.0
    message: str = ""

    @property
    def silent(self) -> bool:
        """Whether it says done and is wrong."""
        return self.end == "done" and bool(self.found)

    @property
    def kind(self) -> str:
        """What a smaller case must share with it to show the same."""
        words = sorted({text.split(":")[0] for text in self.found})
        return " ".join([self.end, self.cause, *words])

    def row(self) -> dict[str, object]:
        """Return it as data."""
        return asdict(self)


def cause_of(message: str) -> str:
    """Return a message's first sentence without times, numbers, values and kinds of bodies."""
    if said := re.search(r"raises (\w+\(\"[^\"]*)\"\)", message):
        return said[1].replace('("', ": ")[:110]
    text = re.sub(r"^At t = \S+ s ", "", message).split(" What was computed")[0]
    text = re.split(r"[,:] but it is|\. ", text)[0]
    text = re.sub(r"\([^()]*\)", "", re.sub(r"\[[^\]]*\]", "", text))
    text = re.sub(r"\b(\w+Body|Ball|Rod|Dumbbell|Plate)\b", "*", text)
    text = re.sub(r"(number |contact )?[-+]?\d[\d.e+-]*", "#", text)
    return " ".join(text.split())[:110].rstrip(".")


def run(case: Case, seconds: float = 20.0, repeat: bool = False) -> Outcome:
    """Build and simulate a case, and look at all that it gave.

    Parameters
    ----------
    case : Case
        The system.
    seconds : float
        Processor time after which it is interrupted [s].
    repeat : bool
        Whether it is run twice, to see the same to the last bit.
    """
    began = time.process_time()

    limit = math.inf

    def watch(t: float, t_end: float) -> None:
        # from the first call on: what is compiled for a new kind of body or law is no part of the run
        nonlocal limit
        limit = min(limit, time.process_time() + seconds)
        if time.process_time() > limit:
            raise KeyboardInterrupt

    def ended(end: str, cause: str = "", found: list[str] | None = None, message: str = "") -> Outcome:
        return Outcome(end, cause, tuple(found or ()), time.process_time() - began, message)

    stage = "build"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            system = case.build()
            stage = "run"
            solution = ns.simulate(system, case.t_end, sample_interval=case.sample_interval, progress=watch)
            stage = "checks"
            found = [*_placed(case, solution), *findings(case, solution)]
            if any("jump" in one.split(":")[0] for one in found):
                # a force that comes and goes between two samples looks like a jump; one stays however fine they are
                fine = ns.simulate(case.build(), case.t_end, sample_interval=case.sample_interval / 50.0)
                found = [one for one in found if "jump" not in one.split(":")[0]] + jumps(case, fine)
            if repeat and solution.status == "done":
                again = ns.simulate(case.build(), case.t_end, sample_interval=case.sample_interval)
                found += _differs(solution, again)
        except ns.RunFailed as error:
            part = error.solution
            found = findings(case, part) if isinstance(part, ns.Solution) and len(part.t) else []
            if any(words in str(error) for words in NO_ANSWER) and not found:
                return ended("refused", f"run: {cause_of(str(error))}", [], str(error))
            return ended("failed", cause_of(str(error)), found, str(error))
        except ns.NonsmoothError as error:
            return ended("refused", f"{stage}: {cause_of(str(error))}", [], str(error))
        except Exception as error:
            return ended("exception", f"{stage}: {type(error).__name__} {cause_of(str(error))}", [], repr(error))
    end = "time-out" if solution.status == "interrupted" else solution.status
    return ended(end, "", found, solution.message)


def _differs(one: ns.Solution, two: ns.Solution) -> list[str]:
    same = one.t_end == two.t_end and one.energy == two.energy
    for name in ("q", "u", "t"):
        same = same and np.array_equal(getattr(one, name), getattr(two, name))
    same = same and np.array_equal(one.events.time, two.events.time)
    return [] if same else ["not-repeatable: a second run differs"]


def _placed(case: Case, solution: ns.Solution) -> list[str]:
    """Return whether the body that was moved last is off those that it was to touch; the others may be moved later."""
    moved = [k for k, start in enumerate(case.starts) if start is not None and start.how != "place"]
    if not moved or (last := case.starts[moved[-1]]) is None:
        return []
    offsets = np.cumsum([0, *(body.n_q for body in case.bodies)])
    poses = [
        poses_of(body, solution.t[:1], solution.q[:1, i : i + body.n_q])
        for body, i in zip(case.bodies, offsets, strict=False)
    ]
    k, height = moved[-1], dict(last.arguments).get("height", 0.0)
    pairs = [(i, j) for i, j, _ in case.contacts if k in (i, j)]
    gap = min(distance(case.bodies[i], case.bodies[j], (poses[i], poses[j])) for i, j in pairs)
    if abs(gap - height) > TOUCHES + 2.0 * max(_feet(body) for body in case.bodies):
        kind = type(case.bodies[k]).__name__
        return [f"not-placed: {kind} b{k} starts {gap:.6g} m off by `{last.how}`, not {height:.6g} m"]
    return []


def _feet(body: Body) -> float:
    return max(
        (shape.solid.set_back for shapes in body.frames for shape in shapes if shape.solid),
        default=0.0,
    )
