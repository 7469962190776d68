"""The conformance kit: the properties of laws, bodies, contact kinematics, scenarios and other components, by name.

Each ``check_...`` returns a list of :class:`Property`; nothing runs before a property is called::

    @pytest.mark.parametrize("prop", check_friction_law(MyLaw(0.3)), ids=str)
    def test_my_law(prop):
        prop()

A property is checked in a child process, so that a component that does not return can be reported by name.
"""

from nonsmooth.testing.body import check_body
from nonsmooth.testing.distances import check_distance_backend
from nonsmooth.testing.engine import check_engine
from nonsmooth.testing.friction import check_friction_law
from nonsmooth.testing.guard import check_guard
from nonsmooth.testing.impact import check_impact_law
from nonsmooth.testing.joint import check_joint
from nonsmooth.testing.kinematics import check_contact_kinematics
from nonsmooth.testing.load import check_load
from nonsmooth.testing.motion import check_motion
from nonsmooth.testing.normal import check_normal_law
from nonsmooth.testing.outcome import NotChecked
from nonsmooth.testing.property import Departs, Property, PropertyFailed
from nonsmooth.testing.scenario import check_scenario
from nonsmooth.testing.shape import check_shape
from nonsmooth.testing.traction import check_traction_law

__all__ = [
    "Departs",
    "NotChecked",
    "Property",
    "PropertyFailed",
    "check_body",
    "check_contact_kinematics",
    "check_distance_backend",
    "check_engine",
    "check_friction_law",
    "check_guard",
    "check_impact_law",
    "check_joint",
    "check_load",
    "check_motion",
    "check_normal_law",
    "check_scenario",
    "check_shape",
    "check_traction_law",
]
