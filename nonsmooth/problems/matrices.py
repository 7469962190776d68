"""Checks of matrices and laws, and the memory, which problems of contacts and of impacts share."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding.compile import bind
from nonsmooth.binding.law_failure import first_without_value, without_value
from nonsmooth.binding.law_functions import law_functions
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Heap, Memory, allocate
from nonsmooth.engine.memory.tables import COUNTS
from nonsmooth.engine.native.kernel import entry_addresses
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import AnisotropicFrictionLaw, FrictionLaw, StatefulFrictionLaw

Floats = NDArray[np.float64]


def check_arrays(call: str, arrays: Mapping[str, tuple[Floats, tuple[int, ...]]], remedy: str) -> None:
    """Check that arrays are finite and have the shapes given with them.

    Raises
    ------
    InvalidInput
        If a shape is wrong or a number is not finite. The message begins with the function ``call``.
    """
    for name, (array, shape) in arrays.items():
        if array.shape != shape or not np.all(np.isfinite(array)):
            raise InvalidInput(f"{call}: {name}", f"must be finite with shape {shape}", array.shape, remedy)


def check_mass(call: str, mass: Floats) -> None:
    """Raise InvalidInput if a mass matrix is not symmetric positive definite."""
    if not np.allclose(mass, mass.T, rtol=1e-12, atol=0.0) or np.linalg.eigvalsh(mass)[0] <= 0.0:
        raise InvalidInput(f"{call}: mass", "must be symmetric positive definite", mass.tolist(), "Check M.")


def check_friction(thing: str, friction: Sequence[FrictionLaw]) -> None:
    """Raise InvalidInput if a law is not a coefficient of the slip speed alone, with a round bound."""
    for law in friction:
        if not isinstance(law, FrictionLaw) or isinstance(law, (AnisotropicFrictionLaw, StatefulFrictionLaw)):
            rule = "must be laws with a round bound and without inner states"
            remedy = "Run a System: matrices know no axis of a body and no past."
            raise InvalidInput(thing, rule, type(law).__name__, remedy)


def columns_of(normal: Floats, tangential: Floats) -> Floats:
    """Generalised directions of all contacts, shape [n_u, 3 n]: normal and two tangents of each contact in turn."""
    return np.concatenate([normal[:, :, None], tangential], axis=2).reshape(len(normal), -1)


def memory_of(n: int, functions: Mapping[str, Sequence[tuple[Any, Callable[..., Any]]]], **counts: int) -> Memory:
    """Memory of ``n`` active contacts with the functions of their laws.

    ``functions`` has a law and its function for each contact, by the name of the field of a contact ("friction").
    ``counts`` are the lengths of further arrays.
    """
    bound = {
        name: [bind(function, "scalar", law.parameters(), type(law).__name__) for law, function in pairs]
        for name, pairs in functions.items()
    }
    memory = allocate(dict.fromkeys(COUNTS, 0) | {"n_slots": n} | counts)
    memory[owners.Model.entry_points][: len(entry_addresses())] = entry_addresses()
    memory[owners.Problem.n_active], memory[owners.Problem.active][:n] = n, np.arange(n)
    memory[owners.Contact.direction][:, 0] = 1.0
    heap = Heap(memory)
    for name, pairs in bound.items():
        for i, (address, values) in enumerate(pairs):
            memory[getattr(owners.Contact, f"{name}_function")][i] = address
            memory[getattr(owners.Contact, f"{name}_parameters")][i] = heap.store(values)
    return heap.close()


def law_without_value(memory: Memory, laws: Sequence[tuple[Any, ...]]) -> str:
    """Sentence on the first function of the laws of each contact that gave no finite value, or ""."""
    return first_without_value(
        without_value(memory.floats[int(memory[part.parameters][i]) :], part, (), f"contact {i}")
        for i, of_contact in enumerate(laws)
        for part in law_functions(*of_contact)
    )
