"""Simultaneous localisation and mapping with a planar scanner."""

import math
from collections import deque
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec, PlanarScan
from navette.navigation.slam.global_refinement import refine_all
from navette.navigation.slam.loop_closure import LoopFinder, softened
from navette.navigation.slam.motion import (
    HERE,
    Matrix3,
    MotionModel,
    ScanMotion,
    inverted,
    moved_covariance,
    rotation3,
)
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.pose_graph import GraphEdge, mahalanobis
from navette.navigation.slam.refinement import PosePrior, Refined
from navette.navigation.slam.relocation import locate
from navette.navigation.slam.rendering import MapScan, render
from navette.navigation.slam.scan_graph import KeyScan, ScanGraph
from navette.navigation.slam.scan_points import scan_points
from navette.navigation.slam.tracking import DOUBTFUL, LocalMap, match
from navette.navigation.slam.visibility import SensorView

# Uncertainty of the first pose, which is the map's origin.
_START = np.diag([1e-6, 1e-6, 1e-6])
# Of a pose that a person or a search of the whole map gives.
_PLACED = np.diag([0.3**2, 0.3**2, 0.2**2])
# What the errors that the scans of a local map share add to a match.
_FLOOR = np.diag([0.005**2, 0.005**2, 0.002**2])
# What a contradicting point takes from the evidence of matching ones.
_CONTRADICTING = 3.0
# What another motion must gain where the odometry is doubted.
_GAIN = 0.15
# Standard deviation of a predicted motion beyond which it replaces no odometry, m.
_SURE_M = 0.3
# Newest key scans that are searched for in the map by a robot that is lost.
_SCOUTED = 10
# Squared Mahalanobis distance of a closure from the graph up to which it fits anyway.
_CLOSE = 1.0


class SlamEstimate(NamedTuple):
    """Pose of the robot at the stamp of a scan.

    Attributes:
        map_T_base: the pose.
        covariance: (3, 3) of x, y, m, and yaw, rad, relative to the map's origin.
        is_matched: whether the scan agreed with the map; otherwise the pose is a
            prediction.
        is_corrected: whether earlier poses changed too, after a loop closure.
    """

    map_T_base: Pose2
    covariance: Matrix3
    is_matched: bool
    is_corrected: bool


class _Tracked(NamedTuple):
    """A scan, relative to the key scan before it."""

    stamp_ns: int
    key: int
    key_T_base: Pose2


