# SPDX-License-Identifier: Apache-2.0
"""Parameters derived from the shape and the drive of a robot without its own."""

import math
from collections.abc import Iterator
from typing import Any

from navette.geometry import Transform3, Vector3
from navette.msgs import topics
from navette.msgs.topics import StackTopic
from navette.sim.drive_geometry import base_of
from navette.sim.drive_profile import drive_parameters, full_lock_radius
from navette.sim.scene import (
    AckermannDrive,
    Box,
    Capsule,
    Cylinder,
    DiffDrive,
    Ellipsoid,
    Geometry,
    Model,
    Plane,
    Shape,
    Sphere,
)
from navette.sim.sensor_specs import (
    DepthCameraSensor,
    LidarSensor,
    RingLidarSensor,
    Sensor,
    SonarSensor,
)
from navette.sim.sensor_topics import has_bumper, topics_of
from navette.sim.steering import link_poses

_CORNERS = 12  # of the polygon drawn around a circle

Point2 = tuple[float, float]


def footprint_of(model: Model) -> tuple[Point2, ...]:
    """Convex outline of the solid geometry, from above, in the base frame.

    Steered wheels are contained at every angle.
    """
    return convex_hull([(x, y) for x, y, _ in _solid_points(model)])


def extent_of(model: Model) -> tuple[Vector3, Vector3]:
    """Lowest and highest corner of the box around the solid geometry, base frame."""
    xs, ys, zs = zip(*_solid_points(model), strict=True)
    return (min(xs), min(ys), min(zs)), (max(xs), max(ys), max(zs))


def _solid_points(model: Model) -> list[Vector3]:
    """Points whose convex hull contains the solid geometry, in the base frame."""
    base_T_model = base_of(model).inverse()
    return [
        point
        for link in model.links
        for geometry in link.geometries
        if geometry.collides
        for model_T_link in link_poses(model, link)
        for point in _outline(geometry, base_T_model @ model_T_link)
    ]


def derive_parameters(model: Model) -> dict[str, dict[str, object]]:
    """Return parameters by node name; speeds from the drive's limits, else by size.

    Defaults for a robot of radius r: 1 m/s, less if r < 0.5 m; 1 s to full speed, 0.5 s
    to full yaw rate. The kind of the drive and a car's turning radius are the model's.
    """
    assert model.drive is not None, "derive_parameters() of a model without a drive"
    outline = footprint_of(model)
    flat = [round(value, 4) for point in outline for value in point]
    radius = max(math.hypot(x, y) for x, y in outline)
    drive = model.drive
    limits = drive.limits
    speed = limits.speed or min(1.0, 2.0 * radius)
    reverse = limits.reverse_speed or speed / 2
    yaw_rate = limits.yaw_rate or _yaw_rate(drive, speed, radius)
    acceleration = limits.acceleration or speed
    yaw_acceleration = limits.yaw_acceleration or 2 * yaw_rate
    cruise = 0.7 * speed
    parameters: dict[str, dict[str, object]] = {
        **_costmap_parameters(model, flat),
        "sim": {
            "max_speed_mps": speed,
            "max_reverse_speed_mps": reverse,
            "max_yaw_rate_radps": yaw_rate,
            "max_accel_mps2": acceleration,
            "max_yaw_accel_radps2": yaw_acceleration,
        },
        "map_memory": {"footprint_m": flat},
        "planner": {"footprint_m": flat},
        "arbiter": {"max_speed_mps": speed, "max_turn_rate_radps": yaw_rate},
        "behaviors": {
            "footprint_m": flat,
            "max_speed_mps": min(reverse, cruise / 2),
            "max_turn_rate_radps": 0.5 * yaw_rate,
            "acceleration_mps2": min(acceleration, 0.5),
            "deceleration_mps2": min(acceleration, 0.5),
            "turn_acceleration_radps2": min(yaw_acceleration, 1.5),
        },
        "control": {
            "footprint_m": flat,
            "cruise_speed_mps": cruise,
            "reverse_speed_mps": min(reverse, cruise / 2),
            "max_speed_mps": speed,
            "max_turn_rate_radps": 0.7 * yaw_rate,
            "acceleration_mps2": min(acceleration, 1.0),
            "deceleration_mps2": min(acceleration, 1.0),
            "turn_acceleration_radps2": min(yaw_acceleration, 2.0),
        },
    }
    for node, values in drive_parameters(drive, speed, cruise).items():
        parameters[node].update(values)
    return parameters


