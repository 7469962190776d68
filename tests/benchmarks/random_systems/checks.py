"""What must hold of every run, asked of its numbers alone: no gap and no kinematics of the engine is used."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

import nonsmooth as ns
from bodies import BallJoint, Distance, Fixed, Hinge, Slider
from laws import (
    Bristle,
    CoulombContensou,
    EnergeticImpact,
    JohnsonImpact,
    MonoStiffnessImpact,
    PlasticImpact,
    Unilateral,
    ViscoelasticImpact,
)
from nonsmooth.interfaces.body import Vector
from nonsmooth.solution.checks import closing_gain, friction_gain
from tests.benchmarks.random_systems.case import Case
from tests.benchmarks.random_systems.cones import cones
from tests.benchmarks.random_systems.gaps import overlaps
from tests.benchmarks.random_systems.pieces import is_still, pieces_of, poses_of, rotations
from tests.benchmarks.random_systems.through import passed

DEPTH = 1e-6
"""Depth [m] from which bodies count as inside of each other."""
_OPEN = 1e-6
"""Part of the energy, of the momentum, from which an account counts as open."""
_STEP = 1e-9
"""Error of a step, relative to scales."""
_CLOSED = 1e-12
"""Gap that counts as closed [m]."""
_NEVER_GAIN = (EnergeticImpact, MonoStiffnessImpact, JohnsonImpact, ViscoelasticImpact, PlasticImpact)


@dataclass(frozen=True)
class Records:
    """Samples and events in order of time: velocities before and after each."""

    t: Vector
    q: Vector
    before: Vector
    after: Vector

    @classmethod
    def of(cls, solution: ns.Solution) -> Records:
        """Merge them; an event comes before a sample of the same time."""
        events = solution.events
        t = np.concatenate([events.time, solution.t])
        order = np.argsort(t, kind="stable")
        parts = ((events.q, solution.q), (events.u_before, solution.u), (events.u_after, solution.u))
        return cls(t[order], *(np.concatenate(pair)[order] for pair in parts))


def findings(case: Case, solution: ns.Solution) -> list[str]:
    """Return what is wrong with a run, each with its kind as first word; nothing where all holds."""
    records = Records.of(solution)
    if not all(np.all(np.isfinite(a)) for a in (records.t, records.q, records.before, records.after)):
        return ["not-finite: a number in the solution"]
    stored = _stored(case, records)
    energy = sum(stored.values())
    found = [*_inside(case, records, energy), *_unfelt(case, records, stored), *_jumps(case, records)]
    found += [*_joints(case, records), *_energy(case, solution), *_momentum(case, records, solution, energy)]
    return [*found, *cones(case, solution, *_loads(case, records))]


def _loads(case: Case, records: Records) -> tuple[float, float]:
    """Return the sum of all weights [N] and the largest sum of the sizes of momenta [kg m/s]."""
    masses = _masses(case)
    speeds = [np.linalg.norm(v[:, :3], axis=1) for v in _velocities(case, records.after)]
    moved = sum(mass * speed for mass, speed in zip(masses, speeds, strict=True) if mass > 0.0)
    return sum(masses) * abs(case.gravity), float(np.max(moved))


def _columns(case: Case, q: Vector) -> Iterator[tuple[int, Any, Vector]]:
    i = 0
    for k, body in enumerate(case.bodies):
        yield k, body, q[:, i : i + body.n_q]
        i += body.n_q


def _velocities(case: Case, u: Vector) -> list[Vector]:
    ends = np.cumsum([body.n_u for body in case.bodies])[:-1]
    return np.split(u, ends, axis=1)


def _masses(case: Case) -> list[float]:
    return [body.total_mass if body.n_q else 0.0 for body in case.bodies]  # type: ignore[attr-defined]


def _energies(case: Case, q: Vector, u: Vector) -> Vector:
    """Return kinetic and potential energy [J], shape [n]."""
    total = np.zeros(len(q))
    velocities = _velocities(case, u)
    for k, body, own in _columns(case, q):
        if body.n_q:
            mass, v = body.total_mass, velocities[k]
            inertia = _inertia(body)
            total += 0.5 * mass * np.sum(v[:, :3] ** 2, axis=1) + mass * case.gravity * own[:, 2]
            total += 0.5 * np.einsum("ni,ij,nj->n", v[:, 3:], inertia, v[:, 3:])
    return total


def _inertia(body: Any) -> Vector:
    yz, xz, xy = body.products
    principal = np.diag(body.inertia)
    return np.asarray(principal + np.array([[0.0, xy, xz], [xy, 0.0, yz], [xz, yz, 0.0]]))


def _stored(case: Case, records: Records) -> dict[tuple[int, int], float]:
    """Return what compliant contacts that start indented hold of energy [J], by the numbers of their bodies."""
    poses = [poses_of(body, records.t[:1], own[:1]) for _, body, own in _columns(case, records.q)]
    stored = {}
    for i, j, laws in case.contacts:
        if type(laws.normal) is not Unilateral:
            found = overlaps(case.bodies[i], case.bodies[j], (poses[i], poses[j]))
            depth = max((o.depth - o.allowed for o in found), default=0.0)
            law: Any = laws.normal
            if depth > DEPTH:
                exponent = getattr(law, "exponent", 1.0)
                stored[i, j] = float(law.stiffness * depth ** (exponent + 1.0) / (exponent + 1.0))
    return stored


def _indentation(case: Case, records: Records, normal: Any, stored: float) -> float:
    """Return how deep all the energy there is can press a contact by its law [m]; a rigid one not at all."""
    if type(normal) is Unilateral:
        return 0.0
    exponent = getattr(normal, "exponent", 1.0)
    velocities, energy = _velocities(case, records.after), stored
    for k, body, own in _columns(case, records.q):
        if body.n_q:
            v = velocities[k]
            kinetic = 0.5 * body.total_mass * np.sum(v[:, :3] ** 2, axis=1)
            kinetic += 0.5 * np.einsum("ni,ij,nj->n", v[:, 3:], _inertia(body), v[:, 3:])
            energy += float(np.max(kinetic)) + body.total_mass * case.gravity * float(np.ptp(own[:, 2]) + 1e-3)
    return float(((exponent + 1.0) * energy / normal.stiffness) ** (1.0 / (exponent + 1.0)))


def _unfelt(case: Case, records: Records, stored: dict[tuple[int, int], float]) -> Iterator[str]:
    """Return which indentations of the start leave both bodies as they are, falling by their weight alone.

    Bodies of joints are left out, as these may hold them; a thousandth of the energy is enough.
    """
    velocities, tied = _velocities(case, records.after), {k for i, j, _ in case.joints for k in (i, j)}
    early = records.t <= records.t[0] + 2.0 * case.sample_interval
    fall = case.gravity * (records.t[early] - records.t[0])
    for (i, j), energy in stored.items():
        free = [k for k in (i, j) if case.bodies[k].n_q and k not in tied]
        gained = 0.0
        for k in free:
            change = velocities[k][early, :3] - velocities[k][0, :3]
            change[:, 2] += fall
            gained += 0.5 * _masses(case)[k] * float(np.max(np.sum(change**2, axis=1)))
        if free and gained < 1e-3 * energy:
            yield f"unfelt: b{i}, b{j} start indented, with {energy:.3g} J, and gain {gained:.3g} J"


def _inside(case: Case, records: Records, stored: float) -> Iterator[str]:
    poses = [poses_of(body, records.t, own) for _, body, own in _columns(case, records.q)]
    for i, j, laws in case.contacts:
        allowed = DEPTH + _indentation(case, records, laws.normal, stored)
        found = [
            o
            for o in overlaps(case.bodies[i], case.bodies[j], (poses[i], poses[j]))
            if o.depth > allowed + 1.5 * o.allowed
        ]
        if found:
            deepest = max(found, key=lambda o: o.depth)
            names = f"{type(case.bodies[i]).__name__} b{i}, {type(case.bodies[j]).__name__} b{j}"
            first, worst = records.t[found[0].pose], records.t[deepest.pose]
            yield f"inside: {names} by {deepest.depth:.3g} m at t = {worst:.6g} s, first seen at {first:.6g} s"
        pairs = itertools.product(pieces_of(case.bodies[i]), pieces_of(case.bodies[j]))
        for one, two in pairs if type(laws.normal) is Unilateral else ():
            for pose in passed(one, two, (poses[i], poses[j]))[:1]:
                yield f"through: disc b{i} and disc b{j} pass each other before t = {records.t[pose]:.6g} s"


def jumps(case: Case, solution: ns.Solution) -> list[str]:
    """Return which bodies move farther between two samples than their velocities there tell."""
    return list(_jumps(case, Records.of(solution)))


def _jumps(case: Case, records: Records) -> Iterator[str]:
    compliant = any(type(laws.normal) is not Unilateral for _, _, laws in case.contacts)
    before, after = _velocities(case, records.before), _velocities(case, records.after)
    dt = np.diff(records.t)
    for k, body, own in _columns(case, records.q):
        if not body.n_q:
            continue
        length = float(np.max(np.abs(np.linalg.norm(own[:, 3:], axis=1) - 1.0)))
        if length > 1e-8:
            yield f"quaternion: of b{k} is off unit length by {length:.2g}"
        for name, part, base, rate in (("jump", slice(0, 3), 1e-7, 50.0), ("turn-jump", slice(3, 6), 1e-5, 5e3)):
            left, right = after[k][:-1, part], before[k][1:, part]
            size = np.maximum(np.linalg.norm(left, axis=1), np.linalg.norm(right, axis=1))
            change = 2.0 * float(np.max(size, initial=0.0)) if compliant else np.linalg.norm(right - left, axis=1)
            allowed = base + (change + rate * dt) * dt
            if name == "jump":
                moved = np.diff(own[:, :3], axis=0) - 0.5 * (left + right) * dt[:, None]
                way = np.linalg.norm(moved, axis=1)
            else:
                way = _angles(own[:, 3:])
                allowed = allowed + size * dt
            worst = int(np.argmax(way - allowed)) if len(dt) else 0
            if len(dt) and way[worst] > allowed[worst]:
                size_of, when = f"{way[worst]:.3g} in {dt[worst]:.2g} s", f"t = {records.t[worst]:.6g} s"
                yield f"{name}: of b{k} ({type(body).__name__}) by {size_of} at {when}"


def _angles(q: Vector) -> Vector:
    unit = q / np.linalg.norm(q, axis=1)[:, None]
    same = np.sign(np.sum(unit[1:] * unit[:-1], axis=1))[:, None] * unit[:-1]
    return np.asarray(4.0 * np.arcsin(np.clip(0.5 * np.linalg.norm(unit[1:] - same, axis=1), 0.0, 1.0)))


def _joints(case: Case, records: Records) -> Iterator[str]:
    poses = [poses_of(body, records.t, own) for _, body, own in _columns(case, records.q)]
    for i, j, joint in case.joints:
        made: Any = joint
        (one, axes), (two, others) = poses[i], poses[j]
        away = two + others @ np.array(made.second) - one - axes @ np.array(made.first)
        apart = np.linalg.norm(away, axis=1)
        if type(joint) is Distance:
            apart = np.abs(apart - made.length)
        elif type(joint) is Slider:
            apart = np.linalg.norm(np.cross(away, axes @ np.array(made.axis)), axis=1)
        else:
            assert type(joint) in (BallJoint, Hinge, Fixed)
        angle = np.zeros(len(apart))
        if type(joint) is Hinge:
            angle = np.linalg.norm(np.cross(axes @ np.array(made.axis), others @ np.array(made.second_axis)), axis=1)
        elif type(joint) in (Fixed, Slider):
            seen = rotations(np.array([made.orientation]))[0]
            angle = np.max(np.abs(axes @ seen - others), axis=(1, 2))
        if max(float(np.max(apart)), 0.01 * float(np.max(angle))) > 1e-8:
            yield f"joint: {type(joint).__name__} of b{i}, b{j} open by {np.max(apart):.3g} m, {np.max(angle):.3g} rad"


def _energy(case: Case, solution: ns.Solution) -> Iterator[str]:
    account = solution.energy
    # after each step velocities are known to a part of those of falls through the bodies, heights to one of their sizes
    falls = [
        mass * float(body.scales[1][0]) ** 2
        for mass, body in zip(_masses(case), case.bodies, strict=True)
        if mass > 0.0
    ]
    heights = [mass * float(body.scales[0][0]) for mass, body in zip(_masses(case), case.bodies, strict=True) if mass]
    steps = _STEP * solution.counters.steps
    slow = steps * (float(np.sqrt(account.scale * sum(falls))) + abs(case.gravity) * sum(heights))
    if account.unexplained > _OPEN * account.scale + slow:
        yield f"energy: residual {account.residual:.3g}"
    # by the masses alone, whatever the account says
    energies = _energies(case, np.vstack([solution.q, solution.q_end]), np.vstack([solution.u, solution.u_end]))
    scale = account.exchanged + max(account.kinetic_start, account.kinetic_end) + 1e-6 * float(np.max(np.abs(energies)))
    said = account.kinetic_end + account.potential_end
    if abs(energies[-1] - said) > _OPEN * scale + 1e-12:
        yield f"energy-end: {energies[-1]:.9g} J by the masses, {said:.9g} J by the account"
    still = all(body.n_q or is_still(body) for body in case.bodies)
    rigid = all(type(laws.normal) is Unilateral for _, _, laws in case.contacts)
    stores = any(isinstance(laws.friction, Bristle | CoulombContensou) for _, _, laws in case.contacts)
    loses = all(isinstance(laws.impact, _NEVER_GAIN) for _, _, laws in case.contacts)
    gain = float(np.max(np.diff(energies[:-1]), initial=0.0))
    # bodies may be put up and down by the gap that counts as closed
    lifted = _CLOSED * abs(case.gravity) * sum(_masses(case))
    # what a run itself says to come from friction and from averaged forces is not silent
    said = friction_gain(solution) + closing_gain(solution)
    if still and rigid and loses and not stores and gain > _OPEN * scale + lifted + said:
        yield f"energy-gained: {gain / scale:.3g} of what was exchanged, from one sample to the next"


def _momentum(case: Case, records: Records, solution: ns.Solution, stored: float) -> Iterator[str]:
    """Between free bodies alone nothing changes the momentum but the weight, nor the spin about the mass centre."""
    if any(not body.n_q for body in case.bodies):
        return
    masses, velocities = np.array(_masses(case)), _velocities(case, solution.u)
    places = np.stack([own[:, :3] for _, _, own in _columns(case, solution.q)])
    speeds = np.stack([v[:, :3] for v in velocities])
    momentum = np.einsum("k,kni->ni", masses, speeds)
    momentum[:, 2] += np.sum(masses) * case.gravity * solution.t
    size = float(np.max(np.einsum("k,kn->n", masses, np.linalg.norm(speeds, axis=2)))) + 1e-12
    change = float(np.max(np.linalg.norm(momentum - momentum[0], axis=1))) / size
    if change > _OPEN:
        yield f"momentum: changes by {change:.3g} of the sum of its parts"
    arms = places - np.einsum("k,kni->ni", masses, places) / np.sum(masses)
    parts = masses[:, None, None] * np.cross(arms, speeds - np.einsum("k,kni->ni", masses, speeds) / np.sum(masses))
    own = np.stack(
        [
            np.einsum("nij,jk,nk->ni", rotations(q[:, 3:]), _inertia(body), v[:, 3:])
            for (_, body, q), v in zip(_columns(case, solution.q), velocities, strict=True)
        ]
    )
    spin = np.sum(parts + own, axis=0)
    reach = float(np.max(np.linalg.norm(arms, axis=2)))
    # friction acts at a point of either body: an indentation parts them, and makes a couple of what they exchange
    lever = max((_indentation(case, records, laws.normal, stored) for _, _, laws in case.contacts), default=0.0)
    turned = float(np.max(np.sum(np.linalg.norm(own, axis=2), axis=0)))
    change = float(np.max(np.linalg.norm(spin - spin[0], axis=1)))
    if change > _OPEN * (size * reach + turned) + 2.0 * size * lever:
        yield f"spin: changes by {change:.3g} kg m^2/s, with {size * reach + turned:.3g} in its parts"
