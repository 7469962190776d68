"""The owners of the numbers of the engine, with a declaration of every number."""

from __future__ import annotations

from nonsmooth.engine.memory.owners.active_contact import ActiveContact, Unknown
from nonsmooth.engine.memory.owners.bodies import Articulation, Body, Joint, Load
from nonsmooth.engine.memory.owners.contact import Contact, DeclaredContact
from nonsmooth.engine.memory.owners.guards import Guard, ImpactGuard, OwnGuard
from nonsmooth.engine.memory.owners.instant import Event, Impact, Problem
from nonsmooth.engine.memory.owners.island import Island, Step
from nonsmooth.engine.memory.owners.model import Coefficients, Model, Options, Tolerance
from nonsmooth.engine.memory.owners.neighbours import Carrier, HalfSpace, Pair, Search, Sphere
from nonsmooth.engine.memory.owners.run import Output, Request, Run, Totals
