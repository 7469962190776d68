from nonsmooth.engines.event_driven import EventDriven as EventDriven
from nonsmooth.errors import InvalidInput as InvalidInput
from nonsmooth.errors import NoDistance as NoDistance
from nonsmooth.errors import NonsmoothError as NonsmoothError
from nonsmooth.errors import PluginError as PluginError
from nonsmooth.errors import RunFailed as RunFailed
from nonsmooth.errors import RunsInPython as RunsInPython
from nonsmooth.errors import UnknownName as UnknownName
from nonsmooth.files.reading import Setup as Setup
from nonsmooth.files.reading import load_system as load_system
from nonsmooth.files.writing import save_system as save_system
from nonsmooth.interfaces import Criterion as Criterion
from nonsmooth.placing.starts import at_height as at_height
from nonsmooth.placing.starts import resting as resting
from nonsmooth.placing.starts import touching as touching
from nonsmooth.placing.starts import turned_about as turned_about
from nonsmooth.problems.contact import solve_contact as solve_contact
from nonsmooth.problems.contact_result import ContactResult as ContactResult
from nonsmooth.problems.impact import ImpactResult as ImpactResult
from nonsmooth.problems.impact import solve_impact as solve_impact
from nonsmooth.problems.restitution import restitution as restitution
from nonsmooth.queries.distance import distance as distance
from nonsmooth.queries.proximity import proximity as proximity
from nonsmooth.results.opening import open_solution as open_solution
from nonsmooth.results.output import Output as Output
from nonsmooth.runs.model import Model as Model
from nonsmooth.runs.resuming import resume as resume
from nonsmooth.runs.simulate import assemble as assemble
from nonsmooth.runs.simulate import simulate as simulate
from nonsmooth.solution.solution import Solution as Solution
from nonsmooth.solution.state import State as State
from nonsmooth.system.materials import ContactLaws as ContactLaws
from nonsmooth.system.materials import Materials as Materials
from nonsmooth.system.replacing import with_laws as with_laws
from nonsmooth.system.system import System as System

__version__: str
"""The version that is installed."""
