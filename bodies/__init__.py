"""Built-in bodies, shapes, motions, contact pairs, joints and loads."""

from bodies.ball import Ball
from bodies.box_body import BoxBody
from bodies.capsule_body import CapsuleBody
from bodies.compound import Compound, Part
from bodies.cone_body import ConeBody
from bodies.contacts.frustum.frustum_frustum import FrustumFrustum
from bodies.contacts.frustum.frustum_polyhedron import FrustumPolyhedron
from bodies.contacts.frustum.frustum_smooth import FrustumSmooth
from bodies.contacts.frustum.frustum_sphere import FrustumSphere
from bodies.contacts.frustum.frustum_swept import FrustumSwept
from bodies.contacts.mesh.frustum_mesh import FrustumMesh
from bodies.contacts.mesh.mesh_mesh import MeshMesh
from bodies.contacts.mesh.mesh_smooth import MeshSmooth
from bodies.contacts.mesh.mesh_sphere import MeshSphere
from bodies.contacts.mesh.mesh_swept import MeshSwept
from bodies.contacts.plane.plane_capsule import PlaneCapsule
from bodies.contacts.plane.plane_ellipsoid import PlaneEllipsoid
from bodies.contacts.plane.plane_frustum import PlaneFrustum
from bodies.contacts.plane.plane_mesh import PlaneMesh
from bodies.contacts.plane.plane_polyhedron import PlanePolyhedron
from bodies.contacts.plane.plane_smooth import PlaneSmooth
from bodies.contacts.plane.plane_sphere import PlaneSphere
from bodies.contacts.plane.plane_vertex import PlaneVertex
from bodies.contacts.polyhedron.polyhedron_point import PolyhedronPoint
from bodies.contacts.polyhedron.polyhedron_polyhedron import PolyhedronPolyhedron
from bodies.contacts.polyhedron.polyhedron_sphere import PolyhedronSphere
from bodies.contacts.polyhedron.swept_swept import SweptSwept
from bodies.contacts.round.box_sphere import BoxSphere
from bodies.contacts.round.capsule_capsule import CapsuleCapsule
from bodies.contacts.round.capsule_sphere import CapsuleSphere
from bodies.contacts.round.sphere_sphere import SphereSphere
from bodies.contacts.smooth.capsule_smooth import CapsuleSmooth
from bodies.contacts.smooth.polyhedron_smooth import PolyhedronSmooth
from bodies.contacts.smooth.smooth_smooth import SmoothSmooth
from bodies.contacts.surface.mesh_point import MeshPoint
from bodies.cylinder_body import CylinderBody
from bodies.disc_body import DiscBody
from bodies.driven_body import DrivenBody
from bodies.dumbbell import Dumbbell
from bodies.ellipsoid_body import EllipsoidBody
from bodies.free import FreeBody
from bodies.generalised import Coordinate, GeneralisedBody, PointFrame, TurningFrame
from bodies.hull_body import HullBody
from bodies.joints.ball_joint import BallJoint
from bodies.joints.distance import Distance
from bodies.joints.fixed import Fixed
from bodies.joints.hinge import Hinge
from bodies.joints.slider import Slider
from bodies.line_body import LineBody
from bodies.loads.bushing import Bushing
from bodies.loads.function_load import FunctionLoad
from bodies.loads.spring import Spring
from bodies.loads.torsion_spring import TorsionSpring
from bodies.mesh_body import MeshBody
from bodies.meshes.decomposition import Decomposition
from bodies.meshes.mesh_file import MeshFile
from bodies.meshes.triangles import Triangles
from bodies.motions.constant_velocity import ConstantVelocity
from bodies.motions.function_motion import FunctionMotion
from bodies.motions.harmonic import Harmonic
from bodies.motions.rest import Rest
from bodies.motions.table import Table
from bodies.open_box import OpenBox
from bodies.planar_body import PlanarBody
from bodies.plate import Plate
from bodies.rigid_body import RigidBody
from bodies.rod import Rod
from bodies.shapes.box import Box
from bodies.shapes.capsule import Capsule
from bodies.shapes.cone import Cone
from bodies.shapes.cylinder import Cylinder
from bodies.shapes.disc import Disc
from bodies.shapes.egg import Egg
from bodies.shapes.ellipsoid import Ellipsoid
from bodies.shapes.frustum import Frustum
from bodies.shapes.ground import Ground
from bodies.shapes.half_space import HalfSpace
from bodies.shapes.hull import ConvexHull
from bodies.shapes.moved_shape import MovedShape
from bodies.shapes.plane import Plane
from bodies.shapes.point import Point
from bodies.shapes.polyhedron import Polyhedron, SweptPolytope
from bodies.shapes.sphere import Sphere
from bodies.shapes.superellipsoid import Superellipsoid
from bodies.shapes.support_shape import SupportShape
from bodies.shapes.triangle_mesh import TriangleMesh
from bodies.solid import Solid
from bodies.superellipsoid_body import SuperellipsoidBody
from bodies.support_body import SupportBody
from bodies.wall import Wall

__all__ = [
    "Ball",
    "BallJoint",
    "Box",
    "BoxBody",
    "BoxSphere",
    "Bushing",
    "Capsule",
    "CapsuleBody",
    "CapsuleCapsule",
    "CapsuleSmooth",
    "CapsuleSphere",
    "Compound",
    "Cone",
    "ConeBody",
    "ConstantVelocity",
    "ConvexHull",
    "Coordinate",
    "Cylinder",
    "CylinderBody",
    "Decomposition",
    "Disc",
    "DiscBody",
    "Distance",
    "DrivenBody",
    "Dumbbell",
    "Egg",
    "Ellipsoid",
    "EllipsoidBody",
    "Fixed",
    "FreeBody",
    "Frustum",
    "FrustumFrustum",
    "FrustumMesh",
    "FrustumPolyhedron",
    "FrustumSmooth",
    "FrustumSphere",
    "FrustumSwept",
    "FunctionLoad",
    "FunctionMotion",
    "GeneralisedBody",
    "Ground",
    "HalfSpace",
    "Harmonic",
    "Hinge",
    "HullBody",
    "LineBody",
    "MeshBody",
    "MeshFile",
    "MeshMesh",
    "MeshPoint",
    "MeshSmooth",
    "MeshSphere",
    "MeshSwept",
    "MovedShape",
    "OpenBox",
    "Part",
    "PlanarBody",
    "Plane",
    "PlaneCapsule",
    "PlaneEllipsoid",
    "PlaneFrustum",
    "PlaneMesh",
    "PlanePolyhedron",
    "PlaneSmooth",
    "PlaneSphere",
    "PlaneVertex",
    "Plate",
    "Point",
    "PointFrame",
    "Polyhedron",
    "PolyhedronPoint",
    "PolyhedronPolyhedron",
    "PolyhedronSmooth",
    "PolyhedronSphere",
    "Rest",
    "RigidBody",
    "Rod",
    "Slider",
    "SmoothSmooth",
    "Solid",
    "Sphere",
    "SphereSphere",
    "Spring",
    "Superellipsoid",
    "SuperellipsoidBody",
    "SupportBody",
    "SupportShape",
    "SweptPolytope",
    "SweptSwept",
    "Table",
    "TorsionSpring",
    "TriangleMesh",
    "Triangles",
    "TurningFrame",
    "Wall",
]
