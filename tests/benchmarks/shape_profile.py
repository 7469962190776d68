"""Where the time of runs with general shapes goes: ``python -m tests.benchmarks.shape_profile``.

The engine calls the evaluators of contact pairs, and the search for near pairs, by their addresses.  Here every address
is replaced by that of a function that reads the processor's clock, calls the original and reads the clock again, so
that the shares are those of one and the same run, not of calls made apart.  What an empty function takes between the
two readings is subtracted; what the readings cost in all shows as the run's time over that of a run without them.

Printed are, per run: simulated and wall time without the clock, that with it over the former, shares of the search for
near pairs (the compiled sweep), of the pairs' evaluators (closed forms, polishing, features) and of the rest of the
engine; then calls and microseconds of every kind of pair.  FCL is not called in a run, so that it has no share.
"""

from __future__ import annotations

import ctypes
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

import nonsmooth as ns
from bodies import BoxBody, Dumbbell, Ellipsoid, EllipsoidBody, Harmonic, HullBody, Plate, RigidBody
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.binding.compile import bind
from nonsmooth.binding.source import name_of
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.entry_points import ENTRY_POINTS
from nonsmooth.engine.native.kernel import address_of, call_pair, entry_addresses
from nonsmooth.interfaces import Body, Engine
from nonsmooth.model.assembly import assemble
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.runs.folder_sink import OutputSink
from nonsmooth.runs.loop import Callbacks, EngineLoop
from nonsmooth.runs.records import Records
from scenarios.dice_throw import DiceThrow
from scenarios.mesh_drop import MeshDrop

REPETITIONS = 2
_SEARCH = ENTRY_POINTS.index("fill_list")
_SHIM = """def shim(a, b, p, out):
 began = clock()
 call_pair({inner}, a, b, p, out)
 add({account}, clock() - began)
"""


def _clock(typingctx: Any) -> Any:
    """Return the processor's count of cycles."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        name, kind = "llvm.readcyclecounter", ir.FunctionType(ir.IntType(64), [])
        return builder.call(builder.module.globals.get(name) or ir.Function(builder.module, kind, name), [])

    return types.int64(), codegen


def _add(typingctx: Any, address: Any, cycles: Any) -> Any:
    """Add cycles to the first, and 1 to the second of the integers at an address."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        integer = ir.IntType(64)
        account = builder.inttoptr(args[0], ir.PointerType(integer))
        for i, more in enumerate((args[1], ir.Constant(integer, 1))):
            place = builder.gep(account, [ir.Constant(integer, i)])
            builder.store(builder.add(builder.load(place), more), place)
        return context.get_dummy_value()

    return types.void(types.int64, types.int64), codegen


def _timed(inner: int, account: np.ndarray) -> int:
    """Return the address of a function that calls the pair at another and adds cycles and calls to an account."""
    scope: dict[str, Any] = {"clock": intrinsic(_clock), "call_pair": call_pair, "add": intrinsic(_add)}
    exec(_SHIM.format(inner=inner, account=account.ctypes.data), scope)
    return address_of(lambda: scope["shim"], "pair", "")


def _nothing(a: Any, b: Any, out: Any) -> None:
    pass


def _clock_itself() -> float:
    """Return the least cycles between two readings with an empty function between them."""
    account, function = np.zeros(2, np.int64), bind(_nothing, "pair", {}, "profile")[0]
    call = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)(_timed(function, account))
    cycles = []
    for _ in range(2000):
        account[:] = 0
        call(None, None, None, None)
        cycles.append(int(account[0]))
    return float(min(cycles))


