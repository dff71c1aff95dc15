"""Obstacles around the robot from all further sensors.

Observations are placed in a frame that does not jump (odometry). The layer keeps what
was marked until a ray clears it or the window has moved on, so that a table remains
after it left the camera's view.
"""

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Footprint, Pose2
from navette.navigation.costmap.layers.observation import Cone, Observation, Points
from navette.navigation.costmap.layers.params import (
    ObstacleLayerParams,
    RangeLayerParams,
    SourceParams,
)
from navette.navigation.costmap.layers.range_grid import RangeWindow
from navette.navigation.costmap.layers.voxels import VoxelWindow

# A ray that crosses less of a voxel than this share of its edge does not clear it.
_LEAST_CHORD = 0.5
_BUMP_M = 0.05  # beyond the bumper
_BUMP_HALF_WIDTH_M = 0.1


class ObstacleLayer:
    """Voxels, range readings and contacts within a square around the robot."""

    def __init__(
        self,
        params: ObstacleLayerParams,
        ranges: RangeLayerParams,
        size_m: float,
        footprint: Footprint | None = None,
    ) -> None:
        self.params = params
        self._ranges = ranges
        self._footprint = footprint
        self._voxels = VoxelWindow(
            size_m,
            params.resolution_m,
            origin_z=params.origin_z,
            z_resolution=params.z_resolution,
            z_voxels=params.z_voxels,
            mark_threshold=params.mark_threshold,
        )
        self._cells = RangeWindow(size_m, params.resolution_m, ranges.phi)
        self._bumps: list[tuple[int, Points]] = []  # stamp, places

    def reset(self) -> None:
        """Forget everything."""
        self._voxels.reset()
        self._cells.reset()
        self._bumps.clear()

    def observe(
        self, observation: Observation, source: SourceParams, odom_T_base: Pose2
    ) -> None:
        """Clear and mark by an observation, in the odometry's frame."""
        self._move_to(odom_T_base)
        origin, hits = observation.origin, observation.hits
        if source.clearing:
            misses = observation.misses
            ends = np.concatenate([hits, misses]) if len(misses) else hits
            self._clear(origin, ends, source)
        if not source.marking:
            return
        rays = hits - origin
        distance = np.sqrt(np.einsum("ij,ij->i", rays, rays))
        near = distance <= source.obstacle_max_range
        near &= distance >= source.obstacle_min_range
        height = hits[:, 2]
        band = (height >= source.min_obstacle_height) & (
            height <= source.max_obstacle_height
        )
        self._voxels.mark(hits[near & band])
        if source.max_drop_height > 0.0:
            self._mark_drops(origin, hits, distance, source)

    def measure(self, cone: Cone, odom_T_sensor: Pose2, odom_T_base: Pose2) -> None:
        """Update the cells of a range reading."""
        self._move_to(odom_T_base)
        if cone.is_free and not self._ranges.clear_on_max_reading:
            return
        sensor = odom_T_sensor.x, odom_T_sensor.y, odom_T_sensor.yaw
        self._cells.update(sensor, cone.reading, cone.half_angle, is_free=cone.is_free)

    def bump(self, odom_T_bumper: Pose2, stamp_ns: int) -> None:
        """Mark what a bumper touched: it lies along the bumper's +x axis."""
        across = np.linspace(-_BUMP_HALF_WIDTH_M, _BUMP_HALF_WIDTH_M, 5)
        touched = np.stack([np.full(5, _BUMP_M), across], axis=1)
        places = odom_T_bumper.apply(touched)
        kept = [each for each in self._bumps if not _same(each[1], places)]
        self._bumps = [*kept, (stamp_ns, places)]

    def obstacles(self, odom_T_base: Pose2, now_ns: int) -> Points:
        """Return the places (N, 2) of all obstacles, in the odometry's frame, m."""
        self._move_to(odom_T_base)
        oldest_ns = now_ns - round(self.params.bump_persistence_s * 1e9)
        self._bumps = [each for each in self._bumps if each[0] >= oldest_ns]
        found = np.concatenate(
            [
                self._voxels.obstacles(),
                self._cells.obstacles(self._ranges.mark_threshold),
                *(places for _, places in self._bumps),
            ]
        )
        footprint = self._footprint
        if footprint is None or not self.params.footprint_clearing_enabled:
            return found
        inside = np.hypot(*(found - (odom_T_base.x, odom_T_base.y)).T)
        inside = inside <= footprint.circumscribed_radius
        on_base = odom_T_base.inverse().apply(found[inside])
        inside[inside] = footprint.contains(on_base)
        self._voxels.clear_region(found[inside])
        kept: Points = found[~inside]
        return kept

    def _move_to(self, odom_T_base: Pose2) -> None:
        self._voxels.move_to(odom_T_base.x, odom_T_base.y)
        self._cells.move_to(odom_T_base.x, odom_T_base.y)

    def _clear(self, origin: Points, ends: Points, source: SourceParams) -> None:
        resolution = self.params.resolution_m
        self._voxels.clear(
            origin,
            ends,
            longer_than=max(source.raytrace_min_range, 1e-6),
            farthest=source.raytrace_max_range,
            margin=resolution,
            least_chord=_LEAST_CHORD * min(resolution, self.params.z_resolution),
        )

    def _mark_drops(
        self,
        origin: Points,
        hits: Points,
        distance: NDArray[np.float64],
        source: SourceParams,
    ) -> None:
        """Mark where rays passed the level of the floor, and clear where it is."""
        below = hits[:, 2] < -source.max_drop_height
        crossing, _ = floor_crossings(origin, hits[below])
        away = np.linalg.norm(crossing - origin[:2], axis=1)
        crossing = crossing[away <= source.obstacle_max_range]
        floor = np.empty((0, 2))
        if self._voxels.has_drops:
            near = distance <= source.raytrace_max_range
            level = np.abs(hits[:, 2]) <= source.max_drop_height
            floor = hits[near & level, :2]
        self._voxels.mark_drops(crossing, floor)


def floor_crossings(origin: Points, ends: Points) -> tuple[Points, NDArray[np.float64]]:
    """Return where rays to points below the floor cross z = 0.

    Args:
        origin: (3,) above the floor, m.
        ends: (N, 3) below it, m.

    Returns:
        Places (N, 2), m, and shares (N,) of the rays up to there.
    """
    if origin[2] <= 0.0 or not len(ends):
        return np.empty((0, 2)), np.empty(0)
    share = origin[2] / (origin[2] - ends[:, 2])
    places: Points = origin[:2] + share[:, None] * (ends[:, :2] - origin[:2])
    return places, share


def _same(a: Points, b: Points) -> bool:
    return bool(np.abs(a - b).max() < _BUMP_M)
