"""The owners of the numbers of the engine, with a declaration of every number."""

from __future__ import annotations

from nonsmooth.engine.memory.owners.active_contact import ActiveContact, Unknown
from nonsmooth.engine.memory.owners.bodies import Articulation, BodyRecord, JointRecord, LoadRecord
from nonsmooth.engine.memory.owners.contact import ContactRecord, HistoryRecord, KindRecord, RowRecord
from nonsmooth.engine.memory.owners.guards import GuardRecord, ImpactGuard, OwnGuard
from nonsmooth.engine.memory.owners.instant import Event, Impact, Problem
from nonsmooth.engine.memory.owners.island import Island, Step
from nonsmooth.engine.memory.owners.model import Coefficients, ModelNumbers, Options, Tolerance
from nonsmooth.engine.memory.owners.neighbours import BoundingSphere, Carrier, HalfSpaceRecord, Pair, Search
from nonsmooth.engine.memory.owners.run import OutputNumbers, Request, Run, Totals
