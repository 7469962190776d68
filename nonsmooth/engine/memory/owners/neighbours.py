"""Numbers of what decides which bodies may meet: bounding spheres, half-spaces, searches for features, convex pairs."""

from __future__ import annotations

from typing import final

from nonsmooth.engine.memory.declare import Life, Record, Vector3, address, end_of, question, real, row, vector, whole
from nonsmooth.types import Floats

_PARAMETER, _REUSED = Life.PARAMETER, Life.REUSED


@final
class BoundingSphere(Record, key="spheres", capacity="n_spheres", length="model.n_spheres"):
    """A bounding sphere about the origin of a frame, which holds all bounded shapes that the frame carries."""

    frame: int = whole(_PARAMETER, "Offset of the frame.")
    radius: float = real(_PARAMETER, "m", "Radius.")
    first_partner: int = whole(_PARAMETER, "First of its pairs among all.", has_end=True)
    end_partner: int = end_of("first_partner", "End of its pairs.")
    feature_radius: float = real(_PARAMETER, "m", "Radius of the features that are searched for, 0 if there are none.")
    speed: float = real(_REUSED, "m/s", "Bound of its speed within a step.")
    distance: float = real(_REUSED, "m", "Bound of its displacement since the neighbour list was made.")
    place: Vector3 = vector(_REUSED, 3, "m", "Centre when the neighbour list was made.")
    places: Floats = row(_REUSED, 3, "m", "The same, number by number.", inside=("place", 0))
    axes: Floats = row(_REUSED, 9, "1", "Axes of the frame when the neighbour list was made.")


@final
class HalfSpaceRecord(Record, key="half_spaces", capacity="n_half_spaces", length="model.n_half_spaces"):
    """An unbounded shape that has contacts."""

    row: int = whole(_PARAMETER, "Row of its contacts.")
    sphere: int = whole(_PARAMETER, "Bounding sphere of the other shape.")
    frame: int = whole(_PARAMETER, "Offset of the frame of the unbounded shape.")
    is_steady: bool = question(_PARAMETER, "The frame is at rest, and the shape is below a plane.")
    ceiling: float = real(_PARAMETER, "m", "Height of that plane along the third axis of the frame.")


@final
class Search(Record, key="searches", capacity="n_searches", length="model.n_searches"):
    """A search for candidate features: those of two shapes that are near each other share a number of contacts."""

    function: int = address(_PARAMETER, "Address of the function that finds pairs of features.")
    parameters: int = whole(_PARAMETER, "Offset of the parameters of that function.")
    out: int = whole(_PARAMETER, "Offset at which the function writes.")
    row: int = whole(_PARAMETER, "Row of the first of the declared contacts that hold the pairs.")
    first_contact: int = whole(_PARAMETER, "First of the declared contacts that hold the pairs.")
    n_contacts: int = whole(_PARAMETER, "Number of these contacts.")
    sphere_a: int = whole(_PARAMETER, "Bounding sphere of the first shape.")
    sphere_b: int = whole(_PARAMETER, "Bounding sphere of the second shape.")


@final
class Pair(Record, key="pairs", capacity="n_pairs", length="model.n_pairs"):
    """Two convex parts of bodies between which contacts are declared."""

    carrier_a: int = whole(_PARAMETER, "Carrier of the first part.")
    carrier_b: int = whole(_PARAMETER, "Carrier of the second part.")
    frame_a: int = whole(_PARAMETER, "Offset of the frame of the first part.")
    frame_b: int = whole(_PARAMETER, "Offset of the frame of the second part.")
    part_a: int = whole(_PARAMETER, "Offset of the numbers of the first part.")
    part_b: int = whole(_PARAMETER, "Offset of the numbers of the second part.")
    group: int = whole(_PARAMETER, "First pair of the same shapes.")
    contact: int = whole(_PARAMETER, "First declared contact of the pair.")
    is_guarded: bool = question(_PARAMETER, "The separation of its shapes decides whether they meet.")
    is_apart: bool = question(Life.STATE, "Its shapes are apart, and their contacts are not listed.")
    is_swapped: bool = question(_PARAMETER, "Its first part belongs to the second body of the contacts.")
    are_both_flat: bool = question(_PARAMETER, "Both parts are discs without thickness.")
    allowed: float = real(_PARAMETER, "m", "Overlap that the laws of the pair allow.")
    size: float = real(_PARAMETER, "m", "Size of the smaller part.")
    reach: float = real(_REUSED, "m", "Displacement of the parts for which the listed contacts are enough.")
    listed: float = real(_REUSED, "m", "Bound of the displacement of the parts when the contacts were listed.")
    margin: float = real(_REUSED, "m", "Distance that the parts may move before the pair is evaluated again.")
    is_searched: bool = question(Life.STEP, "The step is searched for its first meeting.")
    is_watched: bool = question(_REUSED, "Its separation is watched within the step, in place of its contacts.")
    level: float = real(Life.STEP, "m", "Separation at which it meets in the step.")
    begin: float = real(Life.STEP, "1", "Fraction of the step from which its separation is watched.")
    is_near: bool = question(Life.STEP, "Its shapes touch within the tolerances.")
    is_closed: bool = question(Life.STEP, "A contact of the pair is closed.")
    deepest: float = real(Life.STEP, "m", "Least gap of the closed contacts.")
    direction: Vector3 = vector(
        Life.STATE, 3, "1", "Direction of largest separation, along the axes of the first frame."
    )
    facing: Vector3 = vector(Life.STATE, 3, "1", "Same direction when stored, along the axes of the second frame.")
    drift: Vector3 = vector(Life.STEP, 3, "1/s", "Rate of that direction, along the same axes.")
    searched: float = real(Life.STEP, "s", "Time within the step at which the direction was searched.")
    clearance: float = real(_PARAMETER, "m", "Separation at which contacts of the shapes may close.")
    normal: Vector3 = vector(Life.STEP, 3, "1", "Normal of the deepest closed contact.")
    measured: Vector3 = vector(Life.SOLUTION, 3, "1", "Direction of largest separation that a measurement found.")
    separation: float = real(Life.SOLUTION, "m", "Separation along it, a lower bound of the distance.")
    shallowest: float = real(Life.SOLUTION, "m", "Upper bound of the separation, negative if an overlap is proved.")
    first: Vector3 = vector(Life.SOLUTION, 3, "m", "Point of the first part that is nearest to the second.")
    second: Vector3 = vector(Life.SOLUTION, 3, "m", "Point of the second part that is nearest to the first.")
    between: Vector3 = vector(
        _REUSED, 3, "m", "Centre of the second disc along the axes of the first, if both are flat."
    )


@final
class Carrier(Record, key="carriers", capacity="n_carriers", length="model.n_carriers"):
    """A frame that carries convex parts."""

    frame: int = whole(_PARAMETER, "Offset of the frame.")
    body: int = whole(_PARAMETER, "Body of the frame.")
    radius: float = real(_PARAMETER, "m", "Radius about the origin of the frame that holds all of its parts.")
    speed_at_start: float = real(Life.STEP, "m/s", "Bound of the speed of its points at the start of the step.")
    speed_at_end: float = real(_REUSED, "m/s", "Bound of the speed of its points at the end of the step.")
    place: Vector3 = vector(_REUSED, 3, "m", "Origin when it was evaluated last.")
    axes: Floats = row(_REUSED, 9, "1", "Axes when it was evaluated last.")
    distance: float = real(_REUSED, "m", "Bound of its displacement since its pairs were evaluated.")
