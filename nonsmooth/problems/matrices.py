"""Common parts of contact and impact problems: checks of matrices and laws, memory, and Delassus matrix."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.binding.compile import bind
from nonsmooth.binding.law_failure import first_without_value, without_value
from nonsmooth.binding.law_functions import law_functions
from nonsmooth.checks import floats
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.heap import Heap
from nonsmooth.engine.memory.layout import MOST_BLOCKS
from nonsmooth.engine.memory.memory import Memory, allocate
from nonsmooth.engine.memory.tables import COUNTS
from nonsmooth.engine.native.kernel import entry_addresses
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import AnisotropicFrictionLaw, FrictionLaw, StatefulFrictionLaw

Floats = NDArray[np.float64]


def read_arrays(call: str, remedy: str, **given: tuple[ArrayLike | None, tuple[int, ...]]) -> list[Floats]:
    """Arrays of floats from the arguments ``given``, each with its required shape; zeros in place of None.

    Raises
    ------
    InvalidInput
        If a shape is wrong or a number is not finite. The message begins with the function ``call``.
    """
    found = [np.zeros(shape) if one is None else floats(f"{call}: {name}", one) for name, (one, shape) in given.items()]
    for array, (name, (_, shape)) in zip(found, given.items(), strict=True):
        if array.shape != shape or not np.all(np.isfinite(array)):
            raise InvalidInput(f"{call}: {name}", f"must be finite with shape {shape}", array.shape, remedy)
    return found


def check_mass(call: str, mass: Floats) -> None:
    """Raise InvalidInput if a mass matrix is not symmetric positive definite."""
    if not np.allclose(mass, mass.T, rtol=1e-12, atol=0.0) or np.linalg.eigvalsh(mass)[0] <= 0.0:
        raise InvalidInput(f"{call}: mass", "must be symmetric positive definite", mass.tolist(), "Check M.")


def check_friction(thing: str, friction: Sequence[FrictionLaw]) -> None:
    """Raise InvalidInput if a law is no friction law, is anisotropic or has inner states."""
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

    ``functions`` maps the name of a law's field in a contact, such as "friction", to a list. The list has a pair for
    each contact: the law and its function. ``counts`` are the lengths of further arrays.
    """
    bound = {
        name: [bind(function, "scalar", law.parameters(), type(law).__name__) for law, function in pairs]
        for name, pairs in functions.items()
    }
    memory = allocate(dict.fromkeys(COUNTS, 0) | {"n_slots": n} | counts)
    memory[owners.ModelNumbers.entry_points][: len(entry_addresses())] = entry_addresses()
    memory[owners.Problem.n_active], memory[owners.Problem.active][:n] = n, np.arange(n)
    memory[owners.ContactRecord.direction][:, 0] = 1.0
    heap = Heap(memory)
    for name, pairs in bound.items():
        for i, (address, values) in enumerate(pairs):
            memory[getattr(owners.ContactRecord, f"{name}_function")][i] = address
            memory[getattr(owners.ContactRecord, f"{name}_parameters")][i] = heap.store(values)
    return heap.close()


def law_without_value(memory: Memory, laws: Sequence[tuple[Any, ...]]) -> str:
    """Sentence on the first law function that gave no finite value; "" without such a function.

    ``laws`` has the laws of each contact.
    """
    return first_without_value(
        without_value(memory.floats[int(memory[part.parameters][i]) :], part, (), f"contact {i}")
        for i, of_contact in enumerate(laws)
        for part in law_functions(*of_contact)
    )


def write_delassus(memory: Memory, matrix: Floats) -> None:
    """Write a Delassus matrix [1/kg] of shape [3 n, 3 n] for the contacts 0 to n - 1, in this order.

    The memory gets the blocks (3 x 3) of pairs of contacts, row by row, with the columns of the blocks and where each
    row starts. Two contacts with zero blocks both ways do not act on each other, and get no block.

    Raises
    ------
    InvalidInput
        If there are more blocks than the memory can hold.
    """
    n = len(matrix) // 3
    blocks = np.reshape(matrix, (n, 3, n, 3)).transpose(0, 2, 1, 3)
    coupled = np.any(blocks != 0.0, axis=(2, 3))
    # store both blocks of a coupled pair of contacts, and each block on the diagonal even if it is zero
    coupled |= coupled.T | np.eye(n, dtype=bool)
    rows, columns = np.nonzero(coupled)
    if len(columns) > MOST_BLOCKS:
        remedy = "Solve groups of contacts that do not act on each other separately."
        raise InvalidInput("contacts", f"must couple in at most {MOST_BLOCKS} pairs", len(columns), remedy)
    memory[owners.Island.block_start][: n + 1] = np.searchsorted(rows, np.arange(n + 1))
    memory[owners.Island.block_column][: len(columns)] = columns
    memory[owners.ActiveContact.diagonal_block][:n] = np.flatnonzero(rows == columns)
    # 9 numbers for each block
    memory[owners.Island.delassus][: 9 * len(columns)] = blocks[coupled].ravel()


def read_delassus(memory: Memory, n: int) -> Floats:
    """Delassus matrix [1/kg] of the contacts 0 to n - 1, shape [3 n, 3 n]; zero where two contacts have no block."""
    starts = memory[owners.Island.block_start][: n + 1]
    columns = memory[owners.Island.block_column][: int(starts[-1])]
    rows = np.repeat(np.arange(n), np.diff(starts))
    blocks = np.zeros((n, n, 3, 3))
    # 9 numbers for each block
    blocks[rows, columns] = memory[owners.Island.delassus][: 9 * len(columns)].reshape(-1, 3, 3)
    return np.ascontiguousarray(blocks.transpose(0, 2, 1, 3)).reshape(3 * n, 3 * n)
