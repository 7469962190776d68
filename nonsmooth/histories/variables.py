"""The table of variables: every quantity that a history can have, with its unit, axes and reading.

To add a variable, add a row.  `Solution.history`, the message on an unknown name, `to_xarray`, the export of tables and
``print(variables())`` take it from here.

A reading evaluates the run at all requested times in one pass.  The variables that share a reading take their arrays
from it.  A new variable can be computed from the attributes of a reading:

- :class:`~nonsmooth.histories.states.States`: q, u and inner states of laws;
- :class:`~nonsmooth.histories.states.Modes`: modes of contacts;
- :class:`~nonsmooth.histories.states.Frames`: motion of the frames of bodies;
- :class:`~nonsmooth.histories.states.Energies`: energies, works and losses;
- :class:`~nonsmooth.histories.contacts.NearContacts`: gaps and velocities of contacts, open ones too;
- :class:`~nonsmooth.histories.contacts.ClosedContacts`: forces of closed contacts;
- :class:`~nonsmooth.histories.states.Joints`: forces of joints;
- :class:`~nonsmooth.histories.impulses.Impulses`: impulses of events.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import check_kind
from nonsmooth.errors import InvalidInput
from nonsmooth.histories.contacts import ClosedContacts, NearContacts
from nonsmooth.histories.impulses import Impulses
from nonsmooth.histories.request import HistoryRequest
from nonsmooth.histories.states import Energies, Frames, Joints, Modes, States


@final
@dataclass(frozen=True)
class Variable:
    """A quantity that a history can have: a row of the table.

    Attributes
    ----------
    name : str
        Name of the variable in :meth:`nonsmooth.Solution.history`.
    unit : str
        SI unit, "1" for a pure number, or "" if each column has a unit of its own.
    axes : tuple of str
        Axes behind the axis of time.  "contact" and "joint" are the chosen contacts and joints, "frame", "coordinate"
        and "velocity" belong to the chosen bodies, "axis" is x, y, z, and "side" the first and the second body.
    description : str
        The quantity in words.
    reading : callable
        ``reading(request)`` evaluates the run at the times of the request and returns an object with the results, for
        example ``States.of``.
    values : callable
        ``values(results)`` returns the array of this variable from the object that ``reading`` returned.  Its first
        axis is ``over``; ``axes`` follow.
    over : str
        First axis, "time", or "impulse" for variables of the impulses of events.
    """

    name: str
    unit: str
    axes: tuple[str, ...]
    description: str
    reading: Callable[[HistoryRequest], Any]
    values: Callable[[Any], NDArray[Any]]
    over: str = "time"

    def __post_init__(self) -> None:
        check_kind(f"Variable {self.name!r}: axes", self.axes, tuple, 'For example ("contact",).')
        if isinstance(self.reading, type) or not callable(self.reading):
            rule = "must be a function of a request"
            raise InvalidInput(f"Variable {self.name!r}: reading", rule, self.reading, "Take `of` of a reading.")


def _row(name: str, unit: str, axes: tuple[str, ...], description: str, reading: Any, over: str = "time") -> Variable:
    """Table row of the variable ``name``, which is read from the attribute ``name`` of the class ``reading``."""
    return Variable(name, unit, axes, description, reading.of, attrgetter(name), over)


def _closed(name: str, unit: str, axes: tuple[str, ...], description: str, if_open: float) -> Variable:
    """Table row of the variable ``name``, which is read from the attribute ``name`` of :class:`ClosedContacts`.

    The value of the variable is ``if_open`` while a contact is open.
    """
    return Variable(
        name,
        unit,
        _CONTACT + axes,
        description,
        ClosedContacts.of,
        lambda closed: closed.spread(getattr(closed, name), if_open=if_open),
    )


_CONTACT, _JOINT, _FRAME, _XYZ, _SIDES = ("contact",), ("joint",), ("frame",), ("axis",), ("side",)
_ROWS = (
    # variables of the states of bodies and of laws, and of the modes of contacts
    _row("q", "", ("coordinate",), "coordinates, see coordinate_units", States),
    _row("u", "", ("velocity",), "velocities, see velocity_units", States),
    _row(
        "law_state", "", ("law_state",), "inner states of friction and traction laws, in SI units of each law", States
    ),
    _row("coordinate_rate", "", ("coordinate",), "rates of coordinates, coordinate_units per second", Energies),
    _row("mode", "1", _CONTACT, "mode: 0 open, 1 stick, 2 slide", Modes),
    _row("mode_word", "1", (), "mode word of all contacts", Modes),
    # frames of bodies; the point x of a frame is at position + rotation @ x
    _row("position", "m", _FRAME + _XYZ, "origin of the frame", Frames),
    _row("rotation", "1", (*_FRAME, *_XYZ, "column"), "axes of the frame as columns", Frames),
    _row("velocity", "m/s", _FRAME + _XYZ, "velocity of the origin", Frames),
    _row("angular_velocity", "rad/s", _FRAME + _XYZ, "angular velocity, in world axes", Frames),
    # variables of the whole system: energies, works and losses
    _row("kinetic_energy", "J", (), "kinetic energy of the free bodies", Energies),
    _row("potential_energy", "J", (), "potential energy of the free bodies", Energies),
    _row("driven_work", "J", (), "work of driven bodies since the start", Energies),
    _row("load_work", "J", (), "work of loads and compliant contacts since the start", Energies),
    _row("restitution_loss", "J", (), "loss to restitution since the start", Energies),
    _row("friction_loss", "J", (), "loss to friction since the start", Energies),
    _row("closing_loss", "J", (), "loss in closing steps and projections since the start", Energies),
    _row("loss", "J", (), "all losses since the start", Energies),
    _row("unexplained_energy", "J", (), "change of energy that no work and no loss explains", Energies),
    # contacts, open ones too; NaN if the bodies are far apart
    _row("gap", "m", _CONTACT, "gap, negative for a compliant contact that is pressed in", NearContacts),
    _row("normal_velocity", "m/s", _CONTACT, "rate of the gap, positive if the bodies separate", NearContacts),
    _row("slip_speed", "m/s", _CONTACT, "tangential speed of the second body relative to the first", NearContacts),
    # closed contacts; the last argument is the value while the contact is open
    _closed("normal_force", "N", (), "normal force", 0.0),
    _closed("friction_force", "N", _XYZ, "friction force on the second body", 0.0),
    _closed("friction_moment", "N m", _XYZ, "moment of a traction law on the second body", 0.0),
    _closed("contact_point", "m", _SIDES + _XYZ, "contact points on the first and the second body", np.nan),
    _closed("contact_normal", "1", _XYZ, "unit normal from the first to the second body", np.nan),
    _closed("slip_velocity", "m/s", _XYZ, "tangential velocity of the second body relative to the first", np.nan),
    _closed("beyond_cone", "1", (), "true if the force is outside of the friction cone", 0.0),
    # variables of joints: force and moment are those that the joint exerts on its second body
    _row("joint_point", "m", _JOINT + _XYZ, "point of the joint on the second body", Joints),
    _row("joint_force", "N", _JOINT + _XYZ, "force on the second body", Joints),
    _row("joint_moment", "N m", _JOINT + _XYZ, "moment on the second body about the point", Joints),
    # variables of impulses: each array has one entry for every contact that an event lists, event by event
    _row("impulse_event", "1", (), "number of the event", Impulses, "impulse"),
    _row("impulse_contact", "1", (), "number of the contact", Impulses, "impulse"),
    _row("normal_impulse", "N s", (), "normal impulse", Impulses, "impulse"),
    _row("friction_impulse", "N s", _XYZ, "friction impulse on the second body", Impulses, "impulse"),
    _row("impulse_point", "m", _SIDES + _XYZ, "contact points on the first and the second body", Impulses, "impulse"),
    _row("impulse_normal", "1", _XYZ, "unit normal from the first to the second body", Impulses, "impulse"),
)
VARIABLES: Mapping[str, Variable] = {row.name: row for row in _ROWS}
"""All variables by their names."""


def variables() -> str:
    """The table of variables as text: name, unit, axes and description, a line each."""
    rows = VARIABLES.values()
    cells = [(row.name, f"[{row.unit}]" if row.unit else "", ", ".join((row.over, *row.axes))) for row in rows]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return "\n".join(
        "  ".join(f"{cell:{width}}" for cell, width in zip(line, widths, strict=True)) + f"  {row.description}"
        for line, row in zip(cells, rows, strict=True)
    )
