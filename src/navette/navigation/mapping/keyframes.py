"""Fused costmaps, kept to be placed again when the trajectory is corrected.

A loop closure of SLAM moves where the robot has been. The map is then rebuilt from the
costmaps at their corrected poses, so that no wall stays twice.
"""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import replace

from navette.geometry import Pose2, angle_difference
from navette.navigation.mapping.memory import PlacedCostmap

# A costmap near the one before shows nothing new that has to be kept.
_APART_M, _APART_RAD = 0.4, 0.4
# Beyond this number every second costmap is dropped.
_MOST = 400
# Motion of a costmap below which the map is kept.
_MOVED_M, _MOVED_RAD = 0.04, 0.015

# Poses of the odometry between those of the trajectory, before these are dropped.
_MOST_BETWEEN = 1000

Trajectory = Sequence[tuple[int, Pose2]]
"""Stamps (ns), ascending, with map_T_base."""


class Keyframes:
    """Placed costmaps with the poses of the odometry at their stamps."""

    def __init__(self) -> None:
        self._kept: list[tuple[PlacedCostmap, Pose2]] = []
        self._trace: list[tuple[int, Pose2]] = []  # odom_T_base of all costmaps

    def clear(self) -> None:
        """Forget all costmaps."""
        self._kept.clear()
        self._trace.clear()

    def trace(self, stamp_ns: int, odom_T_base: Pose2) -> None:
        """Store the pose of the odometry at the stamp of a costmap."""
        if self._trace and stamp_ns <= self._trace[-1][0]:
            self.clear()  # time jumped backward
        self._trace.append((stamp_ns, odom_T_base))

    def add(self, costmap: PlacedCostmap, odom_T_base: Pose2) -> None:
        """Keep a fused costmap, unless it is near the newest one."""
        if self._kept:
            before = self._kept[-1][1]
            turned = abs(angle_difference(before.yaw, odom_T_base.yaw))
            if before.distance_to(odom_T_base) < _APART_M and turned < _APART_RAD:
                return
        self._kept.append((costmap, odom_T_base))
        if len(self._kept) > _MOST:
            del self._kept[1:-1:2]

    def correct(self, trajectory: Trajectory) -> list[PlacedCostmap]:
        """Place the costmaps along a trajectory; return them if any of them moved."""
        if not trajectory or not self._kept:
            return []
        stamps = [stamp_ns for stamp_ns, _ in trajectory]
        corrected, moved = [], False
        for costmap, odom_T_base in self._kept:
            index = max(0, bisect_right(stamps, costmap.stamp_ns) - 1)
            stamp_ns, map_T_node = trajectory[index]
            pose = map_T_node @ self._odometry_at(stamp_ns).inverse() @ odom_T_base
            turned = abs(angle_difference(pose.yaw, costmap.map_T_base.yaw))
            away = pose.distance_to(costmap.map_T_base)
            moved |= away > _MOVED_M or turned > _MOVED_RAD
            corrected.append((replaced(costmap, pose), odom_T_base))
        self._thin_trace(stamps)
        if not moved:
            return []
        self._kept = corrected
        return [costmap for costmap, _ in corrected]

    def _thin_trace(self, stamps: list[int]) -> None:
        """Keep the poses around the stamps of a trajectory, and the newest ones.

        A trajectory keeps its stamps; between two, no pose is asked for again.
        """
        if len(self._trace) < _MOST_BETWEEN + 2 * len(stamps):
            return
        after = [bisect_right(self._trace, each, key=_stamp_of) for each in stamps]
        needed = {at for k in after for at in (k - 1, k)}
        newest = range(after[-1], len(self._trace))
        chosen = sorted(needed.union(newest) & {*range(len(self._trace))})
        self._trace = [self._trace[at] for at in chosen]

    def _odometry_at(self, stamp_ns: int) -> Pose2:
        """Return odom_T_base at a stamp, interpolated."""
        index = bisect_right(self._trace, stamp_ns, key=_stamp_of)
        if index == 0:
            return self._trace[0][1]
        before_ns, before = self._trace[index - 1]
        if index == len(self._trace):
            return before
        after_ns, after = self._trace[index]
        share = (stamp_ns - before_ns) / (after_ns - before_ns)
        return before.interpolate(after, share)


def _stamp_of(traced: tuple[int, Pose2]) -> int:
    return traced[0]


def replaced(costmap: PlacedCostmap, map_T_base: Pose2) -> PlacedCostmap:
    """Return a costmap placed for another pose of the robot at its stamp."""
    new_T_old = map_T_base @ costmap.map_T_base.inverse()
    sensor = new_T_old @ Pose2(*costmap.sensor, 0.0)
    spec = replace(costmap.spec, origin=new_T_old @ costmap.spec.origin)
    hits = None if costmap.hits is None else new_T_old.apply(costmap.hits)
    return replace(
        costmap,
        spec=spec,
        sensor=(sensor.x, sensor.y),
        map_T_base=map_T_base,
        hits=hits,
    )
