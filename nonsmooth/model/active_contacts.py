"""Contacts that are listed take what never changes from the declared ones."""

from __future__ import annotations

from typing import cast

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Life, declarations
from nonsmooth.engine.memory.memory import Memory


def active_contacts(memory: Memory) -> NDArray[np.int64]:
    """Numbers of the declared contacts that are listed, a view."""
    return cast(NDArray[np.int64], memory[owners.Contact.declared][: memory[owners.Island.n_contacts]])


def copy_parameters(memory: Memory) -> None:
    """Give every listed contact the parameters of its declared one.

    The engine does so when it lists a contact. A checkpoint holds no parameters: addresses of functions are others in
    every process.
    """
    declared = active_contacts(memory)
    n = len(declared)
    for name, one in declarations(owners.DeclaredContact).items():
        if one.life is Life.PARAMETER and not one.inside[0]:
            memory[getattr(owners.Contact, name)][:n] = memory[one][declared]