def _yaw_rate(drive: DiffDrive, speed: float, radius: float) -> float:
    """Return the default of the highest yaw rate: a car's is that of its bends."""
    if isinstance(drive, AckermannDrive):
        return speed / full_lock_radius(drive)
    return min(2.0, speed / max(radius, 0.1))


_HEADROOM_M = 0.1  # above the robot, within which an obstacle counts


def _costmap_parameters(model: Model, outline: list[float]) -> dict[str, Any]:
    """Return parameters of the obstacle layer, if a further sensor needs it."""
    sources: dict[str, dict[str, object]] = {}
    top = round(extent_of(model)[1][2] + _HEADROOM_M, 3)
    for topic in topics_of(model):
        values = _SOURCES.get((type(topic.sensor), topic.stack))
        is_main = topic.name == topics.LIDAR.name
        if values is not None and not is_main:
            name = topic.name.strip("/").replace("/", "_")
            sources[name] = {
                "topic": topic.name,
                **values,
                "max_obstacle_height": top,
            }
    if has_bumper(model):
        hazards = topics.HAZARDS.name
        sources["bumper"] = {"topic": hazards, "data_type": "HazardDetectionVector"}
    if not sources:
        return {}
    prefix = "obstacle_layer"
    found: dict[str, object] = {f"{prefix}.observation_sources": " ".join(sources)}
    for name, values in sources.items():
        found |= {f"{prefix}.{name}.{key}": value for key, value in values.items()}
    return {"costmap": {"footprint_m": outline, **found}}


# A laser measures farther with the same accuracy; the noise of depth grows with range².
_FAR = {"obstacle_max_range": 4.0, "raytrace_max_range": 5.0}
_CLOUD: dict[str, object] = {"data_type": "PointCloud2"}
_SOURCES: dict[tuple[type[Sensor], StackTopic], dict[str, object]] = {
    (LidarSensor, topics.LIDAR): {"data_type": "LaserScan", **_FAR},
    (RingLidarSensor, topics.POINTS): {**_CLOUD, **_FAR},
    (DepthCameraSensor, topics.DEPTH_POINTS): _CLOUD,
    (SonarSensor, topics.SONAR): {"data_type": "Range"},
}


def convex_hull(points: list[Point2]) -> tuple[Point2, ...]:
    """Return the corners counter-clockwise (Andrew's monotone chain, 1979)."""
    ordered = sorted({(round(x, 6), round(y, 6)) for x, y in points})

    def chain(sequence: list[Point2]) -> list[Point2]:
        kept: list[Point2] = []
        for point in sequence:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], point) <= 1e-9:
                kept.pop()
            kept.append(point)
        return kept[:-1]

    return tuple(chain(ordered) + chain(ordered[::-1]))


def _turn(a: Point2, b: Point2, c: Point2) -> float:
    """Twice the signed area of the triangle; positive for a left turn."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _outline(geometry: Geometry, base_T_link: Transform3) -> Iterator[Vector3]:
    base_T_shape = base_T_link @ geometry.link_T_shape
    return map(base_T_shape.apply, _surface(geometry.shape))


def _surface(shape: Shape) -> Iterator[Vector3]:
    """Points whose convex hull contains the shape."""
    if isinstance(shape, Plane):
        return
    if isinstance(shape, Cylinder):
        for x, y in _circle(shape.radius):
            yield (x, y, shape.length / 2)
            yield (x, y, -shape.length / 2)
        return
    x, y, z = _half_extent(shape)
    if isinstance(shape, Box):
        for sx, sy, sz in _SIGNS:
            yield (sx * x, sy * y, sz * z)
        return
    for u, v in _circle(1.0):  # three great circles
        yield (u * x, v * y, 0.0)
        yield (u * x, 0.0, v * z)
        yield (0.0, u * y, v * z)


_SIGNS = [(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]


def _half_extent(shape: Box | Capsule | Sphere | Ellipsoid) -> Vector3:
    if isinstance(shape, Box):
        x, y, z = shape.size
        return (x / 2, y / 2, z / 2)
    if isinstance(shape, Sphere):
        return (shape.radius,) * 3
    if isinstance(shape, Capsule):
        return (shape.radius, shape.radius, shape.radius + shape.length / 2)
    return shape.radii


def _circle(radius: float) -> Iterator[Point2]:
    """Corners of a regular polygon around the circle."""
    outer = radius / math.cos(math.pi / _CORNERS)
    for i in range(_CORNERS):
        angle = math.tau * i / _CORNERS
        yield (outer * math.cos(angle), outer * math.sin(angle))
