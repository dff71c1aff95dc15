# SPDX-License-Identifier: Apache-2.0
"""Exact distance from the robot's body to the nearest obstacle."""

import math
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.sim.bounds import bounds_of
from navette.sim.build import Compiled
from navette.sim.masks import OBSTACLE
from navette.sim.rolling import RollingTest


@dataclass(frozen=True)
class Clearance:
    """Distance (m, negative inside) and the nearest obstacle ("" without one)."""

    distance: float
    obstacle: str


class ClearanceProbe:
    """Distance of body to obstacles: bounding boxes first, then exact pairs.

    Pairs of an obstacle and a part of the robot are tried in the order of a lower bound
    on their distance; the search ends when no bound is below the best pair found. An
    obstacle that a wheel rolls on is not one for this wheel.
    """

    def __init__(
        self, compiled: Compiled, data: mujoco.MjData, rolling: RollingTest
    ) -> None:
        self._rolling = rolling
        model = compiled.model
        self._compiled = compiled
        obstacles = np.flatnonzero(compiled.is_obstacle)
        self._obstacles = obstacles
        self._moving = np.flatnonzero(np.array(model.geom_bodyid)[obstacles] != 0)
        self._parts = np.flatnonzero(compiled.is_robot & _meets_obstacles(model))
        self._part_radius = np.array(model.geom_rbound)[self._parts]
        self._low, self._high = bounds_of(model, data, obstacles)
        self._radius = np.array(model.geom_rbound)[obstacles]
        self._bounds = np.empty(len(obstacles) * len(self._parts))
        self.reach = self._farthest(data)

    def _farthest(self, data: mujoco.MjData) -> float:
        """Upper bound of the distance from the root body to the robot's surface (m)."""
        root = data.xpos[self._compiled.robot.root_body]
        away = np.linalg.norm(data.geom_xpos[self._parts] - root, axis=1)
        return float((away + self._part_radius).max())

    def measure(self, data: mujoco.MjData) -> Clearance:
        """Return the nearest obstacle (kinematics must be up to date)."""
        if not len(self._obstacles):
            return Clearance(np.inf, "")
        self._update_bounds(data)
        best, nearest, bounds = np.inf, -1, self._bounds
        while True:
            pair = int(bounds.argmin())
            if bounds[pair] >= best:
                break
            bounds[pair] = np.inf  # measured below
            row, column = divmod(pair, len(self._parts))
            obstacle, part = int(self._obstacles[row]), int(self._parts[column])
            distance = self._distance(data, part, obstacle, min(best, 1e3))
            if distance < best:
                best, nearest = distance, obstacle
        owner = self._compiled.geom_owner[nearest] if nearest >= 0 else ""
        return Clearance(float(best), owner)

    def _distance(
        self, data: mujoco.MjData, part: int, obstacle: int, limit: float
    ) -> float:
        """Return the distance of a pair; infinite if the part rolls on the obstacle."""
        ends = np.zeros(6)  # nearest points of the part and of the obstacle
        distance = mujoco.mj_geomDistance(
            self._compiled.model, data, part, obstacle, limit, ends
        )
        length = math.copysign(math.dist(ends[:3], ends[3:]), distance)
        up = (ends[2] - ends[5]) / length if length else 0.0
        geoms = np.array([part]), np.array([obstacle])
        rolls = self._rolling.rolls(*geoms, np.array([up]), np.array([distance]))
        return math.inf if rolls[0] else distance

    def _update_bounds(self, data: mujoco.MjData) -> None:
        """Write a lower bound of the distance for each obstacle and part."""
        moving = self._moving
        if len(moving):
            places = data.geom_xpos[self._obstacles[moving]]
            reach = self._radius[moving, None]
            self._low[moving], self._high[moving] = places - reach, places + reach
        centres = data.geom_xpos[self._parts]
        _lower_bounds(centres, self._part_radius, self._low, self._high, self._bounds)


@kernel
def _lower_bounds(centres, radius, low, high, bounds):  # type: ignore[no-untyped-def]
    """Write lower bounds (N · P,) of the distances from boxes to balls, m.

    Args:
        centres: (P, 3) of the balls.
        radius: (P,) of the balls.
        low, high: (N, 3) corners of the boxes.
    """
    k = 0
    for i in range(len(low)):
        for j in range(len(centres)):
            x, y, z = centres[j, 0], centres[j, 1], centres[j, 2]
            dx = max(low[i, 0] - x, x - high[i, 0], 0.0)
            dy = max(low[i, 1] - y, y - high[i, 1], 0.0)
            dz = max(low[i, 2] - z, z - high[i, 2], 0.0)
            bounds[k] = math.sqrt(dx * dx + dy * dy + dz * dz) - radius[j]
            k += 1


def _meets_obstacles(model: mujoco.MjModel) -> NDArray[np.bool_]:
    """Geoms that can touch obstacles (tyres touch the ground only)."""
    touches: NDArray[np.bool_] = (np.array(model.geom_conaffinity) & OBSTACLE) != 0
    return touches
