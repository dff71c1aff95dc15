"""A synthetic office with loops: scans, true poses, odometry that drifts, and bags."""

import math
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.bags import BagWriter
from navette.geometry import Pose2, angle_difference, quaternion_from_yaw
from navette.msgs import definition_text, serialize
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.geometry_msgs.msg import Quaternion as QuaternionMsg
from navette.msgs.geometry_msgs.msg import Transform, TransformStamped, Vector3
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.std_msgs.msg import Header
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.navigation.grids import PlanarScan

Segments = NDArray[np.float64]
"""(N, 4) x1, y1, x2, y2, m."""

PERIOD_NS = 200_000_000
RANGE_M = 12.0


def box(x: float, y: float, width: float, height: float) -> list[tuple[float, ...]]:
    """Return the four walls of a box with its lower left corner at (x, y)."""
    a, b = x + width, y + height
    return [(x, y, a, y), (a, y, a, b), (a, b, x, b), (x, b, x, y)]


def office() -> Segments:
    """Return a corridor around a block, 16 m x 12 m, with niches and furniture."""
    walls = box(0.0, 0.0, 16.0, 12.0) + box(3.0, 3.0, 10.0, 6.0)
    for at in ((0.0, 5.0), (15.0, 4.0), (7.0, 0.0), (10.0, 11.3), (1.8, 11.0)):
        walls += box(*at, 0.9, 0.7)
    walls += box(4.0, 1.9, 0.4, 0.5) + box(15.3, 8.7, 0.3, 0.3)
    return np.array(walls)


