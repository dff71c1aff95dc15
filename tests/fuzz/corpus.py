"""Every input that once ended a program, made by this script.

``python tests/fuzz/corpus.py FOLDER`` writes them as files: messages as CDR, models and
worlds as XML. To add one, write a function that returns a message (``MESSAGES``) or
writes a file into a folder and returns its path (``FILES``), and add it to the list;
a test beside this file uses the list.
"""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from fuzz import models
from navette.msgs import Message, serialize
from navette.msgs.geometry_msgs.msg import (
    PointStamped,
    PoseStamped,
    TransformStamped,
    Twist,
)
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.nav_msgs.msg import Path as PathMsg
from navette.msgs.rosgraph_msgs.msg import Clock
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.tf2_msgs.msg import TFMessage


class HostileMessage(NamedTuple):
    """A message, its topic, and the reason with which a stage drops it."""

    name: str
    topic: str
    message: Message
    #: Node and reason; None: the message has a status of its own, or no effect.
    dropped_by: tuple[str, str] | None = None


def _far_point() -> PointStamped:
    msg = PointStamped()
    msg.point.x = 1e308
    return msg


def _far_pose() -> PoseStamped:
    msg = PoseStamped()
    msg.pose.position.x = 1e308
    return msg


def _scan(**fields: Any) -> LaserScan:
    usual = {"ranges": [1.0] * 8, "angle_increment": 0.1, "range_max": 10.0}
    return LaserScan(**{**usual, **fields})


def _late_scan() -> LaserScan:
    msg = _scan()
    msg.header.stamp.sec, msg.header.stamp.nanosec = 2**31 - 1, 2**32 - 1
    return msg


def _grid(width: int, height: int, cells: int) -> OccupancyGrid:
    msg = OccupancyGrid(data=[0] * cells)
    msg.info.width, msg.info.height, msg.info.resolution = width, height, 0.1
    return msg


def _odometry(x: float) -> Odometry:
    msg = Odometry()
    msg.header.frame_id, msg.child_frame_id = "map", "base_link"
    msg.pose.pose.position.x = x
    return msg


def _path(w: float) -> PathMsg:
    pose = PoseStamped()
    pose.pose.orientation.w = w
    return PathMsg(poses=[pose])


def _command(speed: float) -> Twist:
    msg = Twist()
    msg.linear.x = speed
    return msg


def _transform() -> TFMessage:
    transform = TransformStamped(child_frame_id="base_link")
    transform.header.frame_id = "map"
    transform.transform.translation.x = 1e308
    return TFMessage(transforms=[transform])


def _clock() -> Clock:
    msg = Clock()
    msg.clock.sec, msg.clock.nanosec = -(2**31), 2**32 - 1
    return msg


MESSAGES = (
    HostileMessage("far_goal_point", "/goal_point", _far_point()),
    HostileMessage("far_goal_pose", "/goal_pose", _far_pose()),
    HostileMessage("late_scan", "/lidar", _late_scan(), ("costmap", "invalid_stamp")),
    HostileMessage(
        "empty_scan", "/lidar", _scan(ranges=[]), ("costmap", "wrong_length")
    ),
    HostileMessage(
        "large_scan",
        "/lidar",
        _scan(ranges=[1.0] * 200_000),
        ("costmap", "wrong_length"),
    ),
    HostileMessage(
        "huge_map", "/map", _grid(2**32 - 1, 2**32 - 1, 4), ("planner", "wrong_length")
    ),
    HostileMessage(
        "short_costmap", "/costmap", _grid(9, 9, 80), ("map_memory", "wrong_length")
    ),
    HostileMessage(
        "far_odometry",
        "/odom/filtered",
        _odometry(1e308),
        ("control", "out_of_range"),
    ),
    HostileMessage(
        "odometry_nan",
        "/odom/filtered",
        _odometry(float("nan")),
        ("planner", "not_finite"),
    ),
    HostileMessage(
        "zero_quaternion", "/path", _path(0.0), ("control", "invalid_orientation")
    ),
    HostileMessage(
        "command_inf", "/cmd_vel", _command(float("inf")), ("sim", "not_finite")
    ),
    HostileMessage(
        "far_transform", "/tf_static", _transform(), ("control", "out_of_range")
    ),
    HostileMessage("negative_clock", "/clock", _clock()),
)

FILES: tuple[Callable[[Path], Path], ...] = (*models.WORLDS, *models.ROBOTS)


def write(folder: Path) -> int:
    """Write all inputs into a folder; return their number."""
    folder.mkdir(parents=True, exist_ok=True)
    for each in MESSAGES:
        data = serialize(each.message)
        (folder / f"{each.name}.cdr").write_bytes(data)
    for make in FILES:
        own = folder / make.__name__
        own.mkdir(exist_ok=True)
        make(own)
    return len(MESSAGES) + len(FILES)


if __name__ == "__main__":
    target = Path(sys.argv[1])
    sys.stdout.write(f"{write(target)} inputs in {target}\n")
