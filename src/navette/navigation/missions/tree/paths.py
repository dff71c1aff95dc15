"""Lengths and parts of nav_msgs paths, and goals near the robot."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from navette.geometry import Pose2, angle_difference, yaw_of
from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.msgs.nav_msgs.msg import Path


def distance_of(a: Pose2, b: Pose2) -> float:
    """Return the distance of two positions, m."""
    return math.dist((a.x, a.y), (b.x, b.y))


def point_of(pose: PoseStamped) -> tuple[float, float]:
    return pose.pose.position.x, pose.pose.position.y


def path_length_m(path: Path, first: int = 0) -> float:
    """Return the length from a pose of the path to its end, m."""
    points = [point_of(pose) for pose in path.poses[first:]]
    return sum(map(math.dist, points[:-1], points[1:]))


def nearest_index(path: Path, x: float, y: float) -> int:
    """Return the index of the pose nearest to a point; the path is not empty."""
    distances = [math.dist(point_of(pose), (x, y)) for pose in path.poses]
    return distances.index(min(distances))


@dataclass(frozen=True)
class TrackingError:
    """How far the robot is off its path; fields of nav2_msgs/TrackingFeedback.

    Attributes:
        position_tracking_error: m from the nearest pose, positive to its left.
        heading_tracking_error: rad from the path's direction to the robot's, in
            [-pi, pi].
    """

    position_tracking_error: float
    heading_tracking_error: float


def tracking_error(path: Path, pose: Pose2) -> TrackingError:
    """Return the error at the nearest pose of a path that is not empty."""
    nearest = path.poses[nearest_index(path, pose.x, pose.y)].pose
    q = nearest.orientation
    yaw = yaw_of((q.x, q.y, q.z, q.w))
    dx, dy = pose.x - nearest.position.x, pose.y - nearest.position.y
    left = dy * math.cos(yaw) - dx * math.sin(yaw)
    return TrackingError(
        math.copysign(math.hypot(dx, dy), left), angle_difference(pose.yaw, yaw)
    )


def truncated(path: Path, distance_m: float) -> Path:
    """Return the path without its last ``distance_m``."""
    left = 0.0
    for index in range(len(path.poses) - 1, 0, -1):
        left += math.dist(point_of(path.poses[index]), point_of(path.poses[index - 1]))
        if left >= distance_m:
            return Path(header=path.header, poses=list(path.poses[:index]))
    return Path(header=path.header, poses=list(path.poses[:1]))


def around(path: Path, pose: Pose2, *, ahead_m: float, behind_m: float) -> Path:
    """Return the part of the path around the pose nearest to the robot."""
    if not path.poses:
        return path
    here = nearest_index(path, pose.x, pose.y)
    first, last = here, here
    length = 0.0
    while first > 0 and length < behind_m:
        length += math.dist(
            point_of(path.poses[first]), point_of(path.poses[first - 1])
        )
        first -= 1
    length = 0.0
    while last < len(path.poses) - 1 and (length < ahead_m or ahead_m < 0):
        length += math.dist(point_of(path.poses[last]), point_of(path.poses[last + 1]))
        last += 1
    return Path(header=path.header, poses=list(path.poses[first : last + 1]))


def without_passed(
    goals: Sequence[PoseStamped], pose: Pose2, radius_m: float
) -> list[PoseStamped]:
    """Return the goals from the first one on that is not within the radius.

    The last goal stays: the robot has to arrive there.
    """
    left = list(goals)
    while len(left) > 1 and math.dist(point_of(left[0]), (pose.x, pose.y)) <= radius_m:
        left.pop(0)
    return left
