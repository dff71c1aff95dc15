"""Observation and action of the navigation environment, also outside of it.

A trained policy gets its observations from the same functions when it drives a robot.
"""

import math
from dataclasses import dataclass

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import Pose2

FARTHEST_GOAL_M = 1000.0
"""Limit of the goal's coordinates; farther goals are observed at it."""

Observation = dict[str, NDArray[np.float32]]
_OVERSHOOT = 1.5  # measured velocity beyond the commanded limits


@dataclass(frozen=True, kw_only=True)
class Observer:
    """Scale and limits of observation and action for one robot and its lidar.

    Attributes:
        beams: ranges in the observation.
        angle_min, angle_max: of the lidar's first and last beam, rad.
        range_max_m: range of a beam that hits nothing.
        base_T_scan: pose of the lidar.
        forward_mps, reverse_mps, turn_radps: largest commands.
        side_mps: largest command to the side; 0 = the drive does not move sideways,
            and velocity and action have two components instead of three.
    """

    beams: int
    angle_min: float
    angle_max: float
    range_max_m: float
    base_T_scan: Pose2
    forward_mps: float
    reverse_mps: float
    turn_radps: float
    side_mps: float = 0.0

    @property
    def _least(self) -> NDArray[np.float64]:
        return -np.array([self.reverse_mps, self.turn_radps, self.side_mps])[
            : self.size
        ]

    @property
    def _most(self) -> NDArray[np.float64]:
        most = np.array([self.forward_mps, self.turn_radps, self.side_mps])
        return most[: self.size]

    @property
    def size(self) -> int:
        """Number of components of velocity and action."""
        return 3 if self.side_mps > 0 else 2

    def observation_space(self) -> spaces.Space[Observation]:
        """Space of :meth:`observe`."""
        low = (self._least * _OVERSHOOT).astype(np.float32)
        high = (self._most * _OVERSHOOT).astype(np.float32)
        return spaces.Dict(  # type: ignore[return-value] # of any values
            {
                "ranges": spaces.Box(
                    0.0, np.float32(self.range_max_m), (self.beams,), np.float32
                ),
                "goal": spaces.Box(-FARTHEST_GOAL_M, FARTHEST_GOAL_M, (2,), np.float32),
                "velocity": spaces.Box(low, high, dtype=np.float32),
            }
        )

    def action_space(self) -> spaces.Space[NDArray[np.float32]]:
        """Space of actions: shares of the largest speeds and turn rate."""
        return spaces.Box(-1.0, 1.0, (self.size,), np.float32)

    def observe(
        self,
        ranges: NDArray[np.floating],
        map_T_base: Pose2,
        goal_map: tuple[float, float],
        velocity: tuple[float, ...],
    ) -> Observation:
        """Return the observation.

        Args:
            ranges: (N,) m of one scan; inf, −inf and NaN as in REP 117. Without a scan:
                :meth:`ranges_to`.
            map_T_base: the robot's pose.
            goal_map: (x, y), m.
            velocity: forward speed (m/s), turn rate (rad/s) and, if the drive moves
                sideways, speed to the left (m/s).
        """
        dx, dy = goal_map[0] - map_T_base.x, goal_map[1] - map_T_base.y
        c, s = math.cos(map_T_base.yaw), math.sin(map_T_base.yaw)
        goal = np.array([c * dx + s * dy, c * dy - s * dx])
        least, most = self._least * _OVERSHOOT, self._most * _OVERSHOOT
        return {
            "ranges": self.reduce(ranges),
            "goal": np.clip(goal, -FARTHEST_GOAL_M, FARTHEST_GOAL_M).astype(np.float32),
            "velocity": np.clip(velocity, least, most).astype(np.float32),
        }

    def ranges_to(
        self, points_map: NDArray[np.float64], map_T_base: Pose2
    ) -> NDArray[np.float64]:
        """Return ranges (beams,) m to obstacle points (N, 2), such as occupied cells.

        The nearest point of each sector counts; inf without one.
        """
        points = (map_T_base @ self.base_T_scan).inverse().apply(points_map)
        angle = np.arctan2(points[:, 1], points[:, 0]) - self.angle_min
        width = (self.angle_max - self.angle_min) / self.beams
        sector = np.floor(np.mod(angle, math.tau) / width).astype(int)
        seen = sector < self.beams
        ranges = np.full(self.beams, np.inf)
        np.minimum.at(ranges, sector[seen], np.hypot(*points[seen].T))
        return ranges

    def reduce(self, ranges: NDArray[np.floating]) -> NDArray[np.float32]:
        """Return the smallest range of each of ``beams`` equal sectors, m.

        A beam that hits nothing, or is lost, counts as the largest range; one that is
        too close as 0.
        """
        if len(ranges) < self.beams:
            raise InvalidValueError(
                f"scan of {len(ranges)} beams: at least {self.beams} required"
            )
        clean = np.nan_to_num(
            ranges, nan=self.range_max_m, posinf=self.range_max_m, neginf=0.0
        )
        if len(clean) != self.beams:
            edges = np.arange(self.beams) * len(clean) // self.beams
            clean = np.minimum.reduceat(clean, edges)
        limited: NDArray[np.float32] = np.clip(
            clean.astype(np.float32), 0.0, np.float32(self.range_max_m)
        )
        return limited

    def command(self, action: NDArray[np.floating]) -> tuple[float, ...]:
        """Return speed (m/s), turn rate (rad/s) and, if possible, speed to the left.

        Args:
            action: (2,) or (3,) shares of the largest ones, in [−1, 1].

        Raises:
            InvalidValueError: another shape, or not finite.
        """
        values = np.asarray(action, np.float64)
        if values.shape != (self.size,) or not np.isfinite(values).all():
            raise InvalidValueError(
                f"action {action!r}: {self.size} finite numbers in [-1, 1] required"
            )
        share = np.clip(values, -1.0, 1.0)
        return tuple((np.where(share > 0, self._most, -self._least) * share).tolist())
