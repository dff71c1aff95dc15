# SPDX-License-Identifier: Apache-2.0
"""The shapes visible to a sensor, as arrays for ray casting."""

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.sim import ray_kernels as rays
from navette.sim.ring_kernels import cast_rings
from navette.sim.surface import PLAIN, Surface

_NO_SURFACES: Mapping[int, Surface] = MappingProxyType({})

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
        has_surfaces: some are of glass or of dark material.
        has_others: there are meshes or height fields (MJCF worlds), against which only
            MuJoCo can cast rays.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        groups: Sequence[int],
        surfaces: Mapping[int, Surface] = _NO_SURFACES,
    ) -> None:
        self.geoms = np.flatnonzero(np.isin(model.geom_group, groups))
        types = model.geom_type[self.geoms]
        self.kind = np.array(
            [_KINDS.get(mujoco.mjtGeom(int(t)), rays.OTHER) for t in types],
            dtype=np.int64,
        )
        self.size = model.geom_size[self.geoms].copy()
        self.colour = model.geom_rgba[self.geoms, :3].astype(np.float32)
        self.has_others = bool(np.any(self.kind == rays.OTHER))
        found = [surfaces.get(int(geom), PLAIN) for geom in self.geoms]
        self.has_surfaces = any(each != PLAIN for each in found)
        self.specular = np.array([_specular_cosine(each) for each in found])
        self.reflectivity = np.array([each.reflectivity for each in found])
        self._reach = np.array([*(each.reach for each in found), 1.0])  # no shape: −1
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

    def cast_rings(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        pose: tuple[NDArray[np.float64], NDArray[np.float64]],
        azimuths: NDArray[np.float64],
        elevations: NDArray[np.float64],
        reach: float,
        specular: float | None = None,
    ) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
        """Distances (R, N) m and rows of rings of beams, after :meth:`update`.

        Surfaces answer as :class:`~navette.sim.surface.Surface` defines; meshes are
        opaque.

        Args:
            model, data: with the kinematics up to date.
            pose: position (3,) and rotation (3, 3) of the fan in the world.
            azimuths: (N,) rad, ascending, evenly spaced.
            elevations: (R,) rad.
            reach: largest range, m.
            specular: cosine of the largest angle from the normal at which any surface
                returns a beam, instead of the surfaces' own.
        """
        origin, world_R_fan = pose
        cosines = self.specular
        if specular is not None:
            cosines = np.full(len(self.kind), specular)
        shape = (len(elevations), len(azimuths))
        distance, rows = np.empty(shape), np.empty(shape, np.int32)
        if self.has_others:
            beams = ring_directions(azimuths, elevations).reshape(-1, 3)
            found = self.cast_with_mujoco(
                model, data, origin, beams @ world_R_fan.T, reach
            )
            distance[:], rows[:] = (each.reshape(shape) for each in found)
        else:
            cast_rings(
                self.kind, self.size, self.position, self.rotation, cosines,
                origin, world_R_fan, azimuths, elevations, reach, distance, rows,
            )  # fmt: skip
        lost = distance > reach * self._reach[rows]
        distance[lost], rows[lost] = np.inf, -1
        return distance, rows

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


def ring_directions(
    azimuths: NDArray[np.float64], elevations: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the unit vectors (R, N, 3) of rings of beams, in their frame."""
    across, up = np.cos(elevations)[:, None], np.sin(elevations)[:, None]
    x, y = across * np.cos(azimuths), across * np.sin(azimuths)
    return np.stack([x, y, np.broadcast_to(up, x.shape)], axis=-1)


def _specular_cosine(surface: Surface) -> float:
    """Return the cosine of a glass surface's specular angle; 0: opaque."""
    angle = surface.specular_rad
    return 0.0 if angle is None else max(1e-9, math.cos(angle))