def _cycles_per_second() -> float:
    """Return the rate of the clock, by the operating system's over a tenth of a second."""
    account = np.zeros(2, np.int64)
    scope: dict[str, Any] = {"clock": intrinsic(_clock), "add": intrinsic(_add)}
    exec(f"def shim(a, b, p, out): add({account.ctypes.data}, clock())", scope)
    read = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)(address_of(lambda: scope["shim"], "pair", ""))
    read(None, None, None, None)
    began, first = time.perf_counter(), int(account[0])
    time.sleep(0.1)
    account[:] = 0
    read(None, None, None, None)
    return (int(account[0]) - first) / (time.perf_counter() - began)


@dataclass(frozen=True)
class Profile:
    """Where the time of a run went.

    Attributes
    ----------
    bare, wall : float
        Without and with the clock [s].
    search : float
        Seconds in the search for near pairs.
    searches : int
        Number of searches.
    pairs : dict
        Seconds and calls by kind of pair.
    """

    bare: float
    wall: float
    search: float
    searches: int
    pairs: dict[str, tuple[float, int]]

    @property
    def evaluators(self) -> float:
        """Seconds in all pairs."""
        return sum(seconds for seconds, _ in self.pairs.values())


def _instrument(model: LaidOut, accounts: dict[str, np.ndarray], searches: list[float]) -> Any:
    """Put the clock about the pairs and the search of a model; return what has to live as long as it."""
    memory = model.memory
    shims: dict[int, int] = {}
    for contact in model.system.contacts:
        kind = name_of(contact.kinematics.evaluator)
        inner = bind(contact.kinematics.evaluator, "pair", contact.kinematics.values, kind)[0]
        if inner not in shims:
            shims[inner] = _timed(inner, accounts.setdefault(kind, np.zeros(2, np.int64)))
    function, of_kinds = owners.ContactRecord.geometry_function, owners.KindRecord.geometry_function
    for functions in (memory[of_kinds], memory[function][: memory[owners.Island.n_contacts]]):
        functions[:] = [shims[int(one)] for one in functions]
    prototype = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_void_p] * 3)
    search = prototype(entry_addresses()[_SEARCH])

    def timed_search(*heaps: int) -> int:
        began = time.perf_counter()
        status = int(search(*heaps))
        searches.append(time.perf_counter() - began)
        return status

    kept = prototype(timed_search)
    memory[owners.ModelNumbers.entry_points][_SEARCH] = ctypes.cast(kept, ctypes.c_void_p).value
    return kept


def profile(build: Callable[[], ns.System], t_end: float, engine: Engine | None = None) -> Profile:
    """Return where the time of a run goes; of some repetitions that of the least wall time."""
    integrator = engine or ns.EventDriven()

    def run(instrumented: bool) -> tuple[float, list[float], dict[str, np.ndarray]]:
        accounts: dict[str, np.ndarray] = {}
        searches: list[float] = []
        model = assemble(build(), integrator)
        model.memory[owners.Request.t_end], model.memory[owners.Request.sample_interval] = t_end, t_end / 10.0
        kept = _instrument(model, accounts, searches) if instrumented else None
        began = time.perf_counter()
        EngineLoop(
            integrator, model, Records(model), Checkpoint.of(model.memory), OutputSink(), Callbacks(None, None)
        ).run()
        wall = time.perf_counter() - began
        del kept
        return wall, searches, accounts

    rate, empty = _cycles_per_second(), _clock_itself()
    bare = min(run(False)[0] for _ in range(REPETITIONS))
    wall, searches, accounts = min((run(True) for _ in range(REPETITIONS)), key=lambda found: found[0])
    pairs = {kind: ((int(c) - empty * int(n)) / rate, int(n)) for kind, (c, n) in accounts.items()}
    return Profile(bare, wall, sum(searches), len(searches), pairs)


