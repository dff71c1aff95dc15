# SPDX-License-Identifier: Apache-2.0
"""SDF sensors (Gazebo classic, Ignition, gz)."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TypedDict

from navette.geometry import Transform3
from navette.sim.sdf_poses import PoseGraph, read_pose
from navette.sim.sensor_specs import (
    CameraSensor,
    ContactSensor,
    DepthCameraSensor,
    GnssSensor,
    ImuSensor,
    LidarSensor,
    RingLidarSensor,
    Sensor,
    SonarSensor,
)
from navette.sim.xml_tree import Unsupported, XmlNode

_ROUNDED_RAD = 1e-4  # files write 2 pi with some digits
MAX_BEAMS = 20_000
MAX_RING_BEAMS = 1_000_000
MAX_PIXELS = 4096 * 4096


class _Common(TypedDict):
    name: str
    link_T_sensor: Transform3
    frame: str
    topic: str


def read_sensors(
    link: XmlNode, graph: PoseGraph, link_name: str, unsupported: Unsupported
) -> tuple[Sensor, ...]:
    sensors: list[Sensor] = []
    for node in link.all("sensor"):
        common = _Common(
            name=node.name(),
            link_T_sensor=graph.resolve_in(link_name, read_pose(node)),
            frame=_frame(node),
            topic=node.words("topic"),
        )
        kind = node.need_attribute("type")
        if kind in _READERS:
            sensors += _READERS[kind](node, common, unsupported)
        else:
            unsupported.note(f"sensor of type {kind!r}", node)
    return tuple(sensors)


def _frame(node: XmlNode) -> str:
    for tag in ("gz_frame_id", "ignition_frame_id"):
        found = node.find(tag)
        if found is not None:
            return found.text.strip()
    return ""


def _rate(node: XmlNode, default: float) -> float:
    """Read the update rate; SDF's 0 ("as fast as possible") means the default."""
    rate = node.number("update_rate", 0.0)
    if rate < 0 or rate > 1000:
        raise node.error(f"<update_rate> is {rate:g}; expected 0 to 1000 Hz")
    return rate or default


def _lidar(node: XmlNode, common: _Common, unsupported: Unsupported) -> list[Sensor]:
    body = node.find("ray") or node.find("lidar")
    if body is None:
        raise node.error("<ray> or <lidar> is missing")
    horizontal = body.need("scan").need("horizontal")
    samples, angle_min, angle_max = _fan(horizontal, 640.0, math.tau)
    limits = body.need("range")
    range_min, range_max = limits.number("min", 0.0), limits.positive("max")
    if not 0 <= range_min < range_max:
        raise limits.error(
            f"min {range_min:g} and max {range_max:g} m are not a valid range"
        )
    lidar = LidarSensor(
        **common,
        rate_hz=_rate(node, 10.0),
        samples=samples,
        angle_min=angle_min,
        angle_max=angle_max,
        range_min=range_min,
        range_max=range_max,
        noise_stddev=_stddev(body),
        sees_visuals=node.attributes["type"] != "ray",
    )
    vertical = body.find("scan", "vertical")
    if vertical is None or round(vertical.number("samples", 1.0)) <= 1:
        return [lidar]
    rings, lowest, highest = _fan(vertical, 1.0, math.pi)
    if rings * samples > MAX_RING_BEAMS or max(-lowest, highest) > math.pi / 2:
        raise vertical.error(
            f"{rings} x {samples} beams between elevations {lowest:g} and {highest:g}; "
            f"expected at most {MAX_RING_BEAMS} within -pi/2 to pi/2"
        )
    return [
        RingLidarSensor(
            **vars(lidar),
            rings=rings,
            elevation_min=lowest,
            elevation_max=highest,
            is_organized=node.flag("organized", default=True),
        )
    ]


def _fan(node: XmlNode, default: float, most: float) -> tuple[int, float, float]:
    """Read number and angles of the beams of ``<horizontal>`` or ``<vertical>``."""
    samples = round(
        node.positive("samples", default) * node.positive("resolution", 1.0)
    )
    if not 1 <= samples <= MAX_BEAMS:
        raise node.error(f"{samples} samples; expected 1 to {MAX_BEAMS}")
    low, high = node.number("min_angle", 0.0), node.number("max_angle", 0.0)
    if high < low or high - low > most + _ROUNDED_RAD:
        raise node.error(f"angles {low:g} to {high:g} are not a valid scan")
    return samples, low, high


def _camera(node: XmlNode, common: _Common, unsupported: Unsupported) -> list[Sensor]:
    camera = _pinhole(node, common)
    if _stddev(node.need("camera")) > 0:
        unsupported.note("noise of a camera", node)
    return [camera]


