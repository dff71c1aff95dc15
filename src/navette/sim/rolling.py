# SPDX-License-Identifier: Apache-2.0
"""Surfaces of obstacles that wheels roll on: ramps, platforms, door sills."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.sim.bounds import bounds_of
from navette.sim.build import Compiled

# Rubber with a friction of 0.6 holds on a slope of 31°; the edge of a kerb touches a
# wheel in such a direction only if it is lower than 13 % of the wheel's radius.
_STEEPEST = math.radians(30.0)
_MIN_UP = math.cos(_STEEPEST)
_SUNK_M = 0.01  # deeper than this a wheel is in an obstacle, not on it


class RollingTest:
    """Distinguishes wheels that roll on an obstacle from wheels that hit one.

    World files do not mark ramps. The direction of the contact distinguishes the two:
    upwards on a ramp, sideways at a wall or at the side of a kerb. A loose or moving
    thing under a wheel was hit.
    """

    def __init__(self, compiled: Compiled, data: mujoco.MjData) -> None:
        model = compiled.model
        weld = model.body_weldid[model.geom_bodyid]
        fixed = (weld == 0) & (model.body_mocapid[model.geom_bodyid] < 0)
        #: Wheels, casters and other geoms that reach the ground, (ngeom,) bool.
        self.stands = _stands(compiled, data)
        self._carries = fixed & compiled.is_obstacle

    def rolls(
        self,
        part: NDArray[np.int64],
        obstacle: NDArray[np.int64],
        up: NDArray[np.float64],
        distance: NDArray[np.float64],
    ) -> NDArray[np.bool_]:
        """Return which parts of the robot roll on which obstacles, (N,) bool.

        Args:
            part, obstacle: (N,) geoms.
            up: (N,) vertical part of the unit vector from the obstacle to the part.
            distance: (N,) between their surfaces, m; negative inside.
        """
        carried = self.stands[part] & self._carries[obstacle]
        rolling: NDArray[np.bool_] = carried & (up >= _MIN_UP) & (distance >= -_SUNK_M)
        return rolling


def _stands(compiled: Compiled, data: mujoco.MjData) -> NDArray[np.bool_]:
    """Geoms that reach down to the wheels' contact height, (ngeom,) bool."""
    model = compiled.model
    low = bounds_of(model, data, np.arange(model.ngeom))[0][:, 2]
    floor = low[compiled.is_robot & (model.geom_conaffinity != 0)].min()
    slack = 0.1 * compiled.robot.drive.wheel_radius
    stands: NDArray[np.bool_] = compiled.is_robot & (low <= floor + slack)
    return stands