def ray_cast(
    walls: Segments, pose: Pose2, angles: NDArray[np.float64], range_m: float = RANGE_M
) -> NDArray[np.float64]:
    """Return the distance (N,) to the first wall along each beam, or infinity."""
    directions = np.column_stack([np.cos(pose.yaw + angles), np.sin(pose.yaw + angles)])
    start = walls[:, :2] - (pose.x, pose.y)
    along = walls[:, 2:] - walls[:, :2]
    cross = directions[:, 0:1] * along[:, 1] - directions[:, 1:2] * along[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (start[:, 0] * along[:, 1] - start[:, 1] * along[:, 0]) / cross
        u = (
            start[:, 0] * directions[:, 1:2] - start[:, 1] * directions[:, 0:1]
        ) / cross
    t = np.where((u >= 0.0) & (u <= 1.0) & (t > 0.0), t, np.inf).min(axis=1)
    return np.where(t < range_m, t, np.inf)


def scan_at(
    walls: Segments,
    pose: Pose2,
    *,
    beams: int = 360,
    fov: float = math.tau,
    noise: np.random.Generator | None = None,
    stddev_m: float = 0.01,
    range_m: float = RANGE_M,
) -> PlanarScan:
    """Return the scan of a sensor at ``pose``."""
    increment = fov / beams
    angles = -fov / 2 + increment * np.arange(beams)
    ranges = ray_cast(walls, pose, angles, range_m)
    if noise is not None:
        ranges = ranges + stddev_m * noise.normal(size=beams)
    return PlanarScan(ranges.astype(np.float32), -fov / 2, increment, 0.05, range_m)


class Step(NamedTuple):
    """A scan of a drive."""

    stamp_ns: int
    scan: PlanarScan
    odom_T_base: Pose2
    truth: Pose2


def loop(step_m: float = 0.1) -> list[Pose2]:
    """Return poses once around the block and a little further, from (1.5, 1.5)."""
    corners = [
        (1.5, 1.5),
        (14.3, 1.4),
        (14.5, 10.4),
        (1.4, 10.5),
        (1.5, 1.5),
        (6.0, 1.4),
    ]
    poses = [Pose2(*corners[0], 0.0)]
    for (x1, y1), (x2, y2) in pairwise(corners):
        heading = math.atan2(y2 - y1, x2 - x1)
        while abs(turn := angle_difference(heading, poses[-1].yaw)) > 1e-6:
            x, y, yaw = poses[-1]
            poses.append(Pose2(x, y, yaw + max(-0.2, min(0.2, turn))))
        steps = round(math.hypot(x2 - x1, y2 - y1) / step_m)
        for k in range(1, steps + 1):
            share = k / steps
            poses.append(Pose2(x1 + share * (x2 - x1), y1 + share * (y2 - y1), heading))
    return poses


def drive(
    seed: int = 0,
    *,
    poses: list[Pose2] | None = None,
    beams: int = 360,
    fov: float = math.tau,
    noise: float = 0.05,
    yaw_per_m: float = 0.01,
) -> Iterator[Step]:
    """Yield the scans of a drive with odometry whose error grows."""
    rng = np.random.default_rng(seed)
    walls = office()
    scale, bias = 1 + noise * rng.normal(), yaw_per_m * rng.normal()
    odometry, before = Pose2(0.0, 0.0, 0.0), None
    for k, pose in enumerate(poses if poses is not None else loop()):
        if before is not None:
            x, y, turn = before.inverse() @ pose
            length = scale * (1 + noise * rng.normal())
            turn *= 1 + noise * rng.normal()
            turn += math.hypot(x, y) * (bias + yaw_per_m * rng.normal())
            odometry = odometry @ Pose2(x * length, y * length, turn)
        before = pose
        scan = scan_at(walls, pose, beams=beams, fov=fov, noise=rng)
        yield Step(1_000_000_000 + k * PERIOD_NS, scan, odometry, pose)


def errors_m(estimates: list[Pose2], truths: list[Pose2]) -> NDArray[np.float64]:
    """Return the distances (N,) after the best rigid alignment (Umeyama 1991)."""
    a = np.array([pose[:2] for pose in estimates])
    b = np.array([pose[:2] for pose in truths])
    u, _, v = np.linalg.svd((a - a.mean(axis=0)).T @ (b - b.mean(axis=0)))
    flip = np.diag([1.0, np.sign(np.linalg.det(u @ v))])
    rotation = u @ flip @ v
    moved = (a - a.mean(axis=0)) @ rotation + b.mean(axis=0)
    away: NDArray[np.float64] = np.linalg.norm(moved - b, axis=1)
    return away


def write_bag(path: Path, steps: Iterator[Step]) -> None:
    """Write /scan and /tf (odom → base_link → laser) of a drive."""
    writer = BagWriter(path)
    channels = {
        name: writer.add_channel(name, kind, definition_text(kind))
        for name, kind in (
            ("/scan", "sensor_msgs/msg/LaserScan"),
            ("/tf", "tf2_msgs/msg/TFMessage"),
        )
    }
    for step in steps:
        transforms = TFMessage(
            transforms=[
                _transform(step.stamp_ns, "odom", "base_link", step.odom_T_base),
                _transform(step.stamp_ns, "base_link", "laser", Pose2(0.0, 0.0, 0.0)),
            ]
        )
        scan = LaserScan(
            header=_header(step.stamp_ns, "laser"),
            angle_min=step.scan.angle_min,
            angle_max=step.scan.angle_min
            + step.scan.angle_increment * (len(step.scan.ranges) - 1),
            angle_increment=step.scan.angle_increment,
            range_min=step.scan.range_min,
            range_max=step.scan.range_max,
            ranges=step.scan.ranges,
        )
        for name, message in (("/tf", transforms), ("/scan", scan)):
            writer.write(channels[name], step.stamp_ns, serialize(message))
    writer.close()


def _header(stamp_ns: int, frame_id: str) -> Header:
    stamp = Time(sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    return Header(stamp=stamp, frame_id=frame_id)


def _transform(stamp_ns: int, parent: str, child: str, pose: Pose2) -> Any:
    x, y, z, w = quaternion_from_yaw(pose.yaw)
    return TransformStamped(
        header=_header(stamp_ns, parent),
        child_frame_id=child,
        transform=Transform(
            translation=Vector3(x=pose.x, y=pose.y),
            rotation=QuaternionMsg(x=x, y=y, z=z, w=w),
        ),
    )
