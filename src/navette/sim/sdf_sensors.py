# SPDX-License-Identifier: Apache-2.0
"""SDF sensors and drive plugins (Gazebo classic, Ignition, gz)."""

import math
from collections.abc import Iterable
from dataclasses import fields
from typing import Any, TypedDict

from navette.geometry import Transform3
from navette.sim.scene import (
    AckermannDrive,
    CameraSensor,
    ContactSensor,
    DiffDrive,
    ImuSensor,
    LidarSensor,
    MecanumDrive,
    Sensor,
    SpeedLimits,
)
from navette.sim.sdf_poses import PoseGraph, read_pose
from navette.sim.xml_tree import Unsupported, XmlNode

_ROUNDED_RAD = 1e-4  # files write 2 pi with some digits
MAX_BEAMS = 20_000
MAX_PIXELS = 4096 * 4096

_LIDAR_TYPES = ("ray", "lidar", "gpu_ray", "gpu_lidar")

# Plugins whose function Navette's own nodes have; ignored without a warning.
_REPLACED = (
    "posepublisher",
    "pose-publisher",
    "jointstatepublisher",
    "joint-state-publisher",
    "joint_state_publisher",
    "odometrypublisher",
    "odometry-publisher",
    "physics",
    "usercommands",
    "user-commands",
    "scenebroadcaster",
    "scene-broadcaster",
    "imu",
    "sensors",
    "contact",
)


class _Common(TypedDict):
    name: str
    link_T_sensor: Transform3
    frame: str


def read_sensors(
    link: XmlNode, graph: PoseGraph, link_name: str, unsupported: Unsupported
) -> tuple[Sensor, ...]:
    sensors: list[Sensor] = []
    for node in link.all("sensor"):
        common = _Common(
            name=node.name(),
            link_T_sensor=graph.resolve_in(link_name, read_pose(node)),
            frame=_frame(node),
        )
        sensor = _read_sensor(node, common, unsupported)
        if sensor is not None:
            sensors.append(sensor)
    return tuple(sensors)


def _read_sensor(
    node: XmlNode, common: _Common, unsupported: Unsupported
) -> Sensor | None:
    kind = node.need_attribute("type")
    if kind in _LIDAR_TYPES:
        return _lidar(node, kind, common, unsupported)
    if kind == "camera":
        return _camera(node, common, unsupported)
    if kind == "imu":
        return _imu(node, common)
    if kind == "contact":
        contact = node.find("contact")
        names = [c.text.strip() for c in contact.all("collision")] if contact else []
        rate = _rate(node, 10.0)
        return ContactSensor(**common, rate_hz=rate, collisions=tuple(names))
    unsupported.note(f"sensor of type {kind!r}", node)
    return None


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


def _lidar(
    node: XmlNode, kind: str, common: _Common, unsupported: Unsupported
) -> LidarSensor:
    body = node.find("ray") or node.find("lidar")
    if body is None:
        raise node.error("<ray> or <lidar> is missing")
    horizontal = body.need("scan").need("horizontal")
    vertical = body.find("scan", "vertical")
    if vertical is not None and vertical.number("samples", 1.0) > 1:
        unsupported.note(
            "lidar with several rows of beams (one row is simulated)", vertical
        )
    samples = round(
        horizontal.positive("samples", 640.0) * horizontal.positive("resolution", 1.0)
    )
    if not 1 <= samples <= MAX_BEAMS:
        raise horizontal.error(f"{samples} samples; expected 1 to {MAX_BEAMS}")
    angle_min = horizontal.number("min_angle", 0.0)
    angle_max = horizontal.number("max_angle", 0.0)
    if angle_max < angle_min or angle_max - angle_min > math.tau + _ROUNDED_RAD:
        raise horizontal.error(
            f"angles {angle_min:g} to {angle_max:g} are not a valid scan"
        )
    limits = body.need("range")
    range_min, range_max = limits.number("min", 0.0), limits.positive("max")
    if not 0 <= range_min < range_max:
        raise limits.error(
            f"min {range_min:g} and max {range_max:g} m are not a valid range"
        )
    return LidarSensor(
        **common,
        rate_hz=_rate(node, 10.0),
        samples=samples,
        angle_min=angle_min,
        angle_max=angle_max,
        range_min=range_min,
        range_max=range_max,
        noise_stddev=_stddev(body),
        sees_visuals=kind != "ray",
    )


