"""Moving obstacles from scans: detect change, cluster, associate, filter."""

import math
from collections import deque

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import PlanarScan, beam_directions
from navette.navigation.tracking.clusters import (
    Cluster,
    behind_returns,
    convex_parts,
    extent,
    fit_centre,
    fit_disc,
    is_whole,
    segment,
)
from navette.navigation.tracking.free_space import PlacedScan, passed_by, returns
from navette.navigation.tracking.params import TrackingParams
from navette.navigation.tracking.tracks import Track, TrackedObstacle, associate

# Ages of the scans with which the newest is compared: fast and slow obstacles.
_AGES_S = (0.25, 0.75)
_LEAST_RETURNS = 3
_LEAST_CHANGED = 3
# Relative difference of radii up to which two clusters are the same obstacle.
_SAME_RADIUS = 0.3
# Returns this near to the predicted circle of a track belong to it, where those of
# several obstacles are joined.
_ON_CIRCLE_M, _LEAST_CIRCLES = 0.15, 2
# Those this far from all circles belong to something else.
_OFF_CIRCLE_M = 0.3
# Share of the free margin by which the surface recedes between two obstacles.
_DEPTH = 0.5
# Share of an obstacle's returns that are new; less than that of a wall's.
_NEW_SHARE = 0.5
# Beams past the predicted centre that show that an obstacle is not there any more.
_PASSED = 3