class Slam:
    """Build a map from scans and localise in it.

    The steps of each scan: predict the motion; match the scan with the newest key
    scans; after enough motion, keep it as a key scan; search for places seen before;
    optimise the pose graph where one is found.

    A robot whose scans contradict the map has been moved: it is searched for in the
    whole map, and what it sees meanwhile is not mapped.

    Args:
        params: noise, distances and limits.
        start: map_T_base at the first scan, roughly if there is a map already; None:
            the whole map is searched for it.
        graph: a map to continue, or to localise in.
        is_mapping: whether the map grows; otherwise the robot is localised in it.
        trajectory_length: number of newest poses that are kept; None: all.
    """

    def __init__(
        self,
        params: SlamParams,
        start: Pose2 | None = HERE,
        *,
        graph: ScanGraph | None = None,
        is_mapping: bool = True,
        trajectory_length: int | None = None,
    ) -> None:
        self.params = params
        self.graph = ScanGraph() if graph is None else graph
        self.is_mapping = is_mapping or not len(self.graph)
        self._known = len(self.graph)
        self._is_located = False
        # Whether the newest scan contradicts the map where the robot should be.
        self._is_contradicted = False
        self._contradicted = 0.0  # share of its points
        # A map of what the robot has seen since its place is unknown.
        self._scout: Slam | None = None
        self._finder = LoopFinder(params)
        self._queried = 0  # newest key scan at the last search for loops
        self._motion = MotionModel(params)
        self._track: deque[_Tracked] = deque(maxlen=trajectory_length)
        # The key scan that the newest poses are relative to.
        self._anchor = 0
        self._start = start
        self._pose = HERE if start is None else start
        # Of the pose, relative to the key scans around it, in the map's axes.
        self._covariance: Matrix3 = _START
        # Of the newest key scan, relative to the map's origin.
        self._key_covariance: Matrix3 = np.zeros((3, 3))
        # Since the newest key scan, without matching.
        self._since_key = ScanMotion(HERE, np.zeros((3, 3)))
        self.unmatched = 0
        self.unmatched_in_a_row = 0

    def add(
        self,
        stamp_ns: int,
        scan: PlanarScan,
        odom_T_base: Pose2 | None = None,
        *,
        base_T_sensor: Pose2 = HERE,
        yaw: float | None = None,
    ) -> SlamEstimate:
        """Use a scan and return the pose at its stamp.

        Args:
            stamp_ns: later than that of the scan before.
            scan: the scan.
            odom_T_base: pose by odometry at the stamp; None: the velocity is constant.
            base_T_sensor: pose of the sensor on the robot.
            yaw: heading by an IMU at the stamp.
        """
        params = self.params
        points = scan_points(
            scan,
            base_T_sensor,
            max_range_m=params.max_range_m,
            spacing_m=params.point_spacing_m,
            max_points=params.max_points,
        )
        key = KeyScan(stamp_ns, scan, base_T_sensor, points)
        motion = self._motion.step(stamp_ns, odom_T_base, yaw)
        if not self._is_located:
            self._begin(key, motion, odom_T_base, yaw)
            return self._estimate(stamp_ns, self._is_located)
        matched = self._locate(key, motion)
        is_corrected = False
        if self._is_contradicted:
            if self.unmatched_in_a_row >= params.lost_scans:
                self._lose()
        elif self._is_far():
            if self.is_mapping:
                self._keep(key, matched)
                is_corrected = self._close_loops()
            else:
                self._rebuild_local_map()
        return self._estimate(stamp_ns, matched is not None, is_corrected)

    def predicted(self, odom_T_base: Pose2 | None) -> SlamEstimate | None:
        """Return the pose by odometry alone; the next scan continues from the last.

        None: without odometry, or before the robot is located.
        """
        if odom_T_base is None or not self._is_located:
            return None
        motion = self._motion.by_odometry(odom_T_base)
        covariance = moved_covariance(
            self._key_covariance + self._covariance, self._pose, motion
        )
        return SlamEstimate(
            self._pose @ motion.pose, covariance, is_matched=False, is_corrected=False
        )

    def emptied(self) -> "Slam":
        """Return a SLAM without a map; its first scan is where the robot is."""
        fresh = Slam(self.params, self._pose, trajectory_length=self._track.maxlen)
        fresh._motion = self._motion
        return fresh

    def place(self, pose: Pose2) -> None:
        """Place the robot in a known map, roughly; the next scan finds it exactly."""
        if self._known:
            self._lose()
            self._start = pose

    def refine(self) -> None:
        """Optimise all poses jointly, at the end of a run or before a map is saved."""
        self.graph.optimise()
        refine_all(self.graph, self.params)
        self._continue_from_graph()

    @property
    def is_map_known(self) -> bool:
        """Whether the robot is located in a map that was there before."""
        return self._known > 0

    @property
    def loop_closures(self) -> int:
        """Number of measurements between key scans that are not neighbours."""
        return sum(each.is_robust for each in self.graph.edges)

    def trajectory(self) -> list[tuple[int, Pose2]]:
        """Return stamp (ns) and map_T_base of each scan kept, as far as known now."""
        return [
            (each.stamp_ns, self.graph.pose(each.key) @ each.key_T_base)
            for each in self._track
        ]

    def occupancy(self) -> tuple[NDArray[np.int8], GridSpec]:
        """Return the map (H, W): −1 unknown, 0 free, 100 lethal; and its geometry."""
        return render(self.placed_scans(), self.params)

    def placed_scans(self) -> list[MapScan]:
        """Return the key scans at their poses in the map."""
        return [
            MapScan(key.scan, self.graph.pose(node) @ key.base_T_sensor)
            for node, key in enumerate(self.graph.keys)
        ]

    def _lose(self) -> None:
        """Search for the robot from now on; all that is mapped is the known map."""
        self._known = len(self.graph)
        self._is_located, self._start, self._scout = False, None, None

    def _begin(
        self, key: KeyScan, motion: ScanMotion, odom: Pose2 | None, yaw: float | None
    ) -> None:
        """Start a map at the first scan, or find the scan in the known map."""
        self._pose = self._pose @ motion.pose
        if not self._known:
            self._is_located = True
            self._keep(key, None)
            return
        if self._start is None:
            start = self._searched(key, odom, yaw)
        else:
            start = self._start = self._start @ motion.pose
        matched = None if start is None else self._placed(key, start)
        if self._start is None and self._is_claimed_too_early(matched):
            matched = None
        if matched is None:
            self._count_unmatched()
            if self.unmatched_in_a_row >= self.params.lost_scans:
                self._start = None  # it was wrong
            return
        self._is_located, self._is_contradicted = True, False
        self._scout, self.unmatched_in_a_row = None, 0
        self._pose = matched.pose
        self._covariance = inverted(inverted(_PLACED) + matched.information)
        if self.is_mapping and len(self.graph) == self._known:
            self._join(key, matched)
        self._rebuild_local_map()

    def _searched(
        self, key: KeyScan, odom: Pose2 | None, yaw: float | None
    ) -> Pose2 | None:
        """Search the whole map for the newest scans, after each new key scan."""
        scout = self._scout
        if scout is None or scout.unmatched_in_a_row:
            scout = self._scout = Slam(self.params, trajectory_length=1)
        before = len(scout.graph)
        found = scout.add(
            key.stamp_ns, key.scan, odom, base_T_sensor=key.base_T_sensor, yaw=yaw
        )
        count = len(scout.graph)
        if count == before:
            return None
        newest = range(max(0, count - _SCOUTED), count)
        points = scout.graph.points(newest, found.map_T_base)
        return locate(self.graph, points, self.params)

    def _placed(self, key: KeyScan, start: Pose2) -> Refined | None:
        """Match a scan with the map around a start pose; None: it does not fit."""
        before = self._pose, self._covariance
        self._pose, self._covariance = start, _PLACED
        self._rebuild_local_map()
        matched = self._matched(key, ScanMotion(HERE, np.zeros((3, 3))))
        self._pose, self._covariance = before
        if matched is None or matched.overlap < DOUBTFUL:
            return None
        return matched

    def _is_claimed_too_early(self, matched: Refined | None) -> bool:
        """Whether a place that a search found may be another one that is not mapped.

        What the map does not explain may be new. What contradicts it, too, but then
        all other points have to fit, or the robot has to see more.
        """
        if matched is None:
            return False
        return matched.overlap - _CONTRADICTING * self._contradicted < DOUBTFUL

    def _join(self, key: KeyScan, matched: Refined) -> None:
        """Connect the first key scan of a session to the known map."""
        near = self._anchor
        there = self.graph.pose(near)
        node = self.graph.insert(key, self._pose, starts_session=True)
        turn = rotation3(there.yaw)
        information = turn.T @ (matched.information + inverted(_PLACED)) @ turn
        edge = GraphEdge(
            near, node, there.inverse() @ self._pose, softened(information, _FLOOR)
        )
        self.graph.connect([edge])
        self._since_key = ScanMotion(HERE, np.zeros((3, 3)))

    def _count_unmatched(self) -> None:
        self.unmatched += 1
        self.unmatched_in_a_row += 1

    def _locate(self, key: KeyScan, motion: ScanMotion) -> Refined | None:
        """Match a scan and move the pose; without a match, by the motion alone."""
        before = self._pose
        moved, matched = motion, self._matched(key, motion)
        is_contradicted = self._is_contradicted
        if matched is None or matched.overlap < DOUBTFUL:
            steady = self._motion.steady()
            other = self._matched(key, steady) if _is_sure(steady) else None
            gain = DOUBTFUL if matched is None else matched.overlap + _GAIN
            if other is not None and other.overlap > gain:
                moved, matched = steady, other
        self._is_contradicted = matched is None and is_contradicted
        covariance = moved_covariance(self._covariance, before, moved)
        since = self._since_key
        self._since_key = ScanMotion(
            since.pose @ moved.pose,
            moved_covariance(since.covariance, since.pose, moved),
        )
        if matched is None:
            self._count_unmatched()
            self._pose, self._covariance = before @ moved.pose, covariance
        else:
            self.unmatched_in_a_row = 0
            self._pose = matched.pose
            information = inverted(covariance) + matched.information
            self._covariance = inverted(information)
        self._motion.record(before.inverse() @ self._pose)
        return matched

    def _matched(self, key: KeyScan, motion: ScanMotion) -> Refined | None:
        covariance = moved_covariance(self._covariance, self._pose, motion)
        prior = PosePrior(self._pose @ motion.pose, inverted(covariance))
        found = match(self._local, key.points, prior, self.params)
        pose = prior.pose if found is None else found.pose
        placed = SensorView(key.scan, key.base_T_sensor)
        share = self._local.contradiction(placed, key.points, pose)
        self._contradicted = share
        self._is_contradicted = share > self.params.max_contradicted
        return None if self._is_contradicted else found

    def _is_far(self) -> bool:
        """Whether the robot moved enough since the newest key scan."""
        moved = self._last_key.inverse() @ self._pose
        return (
            math.hypot(moved.x, moved.y) > self.params.key_distance_m
            or abs(moved.yaw) > self.params.key_angle_rad
        )

    def _keep(self, key: KeyScan, matched: Refined | None) -> None:
        """Make a scan a key scan, connected to the one before."""
        node = self.graph.insert(key, self._pose, starts_session=not len(self.graph))
        if node:
            self._connect(node, matched)
        self._since_key = ScanMotion(HERE, np.zeros((3, 3)))
        self._rebuild_local_map()

    def _connect(self, node: int, matched: Refined | None) -> None:
        last = self.graph.pose(node - 1)
        moved = last.inverse() @ self._pose
        since = self._since_key
        information = inverted(since.covariance)
        if matched is not None:
            turn = rotation3(last.yaw)
            information = information + turn.T @ matched.information @ turn
        edge = GraphEdge(node - 1, node, moved, softened(information, _FLOOR))
        self.graph.connect([edge])
        step = ScanMotion(moved, inverted(edge.information))
        self._key_covariance = moved_covariance(self._key_covariance, last, step)

    def _close_loops(self) -> bool:
        """Search for places seen before; return whether poses changed."""
        if not self._is_half_a_submap_later():
            return False
        params = self.params
        query = self.graph.newest_chunk(params.submap_scans, params.submap_length_m)
        if query is None:
            return False
        self._queried = query.last - 1
        edges = self._finder.find(query, self.graph)
        if not edges:
            return False
        self.graph.connect(edges)
        fits = all(mahalanobis(each, self.graph.poses) < _CLOSE for each in edges)
        if not fits:
            self.graph.optimise()
            self._continue_from_graph()
        self._key_covariance = self.graph.covariances_from(0)[-1]
        return not fits

    def _is_half_a_submap_later(self) -> bool:
        """Whether the robot moved enough since the last search for loops."""
        params, newest = self.params, len(self.graph) - 1
        since = max(self._queried, self.graph.sessions[-1])
        return (
            newest - since >= max(1, params.submap_scans // 2)
            or self.graph.path_m(since, newest) >= params.submap_length_m / 2
        )

    def _continue_from_graph(self) -> None:
        """Place the robot relative to its key scan, after poses changed."""
        if self._track:
            last = self._track[-1]
            node = len(self.graph) - 1 if self.is_mapping else last.key
            self._pose = self.graph.pose(node)
            if last.key == node:
                self._pose = self._pose @ last.key_T_base
        self._rebuild_local_map()

    def _rebuild_local_map(self) -> None:
        """Take the newest key scans; at the start of a session, the known ones."""
        count, size = len(self.graph), self.params.local_scans
        new = range(max(self._known, count - size), count) if self.is_mapping else ()
        nodes = list(new)
        if self._known and len(nodes) < size:
            nearest = self.graph.nearest(self._pose, 2 * size)
            nodes = sorted({*nodes, *(k for k in nearest if k < self._known)})
        self._anchor = nodes[-1] if new else self._nearest_of(nodes)
        self._last_key = self.graph.pose(self._anchor) if new else self._pose
        points = self.graph.points(nodes)
        if not len(points):  # nothing was in range: no scan will match
            points = np.array([[self._pose.x, self._pose.y, 0.0, 0.0]])
        scans = [
            SensorView(
                self.graph.keys[node].scan,
                self.graph.pose(node) @ self.graph.keys[node].base_T_sensor,
            )
            for node in nodes
        ]
        self._local = LocalMap(points, self.params, scans=scans)

    def _nearest_of(self, nodes: list[int]) -> int:
        return min(nodes, key=lambda k: self.graph.pose(k).distance_to(self._pose))

    def _estimate(
        self, stamp_ns: int, is_matched: bool, is_corrected: bool = False
    ) -> SlamEstimate:
        node = self._anchor
        key_T_base = self.graph.pose(node).inverse() @ self._pose
        if self._is_located:
            self._track.append(_Tracked(stamp_ns, node, key_T_base))
        moved = ScanMotion(key_T_base, np.zeros((3, 3)))
        covariance = moved_covariance(
            self._key_covariance, self.graph.pose(node), moved
        )
        return SlamEstimate(
            self._pose, covariance + self._covariance, is_matched, is_corrected
        )


def _is_sure(motion: ScanMotion) -> bool:
    return bool(motion.covariance[0, 0] < _SURE_M**2)
