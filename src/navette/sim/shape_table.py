# SPDX-License-Identifier: Apache-2.0
"""The shapes visible to a sensor, as arrays for ray casting."""

from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.sim import ray_kernels as rays

_KINDS = {
    mujoco.mjtGeom.mjGEOM_PLANE: rays.PLANE,
    mujoco.mjtGeom.mjGEOM_BOX: rays.BOX,
    mujoco.mjtGeom.mjGEOM_SPHERE: rays.SPHERE,
    mujoco.mjtGeom.mjGEOM_CYLINDER: rays.CYLINDER,
    mujoco.mjtGeom.mjGEOM_CAPSULE: rays.CAPSULE,
    mujoco.mjtGeom.mjGEOM_ELLIPSOID: rays.ELLIPSOID,
}


class ShapeTable:
    """Geoms of the given groups; poses of moving ones follow :meth:`update`.

    Attributes:
        kind, size, position, rotation: as in :mod:`navette.sim.ray_kernels`.
        has_others: there are meshes or height fields (MJCF worlds), against which only
            MuJoCo can cast rays.
    """

    def __init__(self, model: mujoco.MjModel, groups: Sequence[int]) -> None:
        self.geoms = np.flatnonzero(np.isin(model.geom_group, groups))
        types = model.geom_type[self.geoms]
        self.kind = np.array(
            [_KINDS.get(mujoco.mjtGeom(int(t)), rays.OTHER) for t in types],
            dtype=np.int64,
        )
        self.size = model.geom_size[self.geoms].copy()
        self.colour = model.geom_rgba[self.geoms, :3].astype(np.float32)
        self.has_others = bool(np.any(self.kind == rays.OTHER))
        self.position = np.zeros((len(self.geoms), 3))
        self.rotation = np.zeros((len(self.geoms), 3, 3))
        self._moving = np.flatnonzero(model.geom_bodyid[self.geoms] != 0)
        self._is_placed = False
        self.row_of_geom = np.full(model.ngeom + 1, -1, dtype=np.int32)
        self.row_of_geom[self.geoms] = np.arange(len(self.geoms))
        self.groups = np.zeros(mujoco.mjNGROUP, dtype=np.uint8)
        self.groups[list(groups)] = 1

    def update(self, data: mujoco.MjData) -> None:
        """Copy poses from the kinematics; those of static shapes only once."""
        rows = self._moving if self._is_placed else np.arange(len(self.geoms))
        self._is_placed = True
        if len(rows):
            geoms = self.geoms[rows]
            self.position[rows] = data.geom_xpos[geoms]
            self.rotation[rows] = data.geom_xmat[geoms].reshape(-1, 3, 3)

    def cast_with_mujoco(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        origin: NDArray[np.float64],
        directions: NDArray[np.float64],
        reach: float,
    ) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
        """Distances (N,) in lengths of the rays (N, 3), inf without a hit; and rows."""
        count = len(directions)
        distance, geom = np.empty(count), np.empty(count, dtype=np.int32)
        mujoco.mj_multiRay(
            model,
            data,
            origin,
            directions.ravel(),
            self.groups,
            True,  # static geoms too
            -1,
            geom,
            distance,
            None,
            count,
            reach,
        )
        distance[distance < 0] = np.inf
        return distance, self.row_of_geom[geom]
