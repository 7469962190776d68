"""nonsmooth: event-driven multibody dynamics with friction and energetic multiple impacts."""

from nonsmooth.contact import solve_contact
from nonsmooth.contact_result import ContactResult
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.errors import InvalidInput, NoDistance, NonsmoothError, PluginError, RunFailed, RunsInPython, UnknownName
from nonsmooth.files.reading import Setup, load_system
from nonsmooth.files.writing import save_system
from nonsmooth.impact import ImpactResult, solve_impact
from nonsmooth.interfaces import Criterion
from nonsmooth.placing.orientation import turned_about
from nonsmooth.placing.starts import at_height, resting, touching
from nonsmooth.plugins import registry as _registry
from nonsmooth.queries.distance import distance
from nonsmooth.queries.proximity import proximity
from nonsmooth.restitution import restitution
from nonsmooth.results.opening import open_solution
from nonsmooth.results.output import Output
from nonsmooth.run_scenario import run_scenario
from nonsmooth.runs.model import Model
from nonsmooth.runs.resuming import resume
from nonsmooth.scenario import scenario
from nonsmooth.simulate import assemble, simulate
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import State
from nonsmooth.system.materials import ContactLaws, Materials
from nonsmooth.system.replacing import with_laws
from nonsmooth.system.system import System

__version__: str
"""The version that is installed."""

__all__ = [
    "ContactLaws",
    "ContactResult",
    "Criterion",
    "EventDriven",
    "ImpactResult",
    "InvalidInput",
    "Materials",
    "Model",
    "NoDistance",
    "NonsmoothError",
    "Output",
    "PluginError",
    "RunFailed",
    "RunsInPython",
    "Setup",
    "Solution",
    "State",
    "System",
    "UnknownName",
    "assemble",
    "at_height",
    "distance",
    "load_system",
    "open_solution",
    "proximity",
    "resting",
    "restitution",
    "resume",
    "run_scenario",
    "save_system",
    "scenario",
    "simulate",
    "solve_contact",
    "solve_impact",
    "touching",
    "turned_about",
    "with_laws",
]


_registry.check_hidden()


def __getattr__(name: str) -> str:
    if name != "__version__":
        raise AttributeError(f"module 'nonsmooth' has no attribute {name!r}")
    from importlib.metadata import version

    return version("nonsmooth")
