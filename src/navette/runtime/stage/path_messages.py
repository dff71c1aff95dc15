"""Conversion of poses and paths from and to messages."""

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, quaternion_from_yaw, yaw_of
from navette.msgs import copy_message
from navette.msgs.geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from navette.msgs.nav_msgs.msg import Path
from navette.msgs.std_msgs.msg import Header
from navette.runtime.time import ns_to_stamp

Poses = NDArray[np.float64]


def pose_of(msg: Pose) -> Pose2:
    """Return x, y and heading of a pose."""
    q = msg.orientation
    return Pose2(msg.position.x, msg.position.y, yaw_of((q.x, q.y, q.z, q.w)))


def has_heading(msg: Pose) -> bool:
    """Return whether the orientation is given; zeros mean any heading."""
    q = msg.orientation
    return any((q.x, q.y, q.z, q.w))


def poses_of(msg: Path) -> Poses:
    """Return poses (N, 3) x, y, yaw of a path, in the path's frame."""
    rows = []
    for stamped in msg.poses:  # without pose_of: half the time
        pose = stamped.pose
        position, q = pose.position, pose.orientation
        rows.append((position.x, position.y, yaw_of((q.x, q.y, q.z, q.w))))
    return np.array(rows, np.float64).reshape(-1, 3)


def pose_message(pose: Pose2) -> Pose:
    """Return a pose with z = 0."""
    x, y, z, w = quaternion_from_yaw(pose.yaw)
    return Pose(
        position=Point(x=float(pose.x), y=float(pose.y)),
        orientation=Quaternion(x=x, y=y, z=z, w=w),
    )


def path_message(poses: Poses, frame_id: str, stamp_ns: int) -> Path:
    """Return poses (N, 3) x, y, yaw as a message with z = 0."""
    header = Header(stamp=ns_to_stamp(stamp_ns), frame_id=frame_id)
    blank, stamped = Pose(), []
    for x, y, yaw in poses.tolist():
        pose = copy_message(blank)  # takes less time than to construct each
        position, q = pose.position, pose.orientation
        position.x, position.y = x, y
        q.x, q.y, q.z, q.w = quaternion_from_yaw(yaw)
        stamped.append(PoseStamped(header=header, pose=pose))
    return Path(header=header, poses=stamped)


def moved(poses: Poses, map_T_frame: Pose2) -> Poses:
    """Return poses (N, 3) of a frame in the map frame."""
    points = map_T_frame.apply(poses[:, :2])
    return np.column_stack([points, poses[:, 2] + map_T_frame.yaw])
