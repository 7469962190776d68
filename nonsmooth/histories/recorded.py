"""Whether a run holds the modes and impulses of its contacts, which only some engines record."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nonsmooth.errors import InvalidInput

if TYPE_CHECKING:
    from nonsmooth.interfaces import Engine
    from nonsmooth.system.system import System


def check_recorded(where: str, what: str, system: System, engine: Engine) -> None:
    """Look whether an engine records modes and impulses of the contacts of a system.

    Raises
    ------
    InvalidInput
        If it does not: zeros would look like open contacts.
    """
    if system.contacts and not engine.records_contacts:
        raise InvalidInput(
            f"{where}: {what} of contacts",
            "are known only of engines that record contacts",
            engine,
            "Run with nonsmooth.EventDriven(), or let records_contacts of the engine return True and record events.",
        )