def dumbbell() -> ns.System:
    """Return the dumbbell of two balls that are said as ellipsoids, on the shaking plate."""
    body, frequency = Dumbbell(), 25.0
    half, r = 0.5 * body.centre_distance, body.radius
    general = RigidBody(body.total_mass, body.inertia, tuple(Ellipsoid(r, r, r, x) for x in (-half, half)))
    plate = Plate(Harmonic(amplitude=0.9 * 9.81 / (2.0 * math.pi * frequency) ** 2, frequency=frequency))
    system, tilt = ns.System([plate, general]), math.radians(10.0)
    system.contact(plate, general, normal=Unilateral(), friction=Coulomb(0.2), impact=EnergeticImpact(0.65))
    place = (half * math.cos(tilt), 0.0, r + half * math.sin(tilt))
    system.place(general, position=place, orientation=(math.cos(0.5 * tilt), 0.0, -math.sin(0.5 * tilt), 0.0))
    return system


def _cloud(make: Callable[[np.random.Generator], Body], n: int) -> ns.System:
    """Return bodies of 5 cm on a lattice that fly at each other, elastic and without friction."""
    rng = np.random.default_rng(5)
    bodies = [make(rng) for _ in range(n)]
    system, side = ns.System(bodies, gravity=0.0), math.ceil(n ** (1.0 / 3.0))
    for i, body in enumerate(bodies):
        for other in bodies[:i]:
            system.contact(
                other, body, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(restitution=1.0)
            )
    for body, cell in zip(bodies, rng.permutation(np.array(list(np.ndindex(side, side, side)))), strict=False):
        place, turn = 0.13 * (cell - 0.5 * (side - 1)) + rng.uniform(-0.01, 0.01, 3), rng.normal(size=4)
        system.place(
            body,
            position=place,
            orientation=turn / np.linalg.norm(turn),
            velocity=-4.0 * place + 0.3 * rng.normal(size=3),
            angular_velocity=5.0 * rng.normal(size=3),
        )
    return system


def _polytope(rng: np.random.Generator) -> Body:
    if rng.uniform() < 0.5:
        return BoxBody(*rng.uniform(0.02, 0.04, 3).tolist())
    points = rng.normal(size=(6, 3))
    return HullBody((0.05 * points / np.linalg.norm(points, axis=1)[:, None]).tolist())


def _ellipsoid(rng: np.random.Generator) -> Body:
    return EllipsoidBody(*rng.uniform(0.02, 0.05, 3).tolist())


RUNS: dict[str, tuple[Callable[[], ns.System], float]] = {
    "dumbbell of ellipsoids": (dumbbell, 4.0),
    "three sharp dice": (lambda: DiceThrow(rounding=0.0).build(), 1.0),
    "20 polytopes": (lambda: _cloud(_polytope, 20), 0.3),
    "50 ellipsoids": (lambda: _cloud(_ellipsoid, 50), 0.3),
    "mesh drop": (lambda: MeshDrop().build(), 0.3),
}
"""Systems and end times [s]."""


def rows() -> Iterator[str]:
    """Yield the two tables in Markdown."""
    found = {name: profile(*run) for name, run in RUNS.items()}
    yield "| run | simulated [s] | wall [ms] | with the clock | FCL | search for near pairs | pairs | rest |"
    yield "|---" * 8 + "|"
    for name, one in found.items():
        shares = one.search / one.wall, one.evaluators / one.wall
        numbers = [0.0, *shares, 1.0 - sum(shares)]
        cells = " | ".join(f"{100.0 * x:.1f} %" for x in numbers)
        yield f"| {name} | {RUNS[name][1]:g} | {1e3 * one.bare:.1f} | {one.wall / one.bare:.2f} | {cells} |"
    yield ""
    yield "| run | pair | calls | [µs] each |"
    yield "|---" * 4 + "|"
    for name, one in found.items():
        for kind, (seconds, calls) in one.pairs.items():
            if calls > 0:
                cost = 1e6 * seconds / calls
                yield f"| {name} | {kind} | {calls} | {f'{cost:.2f}' if cost >= 0.01 else 'below 0.01'} |"


def main() -> None:
    """Measure and print."""
    for row in rows():
        print(row, flush=True)


if __name__ == "__main__":
    main()