class MovingObstacles:
    """Tracks what moves; :meth:`step` takes the scans in the order of their stamps.

    1. Mark the returns that lie where beams of earlier scans passed, and find where
       earlier returns have vanished.
    2. Group the returns into clusters; measure the changed ones and those near tracks.
    3. Associate clusters with predicted tracks; filter; begin and end tracks.
    """

    def __init__(self, params: TrackingParams) -> None:
        self.params = params
        self.reset()

    def reset(self) -> None:
        """Forget all scans and tracks."""
        self._past: deque[PlacedScan] = deque()
        self._tracks: list[Track] = []
        self._number = 0
        self._beams: tuple[float, float, int] | None = None
        self._directions = np.empty((0, 2))

    def warm_up(self) -> None:
        """Load or compile the kernels before the first scan."""
        scan = PlanarScan(np.ones(8, np.float32), 0.0, 0.1, 0.1, 20.0)
        for stamp_ns in (0, 300_000_000):
            self.step(scan, Pose2(0.0, 0.0, 0.0), stamp_ns)
        self.reset()

    def step(
        self, scan: PlanarScan, map_T_sensor: Pose2, stamp_ns: int
    ) -> list[TrackedObstacle]:
        """Return what moves, at the stamp of the scan."""
        if self._past and stamp_ns <= self._past[-1].stamp_ns:
            self.reset()
        placed, away = self._place(scan, map_T_sensor, stamp_ns)
        changed, vanished = self._changes(placed)
        self._past.append(placed)
        if not self._tracks and not changed.any() and not len(vanished):
            return []
        for track in self._tracks:
            track.predict(stamp_ns, self.params.acceleration_mps2)
        clusters = self._clusters(placed, away, changed, vanished)
        self._update(placed, clusters)
        return [track.estimate() for track in self._tracks if track.is_moving]

    def _place(
        self, scan: PlanarScan, map_T_sensor: Pose2, stamp_ns: int
    ) -> tuple[PlacedScan, NDArray[np.float64]]:
        beams = (scan.angle_min, scan.angle_increment, len(scan.ranges))
        if beams != self._beams:
            self._beams, self._directions = beams, beam_directions(*beams)
            self._past.clear()
        ranges = np.ascontiguousarray(scan.ranges, np.float32)
        reach = min(scan.range_max, self.params.range_m)
        valid, away, arms = returns(ranges, self._directions, scan.range_min, reach)
        points = map_T_sensor.apply(arms)
        placed = PlacedScan(
            ranges,
            np.ascontiguousarray(points),
            valid,
            *map_T_sensor,
            scan.angle_min,
            scan.angle_increment,
            scan.range_max,
            stamp_ns,
        )
        return placed, away

    def _changes(
        self, placed: PlacedScan
    ) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
        """Return (N,) which returns are new, and points (M, 2) that have vanished."""
        margin = self.params.free_margin_m
        changed = np.zeros(len(placed.ranges), np.bool_)
        oldest_ns = placed.stamp_ns - round(_AGES_S[-1] * 1e9)
        while len(self._past) > 1 and self._past[1].stamp_ns <= oldest_ns:
            self._past.popleft()
        if not self._past:
            return changed, np.empty((0, 2))
        for age_s in _AGES_S:
            past = self._of_age(placed.stamp_ns - round(age_s * 1e9))
            changed |= passed_by(placed.points, placed.valid, past, margin)
        gone = passed_by(past.points, past.valid, placed, margin)
        return changed, past.points[gone]

    def _of_age(self, stamp_ns: int) -> PlacedScan:
        """Return the newest stored scan that is not newer, else the oldest."""
        found = self._past[0]
        for scan in self._past:
            if scan.stamp_ns > stamp_ns:
                break
            found = scan
        return found

    def _clusters(
        self,
        placed: PlacedScan,
        away: NDArray[np.float64],
        changed: NDArray[np.bool_],
        vanished: NDArray[np.float64],
    ) -> list[Cluster]:
        """Return the measured clusters that changed or are near a track."""
        largest = self.params.max_size_m
        clusters = []
        runs = segment(placed.points, placed.valid, away, self.params.gap_m)
        turn = abs(placed.angle_increment) * len(placed.ranges)
        for first, stop in runs[runs[:, 1] - runs[:, 0] >= _LEAST_RETURNS].tolist():
            returns = first + np.flatnonzero(placed.valid[first:stop])
            parts = self._divided(placed, returns)
            mostly_new = np.count_nonzero(changed[returns]) >= _NEW_SHARE * len(returns)
            if len(parts) == 1 and mostly_new:
                parts = self._convex(placed, returns)
            whole = len(parts) == 1 and is_whole(placed.ranges, first, stop, turn)
            for part in parts:
                points = placed.points[part]
                if len(points) < _LEAST_RETURNS:
                    continue
                new = int(np.count_nonzero(changed[part]))
                if extent(points) > largest:
                    if new >= _LEAST_RETURNS:
                        clusters += self._parts_of_wide(placed, changed, part)
                    continue
                left = _count_near(vanished, points.mean(axis=0), largest / 2)
                evidence = new if new >= _LEAST_CHANGED else 0
                evidence += left if left > _LEAST_CHANGED else 0
                if evidence or self._is_near_track(points):
                    clusters.append(self._measure(placed, points, whole, evidence))
        return clusters

    def _divided(
        self, placed: PlacedScan, returns: NDArray[np.int64]
    ) -> list[NDArray[np.int64]]:
        """Return the indices of a run's returns, divided between obstacles.

        Obstacles that meet, or pass before each other, have one run of returns. Each
        return belongs to the predicted circle that it lies on.
        """
        points = placed.points
        if not len(returns):
            return [returns]
        round_ = [t for t in self._tracks if t.is_moving and t.is_round]
        if len(round_) < _LEAST_CIRCLES:
            return [returns]
        circles = np.array([(t.x, t.y, t.radius_m) for t in round_])
        arms = points[returns, None, :] - circles[:, :2]
        off = np.abs(np.hypot(arms[..., 0], arms[..., 1]) - circles[:, 2])
        nearest = off.argmin(axis=1)
        own = np.bincount(
            nearest[off.min(axis=1) <= _ON_CIRCLE_M], minlength=len(off[0])
        )
        owners = np.flatnonzero(own >= _LEAST_RETURNS)
        if len(owners) < _LEAST_CIRCLES:
            return [returns]
        nearest = owners[off[:, owners].argmin(axis=1)]
        nearest[off.min(axis=1) > _OFF_CIRCLE_M] = -1
        parts = [returns[nearest == owner] for owner in owners]
        return [*parts, returns[nearest < 0]]

    def _parts_of_wide(
        self,
        placed: PlacedScan,
        changed: NDArray[np.bool_],
        returns: NDArray[np.int64],
    ) -> list[Cluster]:
        """Measure what is new of a run that is too wide for one obstacle.

        Several obstacles, or obstacles in front of a wall.
        """
        found = []
        for part in self._convex(placed, returns):
            points, new = placed.points[part], int(np.count_nonzero(changed[part]))
            if new < _LEAST_RETURNS:
                continue
            if extent(points) <= self.params.max_size_m:
                cluster = self._measure(placed, points, False, new)
                if cluster.is_round or new >= _NEW_SHARE * len(part):
                    found.append(cluster)
                    continue
            found += self._new_parts(placed, changed, part)
        return found

    def _convex(
        self, placed: PlacedScan, returns: NDArray[np.int64]
    ) -> list[NDArray[np.int64]]:
        """Return the indices, divided where the surface recedes."""
        depth_m = _DEPTH * self.params.free_margin_m
        parts = convex_parts(placed.points[returns], (placed.x, placed.y), depth_m)
        return [returns[part] for part in parts]

    def _new_parts(
        self,
        placed: PlacedScan,
        changed: NDArray[np.bool_],
        returns: NDArray[np.int64],
    ) -> list[Cluster]:
        """Return the runs of new returns among neighbouring returns."""
        found = []
        edges = np.flatnonzero(np.diff(changed[returns].astype(np.int8))) + 1
        for part in np.split(returns, edges):
            if changed[part[0]] and len(part) >= _LEAST_RETURNS:
                points = placed.points[part]
                if extent(points) <= self.params.max_size_m:
                    found.append(self._measure(placed, points, False, len(part)))
        return found

    def _measure(
        self,
        placed: PlacedScan,
        points: NDArray[np.float64],
        whole: bool,
        changed: int,
    ) -> Cluster:
        sensor = (placed.x, placed.y)
        disc = fit_disc(points, sensor, self.params.max_size_m / 2)
        track = self._nearest_track(disc[0], disc[1])
        if track is None or (whole and disc[3]):
            return Cluster(*disc, whole, changed)
        if not (
            disc[3] and abs(disc[2] - track.radius_m) <= _SAME_RADIUS * track.radius_m
        ):
            # Partly hidden, or too few returns for a circle of their own.
            disc = behind_returns(points.mean(axis=0), sensor, track.radius_m)
            if track.is_round:
                known = fit_centre(points, (track.x, track.y), track.radius_m)
                disc = known if known[3] else disc
        return Cluster(*disc, whole, changed)

    def _nearest_track(self, x: float, y: float) -> Track | None:
        near = [
            (math.hypot(track.x - x, track.y - y), i)
            for i, track in enumerate(self._tracks)
            if track.is_moving
        ]
        if not near or min(near)[0] > self.params.gate_m:
            return None
        return self._tracks[min(near)[1]]

    def _is_near_track(self, points: NDArray[np.float64]) -> bool:
        x, y = points.mean(axis=0)
        reach = self.params.gate_m + self.params.max_size_m / 2
        return any(abs(t.x - x) < reach and abs(t.y - y) < reach for t in self._tracks)

    def _update(self, placed: PlacedScan, clusters: list[Cluster]) -> None:
        params = self.params
        matched = associate(self._tracks, clusters, params.gate_m)
        for i, track in enumerate(self._tracks):
            if i in matched:
                track.update(clusters[matched[i]], (placed.x, placed.y), params)
            else:
                track.miss(params)
        taken = set(matched.values())
        for j, cluster in enumerate(clusters):
            if j not in taken and cluster.changed:
                self._number += 1
                self._tracks.append(
                    Track.begin(self._number, cluster, placed.stamp_ns, params)
                )
        self._tracks = [
            track
            for track in self._tracks
            if not track.is_over(params) and not self._is_gone(track, placed)
        ]

    def _is_gone(self, track: Track, placed: PlacedScan) -> bool:
        """Return whether beams pass where the obstacle should be."""
        if track.misses < _PASSED:
            return False
        dx, dy = track.x - placed.x, track.y - placed.y
        side = 0.5 * track.radius_m / max(math.hypot(dx, dy), 1e-6)
        points = np.array(
            [
                (track.x + k * side * -dy, track.y + k * side * dx)
                for k in (-1.0, 0.0, 1.0)
            ]
        )
        passed = passed_by(points, np.ones(3, np.bool_), placed, track.radius_m)
        return bool(passed.all())


def _count_near(
    points: NDArray[np.float64], centre: NDArray[np.float64], reach_m: float
) -> int:
    if not len(points):
        return 0
    near = np.abs(points - centre).max(axis=1) <= reach_m
    return int(np.count_nonzero(near))
