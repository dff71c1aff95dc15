"""Programs of tf2_ros: ``static_transform_publisher`` and ``tf2_echo``."""

import sys
from argparse import ArgumentParser
from collections.abc import Sequence

from navette.cli.ros_program import ros_program
from navette.geometry.se3 import quaternion_from_rpy
from navette.msgs.geometry_msgs.msg import (
    Quaternion,
    Transform,
    TransformStamped,
    Vector3,
)
from navette.runtime import Node, SingleThreadedExecutor, Time, remove_ros_args
from navette.runtime.tf import (
    Buffer,
    StaticTransformBroadcaster,
    TransformException,
    TransformListener,
)

_XYZ, _RPY, _XYZW = ("x", "y", "z"), ("roll", "pitch", "yaw"), ("qx", "qy", "qz", "qw")


def static_transform_publisher() -> None:
    """Publish a fixed transform, latched, until the program is interrupted."""
    transform = read_static_transform(remove_ros_args(sys.argv)[1:])
    with ros_program():
        node = Node(f"static_transform_publisher_{_node_suffix(transform)}")
        transform.header.stamp = node.get_clock().now().to_msg()
        broadcaster = StaticTransformBroadcaster(node)
        broadcaster.sendTransform(transform)
        node.get_logger().info(
            f"publishing the transform from {transform.header.frame_id!r} to "
            f"{transform.child_frame_id!r} until stopped: {_described(transform)}"
        )
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        executor.spin()


def _node_suffix(transform: TransformStamped) -> str:
    words = f"{transform.header.frame_id}_{transform.child_frame_id}"
    return "".join(each if each.isalnum() else "_" for each in words)


def read_static_transform(words: Sequence[str]) -> TransformStamped:
    """Return the transform of a command line.

    ``--x 1 --yaw 0.5 --frame-id map --child-frame-id odom``, or the old form
    ``x y z yaw pitch roll frame_id child_frame_id`` (or ``x y z qx qy qz qw …``).
    """
    if len(words) in (8, 9) and not any(word.startswith("--") for word in words):
        *numbers, parent, child = words
        rest = ("yaw", "pitch", "roll") if len(numbers) == 6 else _XYZW
        options = [
            f"--{key}={n}" for key, n in zip((*_XYZ, *rest), numbers, strict=True)
        ]
        words = [*options, "--frame-id", parent, "--child-frame-id", child]
    parser = ArgumentParser(prog="static_transform_publisher")
    for name in (*_XYZ, *_RPY, *_XYZW):
        parser.add_argument(f"--{name}", type=float)
    parser.add_argument("--frame-id", required=True)
    parser.add_argument("--child-frame-id", required=True)
    given = parser.parse_args(words)
    values = {key: value for key, value in vars(given).items() if value is not None}
    if any(key in values for key in _RPY) and any(key in values for key in _XYZW):
        parser.error("give roll, pitch and yaw, or the quaternion, not both")
    x, y, z = (values.get(key, 0.0) for key in _XYZ)
    transform = TransformStamped(child_frame_id=given.child_frame_id)
    transform.header.frame_id = given.frame_id
    transform.transform = Transform(
        translation=Vector3(x=x, y=y, z=z), rotation=_rotation(values)
    )
    return transform


def _rotation(values: dict[str, float]) -> Quaternion:
    if any(key in values for key in _XYZW):
        qx, qy, qz, qw = (values.get(key, float(key == "qw")) for key in _XYZW)
    else:
        qx, qy, qz, qw = quaternion_from_rpy(*(values.get(key, 0.0) for key in _RPY))
    return Quaternion(x=qx, y=qy, z=qz, w=qw)


def tf2_echo() -> None:
    """Print the transform between two frames, once a second."""
    words = remove_ros_args(sys.argv)[1:]
    parser = ArgumentParser(prog="tf2_echo")
    parser.add_argument("source_frame")
    parser.add_argument("target_frame")
    parser.add_argument("rate", type=float, nargs="?", default=1.0, help="hertz")
    given = parser.parse_args(words)
    with ros_program():
        node = Node("tf2_echo")
        buffer = Buffer(node=node)
        TransformListener(buffer, node)

        def show() -> None:
            try:
                found = buffer.lookup_transform_core(
                    given.source_frame, given.target_frame, Time()
                )
            except TransformException as problem:
                sys.stdout.write(f"{problem}\n")
            else:
                stamp = found.header.stamp
                sys.stdout.write(f"At time {stamp.sec}.{stamp.nanosec:09d}\n")
                sys.stdout.write(f"{_described(found)}\n")
            sys.stdout.flush()

        node.create_timer(1.0 / given.rate, show)
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        executor.spin()


def _described(transform: TransformStamped) -> str:
    place, turn = transform.transform.translation, transform.transform.rotation
    return (
        f"- Translation: [{place.x:.3f}, {place.y:.3f}, {place.z:.3f}]\n"
        f"- Rotation: in Quaternion [{turn.x:.3f}, {turn.y:.3f}, {turn.z:.3f}, "
        f"{turn.w:.3f}]"
    )