def _camera(node: XmlNode, common: _Common, unsupported: Unsupported) -> CameraSensor:
    body = node.need("camera")
    image, clip = body.find("image"), body.find("clip")
    width = round(image.positive("width", 320.0)) if image else 320
    height = round(image.positive("height", 240.0)) if image else 240
    if width * height > MAX_PIXELS:
        raise body.error(f"{width} x {height} pixels; at most {MAX_PIXELS}")
    fov = body.positive("horizontal_fov", 1.047)
    if fov >= math.pi:
        raise body.error(
            f"<horizontal_fov> is {fov:g}; a pinhole camera requires less than pi"
        )
    if _stddev(body) > 0:
        unsupported.note("noise of a camera", body)
    return CameraSensor(
        **common,
        rate_hz=_rate(node, 30.0),
        width=width,
        height=height,
        horizontal_fov=fov,
        near=clip.positive("near", 0.1) if clip else 0.1,
        far=clip.positive("far", 100.0) if clip else 100.0,
    )


def _imu(node: XmlNode, common: _Common) -> ImuSensor:
    return ImuSensor(
        **common,
        rate_hz=_rate(node, 100.0),
        acceleration_stddev=_stddev(node.find("imu", "linear_acceleration", "x")),
        angular_velocity_stddev=_stddev(node.find("imu", "angular_velocity", "x")),
    )


def _stddev(node: XmlNode | None) -> float:
    noise = node.find("noise") if node is not None else None
    if noise is None:
        return 0.0
    stddev = noise.number("stddev", 0.0)
    if stddev < 0:
        raise noise.error(f"<stddev> is {stddev:g}; must be >= 0")
    return stddev


_DRIVES = {
    "ackermann": ("ackermannsteering", "ackermann-steering", "ackermann_drive"),
    "mecanum": ("mecanumdrive", "mecanum-drive", "mecanum_drive"),
    "diff": (
        *("diffdrive", "diff-drive", "diff_drive"),
        *("skid_steer", "skidsteer"),
    ),
}


def find_drive(
    plugins: Iterable[XmlNode], unsupported: Unsupported
) -> DiffDrive | None:
    """Read the first drive; note plugins that have no counterpart in Navette."""
    drive = None
    for plugin in plugins:
        if _is_drive(plugin):
            drive = drive or read_drive(plugin)
        else:
            note_plugin(plugin, unsupported)
    return drive


def note_plugin(plugin: XmlNode, unsupported: Unsupported) -> None:
    if not _is_replaced(plugin):
        name = plugin.attributes.get("name") or plugin.attributes.get("filename", "")
        unsupported.note(f"plugin {name!r}", plugin)


def _is_drive(plugin: XmlNode) -> bool:
    text = _plugin_name(plugin)
    return any(key in text for kind in _DRIVES.values() for key in kind)


def _is_replaced(plugin: XmlNode) -> bool:
    text = _plugin_name(plugin).rpartition("::")[2]
    return text in _REPLACED or any(key in _plugin_name(plugin) for key in _REPLACED)


def _plugin_name(plugin: XmlNode) -> str:
    a = plugin.attributes
    return f"{a.get('filename', '')} {a.get('name', '')}".lower()


def read_drive(plugin: XmlNode) -> DiffDrive:
    """Read the plugin of a drive: wheel joints, geometry and limits.

    Gazebo's differential, skid-steer, AckermannSteering and MecanumDrive plugins.
    """
    text = _plugin_name(plugin)
    if any(key in text for key in _DRIVES["mecanum"]):
        return _read_mecanum(plugin)
    drive = _read_wheels(plugin)
    if any(key in text for key in _DRIVES["ackermann"]):
        return _read_ackermann(plugin, drive)
    return drive


