# SPDX-License-Identifier: Apache-2.0
"""Outlines of obstacles from above: what blocks a robot of some height."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.sim.bounds import bounds_of
from navette.sim.build import Compiled
from navette.sim.profile import convex_hull

_CORNERS = 16  # of the polygon around a circle
_ROUND = (
    mujoco.mjtGeom.mjGEOM_SPHERE,
    mujoco.mjtGeom.mjGEOM_CYLINDER,
    mujoco.mjtGeom.mjGEOM_CAPSULE,
)
_CLEAR_M = 0.01  # an obstacle that ends this near the floor is part of it


def outlines_of(
    compiled: Compiled, data: mujoco.MjData, *, actors: bool
) -> list[NDArray[np.float64]]:
    """Return a convex outline (N, 2) of each obstacle, in the world frame (m).

    Obstacles above and below the robot are left out. Boxes and upright round shapes are
    exact (to a polygon), others are covered by their bounding box.

    Args:
        compiled: the scene.
        data: with the kinematics up to date.
        actors: those of the actors instead of those of all other obstacles.
    """
    robot = np.flatnonzero(compiled.is_robot)
    low, high = bounds_of(compiled.model, data, robot)
    floor, top = float(low[:, 2].min()) + _CLEAR_M, float(high[:, 2].max())
    scripted = compiled.model.body_mocapid[compiled.model.geom_bodyid] >= 0
    obstacles = np.flatnonzero(compiled.is_obstacle & (scripted == actors))
    low, high = bounds_of(compiled.model, data, obstacles)
    near = (high[:, 2] > floor) & (low[:, 2] < top)
    return [_outline(compiled.model, data, int(geom)) for geom in obstacles[near]]


def _outline(
    model: mujoco.MjModel, data: mujoco.MjData, geom: int
) -> NDArray[np.float64]:
    rotation = data.geom_xmat[geom].reshape(3, 3)
    kind = mujoco.mjtGeom(int(model.geom_type[geom]))
    if kind in _ROUND and abs(rotation[2, 2]) > 1 - 1e-9:
        turn = np.linspace(0.0, math.tau, _CORNERS, endpoint=False)
        around = model.geom_size[geom, 0] / math.cos(math.pi / _CORNERS)
        circle = around * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        return np.asarray(data.geom_xpos[geom, :2] + circle)
    centre, half = model.geom_aabb[geom].reshape(2, 3)
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, 8).T
    corners = data.geom_xpos[geom] + (centre + signs * half) @ rotation.T
    return np.array(convex_hull([(x, y) for x, y, _ in corners.tolist()]))
