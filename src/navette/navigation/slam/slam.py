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
from navette.navigation.slam.match_status import MatchStatus
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
from navette.navigation.slam.place_search import FoundPlace, PlaceSearch
from navette.navigation.slam.pose_graph import GraphEdge, mahalanobis
from navette.navigation.slam.refinement import PosePrior, Refined
from navette.navigation.slam.rendering import MapScan, render
from navette.navigation.slam.scan_graph import KeyScan, ScanGraph
from navette.navigation.slam.scan_points import scan_points
from navette.navigation.slam.tracked_pose import STILL, TrackedPose
from navette.navigation.slam.tracking import DOUBTFUL, compare, make_local_map

# Uncertainty of the first pose, which is the map's origin.
_START = np.diag([1e-6, 1e-6, 1e-6])
# What the errors that the scans of a local map share add to a match.
_FLOOR = np.diag([0.005**2, 0.005**2, 0.002**2])
# Of a match with a scan before a stretch without matches, so that it can be inverted.
_WEAKEST = 0.01 * np.eye(3)
# What another motion must gain where the odometry is doubted.
_GAIN = 0.15
# Standard deviation of a predicted motion beyond which it replaces no odometry, m.
_SURE_M = 0.3
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

    A scan without echoes measures nothing: the odometry moves the pose, which becomes
    less certain. A robot whose scans contradict the map has been moved: it is searched
    for in the whole map, and what it sees meanwhile is not mapped.

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
        # Whether the newest scan contradicts the map where the robot should be.
        self._is_contradicted = False
        self._finder = LoopFinder(params)
        self._queried = 0  # newest key scan at the last search for loops
        self._motion = MotionModel(params)
        self._track: deque[_Tracked] = deque(maxlen=trajectory_length)
        # The key scan that the newest poses are relative to.
        self._anchor = 0
        # The newest key scan that scans are matched with.
        self._reference = 0
        self._tracked = TrackedPose(HERE if start is None else start, _START)
        # Of the newest key scan and of the reference, relative to the map's origin.
        self._key_covariance: Matrix3 = np.zeros((3, 3))
        self._reference_covariance: Matrix3 = np.zeros((3, 3))
        # While the place of the robot in the known map is unknown.
        self._search: PlaceSearch | None = None
        self.match_status = MatchStatus.STARTING
        if self._known:
            self._lose(MatchStatus.STARTING, start)
        self.unmatched = 0
        self.unmatched_in_a_row = 0
        self.contradicted_in_a_row = 0

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
        loss = self._loss(key, matched)
        is_corrected = False
        if loss is not None:
            self._lose(loss)
        elif not self._is_contradicted and self._is_far():
            if self.is_mapping:
                is_corrected = self._keep(key, matched)
                is_corrected |= self._close_loops()
            else:
                self._tracked.note_key()
                self._rebuild_local_map()
        return self._estimate(stamp_ns, matched is not None, is_corrected)

    def predicted(self, odom_T_base: Pose2 | None) -> SlamEstimate | None:
        """Return the pose by odometry alone; the next scan continues from the last.

        None: without odometry, or before the robot is located.
        """
        if odom_T_base is None or not self._is_located:
            return None
        motion = self._motion.by_odometry(odom_T_base)
        pose = self._tracked.pose
        covariance = moved_covariance(self._covariance_in_map(), pose, motion)
        return SlamEstimate(
            pose @ motion.pose, covariance, is_matched=False, is_corrected=False
        )

    def emptied(self) -> "Slam":
        """Return a SLAM without a map; its first scan is where the robot is."""
        length = self._track.maxlen
        fresh = Slam(self.params, self._tracked.pose, trajectory_length=length)
        fresh._motion = self._motion
        return fresh

    def place(self, pose: Pose2) -> None:
        """Place the robot in a known map, roughly; the next scan finds it exactly."""
        if self._known:
            self._lose(MatchStatus.STARTING, pose)
            self.unmatched_in_a_row = 0

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

    @property
    def _is_located(self) -> bool:
        return self._search is None and len(self.graph) > 0

    def _lose(self, match_status: MatchStatus, start: Pose2 | None = None) -> None:
        """Search for the robot from now on; all that is mapped is the known map."""
        self._known = len(self.graph)
        self.match_status = match_status
        self._search = PlaceSearch(
            self.graph, self.params, start, match_status,
            make_scout=lambda: Slam(self.params, trajectory_length=1),
        )  # fmt: skip

    def _begin(
        self, key: KeyScan, motion: ScanMotion, odom: Pose2 | None, yaw: float | None
    ) -> None:
        """Start a map at the first scan, or find the scan in the known map."""
        tracked = self._tracked
        tracked.place(tracked.pose @ motion.pose, tracked.covariance)
        if self._search is None:
            self._note_located(key)
            self._keep(key, None)
            return
        place = self._search.find(key, motion.pose, odom, yaw)
        if place is None:
            self._count_unmatched()
            self.match_status = self._search.status
            return
        self._search = None
        self._note_located(key)
        tracked.place(place.pose, inverted(place.information))
        self._rebuild_local_map()
        if self.is_mapping:
            self._start_session(key, place)

    def _note_located(self, key: KeyScan) -> None:
        self.unmatched_in_a_row = self.contradicted_in_a_row = 0
        self.match_status = (
            MatchStatus.MATCHED if key.is_informative else MatchStatus.NO_ECHOES
        )

    def _start_session(self, key: KeyScan, place: FoundPlace) -> None:
        """Connect the first key scan of a session to the known map."""
        node = self.graph.insert(key, place.pose, starts_session=True)
        there = self.graph.pose(place.near)
        turn = rotation3(there.yaw)
        information = softened(turn.T @ place.information @ turn, _FLOOR)
        moved = there.inverse() @ place.pose
        self.graph.connect([GraphEdge(place.near, node, moved, information)])
        self._tracked.note_key()
        self._rebuild_local_map()

    def _count_unmatched(self) -> None:
        self.unmatched += 1
        self.unmatched_in_a_row += 1

    def _locate(self, key: KeyScan, motion: ScanMotion) -> Refined | None:
        """Match a scan and move the pose; without a match, by the motion alone."""
        tracked, before = self._tracked, self._tracked.pose
        self._is_contradicted = False
        moved, matched = motion, None
        if key.is_informative:
            moved, matched = self._best_match(key, motion)
        if matched is not None:
            self.unmatched_in_a_row = self.contradicted_in_a_row = 0
            tracked.match(moved, matched)
        else:
            self._count_unmatched()
            self.contradicted_in_a_row += self._is_contradicted
            # A robot that was carried must not match elsewhere as its window widens.
            if self._motion.is_measured and not self._is_contradicted:
                tracked.reckon(moved.pose, self.params)
            else:
                tracked.move(moved)
        self._motion.record(before.inverse() @ tracked.pose)
        return matched

    def _best_match(
        self, key: KeyScan, motion: ScanMotion
    ) -> tuple[ScanMotion, Refined | None]:
        """Return the match, and the motion that led to it.

        Where the scan fits badly after the motion of the odometry, the velocity before
        may fit better: the odometry jumped.
        """
        matched = self._matched(key, motion)
        is_contradicted = self._is_contradicted
        if matched is None or matched.overlap < DOUBTFUL:
            steady = self._motion.steady()
            other = self._matched(key, steady) if _is_sure(steady) else None
            gain = DOUBTFUL if matched is None else matched.overlap + _GAIN
            if other is not None and other.overlap > gain:
                motion, matched = steady, other
        self._is_contradicted = matched is None and is_contradicted
        return motion, matched

    def _matched(self, key: KeyScan, motion: ScanMotion) -> Refined | None:
        information = inverted(self._tracked.predicted(motion))
        prior = PosePrior(self._tracked.pose @ motion.pose, information)
        compared = compare(self._local, key, prior, self.params)
        self._is_contradicted = compared.is_contradicted
        # In the wide window after a stretch by odometry alone, parts fit by chance.
        least = DOUBTFUL if self.match_status is MatchStatus.NO_ECHOES else 0.0
        return None if compared.overlap < least else compared.refined

    def _loss(self, key: KeyScan, matched: Refined | None) -> MatchStatus | None:
        """Note what a scan shows; return why the robot is lost, or None."""
        params = self.params
        self.match_status = self._status_of(key, matched)
        if self._is_contradicted and self.contradicted_in_a_row >= params.lost_scans:
            return MatchStatus.LOST_CONTRADICTED
        deviation_m = math.sqrt(np.trace(self._tracked.covariance[:2, :2]))
        if matched is None and deviation_m > params.lost_stddev_m:
            return MatchStatus.LOST_UNCERTAIN
        return None

    def _status_of(self, key: KeyScan, matched: Refined | None) -> MatchStatus:
        if matched is not None:
            return MatchStatus.MATCHED
        if self._is_contradicted:
            return MatchStatus.CONTRADICTED
        is_long = self.unmatched_in_a_row >= self.params.lost_scans
        if is_long and not self._motion.is_measured:
            return MatchStatus.LOST_UNCERTAIN
        if key.is_informative:
            return MatchStatus.NOTHING_MAPPED
        return MatchStatus.NO_ECHOES

    def _is_far(self) -> bool:
        """Whether the robot moved enough since the newest key scan."""
        moved = self._last_key.inverse() @ self._tracked.pose
        return (
            math.hypot(moved.x, moved.y) > self.params.key_distance_m
            or abs(moved.yaw) > self.params.key_angle_rad
        )

    def _keep(self, key: KeyScan, matched: Refined | None) -> bool:
        """Make a scan a key scan, connected to the ones before.

        Returns whether earlier poses changed.
        """
        pose = self._tracked.pose
        node = self.graph.insert(key, pose, starts_session=not len(self.graph))
        is_corrected = False
        if matched is not None and self._reference != node - 1:
            is_corrected = self._reconnect(node, matched)
        elif node:
            self._connect(node, matched)
        self._tracked.note_key()
        if is_corrected:
            self._continue_from_graph()
        else:
            self._rebuild_local_map()
        return is_corrected

    def _connect(self, node: int, matched: Refined | None) -> None:
        last = self.graph.pose(node - 1)
        moved = last.inverse() @ self._tracked.pose
        information = inverted(self._tracked.since_key.covariance)
        if matched is not None:
            turn = rotation3(last.yaw)
            information = information + turn.T @ matched.information @ turn
        edge = GraphEdge(node - 1, node, moved, softened(information, _FLOOR))
        self.graph.connect([edge])
        step = ScanMotion(moved, inverted(edge.information))
        self._key_covariance = moved_covariance(self._key_covariance, last, step)

    def _reconnect(self, node: int, matched: Refined) -> bool:
        """Connect the first key scan that matches after some that could not.

        The match measures its pose relative to the scans before these, the odometry
        relative to the last one of these. Returns whether earlier poses changed.
        """
        since = self._tracked.since_key
        information = softened(inverted(since.covariance), _FLOOR)
        reckoned = GraphEdge(node - 1, node, since.pose, information)
        reference = self.graph.pose(self._reference)
        turn = rotation3(reference.yaw)
        information = turn.T @ matched.information @ turn + _WEAKEST
        moved = reference.inverse() @ self._tracked.pose
        edge = GraphEdge(
            self._reference, node, moved, softened(information, _FLOOR), True
        )
        self.graph.connect([reckoned, edge])
        # Of the match and the odometry together.
        covariance = turn.T @ self._tracked.covariance @ turn + _FLOOR
        self._key_covariance = moved_covariance(
            self._reference_covariance, reference, ScanMotion(moved, covariance)
        )
        if mahalanobis(reckoned, self.graph.poses) < _CLOSE:
            return False
        self.graph.optimise()
        return True

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
        covariances = self.graph.covariances_from(0)
        self._key_covariance = covariances[-1]
        self._reference_covariance = covariances[self._reference]
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
            pose = self.graph.pose(node)
            if last.key == node:
                pose = pose @ last.key_T_base
            self._tracked.place(pose, self._tracked.covariance)
        self._rebuild_local_map()

    def _rebuild_local_map(self) -> None:
        """Take the newest key scans; at the start of a session, the known ones."""
        graph, size, pose = self.graph, self.params.local_scans, self._tracked.pose
        newest = len(graph) - 1
        nodes = new = graph.newest(self._known, size) if self.is_mapping else []
        if self._known and len(new) < size:
            nearest = graph.nearest(pose, 2 * size)
            nodes = sorted({*new, *(k for k in nearest if k < self._known)})
        if new:
            self._reference = new[-1]
        else:
            self._reference = self._nearest_of(nodes) if nodes else newest
        if self._reference == newest:
            self._reference_covariance = self._key_covariance
        is_growing = self.is_mapping and len(graph) > self._known
        self._anchor = newest if is_growing else self._reference
        self._last_key = graph.pose(newest) if is_growing else pose
        self._local = make_local_map(graph, nodes, pose, self.params)

    def _nearest_of(self, nodes: list[int]) -> int:
        pose = self._tracked.pose
        return min(nodes, key=lambda k: self.graph.pose(k).distance_to(pose))

    def _estimate(
        self, stamp_ns: int, is_matched: bool, is_corrected: bool = False
    ) -> SlamEstimate:
        pose = self._tracked.pose
        if self._is_located:
            node = self._anchor
            key_T_base = self.graph.pose(node).inverse() @ pose
            self._track.append(_Tracked(stamp_ns, node, key_T_base))
        return SlamEstimate(pose, self._covariance_in_map(), is_matched, is_corrected)

    def _covariance_in_map(self) -> Matrix3:
        """Return the covariance of the pose relative to the map's origin."""
        pose = self._tracked.pose
        if self._search is not None:
            return self._search.covariance(pose)
        reference = self.graph.pose(self._reference)
        moved = ScanMotion(reference.inverse() @ pose, STILL.covariance)
        covariance = moved_covariance(self._reference_covariance, reference, moved)
        return covariance + self._tracked.covariance


def _is_sure(motion: ScanMotion) -> bool:
    return bool(motion.covariance[0, 0] < _SURE_M**2)