def _read_ackermann(plugin: XmlNode, drive: DiffDrive) -> AckermannDrive:
    left = _joints(plugin, "left_steering")
    right = _joints(plugin, "right_steering")
    base = _first(plugin, ("wheel_base", "wheelbase"))
    limit = _first(plugin, ("steering_limit",))
    if len(left) != 1 or len(right) != 1:
        raise plugin.error(
            "Ackermann steering needs one <left_steering_joint> and one "
            "<right_steering_joint>"
        )
    if base is None or limit is None or base <= 0 or not 0 < limit < 1.5:
        raise plugin.error("<wheel_base> must be > 0, <steering_limit> 0 … 1.5 rad")
    if len(drive.left_joints) != 1 or len(drive.right_joints) != 1:
        raise plugin.error(
            "Ackermann steering needs one <left_joint> and one <right_joint>: the "
            "driven wheels at the rear"
        )
    return AckermannDrive(
        **_fields(drive),
        left_steering=left[0],
        right_steering=right[0],
        wheel_base=base,
        kingpin_width=_first(plugin, ("kingpin_width",)) or drive.wheel_separation,
        steering_limit=limit,
    )


def _read_mecanum(plugin: XmlNode) -> MecanumDrive:
    names = [
        _joints(plugin, f"{end}_{side}")
        for side in ("left", "right")
        for end in ("front", "back")
    ]
    if any(len(each) != 1 for each in names):
        raise plugin.error(
            "a mecanum drive needs <front_left_joint>, <front_right_joint>, "
            "<back_left_joint> and <back_right_joint>"
        )
    front_left, back_left, front_right, back_right = (each[0] for each in names)
    track = _first(plugin, ("wheel_separation",))
    base = _first(plugin, ("wheelbase", "wheel_base"))
    radius = _first(plugin, ("wheel_radius",))
    if not (track and base and radius) or min(track, base, radius) <= 0:
        raise plugin.error(
            "<wheel_separation>, <wheelbase> and <wheel_radius> must be > 0"
        )
    return MecanumDrive(
        left_joints=(front_left, back_left),
        right_joints=(front_right, back_right),
        wheel_separation=track + base,
        wheel_radius=radius,
        limits=_limits(plugin),
    )


def _fields(drive: DiffDrive) -> dict[str, Any]:
    return {each.name: getattr(drive, each.name) for each in fields(drive)}


def _read_wheels(plugin: XmlNode) -> DiffDrive:
    left = _joints(plugin, "left")
    right = _joints(plugin, "right")
    if not left or not right:
        raise plugin.error("a drive needs <left_joint> and <right_joint>")
    separation = _first(plugin, ("wheel_separation", "wheelSeparation"))
    radius = _first(plugin, ("wheel_radius",))
    diameter = _first(plugin, ("wheel_diameter", "wheelDiameter"))
    if radius is None and diameter is not None:
        radius = diameter / 2
    if separation is None or radius is None or min(separation, radius) <= 0:
        raise plugin.error("wheel separation and radius must be > 0")
    multiplier = _first(plugin, ("wheel_separation_multiplier",)) or 1.0
    return DiffDrive(
        left_joints=left,
        right_joints=right,
        wheel_separation=separation * multiplier,
        wheel_radius=radius,
        limits=_limits(plugin),
        max_wheel_torque=_first(plugin, ("max_wheel_torque", "wheelTorque", "torque")),
    )


def _joints(plugin: XmlNode, side: str) -> tuple[str, ...]:
    tags = (
        f"{side}_joint",
        f"{side}Joint",
        f"{side}FrontJoint",
        f"{side}RearJoint",
        f"{side}_front_joint",
        f"{side}_rear_joint",
    )
    return tuple(c.text.strip() for c in plugin.children if c.tag in tags)


def _first(plugin: XmlNode, tags: tuple[str, ...]) -> float | None:
    for tag in tags:
        if plugin.find(tag) is not None:
            return plugin.number(tag)
    return None


def _limits(plugin: XmlNode) -> SpeedLimits:
    """Read positive limits; gz has signed minima, and infinity means no limit."""

    def positive(*tags: str) -> float | None:
        value = _first(plugin, tags)
        return abs(value) if value else None

    return SpeedLimits(
        speed=positive("max_linear_velocity", "max_velocity"),
        reverse_speed=positive("min_linear_velocity", "min_velocity"),
        yaw_rate=positive("max_angular_velocity"),
        acceleration=positive("max_linear_acceleration", "max_acceleration"),
        yaw_acceleration=positive("max_angular_acceleration"),
    )