def _depth_camera(
    node: XmlNode, common: _Common, unsupported: Unsupported
) -> list[Sensor]:
    pinhole, body = _pinhole(node, common), node.need("camera")
    per_m = body.number("noise_per_m", 0.0)
    if per_m < 0:
        raise body.error(f"<noise_per_m> is {per_m:g}; must be >= 0")
    clip = body.find("depth_camera", "clip")
    near = clip.positive("near", pinhole.near) if clip else pinhole.near
    far = clip.positive("far", pinhole.far) if clip else pinhole.far
    depth = replace(pinhole, near=near, far=far)
    return [
        DepthCameraSensor(**vars(depth), noise_stddev=_stddev(body), noise_per_m=per_m)
    ]


def _rgbd_camera(
    node: XmlNode, common: _Common, unsupported: Unsupported
) -> list[Sensor]:
    """Read a camera that measures colour and depth."""
    [depth] = _depth_camera(node, common, unsupported)
    colour = _pinhole(node, common)
    return [colour, replace(depth, name=f"{depth.name}_depth")]


def _pinhole(node: XmlNode, common: _Common) -> CameraSensor:
    body = node.need("camera")
    image, clip = body.find("image"), body.find("clip")
    width = round(image.positive("width", 320.0)) if image else 320
    height = round(image.positive("height", 240.0)) if image else 240
    if width * height > MAX_PIXELS or min(width, height) < 1:
        raise body.error(f"{width} x {height} pixels; expected 1 to {MAX_PIXELS}")
    fov = body.positive("horizontal_fov", 1.047)
    if fov >= math.pi:
        raise body.error(
            f"<horizontal_fov> is {fov:g}; a pinhole camera requires less than pi"
        )
    return CameraSensor(
        **common,
        rate_hz=_rate(node, 30.0),
        width=width,
        height=height,
        horizontal_fov=fov,
        near=clip.positive("near", 0.1) if clip else 0.1,
        far=clip.positive("far", 100.0) if clip else 100.0,
    )


def _sonar(node: XmlNode, common: _Common, unsupported: Unsupported) -> list[Sensor]:
    """Read a sonar; ``<radius>`` is that of its cone at the largest range."""
    body = node.need("sonar")
    shortest, longest = body.number("min", 0.0), body.positive("max")
    if not 0 <= shortest < longest:
        raise body.error(
            f"min {shortest:g} and max {longest:g} m are not a valid range"
        )
    return [
        SonarSensor(
            **common,
            rate_hz=_rate(node, 10.0),
            half_angle=math.atan2(body.positive("radius", 0.5), longest),
            range_min=shortest,
            range_max=longest,
            noise_stddev=_stddev(body),
        )
    ]


def _contact(node: XmlNode, common: _Common, unsupported: Unsupported) -> list[Sensor]:
    """Read a bumper; ``<navette:bearings>`` limits it to a part of its collisions."""
    contact = node.find("contact")
    names = [c.text.strip() for c in contact.all("collision")] if contact else []
    bearings = node.find("bearings")
    low, high = bearings.numbers(2) if bearings else (-math.pi, math.pi)
    if not low < high <= low + math.tau + _ROUNDED_RAD:
        raise node.error(f"bearings {low:g} to {high:g}; expected up to one turn")
    return [
        ContactSensor(
            **common,
            rate_hz=_rate(node, 50.0),
            collisions=tuple(names),
            bearings=(low, high),
        )
    ]


def _gnss(node: XmlNode, common: _Common, unsupported: Unsupported) -> list[Sensor]:
    sensing = node.find("navsat", "position_sensing") or node.find(
        "gps", "position_sensing"
    )
    across = sensing.find("horizontal") if sensing else None
    up = sensing.find("vertical") if sensing else None
    return [
        GnssSensor(
            **common,
            rate_hz=_rate(node, 5.0),
            horizontal_stddev=_stddev(across),
            vertical_stddev=_stddev(up),
        )
    ]


def _imu(node: XmlNode, common: _Common, unsupported: Unsupported) -> list[Sensor]:
    return [
        ImuSensor(
            **common,
            rate_hz=_rate(node, 100.0),
            acceleration_stddev=_stddev(node.find("imu", "linear_acceleration", "x")),
            angular_velocity_stddev=_stddev(node.find("imu", "angular_velocity", "x")),
        )
    ]


def _stddev(node: XmlNode | None) -> float:
    noise = node.find("noise") if node is not None else None
    if noise is None:
        return 0.0
    stddev = noise.number("stddev", 0.0)
    if stddev < 0:
        raise noise.error(f"<stddev> is {stddev:g}; must be >= 0")
    return stddev


_Reader = Callable[[XmlNode, _Common, Unsupported], list[Sensor]]

_READERS: dict[str, _Reader] = {
    **dict.fromkeys(("ray", "lidar", "gpu_ray", "gpu_lidar"), _lidar),
    "camera": _camera,
    **dict.fromkeys(("depth", "depth_camera"), _depth_camera),
    **dict.fromkeys(("rgbd", "rgbd_camera"), _rgbd_camera),
    "imu": _imu,
    "sonar": _sonar,
    "contact": _contact,
    **dict.fromkeys(("gps", "navsat"), _gnss),
}
