# SPDX-License-Identifier: Apache-2.0
"""SDF drive plugins (Gazebo classic, Ignition, gz)."""

from collections.abc import Iterable, Sequence
from dataclasses import fields, replace
from typing import Any

from navette.sim.scene import (
    AckermannDrive,
    DiffDrive,
    Joint,
    MecanumDrive,
    SpeedLimits,
)
from navette.sim.xml_tree import Unsupported, XmlNode

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


_DRIVES = {
    "ackermann": ("ackermannsteering", "ackermann-steering", "ackermann_drive"),
    "mecanum": ("mecanumdrive", "mecanum-drive", "mecanum_drive"),
    "diff": (
        *("diffdrive", "diff-drive", "diff_drive"),
        *("skid_steer", "skidsteer"),
    ),
}


def find_drive(
    plugins: Iterable[XmlNode], joints: Sequence[Joint], unsupported: Unsupported
) -> DiffDrive | None:
    """Read the first drive; note plugins that have no counterpart in Navette."""
    drive = None
    for plugin in plugins:
        if _is_drive(plugin):
            drive = drive or _read_drive(plugin, joints, unsupported)
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


def _read_drive(
    plugin: XmlNode, joints: Sequence[Joint], unsupported: Unsupported
) -> DiffDrive:
    """Read the plugin of a drive: wheel joints, geometry and limits.

    Gazebo's differential, skid-steer, AckermannSteering and MecanumDrive plugins.
    """
    text = _plugin_name(plugin)
    if any(key in text for key in _DRIVES["mecanum"]):
        return _read_mecanum(plugin)
    drive = _read_wheels(plugin)
    if any(key in text for key in _DRIVES["ackermann"]):
        unsteered = _without_steered(plugin, drive, joints, unsupported)
        return _read_ackermann(plugin, unsteered)
    return drive


def _without_steered(
    plugin: XmlNode, drive: DiffDrive, joints: Sequence[Joint], unsupported: Unsupported
) -> DiffDrive:
    """Leave out driven wheels that are steered; these roll freely.

    Gazebo's own examples name the front wheels beside the rear ones. Gazebo turns both
    at one speed, at which the front wheels, on wider circles, would slip.
    """
    names = _joints(plugin, "left_steering") + _joints(plugin, "right_steering")
    hubs = {joint.child for joint in joints if joint.name in names}
    steered = {joint.name for joint in joints if joint.parent in hubs}
    left = tuple(name for name in drive.left_joints if name not in steered)
    right = tuple(name for name in drive.right_joints if name not in steered)
    if (left, right) != (drive.left_joints, drive.right_joints):
        unsupported.note("drive of steered wheels (they roll freely)", plugin)
    return replace(drive, left_joints=left, right_joints=right)


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
            "Ackermann steering needs one <left_joint> and one <right_joint> of wheels "
            "that are not steered, at the rear; steered ones beside them roll freely"
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
