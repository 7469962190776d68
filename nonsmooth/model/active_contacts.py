"""Copies of parameters from declared contacts to active ones.

An active contact is a declared contact on the neighbour list. The engine copies its parameters when it lists it. A
checkpoint holds no parameters, because addresses of functions differ between processes. So they are copied again if
a checkpoint changes the list.
"""

from __future__ import annotations

from typing import cast

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Life, declarations
from nonsmooth.engine.memory.memory import Memory


def active_contacts(memory: Memory) -> NDArray[np.int64]:
    """Number of the declared contact of each active contact, a view."""
    return cast(NDArray[np.int64], memory[owners.Contact.declared][: memory[owners.Island.n_contacts]])


def copy_parameters(memory: Memory) -> None:
    """Copy the parameters of its declared contact to each active contact."""
    numbers = active_contacts(memory)
    n = len(numbers)
    for name, one in declarations(owners.DeclaredContact).items():
        if one.life is Life.PARAMETER and not one.inside[0]:
            memory[getattr(owners.Contact, name)][:n] = memory[one][numbers]
